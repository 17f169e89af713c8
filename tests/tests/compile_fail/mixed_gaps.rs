hertzian::oscillator! {
    pub Model(x, y) {
        ddot(x) + x*y^2 = cos(omega*t);
        ddot(y) + y = 0;
    }
}

fn main() {}
