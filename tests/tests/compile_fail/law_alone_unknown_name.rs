hertzian::law! {
    pub Hertz(gap, stiffness) { gap > 0 => stifness*gap^1.5, else => 0 }
}

fn main() {
    let _ = Hertz;
}
