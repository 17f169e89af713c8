hertzian::oscillator! {
    pub Model(x) {
        param zeta;
        law contact(gap) { gap > 0 => gap^1.5, gap > 1 => 0 }
        ddot(x) + 2*zeta*dot(x) + contact(x) + |x|^zeta = cos(sqrt(3)*omega*t);
    }
}

fn main() {}
