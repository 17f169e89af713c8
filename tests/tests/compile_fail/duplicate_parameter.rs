hertzian::oscillator! {
    pub Model(x) {
        param zeta in 0.0..;
        param zeta;
        ddot(x) + 2*zeta*dot(x) + x = cos(omega*t);
    }
}

fn main() {
    let _ = Model { zeta: 0.1 };
}
