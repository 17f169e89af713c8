hertzian::oscillator! {
    pub Model(x) {
        param m;
        ddot(x) + x/m + 1/(x - 2) = cos(omega*t);
    }
}

fn main() {}
