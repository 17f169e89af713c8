hertzian::oscillator! {
    pub Model(x, y) {
        ddot(x) + x - y = cos(omega*t);
    }
}

fn main() {}
