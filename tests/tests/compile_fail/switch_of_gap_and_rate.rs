hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + x + sgn(x + dot(x)) = cos(omega*t);
    }
}

fn main() {}
