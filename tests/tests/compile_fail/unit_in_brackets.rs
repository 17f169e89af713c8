hertzian::oscillator! {
    pub Model(x [m]) {
        param k [N/m];
        1*ddot(x) + k*x = cos(omega*t);
    }
}

fn main() {}
