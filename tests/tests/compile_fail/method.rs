hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + x.powi(3) = 0;
    }
}

fn main() {}
