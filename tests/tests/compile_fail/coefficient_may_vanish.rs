hertzian::oscillator! {
    pub Model(x, y) {
        param a;
        param b;
        ddot(x) + x = cos(omega*t);
        ddot(y) + y + tanh(a*x + b*y) = 0;
    }
}

fn main() {
    let _ = Model { a: 1.0, b: 1.0 };
}
