hertzian::oscillator! {
    pub Model(x) {
        param k;
        law contact(gap, s) { gap > 0 => s*gap, else => 0 }
        ddot(x) + contact(x) + cos(x, k) = 0;
    }
}

fn main() {}
