//! Stops whose force begins with a power of the gap: motions across their levels. A power that is even pushes on beyond its piece, where
//! steps that are tried look.

use std::f64::consts::{FRAC_PI_2, TAU};

use hertzian::time;
use hertzian::{FrequencyResponse, Shooting, System};
use hertzian_tests::dormand_prince;

hertzian::oscillator! {
    /// A stop on one side of a spring, its exponent in the law.
    Square(x) {
        law stop(gap) { gap > 0 => gap^2, else => 0 }
        ddot(x) + 0.1*dot(x) + x + 10*stop(x - 0.5) = cos(omega*t);
    }
}

hertzian::oscillator! {
    /// A stop of any exponent, and a mass that is free otherwise.
    Free(x) {
        param k > 0;
        param alpha > 0;
        law stop(gap) { gap > 0 => k*gap^alpha, else => 0 }
        ddot(x) + stop(x) = 0*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// Nothing but touches with zero slope: three pieces with forces, and one without.
    Pieces(x) {
        param c >= 0;
        param k0 > 0;
        param k1 > 0;
        param k2 > 0;
        param p > 0;
        param q > 0;
        param s > 0;
        param drive;
        param load;
        law pieces(gap) {
            gap > 1        => k0*(gap - 1)^p + k1,
            0 < gap <= 1   => k1*gap^q,
            -0.4 <= gap <= 0 => 0,
            gap < -0.4     => -k2*(-0.4 - gap)^s,
        }
        ddot(x) + c*dot(x) + x + pieces(x) = drive*cos(omega*t) + load;
    }
}

/// Exponents, those of which a power is a whole number among them.
const EXPONENTS: [f64; 9] = [1.0, 1.5, 2.0, 2.37, 2.5, 3.0, 4.0, 5.5, 6.0];

/// The integral of `1 / sqrt(1 - s^n)` from 0 to 1: with `s = sin^2` nothing is singular but where `s` vanishes, as a power.
fn quarter(n: f64) -> f64 {
    let count = 20_000;
    let step = FRAC_PI_2 / f64::from(count);
    let value = |angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        let s = sine * sine;
        // The limit at the end, where the denominator vanishes as the cosine.
        if cosine < 1e-6 {
            return 2.0 / n.sqrt();
        }
        2.0 * sine * cosine / (-(n * s.ln()).exp_m1()).sqrt()
    };
    let inner: f64 = (1..count)
        .map(|i| {
            let factor = if i % 2 == 1 { 4.0 } else { 2.0 };
            factor * value(f64::from(i) * step)
        })
        .sum();
    (inner + value(FRAC_PI_2)) * step / 3.0
}

/// A mass that meets a stop of exponent `alpha` with speed one leaves it with speed one after twice the time
/// `x_m int ds / sqrt(1 - s^(alpha + 1))`, where `2 k x_m^(alpha + 1) = alpha + 1`.
#[test]
fn a_free_mass_leaves_a_stop_when_it_should() {
    assert!((quarter(2.0) - FRAC_PI_2).abs() < 1e-11);
    for alpha in EXPONENTS {
        for k in [0.5, 30.0, 1e4] {
            let model = Free { k, alpha };
            let n = alpha + 1.0;
            let time = 2.0 * (n / (2.0 * k)).powf(1.0 / n) * quarter(n);
            let mut flow = time::of(&model, 1.0, 1e-12).unwrap();
            let mut state = [-1.0, 1.0];
            flow.advance(0.0, 2.0 + time, &mut state, None, None)
                .unwrap_or_else(|error| panic!("{alpha} {k}: {error}"));
            let error = (state[0] + 1.0).abs().max((state[1] + 1.0).abs());
            assert!(error < 1e-9, "{alpha} {k}: {state:?}");
        }
    }
}

/// Orbits on both sides of a resonance, from one end of the range to the other and back: the same.
#[test]
fn a_branch_over_a_square_stop_is_followed_both_ways() {
    let [up, down] = [(0.5, 1.5), (1.5, 0.5)].map(|(from, to)| {
        let branch = FrequencyResponse::of(&Square {})
            .by(Shooting::new())
            .from(from)
            .to(to)
            .run()
            .unwrap();
        assert_eq!(
            branch.points.last().unwrap().value,
            to,
            "{:?}",
            branch.stopped
        );
        [0.7, 1.0, 1.3].map(|omega| branch.at(omega).unwrap()[0].peak_to_peak())
    });
    for (up, down) in up.iter().zip(down) {
        assert!((up - down).abs() < 1e-8, "{up} {down}");
    }
    // The same orbits by the independent integration below, of their states.
    let orbit = FrequencyResponse::of(&Square {})
        .by(Shooting::new())
        .orbit(1.2)
        .unwrap()
        .orbit;
    let force = |x: f64| {
        if x > 0.5 {
            10.0 * (x - 0.5).powi(2)
        } else {
            0.0
        }
    };
    let end = integrate(
        [orbit.state()[0], orbit.state()[1]],
        TAU / 1.2,
        &[0.5],
        |t, [x, v]| (1.2 * t).cos() - 0.1 * v - x - force(x),
    );
    let error = (end[0] - orbit.state()[0])
        .abs()
        .max((end[1] - orbit.state()[1]).abs());
    assert!(error < 1e-8, "{error:e}");
}

#[test]
fn random_powers_agree_with_an_integration_of_their_own() {
    let mut seed = 7_u64;
    let mut between = |low: f64, high: f64| {
        // Knuth's multiplicative congruence; the upper bits are good.
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    for case in 0..30 {
        let mut exponent = || {
            let index = between(0.0, 12.0) as usize;
            EXPONENTS
                .get(index)
                .copied()
                .unwrap_or_else(|| between(1.0, 6.0))
        };
        let [p, q, s] = [exponent(), exponent(), exponent()];
        let mut stiffness = |high: f64| between(-2.0, high).exp2();
        let [k0, k1, k2] = [stiffness(10.0), stiffness(6.0), stiffness(10.0)];
        let c = if case % 2 == 0 {
            0.0
        } else {
            between(0.01, 0.4)
        };
        let (drive, load) = (between(0.1, 2.0), between(-0.5, 0.5));
        let omega = between(0.3, 2.5);
        let model = Pieces {
            c,
            k0,
            k1,
            k2,
            p,
            q,
            s,
            drive,
            load,
        };
        let force = |x: f64| {
            if x > 1.0 {
                k0 * (x - 1.0).powf(p) + k1
            } else if x > 0.0 {
                k1 * x.powf(q)
            } else if x >= -0.4 {
                0.0
            } else {
                -k2 * (-0.4 - x).powf(s)
            }
        };
        let start = [between(-1.0, 1.5), between(-1.0, 1.0)];
        let exact = integrate(start, 2.0 * TAU / omega, &[-0.4, 0.0, 1.0], |t, [x, v]| {
            drive * (omega * t).cos() + load - c * v - x - force(x)
        });
        let mut state = start;
        let system: &dyn System = &model;
        let mut flow = time::of(system, omega, 1e-11).unwrap();
        flow.advance(0.0, 2.0 * TAU, &mut state, None, None)
            .unwrap_or_else(|error| panic!("{case}: {error}, exponents {p} {q} {s}"));
        let error = (state[0] - exact[0]).abs().max((state[1] - exact[1]).abs());
        assert!(error < 1e-7, "{case}: {error:e}, exponents {p} {q} {s}");
    }
}

/// A motion of one coordinate. Steps end on both sides of every level, at most 1e-10 apart.
fn integrate(
    mut state: [f64; 2],
    end: f64,
    levels: &[f64],
    acceleration: impl Fn(f64, [f64; 2]) -> f64,
) -> [f64; 2] {
    let side = |x: f64| levels.iter().filter(|level| x > **level).count();
    let (mut time, mut width) = (0.0, 1e-3);
    while time < end {
        width = f64::min(width, end - time);
        let (next, error) = step(time, state, width, &acceleration);
        let factor = (0.9 * (1e-13 / error.max(1e-30)).powf(0.2)).clamp(0.2, 3.0);
        if error > 1e-13 {
            width *= factor;
            continue;
        }
        if side(next[0]) != side(state[0]) && width > 1e-9 {
            let (mut before, mut behind) = (0.0, width);
            while behind - before > 1e-13 {
                let middle = 0.5 * (before + behind);
                if side(step(time, state, middle, &acceleration).0[0]) == side(state[0]) {
                    before = middle;
                } else {
                    behind = middle;
                }
            }
            for part in [before, 1e-10] {
                state = step(time, state, part, &acceleration).0;
                time += part;
            }
            width = 1e-4;
            continue;
        }
        (state, time) = (next, time + width);
        width *= factor;
    }
    state
}

/// One step, and the difference of both orders.
fn step(
    time: f64,
    state: [f64; 2],
    width: f64,
    acceleration: &impl Fn(f64, [f64; 2]) -> f64,
) -> ([f64; 2], f64) {
    let slope = |time: f64, state: &[f64; 2]| [state[1], acceleration(time, *state)];
    let first = slope(time, &state);
    let (next, apart) = dormand_prince::step(time, (&state, first), width, slope);
    (next, apart[0].max(apart[1]))
}
