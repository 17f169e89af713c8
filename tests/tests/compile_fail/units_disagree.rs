hertzian::oscillator! {
    pub Sprung(x: m) {
        param m: kg > 0;
        param c: N*s/m in 0.0..;
        param k: N/m^1.5 in 0.0..;
        param drive: N;
        law contact(gap) { gap > 0 => k*gap^2, else => 0 }
        m*ddot(x) + c*dot(x) + contact(x) = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    pub Millimetres(x: mm) {
        param m: kg > 0;
        param k: N/mm;
        m*ddot(x) + k*x = 0;
    }
}

fn main() {}
