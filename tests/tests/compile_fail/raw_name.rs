hertzian::oscillator! {
    pub Model(x) {
        param r#type;
        ddot(x) + r#type*x^3 = cos(omega*t);
    }
}

fn main() {}
