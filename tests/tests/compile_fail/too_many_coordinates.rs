hertzian::oscillator! {
    pub Chain(x[100000]) {
        for j in 0..100 {
            ddot(x[j]) + x[j] = 0;
        }
    }
}

fn main() {}
