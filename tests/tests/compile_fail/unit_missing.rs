hertzian::oscillator! {
    pub Sprung(x: m, y) {
        param k: 1/s^2 > 0;
        param c;
        ddot(x) + c*dot(x) + k*x = 0;
        ddot(y) + k*(y - x) = 0;
    }
}

fn main() {}
