hertzian::oscillator! {
    pub Model(x) {
        law contact(gap) {
            gap > 0 => gap^1.5,
            else => 0,
        }
        ddot(x) + h(x) = cos(omega*t);
    }
}

fn main() {}
