hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + for i in 0..1000 { for j in 0..1000 { x/(i + j + 1) } } = cos(omega*t);
    }
}

fn main() {}
