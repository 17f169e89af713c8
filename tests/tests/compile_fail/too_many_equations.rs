hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + x = cos(omega*t);
        ddot(x) + 2*x = 0;
    }
}

fn main() {}
