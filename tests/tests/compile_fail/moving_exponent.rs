hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + 2^x = cos(omega*t);
    }
}

fn main() {}
