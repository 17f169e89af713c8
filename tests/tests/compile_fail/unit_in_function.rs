hertzian::oscillator! {
    pub Sprung(x: m) {
        param k: m/s^2 > 0;
        ddot(x) + k*tanh(x) = 0;
    }
}

fn main() {}
