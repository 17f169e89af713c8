hertzian::oscillator! {
    pub f64(x) {
        ddot(x) + x^3 = cos(omega*t);
    }
}

fn main() {}
