hertzian::oscillator! {
    pub Chain(x[8]) {
        for j in 1..8 {
            ddot(x[j]) + x[j] - x[j - 1] = cos(omega*t);
        }
    }
}

fn main() {}
