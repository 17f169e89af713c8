hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + |x + dot(x)| = cos(omega*t);
    }
}

fn main() {}
