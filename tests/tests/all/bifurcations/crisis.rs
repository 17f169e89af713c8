//! The interior crisis of Wang et al. (2021), Eq. (1), one-sided, exponent one: `zeta = 0.032`, `W = 1`, `omega = 1`.
//!
//! Below the crisis the chaotic motion stays in a band, above it leaves the band for excursions down to `x = -84`. The two are
//! divided by the stable manifold of an unstable orbit `p` of period six, with multipliers `beta_1 = 19.2` and `beta_2 = 0.0139`.
//! In the direction of its left eigenvector `l`, a state `y` that passes `p` lies at
//!
//! ```text
//! xi = l . (F^6(y) - p) / beta_1                                                                              (1)
//! ```
//!
//! from that manifold; the six periods take off all but `beta_2` of the distance along it. One branch of the unstable manifold
//! of `p` folds back and passes `p` again 28 periods later. Where the smallest `xi` of that fold vanishes, the two manifolds
//! touch: the crisis. Above it motions stay in the band for a mean time that grows, by (3.4) of the source and but for
//! oscillations, as
//!
//! ```text
//! T ~ (A - A_c)^-gamma,    gamma = ln beta_2 / (2 ln(beta_1 beta_2)) = 1.62                                   (2)
//! ```
//!
//! so that just above `A_c` a run shows nothing. The times measured, each over 8 to 20 runs, are 1.8e6 periods at `A = 1.7819`,
//! 2.0e6 at 1.78195, 2.6e5 at 1.7820 and some thousands from 1.7822 on. Runs of a million periods see the first escapes between
//! 1.7819 and 1.7820; the crisis lies below both.
//!
//! Source: Grebogi, Ott, Romeiras and Yorke (1987), Critical exponents for crisis-induced intermittency, Phys. Rev. A 36, 5365.

use hertzian::time::Tangent;
use hertzian::time::affine::Affine;
use hertzian::time::stroboscope::Stroboscope;
use hertzian_tests::OneSidedLinear;

type State = [f64; 2];

/// Periods of the orbit, and after which the fold passes it.
const PERIODS: usize = 6;
const RETURN: usize = 28;

fn with_map<T>(drive: f64, then: impl FnOnce(&mut Stroboscope) -> T) -> T {
    let model = OneSidedLinear {
        zeta: 0.032,
        load: 1.0,
        drive,
    };
    let flow = Affine::new(&model, &[model.zeta, model.load, drive], 1.0).expect("affine");
    then(&mut Stroboscope::new(Box::new(flow)))
}

fn after(map: &mut Stroboscope, periods: usize, mut state: State) -> State {
    for _ in 0..periods {
        map.map(&mut state).expect("a motion");
    }
    state
}

/// The orbit of period six.
struct Saddle {
    at: State,
    /// `beta_1, beta_2`
    multipliers: [f64; 2],
    /// The eigenvector of `beta_1`, on the side of `xi > 0`.
    right: State,
    /// The left eigenvector `l`.
    left: State,
}

impl Saddle {
    /// By Newton's method.
    fn of(map: &mut Stroboscope) -> Self {
        let mut at = [0.3266, 0.0654];
        for _ in 0..20 {
            let ([x, v], [a, b, c, d]) = Self::returned(map, at);
            let (fx, fv) = (x - at[0], v - at[1]);
            let determinant = (a - 1.0) * (d - 1.0) - b * c;
            at[0] -= ((d - 1.0) * fx - b * fv) / determinant;
            at[1] -= ((a - 1.0) * fv - c * fx) / determinant;
        }
        let (back, [a, b, c, d]) = Self::returned(map, at);
        assert!((back[0] - at[0]).hypot(back[1] - at[1]) < 1e-12);
        let (half, product) = (0.5 * (a + d), a * d - b * c);
        let first = half + (half * half - product).sqrt();
        let unit = |[x, y]: State| [x, y].map(|z| z / x.hypot(y));
        let (right, left) = (unit([b, first - a]), unit([c, first - a]));
        let side = dot(left, right).signum();
        Self {
            at,
            multipliers: [first, product / first],
            right: right.map(|x| side * x),
            left,
        }
    }

    /// The state after the period, and the matrix `[a b; c d]` of its derivatives.
    fn returned(map: &mut Stroboscope, at: State) -> (State, [f64; 4]) {
        let (mut state, mut tangent) = (at, Tangent::of_state(1, None));
        for _ in 0..PERIODS {
            map.map_with(&mut state, &mut tangent).expect("a motion");
        }
        let [a, c, b, d] = tangent.columns[..] else {
            panic!("two columns of two");
        };
        (state, [a, b, c, d])
    }

    /// (1), of the state that comes back from the unstable manifold at `1e-5 beta_1^part`.
    fn distance(&self, map: &mut Stroboscope, part: f64) -> f64 {
        let [first, _] = self.multipliers;
        let start = 1e-5 * first.powf(part);
        let start = [0, 1].map(|i| self.at[i] + start * self.right[i]);
        let back = after(map, RETURN, start);
        assert!(
            (back[0] - self.at[0]).hypot(back[1] - self.at[1]) < 0.1,
            "it does not pass the orbit"
        );
        let [x, v] = after(map, PERIODS, back);
        dot(self.left, [x - self.at[0], v - self.at[1]]) / first
    }
}

fn dot(a: State, b: State) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The smallest (1) of the fold, by golden section.
fn fold(drive: f64) -> f64 {
    with_map(drive, |map| {
        let saddle = Saddle::of(map);
        assert!((saddle.multipliers[0] - 19.2).abs() < 0.2);
        assert!((saddle.multipliers[1] - 0.0139).abs() < 1e-4);
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut low, mut high) = (0.225, 0.25);
        while high - low > 1e-8 {
            let (a, b) = (high - golden * (high - low), low + golden * (high - low));
            if saddle.distance(map, a) < saddle.distance(map, b) {
                high = b;
            } else {
                low = a;
            }
        }
        saddle.distance(map, 0.5 * (low + high))
    })
}

/// Periods until a motion leaves the band, at most `most`.
fn time_in_band(drive: f64, start: State, most: usize) -> usize {
    with_map(drive, |map| {
        let mut state = start;
        let leaves = |_: &usize| {
            map.map(&mut state).expect("a motion");
            state[0] < -10.0
        };
        (0..most).find(leaves).unwrap_or(most)
    })
}

/// The tangency is at `A_c = 1.7818755`. The same number came from a program in C that shares nothing with this one, with steps
/// of a quarter between the signs of `x` and derivatives by differences.
#[test]
fn the_manifolds_touch() {
    let (mut below, mut above) = (1.7818, 1.7819);
    assert!(fold(below) > 0.0 && fold(above) < 0.0);
    while above - below > 1e-9 {
        let middle = 0.5 * (below + above);
        if fold(middle) > 0.0 {
            below = middle;
        } else {
            above = middle;
        }
    }
    assert!((below - 1.781_875_48).abs() < 1e-8, "{below}");
}

/// At 1.7818 no run leaves the band. At 1.7820 an independent closed-form flow in 80-bit arithmetic saw the first escape after
/// 2.6e5 periods; the mean time here is as long.
#[test]
fn motions_leave_the_band_above_it() {
    assert_eq!(time_in_band(1.7818, [-0.35, 0.335], 1_000_000), 1_000_000);
    let most = 10_000_000;
    let times: Vec<_> = (0..16)
        .map(|k| time_in_band(1.7820, [-0.35 + 1e-5 * f64::from(k), 0.335], most))
        .collect();
    assert!(times.iter().all(|&time| time < most), "{times:?}");
    // Times are distributed exponentially: the mean of sixteen has a standard error of a quarter.
    let mean = times.iter().sum::<usize>() as f64 / 16.0;
    assert!((mean / 2.6e5 - 1.0).abs() < 0.75, "{mean}");
}
