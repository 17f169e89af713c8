hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + x;
    }
}

fn main() {}
