hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + x^1.5 = cos(omega*t);
    }
}

fn main() {}
