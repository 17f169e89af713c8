hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + x**3 = cos(omega*t);
    }
}

fn main() {}
