hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + dot + x = 0;
    }
}

fn main() {}
