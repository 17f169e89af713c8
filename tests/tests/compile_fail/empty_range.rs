hertzian::oscillator! {
    pub Model(x) {
        param zeta in 1.0..0.5;
        ddot(x) + zeta*x = cos(omega*t);
    }
}

fn main() {}
