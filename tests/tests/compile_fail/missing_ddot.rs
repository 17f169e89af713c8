hertzian::oscillator! {
    pub Model(x) {
        dot(x) + x = cos(omega*t);
    }
}

fn main() {}
