hertzian::oscillator! {
    pub Model(x) {
        law contact(gap) {
            gap > 1 => gap - 1,
            gap < 0 => gap,
        }
        ddot(x) + contact(x) = cos(omega*t);
    }
}

fn main() {}
