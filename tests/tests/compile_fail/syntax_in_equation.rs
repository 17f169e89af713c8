hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + (x = 2) - cos(omega*t);
        ddot(x) + |x + 2 = cos(omega*t);
        ddot(x) + x;
        ddot(x) + * x = 0;
        ddot(x) + x = 0
    }
}

fn main() {}
