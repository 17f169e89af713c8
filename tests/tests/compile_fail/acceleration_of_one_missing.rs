hertzian::oscillator! {
    pub Model(x, y) {
        ddot(x) + x = cos(omega*t);
        ddot(x) + y = 0;
    }
}

fn main() {}
