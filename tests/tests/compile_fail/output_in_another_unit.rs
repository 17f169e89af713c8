hertzian::oscillator! {
    pub Model(x: mm) {
        param m: t > 0;
        param k: N/mm^1.5 > 0;
        param drive: N;
        law stop(gap) { gap > 0 => k*gap^1.5, else => 0 }
        m*ddot(x) + stop(x) = drive*cos(omega*t);
        output stroke: N = x;
    }
}

fn main() {}
