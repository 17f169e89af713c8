hertzian::oscillator! {
    pub Chain(x[2]) {
        param k;
        ddot(x[0]) + x[k] = cos(omega*t);
        ddot(x[1]) + x[1/2] = 0;
    }
}

fn main() {}
