hertzian::oscillator! {
    pub Model(x) {
        (1 + 0.1*cos(omega*t))*ddot(x) + x = 0;
    }
}

fn main() {}
