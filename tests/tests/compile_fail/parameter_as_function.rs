hertzian::oscillator! {
    pub Model(x) {
        param zeta;
        ddot(x) + zeta(x + 1) = cos(omega*t);
    }
}

fn main() {}
