hertzian::oscillator! {
    pub Model(x) {
        param k;
        ddot(x) + for k in 0..8 { k*x } = k*cos(omega*t);
    }
}

fn main() {}
