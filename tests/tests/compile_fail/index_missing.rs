hertzian::oscillator! {
    pub Chain(x[2], y) {
        ddot(x[0]) + x = cos(omega*t);
        ddot(x[1]) + x[1] = 0;
        ddot(y) + y[0] = 0;
    }
}

fn main() {}
