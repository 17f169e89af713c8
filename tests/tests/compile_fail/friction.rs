hertzian::oscillator! {
    pub Model(x) {
        param mu;
        ddot(x) + x + mu*sgn(dot(x)) = cos(omega*t);
    }
}

fn main() {}
