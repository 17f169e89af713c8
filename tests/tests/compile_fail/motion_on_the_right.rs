hertzian::oscillator! {
    pub Model(x) {
        param k;
        ddot(x) = cos(omega*t) - k*x - x^3;
    }
}

fn main() {}
