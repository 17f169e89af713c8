hertzian::oscillator! {
    pub Model(x) {
        param zeta;
        ddot(x) + 2 zeta*dot(x) + x = cos(omega*t);
    }
}

fn main() {}
