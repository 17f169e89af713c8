hertzian::oscillator! {
    pub Model(x) {
        param nu;
        ddot(x) + x = cos(omega*t) + cos(sqrt(2)*omega*t) + sin(nu*t);
    }
}

fn main() {}
