hertzian::oscillator! {
    pub Model(x) {
        law stop(gap) { gap > 0 => gap^1.5, else => 0 }
        ddot(x) + stop(x) = cos(omega*t);
        output force = stop(x - 1);
    }
}

fn main() {}
