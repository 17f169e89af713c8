hertzian::law! {
    pub Hertz(gap, k, n) { gap > 0 => k*gap^n, else => 0 }
}

fn main() {
    let _ = Hertz;
}
