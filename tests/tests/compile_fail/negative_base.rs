hertzian::oscillator! {
    pub Model(x) {
        law contact(gap) {
            gap > -1 => gap^1.5,
            else => 0,
        }
        ddot(x) + contact(x) = cos(omega*t);
    }
}

fn main() {}
