hertzian::oscillator! {
    pub Model(x) {
        law contact(gap) { gap > 0 => x^1.5, else => 0 }
        ddot(x) + contact(x) = 0;
    }
}

fn main() {}
