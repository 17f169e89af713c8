//! Motions whose force bends with the rate, against their closed form.
//!
//! `ddot(x) + c*max(0, dot(x)) + x = 0` is a rotation while the rate is negative, and a damped oscillation while it is positive; the field
//! is continuous between, so that the derivative by the first state is the product of those of the parts.

use hertzian::generic::Declaration;
use hertzian::time::{Flow, Integrated, Tangent};
use hertzian_tests::random::Random;

const MOTIONS: u64 = 300;

type Matrix = [[f64; 2]; 2];

fn product(a: Matrix, b: Matrix) -> Matrix {
    let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

fn applied(a: Matrix, x: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| a[i][0] * x[0] + a[i][1] * x[1])
}

/// The flow of `ddot(x) + c*dot(x) + x = 0`: with `a = c/2` and `w^2 = 1 - a^2`, `exp(-a t) (cos wt + sin wt / w (A + a))`.
fn damped(c: f64, time: f64) -> Matrix {
    let a = 0.5 * c;
    let w = (1.0 - a * a).sqrt();
    let (sin, cos) = (w * time).sin_cos();
    let (sin, size) = (sin / w, (-a * time).exp());
    [
        [size * (cos + a * sin), size * sin],
        [-size * sin, size * (cos - a * sin)],
    ]
}

/// When the rate of that motion vanishes first: `tan wt = v w / (x + a v)`.
fn turns(c: f64, [x, v]: [f64; 2]) -> f64 {
    let a = 0.5 * c;
    let w = (1.0 - a * a).sqrt();
    let angle = (v * w).atan2(x + a * v);
    let half = std::f64::consts::PI;
    let angle = angle.rem_euclid(half);
    (if angle < 1e-9 { angle + half } else { angle }) / w
}

/// The state after a time, and its derivative by the first.
fn exact(c: f64, mut state: [f64; 2], mut left: f64) -> ([f64; 2], Matrix) {
    let mut derivative = [[1.0, 0.0], [0.0, 1.0]];
    let mut positive = state[1] > 0.0;
    loop {
        let damping = if positive { c } else { 0.0 };
        let until = turns(damping, state).min(left);
        let part = damped(damping, until);
        (state, derivative) = (applied(part, state), product(part, derivative));
        left -= until;
        if left <= 0.0 {
            return (state, derivative);
        }
        positive = !positive;
    }
}

#[test]
fn derivatives_of_motions_know_where_the_force_bends() {
    let text = "Ratchet(x) {
        param c = 0.5 > 0;
        law swing(gap) { c*max(0, dot(gap)) }
        ddot(x) + x + swing(x) = 0;
    }";
    let mut random = Random::of(7);
    for motion in 0..MOTIONS {
        let c = random.magnitude(1e-2, 1.8);
        let start = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
        let time = random.between(1.0, 12.0);
        let mut ratchet = Declaration::parse(text).unwrap();
        ratchet.set("c", c).unwrap();
        let values = [c];
        let mut flow = Integrated::new(&ratchet, &values, 1.0, 1e-12).unwrap();
        let mut state = start.to_vec();
        let mut tangent = Tangent::of_state(1, None);
        let see = Some(&mut tangent);
        flow.advance(0.0, time, &mut state, see, None).unwrap();
        let (there, derivative) = exact(c, start, time);
        let name = format!("{motion}: c {c}, from {start:?} for {time}");
        for i in 0..2 {
            let error = (state[i] - there[i]).abs();
            assert!(error < 1e-10, "{name}: state {error:.1e}");
            for j in 0..2 {
                let error = (tangent.columns[2 * j + i] - derivative[i][j]).abs();
                assert!(error < 1e-9, "{name}: derivative {error:.1e}");
            }
        }
    }
}
