hertzian::oscillator! {
    pub Model(x) {
        param __law;
        ddot(x) + __law*x^3 = cos(omega*t);
    }
}

fn main() {}
