hertzian::oscillator! {
    pub Model(x) {
        param power > 1;
        law stop(gap, n > 1) { gap > 0 => gap^n, else => 0 }
        ddot(x) + stop(x, power) = 0;
    }
}

fn main() {}
