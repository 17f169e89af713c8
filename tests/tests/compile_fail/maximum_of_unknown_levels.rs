hertzian::oscillator! {
    pub Model(x) {
        param d;
        ddot(x) + max(0, |x| - d) = cos(omega*t);
    }
}

fn main() {}
