hertzian::oscillator! {
    pub Model {
        ddot(x) + x = 0;
    }
}

fn main() {}
