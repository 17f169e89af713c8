hertzian::oscillator! {
    pub Model(x) {
        law contact(gap) { gap > 0 => gap^1.5*cos(omega*t), else => 0 }
        ddot(x) + contact(x) = 0;
    }
}

fn main() {}
