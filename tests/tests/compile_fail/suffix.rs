hertzian::oscillator! {
    pub Model(x) {
        param zeta;
        ddot(x) + 2zeta*dot(x) + x = cos(omega*t);
    }
}

fn main() {
    let _ = Model { zeta: 0.1 };
}
