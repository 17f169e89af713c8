hertzian::oscillator! {
    pub Model(x, y) {
        law stop(gap) { gap > 0 => gap^1.5, else => 0 }
        ddot(x) + stop(x) = cos(omega*t); ddot(y) + stop(y) = cos(omega*t);
        output force = force(stop);
    }
}

fn main() {}
