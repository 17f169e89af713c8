hertzian::oscillator! {
    pub Model(x) {
        law contact(gap) {
            gap > => gap,
            gap = 0 => 0,
            else 0,
        }
        law other { else => 0 }
        ddot(x) + contact(x) = cos(omega*t);
    }
}

fn main() {}
