hertzian::law! {
    pub Hertz(gap > 0, k) { gap > 0 => k*gap^1.5, else => 0 }
}

fn main() {
    let _ = Hertz;
}
