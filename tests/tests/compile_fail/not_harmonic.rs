hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + x = cos(omega*t^2) + |cos(omega*t)| + t + 1/(2 + sin(omega*t));
    }
}

fn main() {}
