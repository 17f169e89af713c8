hertzian::oscillator! {
    pub Model(x) {
        param m in 0.0..;
        m*ddot(x) + x = cos(omega*t);
    }
}

fn main() {}
