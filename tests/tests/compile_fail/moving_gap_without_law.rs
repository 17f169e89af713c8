hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + (x - cos(omega*t))^3 = 0;
    }
}

fn main() {}
