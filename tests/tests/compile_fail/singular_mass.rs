hertzian::oscillator! {
    pub Model(x, y) {
        ddot(x) + ddot(y) + x = cos(omega*t);
        2*ddot(x) + 2*ddot(y) + y = 0;
    }
}

fn main() {}
