hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + x = max(0, cos(omega*t));
    }
}

fn main() {}
