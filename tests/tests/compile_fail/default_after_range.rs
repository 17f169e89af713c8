hertzian::oscillator! {
    pub Model(x) {
        param alpha > 0 = 1.5;
        param zeta in 0.0..1.0 = 0.1;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^alpha = 0;
    }
}

fn main() {}
