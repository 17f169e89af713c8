hertzian::oscillator! {
    pub Model(x) {
        param n;
        ddot(x) + for j in 1..=n { x^3/j } = cos(omega*t);
    }
}

fn main() {}
