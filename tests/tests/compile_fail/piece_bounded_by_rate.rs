hertzian::oscillator! {
    pub Model(x) {
        law contact(gap) {
            dot(gap) > 0 => gap,
            else => 0,
        }
        ddot(x) + contact(x) = cos(omega*t);
    }
}

fn main() {}
