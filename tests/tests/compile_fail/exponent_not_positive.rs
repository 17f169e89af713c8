hertzian::oscillator! {
    pub Model(x) {
        param alpha;
        law contact(gap) {
            gap > 0 => gap^alpha,
            else => 0,
        }
        ddot(x) + contact(x) = cos(omega*t);
    }
}

fn main() {}
