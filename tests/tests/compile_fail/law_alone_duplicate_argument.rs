hertzian::law! {
    pub Spring(gap, k, k) { gap > 0 => k*gap, else => 0 }
}

fn main() {
    let _ = Spring;
}
