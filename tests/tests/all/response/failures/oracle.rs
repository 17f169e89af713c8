//! One-sided contact integrated by hand, well or badly: Runge-Kutta with or without a look for switches, and with or without what
//! a perturbation does there.
//!
//! ```text
//! x'' + H(x) (2 zeta x' + x^alpha) = drive cos(omega t) + load                                               (1)
//! d(x, x') on leaving a switch = [ 1 0; -+ 2 zeta 1 ] d(x, x') on arriving, + on leaving contact             (2)
//! ```
//!
//! Source of (2), saltation: Leine and Nijmeijer (2004), Dynamics and Bifurcations of Non-Smooth Mechanical Systems, chapter 7.

use std::f64::consts::TAU;

use hertzian::Complex;

/// Parameters of (1).
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    pub alpha: f64,
    pub zeta: f64,
    pub load: f64,
    pub drive: f64,
    pub omega: f64,
}

/// How switches are met.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Switches {
    /// Located, and (2) applied.
    Exact,
    /// Located, but (2) left out.
    WithoutSaltation,
    /// Stepped over.
    Ignored,
}

/// `x`, `x'`, and the derivatives of both by the initial `x` and by the initial `x'`.
type State = [f64; 6];

impl Contact {
    fn field(&self, t: f64, s: &State, inside: bool) -> State {
        let [x, v, a, b, c, d] = *s;
        let drive = self.drive * (self.omega * t).cos() + self.load;
        if !inside {
            return [v, drive, b, 0.0, d, 0.0];
        }
        // Stages may reach beyond the level: the piece continues as its odd part.
        let size = x.abs();
        let damping = 2.0 * self.zeta;
        let (force, slope) = match self.alpha {
            1.0 => (x, 1.0),
            _ if size == 0.0 => (0.0, 0.0),
            alpha => {
                let slope = alpha * size.powf(alpha - 1.0);
                (slope * x / alpha, slope)
            }
        };
        let pull = |x: f64, v: f64| -damping * v - slope * x;
        [v, drive - damping * v - force, b, pull(a, b), d, pull(c, d)]
    }

    fn step(&self, t: f64, h: f64, s: &State, inside: impl Fn(&State) -> bool) -> State {
        let moved = |k: &State, h: f64| -> State { std::array::from_fn(|i| s[i] + h * k[i]) };
        let slope = |t: f64, s: &State| self.field(t, s, inside(s));
        let k1 = slope(t, s);
        let k2 = slope(t + 0.5 * h, &moved(&k1, 0.5 * h));
        let k3 = slope(t + 0.5 * h, &moved(&k2, 0.5 * h));
        let k4 = slope(t + h, &moved(&k3, h));
        std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    }

    /// One step, divided where it meets a switch.
    fn located(&self, mut t: f64, mut h: f64, s: &mut State, inside: &mut bool, salted: bool) {
        loop {
            let end = self.step(t, h, s, |_| *inside);
            if (end[0] > 0.0) == *inside {
                *s = end;
                return;
            }
            let (mut low, mut high) = (0.0, h);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                let there = self.step(t, middle, s, |_| *inside);
                if (there[0] > 0.0) == *inside {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            *s = self.step(t, high, s, |_| *inside);
            s[0] = 0.0;
            if salted {
                let jump = if *inside { 2.0 } else { -2.0 } * self.zeta;
                s[3] += jump * s[2];
                s[5] += jump * s[4];
            }
            *inside = !*inside;
            (t, h) = (t + high, h - high);
            if h <= 0.0 {
                return;
            }
        }
    }

    /// State after some periods of the excitation, and the derivatives by the initial state; `see` is called before every step.
    pub fn map(
        &self,
        state: [f64; 2],
        periods: usize,
        steps: usize,
        switches: Switches,
        mut see: impl FnMut([f64; 2]),
    ) -> ([f64; 2], [[f64; 2]; 2]) {
        let h = TAU / self.omega / steps as f64;
        let mut s = [state[0], state[1], 1.0, 0.0, 0.0, 1.0];
        let mut inside = s[0] > 0.0 || s[0] == 0.0 && s[1] > 0.0;
        for index in 0..periods * steps {
            see([s[0], s[1]]);
            let t = h * index as f64;
            if switches == Switches::Ignored {
                s = self.step(t, h, &s, |s| s[0] > 0.0);
            } else {
                let salted = switches == Switches::Exact;
                self.located(t, h, &mut s, &mut inside, salted);
            }
        }
        ([s[0], s[1]], [[s[2], s[4]], [s[3], s[5]]])
    }

    /// The orbit near a state: its state at phase zero.
    pub fn orbit(&self, mut state: [f64; 2], periods: usize, steps: usize) -> [f64; 2] {
        for _ in 0..20 {
            let ([x, v], [[a, b], [c, d]]) =
                self.map(state, periods, steps, Switches::Exact, |_| ());
            let (rx, rv) = (x - state[0], v - state[1]);
            let determinant = (a - 1.0) * (d - 1.0) - b * c;
            let dx = ((d - 1.0) * rx - b * rv) / determinant;
            let dv = ((a - 1.0) * rv - c * rx) / determinant;
            state = [state[0] - dx, state[1] - dv];
            if dx.hypot(dv) < 1e-12 * state[0].hypot(state[1]).max(1.0) {
                break;
            }
        }
        state
    }

    /// Multipliers along the motion from a state.
    pub fn multipliers(
        &self,
        state: [f64; 2],
        periods: usize,
        steps: usize,
        switches: Switches,
    ) -> [Complex<f64>; 2] {
        let (_, [[a, b], [c, d]]) = self.map(state, periods, steps, switches, |_| ());
        let (mean, determinant) = (0.5 * (a + d), a * d - b * c);
        let root = Complex::new(mean * mean - determinant, 0.0).sqrt();
        [mean + root, mean - root].map(|value| value * Complex::new(1.0, 0.0))
    }
}

/// Orbits of period one, two and three at drive 1, frequency 1, alpha 1, load 1, zeta 0.032: state at phase zero and multiplier with
/// positive imaginary part. From the closed-form flow in 80-bit arithmetic, independent of this project (`periodic_solutions` of
/// the reference values).
pub const EXACT: [([f64; 2], [f64; 2]); 3] = [
    (
        [-1.999_776_122_757_642_7, 0.178_235_874_603_685_45],
        [-0.655_596_449_627_929_2, 0.615_582_920_279_132_8],
    ),
    (
        [-5.632_060_192_753_841, 3.526_590_078_650_18],
        [-0.524_746_191_089_171_2, 0.733_336_154_170_019_1],
    ),
    (
        [-31.334_287_816_436_89, 0.605_360_285_158_400_4],
        [-0.380_774_924_593_537_2, 0.817_888_662_584_343_5],
    ),
];

/// Both multipliers of an orbit of [`EXACT`].
pub fn pair([re, im]: [f64; 2]) -> [Complex<f64>; 2] {
    [Complex::new(re, im), Complex::new(re, -im)]
}

/// That of the paper at this drive, exponent one.
pub const fn paper(drive: f64) -> Contact {
    Contact {
        alpha: 1.0,
        zeta: 0.032,
        load: 1.0,
        drive,
        omega: 1.0,
    }
}

#[test]
fn the_oracle_is_exact() {
    for (index, (state, multiplier)) in EXACT.into_iter().enumerate() {
        let periods = index + 1;
        let found = paper(1.0).orbit(state, periods, 4000);
        assert!((found[0] - state[0]).hypot(found[1] - state[1]) < 1e-9);
        let found = paper(1.0).multipliers(found, periods, 4000, Switches::Exact);
        let error = super::models::distance(&found, &pair(multiplier));
        assert!(error < 1e-9, "{periods}: {error:e}");
    }
}
