hertzian::oscillator! {
    pub Model(x) {
        law contact(gap) {
            else => 0,
            gap > 0 => gap^1.5,
        }
        ddot(x) + contact(x) = cos(omega*t);
    }
}

fn main() {}
