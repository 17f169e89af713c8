//! Newton's method on a sampled balance of a damping that jumps.

use hertzian::{FrequencyResponse, Shooting};
use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::models::linear;
use super::oracle::{Switches, paper};

/// The damping force, sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Damping {
    /// `H(x) x'`
    Jumps,
    /// The derivative of the series of `max(x, 0)`.
    Primitive,
}

/// Harmonic balance of [`paper`] by samples, written as one would.
struct Balance {
    /// From a series to samples, and back.
    values: DMatrix<f64>,
    coefficients: DMatrix<f64>,
    /// Derivative by time.
    derivative: DMatrix<f64>,
    right: DVector<f64>,
    damping: Damping,
}

impl Balance {
    fn new(period: usize, harmonics: usize, samples: usize, drive: f64, damping: Damping) -> Self {
        let length = 2 * harmonics + 1;
        let base = 1.0 / period as f64;
        let values = DMatrix::from_fn(samples, length, |row, column| {
            let k = column.div_ceil(2);
            let angle = TAU * ((k * row) % samples) as f64 / samples as f64;
            if column % 2 == 0 && k > 0 {
                angle.sin()
            } else {
                angle.cos()
            }
        });
        let scale = |row: usize| if row == 0 { 1.0 } else { 2.0 } / samples as f64;
        let coefficients = DMatrix::from_fn(length, samples, |row, column| {
            scale(row) * values[(column, row)]
        });
        let mut derivative = DMatrix::zeros(length, length);
        for k in 1..=harmonics {
            derivative[(2 * k - 1, 2 * k)] = base * k as f64;
            derivative[(2 * k, 2 * k - 1)] = -base * k as f64;
        }
        let mut right = DVector::zeros(length);
        right[0] = paper(drive).load;
        right[2 * period - 1] = drive;
        Self {
            values,
            coefficients,
            derivative,
            right,
            damping,
        }
    }

    /// Residual and its derivative.
    fn residual(&self, u: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let twice_zeta = 2.0 * paper(0.0).zeta;
        let x = &self.values * u;
        let v = &self.values * (&self.derivative * u);
        let inside = x.map(|x| if x > 0.0 { 1.0 } else { 0.0 });
        let masked = |mut matrix: DMatrix<f64>| {
            for (mut row, &factor) in matrix.row_iter_mut().zip(inside.iter()) {
                row *= factor;
            }
            &self.coefficients * matrix
        };
        let second = &self.derivative * &self.derivative;
        let spring = &self.coefficients * x.component_mul(&inside);
        let stiffness = masked(self.values.clone());
        let (damping, slope) = match self.damping {
            Damping::Jumps => (
                &self.coefficients * v.component_mul(&inside),
                masked(&self.values * &self.derivative),
            ),
            Damping::Primitive => (&self.derivative * &spring, &self.derivative * &stiffness),
        };
        (
            &second * u + damping * twice_zeta + spring - &self.right,
            second + slope * twice_zeta + stiffness,
        )
    }

    /// Residuals of Newton's method from a series.
    fn iterate(&self, mut u: DVector<f64>) -> Vec<f64> {
        let mut norms = Vec::new();
        for _ in 0..20 {
            let (residual, jacobian) = self.residual(&u);
            norms.push(residual.norm());
            u -= jacobian.lu().solve(&residual).unwrap();
        }
        norms
    }
}

/// Period 8 beside its fold at A = 1.779836, from the exact orbit (`period_8` of the reference values): the residual jumps
/// whenever a sample passes the level, and its derivative does not know.
#[test]
fn newton_wanders_where_sampled_damping_jumps() {
    let (period, harmonics, per_period, drive) = (8, 80, 128, 1.7798);
    let state = [-0.330_466_471_111_865_8, 0.333_494_239_641_907_6];
    let mut motion = Vec::new();
    paper(drive).map(state, period, per_period, Switches::Exact, |[x, _]| {
        motion.push(x);
    });
    let x = DVector::from_vec(motion);
    let [jumps, primitive] = [Damping::Jumps, Damping::Primitive].map(|damping| {
        let balance = Balance::new(period, harmonics, period * per_period, drive, damping);
        let norms = balance.iterate(&balance.coefficients * &x);
        let shown: Vec<_> = norms.iter().map(|norm| format!("{norm:.0e}")).collect();
        println!("{damping:?}: {}", shown.join(" "));
        norms
    });
    assert!(jumps[1..].iter().all(|&norm| norm > 1e-3));
    assert!(primitive[5..].iter().all(|&norm| norm < 1e-13));
    // By shooting, which is what is offered close to a fold.
    let model = linear(drive);
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0)
        .period(8);
    let cycle = shooting.near_state(&[-0.33, 0.333]).orbit(drive).unwrap();
    println!("by shooting: error {:.0e}", cycle.error.unwrap());
    for (multiplier, exact) in cycle
        .stability
        .multipliers
        .iter()
        .zip([0.990_263_429_435_609_6, 0.186_012_521_175_605_96])
    {
        assert!((multiplier - exact).norm() < 1e-9, "{multiplier} {exact}");
    }
}
