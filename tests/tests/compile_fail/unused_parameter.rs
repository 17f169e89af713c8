hertzian::oscillator! {
    pub Model(x) {
        param zeta in 0.0..;
        param drive;
        ddot(x) + x = drive*cos(omega*t);
    }
}

fn main() {
    let _ = Model { zeta: 0.1, drive: 1.0 };
}
