hertzian::law! {
    pub Stop(gap, k) { gap > 0 => k*gap^1.5, gap < -1 => k*(gap + 1) }
}

fn main() {
    let _ = Stop;
}
