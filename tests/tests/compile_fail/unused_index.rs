hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + for j in 0..8 { x^3 } = cos(omega*t);
    }
}

fn main() {}
