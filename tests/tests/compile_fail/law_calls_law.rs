hertzian::oscillator! {
    pub Model(x) {
        law contact(gap) { gap > 0 => gap^1.5, else => 0 }
        law double(u) { contact(u) + contact(2*u) }
        ddot(x) + double(x) = 0;
    }
}

fn main() {}
