hertzian::oscillator! {
    pub Model(x) {
        param drive;
        ddot(x) + x + x^3 = drive*cos(omega);
    }
}

fn main() {}
