hertzian::oscillator! {
    pub Model(x) {
        param zeta = -0.1 in 0.0..;
        param k = 0 > 0;
        ddot(x) + 2*zeta*dot(x) + k*x = 0;
    }
}

fn main() {}
