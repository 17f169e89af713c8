hertzian::oscillator! {
    pub Model(x) {
        law contact(gap) { 2 }
        ddot(x) + contact(x) = cos(omega*t);
    }
}

fn main() {}
