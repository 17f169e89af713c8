//! Every method on equations whose multipliers are known: prescribed motions of known systems.
//!
//! The variational equation of a prescribed motion is linear, so any series will do as orbit.

use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, DMatrix};

use super::Method;
use super::hill_matrix::{Coefficients, Lattice};
use super::orbit::Orbit;
use crate::balance::aft::Aft;
use crate::balance::{Balance, Parity, Resolution};
use crate::continuation::jacobian::Jacobian;
use crate::continuation::problem::Problem;
use crate::model::layout::Layout;
use crate::numeric::spectrum::distance;
use crate::system::{System, Variable};
use crate::testing::by_hand::PowerForm;

const ALL: [Method; 6] = [
    Method::Monodromy,
    Method::HillImaginaryPart,
    Method::HillWeightedMean,
    Method::Hill,
    Method::KoopmanHill,
    Method::KoopmanHillSubharmonic,
];

hertzian::oscillator! {
    /// Stiffness that depends on the sign of the displacement: along a sine, Meissner's equation.
    TwoSlopes(x) {
        param above;
        param below;
        param zeta in 0.0..;
        law spring(gap) { gap > 0 => above*gap, else => below*gap }
        ddot(x) + 2*zeta*dot(x) + spring(x) = 0;
    }
}

hertzian::oscillator! {
    /// Mathieu's equation `x'' + c x' + (a - 2 q cos 2 t) x = 0` for omega 2.
    Mathieu(x) {
        param a;
        param q;
        param c in 0.0..;
        ddot(x) + c*dot(x) + (a - 2*q*cos(omega*t))*x = 0;
    }
}

hertzian::oscillator! {
    /// Damped as little as is enough not to oscillate.
    Critical(x) {
        ddot(x) + 2*dot(x) + x = 0;
    }
}

hertzian::oscillator! {
    /// Two coupled linear oscillators.
    Coupled(x, y) {
        param zeta in 0.0..;
        ddot(x) + 2*zeta*dot(x) + 2*x - y = 0;
        ddot(y) + 2*zeta*dot(y) + 2*y - x = 0;
    }
}

hertzian::oscillator! {
    /// A saddle and an oscillation, coupled.
    Saddle(x, y) {
        param c;
        ddot(x) + c*dot(x) + 0.5*x + 1.5*y = 0;
        ddot(y) + c*dot(y) + 1.5*x + 0.5*y = 0;
    }
}

/// Multipliers by a method, with perturbations of `harmonics` harmonics, along a motion `mean + sin`.
fn multipliers(
    system: &dyn System,
    method: Method,
    omega: f64,
    harmonics: usize,
) -> (Vec<Complex<f64>>, f64, Option<f64>) {
    let layout = Layout::of(system);
    let mut parameters = vec![0.0; system.facts().parameters.len()];
    system.values(&mut parameters);
    let mut coefficients = vec![0.0; layout.coefficients];
    system.coefficients(&parameters, omega, &mut coefficients);
    let mut series = vec![0.0; layout.coordinates * (2 * harmonics + 1)];
    for start in (0..series.len()).step_by(2 * harmonics + 1) {
        series[start + 2] = 1.0;
    }
    let orbit = Orbit {
        system,
        layout: &layout,
        coefficients: &coefficients,
        base: omega,
        period: 1,
        series: &series,
        aft: Aft::Switched,
        samples: 0,
        rigid: None,
    };
    let found = method.engine().multipliers(&orbit, 1e-12);
    (found.multipliers, found.error, found.bound)
}

/// Both roots of `z^2 - trace z + determinant`.
fn roots(trace: f64, determinant: f64) -> [Complex<f64>; 2] {
    let root = Complex::new(0.25 * trace * trace - determinant, 0.0).sqrt();
    [root + 0.5 * trace, -root + 0.5 * trace]
}

/// Meissner (1918): over half a period each, `x'' + a^2 x = 0` and `x'' + b^2 x = 0`, so that the trace of the monodromy is
/// `2 cos a h cos b h - (a/b + b/a) sin a h sin b h` with `h = pi / omega`.
fn meissner(a: f64, b: f64, omega: f64) -> [Complex<f64>; 2] {
    let h = PI / omega;
    let ((sa, ca), (sb, cb)) = ((a * h).sin_cos(), (b * h).sin_cos());
    roots(2.0 * ca * cb - (a / b + b / a) * sa * sb, 1.0)
}

/// What has no row is called by the name of the first.
#[test]
fn every_method_has_a_row() {
    for method in ALL {
        assert_ne!(method.to_string(), Method::Default.to_string());
    }
}

/// In the exact equation a sine is above and below for half a period each.
#[test]
fn meissners_equation() {
    for (a, b, omega) in [(1.0, 1.7, 2.3), (1.0, 2.0, 1.1), (0.3, 1.4, 1.0)] {
        let system = TwoSlopes {
            above: a * a,
            below: b * b,
            zeta: 0.0,
        };
        let exact = meissner(a, b, omega);
        let error = |method, harmonics| {
            let (found, ..) = multipliers(&system, method, omega, harmonics);
            distance(&found, &exact)
        };
        assert!(error(Method::Monodromy, 1) < 1e-13 * exact[0].norm().max(1.0));
        for method in ALL {
            let (coarse, fine) = (error(method, 10), error(method, 40));
            assert!(
                fine < 0.02 && fine <= coarse.max(1e-12),
                "{method} {a} {b}: {coarse:e} {fine:e}"
            );
        }
    }
}

/// Stiffness coefficients of Meissner's equation fall as `k^-1`. Hill's exponents then converge with the third power (the
/// eigenvector falls as `k^-3`), the projection with the second at best.
#[test]
fn orders_at_a_jump_of_the_stiffness() {
    let system = TwoSlopes {
        above: 1.0,
        below: 2.89,
        zeta: 0.0,
    };
    let exact = meissner(1.0, 1.7, 2.3);
    let order = |method| {
        let error = |harmonics| {
            let (found, ..) = multipliers(&system, method, 2.3, harmonics);
            distance(&found, &exact)
        };
        (error(10) / error(80)).log2() / 3.0
    };
    for method in [
        Method::HillImaginaryPart,
        Method::HillWeightedMean,
        Method::Hill,
    ] {
        let order = order(method);
        assert!((2.5..4.0).contains(&order), "{method} {order}");
    }
    for method in [Method::KoopmanHill, Method::KoopmanHillSubharmonic] {
        let order = order(method);
        assert!((1.0..3.0).contains(&order), "{method} {order}");
    }
}

/// Characteristic values of Mathieu's equation for `q = 1` (Abramowitz and Stegun, chapter 20): on the curves `a_0`, `b_2`, `a_2`
/// of the chart of Ince and Strutt there is a solution of period pi, on `b_1`, `a_1` one of period 2 pi.
#[test]
fn mathieus_equation() {
    for (a, trace) in [
        (-0.455_138_604_1, 2.0),
        (-0.110_248_817_0, -2.0),
        (1.859_108_072_5, -2.0),
        (3.917_024_773_0, 2.0),
        (4.371_300_982_7, 2.0),
    ] {
        let system = Mathieu { a, q: 1.0, c: 0.0 };
        for method in ALL {
            // Without a look at copies one of two negative multipliers may come out twice; a tabulated value is off by 1e-10, and the double
            // multiplier by the square root of that.
            let copies = [Method::HillImaginaryPart, Method::HillWeightedMean];
            let allowed = if trace < 0.0 && copies.contains(&method) {
                1e-4
            } else {
                2e-8
            };
            let (found, ..) = multipliers(&system, method, 2.0, 12);
            let sum = found[0] + found[1];
            assert!((sum - trace).norm() < allowed, "{method} {a}: {found:?}");
        }
    }
    // Between the curves: stable, unstable, stable, unstable.
    for (a, stable) in [
        (-0.3, true),
        (0.9, false),
        (2.9, true),
        (4.1, false),
        (6.0, true),
    ] {
        let system = Mathieu { a, q: 1.0, c: 0.0 };
        for method in ALL {
            let (found, ..) = multipliers(&system, method, 2.0, 12);
            let largest = found[0].norm();
            assert_eq!(
                (largest - 1.0).abs() < 1e-7,
                stable,
                "{method} {a}: {found:?}"
            );
        }
    }
}

/// With coefficients that end, the bound on the projection holds, is of use, and the subharmonic one falls twice as fast.
#[test]
fn bounds_of_the_projection_hold_where_coefficients_fall_exponentially() {
    let system = Mathieu {
        a: 0.3,
        q: 0.02,
        c: 0.1,
    };
    let (exact, error, none) = multipliers(&system, Method::Monodromy, 2.0, 1);
    assert!(error < 1e-11 && none.is_none());
    for method in [Method::KoopmanHill, Method::KoopmanHillSubharmonic] {
        let mut before = 1.0;
        for harmonics in [10, 20, 40] {
            let (found, _, bound) = multipliers(&system, method, 2.0, harmonics);
            let error = distance(&found, &exact);
            if let Some(bound) = bound {
                assert!(bound < before, "{method} {harmonics} {bound:e}");
                assert!(error < 10.0 * bound.max(1e-13), "{error:e} {bound:e}");
                before = bound;
            }
        }
        assert!(before < 1e-6, "{method} {before:e}");
    }
    // Where a gap crosses a level they do not fall that fast, and there is none.
    let system = TwoSlopes {
        above: 1.0,
        below: 1.01,
        zeta: 0.1,
    };
    let method = Method::KoopmanHill;
    assert!(multipliers(&system, method, 2.0, 40).2.is_none());
}

#[test]
fn linear_oscillators() {
    let zeta = 0.05;
    let system = Coupled { zeta };
    for omega in [0.7, 1.3, 4.0] {
        let exact: Vec<_> = [1.0_f64, 3.0]
            .into_iter()
            .flat_map(|square| {
                let frequency = (square - zeta * zeta).sqrt();
                let modulus = (-zeta * TAU / omega).exp();
                let angle = frequency * TAU / omega;
                [angle, -angle].map(|angle| Complex::from_polar(modulus, angle))
            })
            .collect();
        for method in ALL {
            let (found, error, bound) = multipliers(&system, method, omega, 8);
            let distance = distance(&found, &exact);
            assert!(distance < 1e-11, "{method} {omega}: {distance:e}");
            assert!(error < 1e-10);
            let _ = bound;
        }
    }
}

hertzian::oscillator! {
    /// Mathieu's equation whose stiffness varies 48 times in a period.
    Fast(x) {
        param a;
        param q;
        param c in 0.0..;
        ddot(x) + c*dot(x) + (a - 2*q*cos(48*omega*t))*x = 0;
    }
}

/// Steps that just meet the waves of the stiffness would see it constant: the multipliers are powers of those of one wave.
#[test]
fn fast_waves_are_seen() {
    for (a, q) in [(0.3, 0.1), (2.1, 0.3), (1.0, 0.4)] {
        let (one, ..) = multipliers(&Mathieu { a, q, c: 0.05 }, Method::Monodromy, 48.0, 1);
        let exact: Vec<_> = one.iter().map(|multiplier| multiplier.powu(48)).collect();
        let fast = Fast { a, q, c: 0.05 };
        let (found, error, _) = multipliers(&fast, Method::Monodromy, 1.0, 1);
        let distance = distance(&found, &exact);
        assert!(distance < error + 1e-11, "{a} {q}: {distance:e} {error:e}");
    }
}

hertzian::oscillator! {
    /// Three contacts, two of which switch together.
    Apart(x) {
        param alpha > 0;
        law rough(gap) { gap > 0 => gap^alpha, else => 0 }
        law linear(gap) { gap > 0 => gap, else => 0 }
        law stop(gap) { gap > 0.3 => 2*(gap - 0.3), else => 0 }
        ddot(x) + 0.1*dot(x) + 0.2*x + rough(x) + linear(x) + stop(x) = 0;
    }
}

hertzian::oscillator! {
    /// The same as one.
    Together(x) {
        param alpha > 0;
        law contact(gap) {
            gap > 0.3 => gap^alpha + gap + 2*(gap - 0.3),
            0 < gap <= 0.3 => gap^alpha + gap,
            else => 0,
        }
        ddot(x) + 0.1*dot(x) + 0.2*x + contact(x) = 0;
    }
}

/// A panel is graded towards every contact that switches at its end, not only towards one.
#[test]
fn contacts_that_switch_together() {
    for alpha in [0.6, 1.5] {
        let (apart, error, _) = multipliers(&Apart { alpha }, Method::Monodromy, 0.7, 1);
        let (together, other, _) = multipliers(&Together { alpha }, Method::Monodromy, 0.7, 1);
        let distance = distance(&apart, &together);
        assert!(
            distance < error + other + 1e-11,
            "{alpha}: {distance:e} {error:e}"
        );
        assert!(error < 1e-9, "{error:e}");
    }
}

/// A hundred oscillations in a period, with a stiffness that varies: the first steps are far too long. For small `omega` the phase
/// of the multipliers is the integral of the frequency over a period, `theta = int sqrt(a - 2 q cos omega t) dt` (Wentzel,
/// Kramers, Brillouin 1926), and their sum `2 cos theta`.
#[test]
fn many_oscillations_in_a_period() {
    let (a, q, omega) = (1.0, 0.2, 0.01);
    let count = 4000;
    let mean: f64 = (0..count)
        .map(|i| (a - 2.0 * q * (TAU * f64::from(i) / f64::from(count)).cos()).sqrt())
        .sum::<f64>()
        / f64::from(count);
    let (found, error, _) = multipliers(&Mathieu { a, q, c: 0.0 }, Method::Default, omega, 1);
    assert!(error < 1e-6, "{error:e}");
    let expected = 2.0 * (TAU * mean / omega).cos();
    let sum = found[0] + found[1];
    assert!((sum - expected).norm() < 0.05, "{sum} {expected}");
}

/// Stiffness eigenvalues 2 and -1: the multipliers of the saddle are a million and a millionth, those of the oscillation near one.
#[test]
fn multipliers_over_twelve_decades() {
    let (c, omega) = (0.01, 0.45);
    let period = TAU / omega;
    let exponent = |k: f64, sign: f64| {
        let root = Complex::new(0.25 * c * c - k, 0.0).sqrt();
        (root.scale(sign) - 0.5 * c).scale(period).exp()
    };
    let exact = [
        exponent(-1.0, 1.0),
        exponent(2.0, 1.0),
        exponent(2.0, -1.0),
        exponent(-1.0, -1.0),
    ];
    assert!(exact[0].re > 1e6 && exact[3].re < 1e-6);
    for method in [Method::Monodromy, Method::Default] {
        let (found, ..) = multipliers(&Saddle { c }, method, omega, 1);
        for (a, b) in found.iter().zip(&exact) {
            let error = (a - b).norm() / b.norm();
            assert!(error < 1e-11, "{method} {a} {b}: {error:e}");
        }
    }
    // One coordinate needs no factors: Liouville's formula gives the smaller one.
    let system = Mathieu {
        a: -6.0,
        q: 1.0,
        c: 0.0,
    };
    let (found, ..) = multipliers(&system, Method::Monodromy, 0.7, 1);
    let product = found[0] * found[1];
    assert!(
        found[0].re > 1e8 && (product - 1.0).norm() < 1e-13,
        "{found:?}"
    );
}

/// Two real negative multipliers: their exponents have copies at `+i/2` and `-i/2`, and the smallest imaginary parts belong to
/// the two copies of one of them. The determinant tells; by symmetry they are told apart.
#[test]
fn two_real_negative_multipliers() {
    let system = Mathieu {
        a: 0.9,
        q: 1.0,
        c: 0.2,
    };
    let (exact, ..) = multipliers(&system, Method::Monodromy, 2.0, 1);
    assert!(exact[0].re < -1.0 && exact[1].re < 0.0 && exact[1].re > -1.0);
    let by = |method| multipliers(&system, method, 2.0, 12);
    let (found, error, _) = by(Method::Hill);
    assert!(distance(&found, &exact) < 1e-9 && error < 1e-9);
    let (found, error, _) = by(Method::HillImaginaryPart);
    let wrong = distance(&found, &exact);
    assert!(wrong < 1e-9 || error > 0.3 * wrong, "{wrong:e} {error:e}");
}

/// Critical damping: both multipliers are `e^(-2 pi / omega)`, and rounding of the matrix moves them by its root.
#[test]
fn a_double_multiplier_is_known_to_the_root_of_rounding() {
    for omega in [0.37, 1.0, 3.0] {
        let (found, error, _) = multipliers(&Critical {}, Method::Monodromy, omega, 1);
        let exact = [Complex::new((-TAU / omega).exp(), 0.0); 2];
        let wrong = distance(&found, &exact);
        assert!(
            wrong < error && error < 1e-6 * exact[0].re,
            "{omega}: {wrong:e} {error:e}"
        );
    }
}

/// `-H_21 + H_22 H_11` of the Hill matrix is `D^2 + T^ D + S^`, the Jacobian of the balance over `M Omega^2`.
#[test]
fn the_hill_matrix_contains_the_jacobian_of_the_balance() {
    let omega = 0.8;
    for (one_sided, alpha) in [(true, 1.5), (true, 1.0), (true, 0.6), (false, 2.5)] {
        let system = PowerForm::new(one_sided, alpha, 0.05, 1.0, 0.1);
        let u = [0.3, 1.0, 0.2, -0.3, 0.1, 0.05, 0.02, omega];
        let resolution = Resolution {
            harmonics: 3,
            core: 3,
            parity: Parity::All,
            stride: 1,
            samples: 64,
            aft: Aft::Switched,
            period: 1,
        };
        let mut balance = Balance::new(&system, &system.values, omega, Variable::Omega, resolution);
        let mut jacobian = Jacobian::new(balance.partition());
        balance.evaluate(&u, &mut [0.0; 7], Some(&mut jacobian));
        let expected = jacobian.entries();
        let orbit = Orbit::of(&balance, &u[..7]);
        let matrix = Coefficients::of(&orbit).unwrap().matrix(Lattice::Whole);
        let block = |i: usize, j: usize| matrix.view((7 * i, 7 * j), (7, 7)).into_owned();
        let found: DMatrix<f64> = block(1, 1) * block(0, 0) - block(1, 0);
        for i in 0..7 {
            for j in 0..7 {
                let error = (found[(i, j)] * omega * omega - expected[(i, j)]).abs();
                assert!(error < 1e-9, "{alpha} {i} {j}: {error:e}");
            }
        }
    }
}
