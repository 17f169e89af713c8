hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + max(0, x)*H(1 + 2*dot(x)) = cos(omega*t);
    }
}

fn main() {}
