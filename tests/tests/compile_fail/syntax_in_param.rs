hertzian::oscillator! {
    pub Model(x) {
        param zeta in 0.0;
        param 2;
        param load 3;
        param range in ..a;
        ddot(x) + zeta*x = load*cos(omega*t);
    }
}

fn main() {
    let _ = Model { zeta: 0.1, load: 1.0, range: 0.0 };
}
