hertzian::law! {
    pub Spring(gap, k = 3) { gap > 0 => k*gap, else => 0 }
}

fn main() {
    let _ = Spring;
}
