hertzian::oscillator! {
    pub Model(x) {
        law contact(gap) {
            gap > 0 => gap^1.5,
            gap < 0 => 0,
        }
        ddot(x) + contact(x) = cos(omega*t);
    }
}

fn main() {}
