hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + x = cos(w*t);
    }
}

fn main() {}
