hertzian::oscillator! {
    pub Sprung(x: metre) {
        param k: 1/s^2 > 0;
        param c: 1/sec;
        ddot(x) + c*dot(x) + k*x = 0;
    }
}

fn main() {}
