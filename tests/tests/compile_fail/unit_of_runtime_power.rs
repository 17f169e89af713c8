hertzian::oscillator! {
    pub Sprung(x: m) {
        param m: kg > 0;
        param k: N in 0.0..;
        param alpha: 1 > 0;
        law contact(gap) { gap > 0 => k*gap^alpha, else => 0 }
        m*ddot(x) + contact(x) = 0;
    }
}

fn main() {}
