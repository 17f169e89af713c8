hertzian::oscillator! {
    pub Chain(x[8]) {
        for j in 0..8 {
            ddot(x[j]) + 2*x[j] - x[j - 1] - x[j + 1] = 0;
        }
    }
}

fn main() {}
