hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + sign(x)*x^2 = coss(omega*t);
    }
}

fn main() {}
