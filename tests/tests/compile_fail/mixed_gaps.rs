hertzian::oscillator! {
    pub Model(x, y) {
        ddot(x) + x*|y| + x^2*dot(y) = cos(omega*t);
        ddot(y) + y = 0;
    }
}

fn main() {}
