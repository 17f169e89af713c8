hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + |x|^1/3 = cos(omega*t);
    }
}

fn main() {}
