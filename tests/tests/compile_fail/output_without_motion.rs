hertzian::oscillator! {
    pub Model(x) {
        param drive;
        law stop(gap) { gap > 0 => gap^1.5, else => 0 }
        ddot(x) + stop(x) = drive*cos(omega*t);
        output load = drive*cos(omega*t);
    }
}

fn main() {}
