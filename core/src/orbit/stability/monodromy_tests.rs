//! The monodromy against an independent integration, and its order of convergence.
//!
//! The variational equation of a prescribed motion is linear, so any series will do as orbit. In the coordinate
//! `y = dx' + G'(x) dx` the perturbation `dx` of the one-sided oscillator has a continuous field and no saltation:
//! `dx' = y - 2 zeta H dx`, `y' = -alpha x^(alpha - 1) H dx`.

use nalgebra::{DMatrix, Matrix2, Vector2};

use super::monodromy::Monodromy;
use super::orbit::Orbit;
use crate::balance::aft::Aft;
use crate::model::layout::Layout;
use crate::system::System;
use crate::testing::by_hand::PowerForm;

const MEAN: f64 = 0.3;
const OMEGA: f64 = 0.8;
const ZETA: f64 = 0.05;

fn monodromy(system: &PowerForm, density: f64) -> DMatrix<f64> {
    let layout = Layout::of(system);
    let mut coefficients = vec![0.0; layout.coefficients];
    system.coefficients(&system.values, OMEGA, &mut coefficients);
    let orbit = Orbit {
        system,
        layout: &layout,
        coefficients: &coefficients,
        base: OMEGA,
        period: 1,
        series: &[MEAN, 1.0, 0.0],
        aft: Aft::Switched,
        samples: 0,
        rigid: None,
    };
    DMatrix::from_vec(2, 2, Monodromy::new(true).matrix(&orbit, density))
}

/// Runge-Kutta in the continuous coordinate, from switch to switch, with the phase graded towards the switches.
fn reference(alpha: f64) -> Matrix2<f64> {
    let first = (-MEAN).acos();
    let (falling, rising) = (first, std::f64::consts::TAU - first);
    // From just behind the loss of contact, where y is the velocity, once around.
    let apart = panel(alpha, falling, rising, false);
    let touching = panel(alpha, rising, falling + std::f64::consts::TAU, true);
    let to_y = Matrix2::new(1.0, 0.0, 0.0, OMEGA);
    to_y.try_inverse().unwrap() * touching * apart * to_y
}

fn panel(alpha: f64, start: f64, end: f64, contact: bool) -> Matrix2<f64> {
    let steps = 20_000;
    let h = 1.0 / f64::from(steps);
    let width = end - start;
    let field = |s: f64| {
        // I_s(5, 5), flat at both ends, from the nearer end: there the gap keeps its digits as
        // cos(e + d) - cos e = -2 sin(e + d/2) sin(d/2).
        let (end, sign, r) = if s < 0.5 {
            (start, 1.0, s)
        } else {
            (end, -1.0, 1.0 - s)
        };
        let tail = 126.0 + r * (-420.0 + r * (540.0 + r * (-315.0 + r * 70.0)));
        let distance = sign * width * r.powi(5) * tail;
        let slope = width * 630.0 * (s * (1.0 - s)).powi(4) / OMEGA;
        let x = (-2.0 * (end + 0.5 * distance).sin() * (0.5 * distance).sin()).max(0.0);
        if contact {
            let stiffness = if x > 0.0 {
                alpha * x.powf(alpha - 1.0)
            } else {
                0.0
            };
            Matrix2::new(-2.0 * ZETA, 1.0, -stiffness, 0.0) * slope
        } else {
            Matrix2::new(0.0, 1.0, 0.0, 0.0) * slope
        }
    };
    let mut result = Matrix2::zeros();
    for column in 0..2 {
        let mut y = Vector2::zeros();
        y[column] = 1.0;
        for step in 0..steps {
            let s = h * f64::from(step);
            let (a, b, c) = (field(s), field(s + 0.5 * h), field(s + h));
            let k1 = a * y;
            let k2 = b * (y + 0.5 * h * k1);
            let k3 = b * (y + 0.5 * h * k2);
            let k4 = c * (y + h * k3);
            y += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
        }
        result.set_column(column, &y);
    }
    result
}

fn error(alpha: f64, density: f64) -> f64 {
    let system = PowerForm::new(true, alpha, ZETA, 1.0, 0.1);
    let expected = reference(alpha);
    let found = monodromy(&system, density);
    let mut largest = 0.0_f64;
    for i in 0..2 {
        for j in 0..2 {
            largest = largest.max((found[(i, j)] - expected[(i, j)]).abs());
        }
    }
    largest
}

/// With saltation at the switch of the damping, and stiffness that vanishes, jumps or is unbounded there.
#[test]
fn agrees_with_the_continuous_coordinate() {
    for alpha in [2.5, 1.5, 1.0, 0.6] {
        let error = error(alpha, 512.0);
        assert!(error < 1e-11, "alpha {alpha}: {error:e}");
    }
}

/// Sixth order, whatever the exponent: the graded equation is smooth.
#[test]
fn order_of_convergence() {
    for alpha in [2.5, 1.5, 0.6] {
        let observed = (error(alpha, 24.0) / error(alpha, 96.0)).log2() / 2.0;
        assert!(
            (5.5..6.5).contains(&observed),
            "alpha {alpha}: order {observed}"
        );
    }
}

/// Liouville: the determinant is the exponential of the integrated divergence, here damping times time in contact.
#[test]
fn determinant_is_liouvilles() {
    for alpha in [2.5, 1.5, 1.0, 0.6] {
        let system = PowerForm::new(true, alpha, ZETA, 1.0, 0.1);
        let contact = 2.0 * (-MEAN).acos() / OMEGA;
        let expected = (-2.0 * ZETA * contact).exp();
        let found = monodromy(&system, 256.0).determinant();
        assert!(
            (found - expected).abs() < 1e-12,
            "alpha {alpha}: {found} {expected}"
        );
    }
}
