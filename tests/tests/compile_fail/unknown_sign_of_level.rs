hertzian::oscillator! {
    pub Model(x) {
        param k;
        ddot(x) + |k*x - 1| = cos(omega*t);
    }
}

fn main() {}
