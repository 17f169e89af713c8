hertzian::oscillator! {
    pub Model(x) {
        param zeta in 0.0..;
        ddot(x) + 2*zeta*dot(x) + x + zetta*x^3 = cos(omega*t);
    }
}

fn main() {}
