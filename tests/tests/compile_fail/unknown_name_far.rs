hertzian::oscillator! {
    pub Model(x) {
        ddot(x) + stiffness*x = cos(omega*t);
    }
}

fn main() {}
