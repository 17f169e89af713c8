hertzian::oscillator! {
    pub Model(x, y) {
        param m = -2;
        -3*ddot(x) + x^3 = cos(omega*t);
        m*ddot(y) + y^3 = 0;
    }
}

fn main() {}
