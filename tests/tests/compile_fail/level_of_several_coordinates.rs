hertzian::oscillator! {
    pub Model(x, y) {
        param a;
        ddot(x) + max(0, a*(x - y) - 1) = cos(omega*t);
        ddot(y) + y = 0;
    }
}

fn main() {}
