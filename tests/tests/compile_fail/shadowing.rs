hertzian::oscillator! {
    pub Model(x) {
        param omega;
        param x;
        law pi(gap) { gap > 0 => gap, else => 0 }
        law contact(t) { t > 0 => t, else => 0 }
        ddot(x) + x + pi(x) + contact(x) = cos(omega*t);
    }
}

fn main() {}
