hertzian::oscillator! {
    pub Model(x) {
        param play;
        law backlash(gap) {
            gap > play => gap - play,
            gap < -play => gap + play,
            else => 0,
        }
        ddot(x) + backlash(x) = cos(omega*t);
    }
}

fn main() {}
