//! Lyapunov exponents: the mean rates, per period, at which neighbouring motions part.
//!
//! An orthonormal frame `Q` is carried along by the tangent map `T_k` of each period and made orthonormal again:
//!
//! ```text
//! T_k Q_(k-1) = Q_k R_k                                                                                 (1)
//! lambda_i = mean of ln R_k,ii                                                                          (2)
//! sum_i lambda_i = mean of ln |det T_k|                                                                 (3)
//! ```
//!
//! The sum (3) is known in another way too, as the integral of the divergence over the same motion, and both are returned. At
//! a switch the tangent jumps by the saltation, which the flow applies (Mueller 1995, Chaos, Solitons and Fractals 5, 1671).
//! Standard errors are those of batch means.
//!
//! Source: Benettin, Galgani, Giorgilli and Strelcyn (1980), Meccanica 15, 9.

use crate::error::Error;
use crate::numeric::estimate::Estimate;
use crate::system::System;
use crate::time::divergence::Divergence;
use crate::time::stroboscope::Stroboscope;
use crate::time::{FlowError, Stretch, Tangent};

/// The least part of a column that is left beside the others, for six digits of it.
const RESOLVED: f64 = 1e-10;

/// A motion that carries its frame.
///
/// ```
/// use hertzian::attractors::lyapunov::Lyapunov;
/// use hertzian::time::stroboscope::Stroboscope;
/// use std::f64::consts::TAU;
///
/// hertzian::oscillator! {
///     Linear(x) {
///         param drive;
///         ddot(x) + 0.2*dot(x) + 4*x = drive*cos(omega*t);
///     }
/// }
///
/// let model = Linear { drive: 3.0 };
/// let mut map = Stroboscope::of(&model, 1.0)?;
/// let mut motion = Lyapunov::new(&mut map, &[0.0, 0.0]);
/// motion.settle(10)?;
/// for _ in 0..4 {
///     motion.batch(10)?;
/// }
/// // Areas shrink by the damping: per period of 2 pi, -0.2 times 2 pi.
/// assert!((motion.sum().value + 0.2 * TAU).abs() < 1e-9);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug)]
pub struct Lyapunov<'s> {
    map: &'s mut Stroboscope,
    divergence: Option<Divergence>,
    state: Vec<f64>,
    tangent: Tangent,
    sums: Vec<f64>,
    /// Means (2) per period over each batch.
    batches: Vec<Vec<f64>>,
    /// Mean integrals of the divergence over those for which it was asked for.
    integrals: Vec<Estimate>,
}

impl<'s> Lyapunov<'s> {
    /// Starts a motion.
    pub fn new(map: &'s mut Stroboscope, state: &[f64]) -> Self {
        let order = state.len();
        Self {
            map,
            divergence: None,
            state: state.to_vec(),
            tangent: Tangent::of_state(order / 2, None),
            sums: vec![0.0; order],
            batches: Vec::new(),
            integrals: Vec::new(),
        }
    }

    /// Integrates the divergence as well. The system must be the one that moves, with the values of its parameters and of `omega`.
    ///
    /// # Errors
    /// If parameters or the frequency are outside their ranges, levels are out of order, or the mass matrix is singular.
    pub fn with_divergence(
        mut self,
        system: &dyn System,
        values: &[f64],
        omega: f64,
    ) -> Result<Self, Error> {
        self.divergence = Some(Divergence::new(system, values, omega)?);
        Ok(self)
    }

    /// Applies the map some times: the state settles, and the frame turns to its directions.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub fn settle(&mut self, periods: usize) -> Result<(), FlowError> {
        for _ in 0..periods {
            self.map.map_with(&mut self.state, &mut self.tangent)?;
            orthonormalise(&mut self.tangent.columns, &mut self.sums);
        }
        Ok(())
    }

    /// Adds a batch of so many applications of the map, one or more, and gives its mean exponents, per period of the declaration.
    ///
    /// # Errors
    /// If the motion cannot be continued, or the batch is empty.
    pub fn batch(&mut self, periods: usize) -> Result<&[f64], FlowError> {
        if periods == 0 {
            return Err(FlowError::NoPeriods);
        }
        self.sums.fill(0.0);
        let mut integral = Estimate::default();
        for _ in 0..periods {
            match &mut self.divergence {
                None => self.map.map_with(&mut self.state, &mut self.tangent)?,
                Some(divergence) => {
                    let mut see = |stretch: &dyn Stretch| integral.add(divergence.over(stretch));
                    let tangent = Some(&mut self.tangent);
                    self.map.advance(&mut self.state, tangent, Some(&mut see))?;
                }
            }
            orthonormalise(&mut self.tangent.columns, &mut self.sums);
        }
        let count = (periods * self.map.stride()) as f64;
        if self.divergence.is_some() {
            self.integrals.push(integral.over(count));
        }
        self.batches
            .push(self.sums.iter().map(|sum| sum / count).collect());
        Ok(&self.batches[self.batches.len() - 1])
    }

    /// The mean exponents of each batch so far.
    pub fn batches(&self) -> &[Vec<f64>] {
        &self.batches
    }

    /// The state that the motion has reached.
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// The exponents of all batches, which must be equally long, with their standard errors.
    ///
    /// Largest first, per period of the declaration. NaN for those so far below the largest that neighbours are pressed
    /// together beyond ten decades in one application of the map, as the units of the state measure it: least where `omega` is about
    /// one; with one coordinate, the [divergence](Self::divergence) less the largest then.
    pub fn exponents(&self) -> Vec<Estimate> {
        let mut exponents: Vec<Estimate> = (0..self.state.len())
            .map(|i| Estimate::of_batches(self.batches.iter().map(move |batch| batch[i])))
            .collect();
        let key = |exponent: &Estimate| {
            if exponent.value.is_nan() {
                f64::NEG_INFINITY
            } else {
                exponent.value
            }
        };
        exponents.sort_by(|a, b| key(b).total_cmp(&key(a)));
        exponents
    }

    /// Their sum, as the determinants of the tangent maps give it (3), with its standard error.
    pub fn sum(&self) -> Estimate {
        Estimate::of_batches(self.batches.iter().map(|batch| batch.iter().sum()))
    }

    /// Their sum, as the divergence gives it; `None` if it was not [asked for](Self::with_divergence). Its error is what the integral may be
    /// wrong by: rounding, and what the nodes do not resolve.
    pub fn divergence(&self) -> Option<Estimate> {
        let count = self.batches.len();
        let mut sum = Estimate::default();
        for integral in &self.integrals {
            sum.add(*integral);
        }
        let asked = count > 0 && self.integrals.len() == count;
        asked.then(|| sum.over(count as f64))
    }
}

/// Makes columns orthonormal, (1), by the modified method of Gram and Schmidt, and adds the logarithms of their lengths: NaN for
/// one of which only rounding is left beside those before it.
fn orthonormalise(columns: &mut [f64], sums: &mut [f64]) {
    let order = sums.len();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for i in 0..order {
        let (before, rest) = columns.split_at_mut(i * order);
        let column = &mut rest[..order];
        let whole = dot(column, column).sqrt();
        for other in before.chunks_exact(order) {
            let part = dot(column, other);
            for (x, y) in column.iter_mut().zip(other) {
                *x -= part * y;
            }
        }
        let length = dot(column, column).sqrt();
        let resolved = length > RESOLVED * whole;
        sums[i] += if resolved { length.ln() } else { f64::NAN };
        if length > 0.0 {
            for x in column {
                *x /= length;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::testing::one_sided::one_sided;
    use crate::time::affine::Affine;

    /// The exponents, their sum, and the same by the divergence.
    struct Found {
        exponents: Vec<Estimate>,
        sum: Estimate,
        divergence: f64,
    }

    fn found(lyapunov: &Lyapunov<'_>) -> Found {
        Found {
            exponents: lyapunov.exponents(),
            sum: lyapunov.sum(),
            divergence: lyapunov.divergence().expect("asked for").value,
        }
    }

    fn exponents(drive: f64, state: [f64; 2], batches: usize, periods: usize) -> Found {
        let model = one_sided(drive);
        let values = [model.zeta, model.load, model.drive];
        let flow = Affine::new(&model, &values, 1.0).expect("affine");
        let mut map = Stroboscope::new(Box::new(flow));
        let lyapunov = Lyapunov::new(&mut map, &state);
        let mut lyapunov = lyapunov
            .with_divergence(&model, &values, 1.0)
            .expect("a mass");
        lyapunov.settle(2000).expect("a motion");
        for _ in 0..batches {
            lyapunov.batch(periods).expect("a motion");
        }
        found(&lyapunov)
    }

    fn check_sum(found: &Found) {
        let sum: f64 = found.exponents.iter().map(|e| e.value).sum();
        let divergence = found.divergence;
        assert!((sum - found.sum.value).abs() < 1e-13);
        assert!(
            (found.sum.value - divergence).abs() < 1e-10,
            "{:?} {divergence}",
            found.sum
        );
    }

    crate::oscillator! {
        Heavy(x) {
            param zeta in 0.0..;
            ddot(x) + 2*zeta*dot(x) + x = cos(omega*t);
        }
    }

    /// With a damping ratio of five the exponents are -0.63 and -62 per period: the second is not told from rounding, and not
    /// made up.
    #[test]
    fn what_is_pressed_into_rounding_is_no_number() {
        let model = Heavy { zeta: 5.0 };
        let flow = Affine::new(&model, &[5.0], 1.0).expect("affine");
        let mut map = Stroboscope::new(Box::new(flow));
        let lyapunov = Lyapunov::new(&mut map, &[0.0, 0.0]);
        let mut lyapunov = lyapunov
            .with_divergence(&model, &[5.0], 1.0)
            .expect("a mass");
        lyapunov.settle(20).expect("a motion");
        lyapunov.batch(20).expect("a motion");
        let found = found(&lyapunov);
        let root = 24.0_f64.sqrt();
        let exact = [root - 5.0, -root - 5.0].map(|rate| TAU * rate);
        assert!((found.exponents[0].value - exact[0]).abs() < 1e-12);
        assert!(found.exponents[1].value.is_nan());
        let sum = found.divergence;
        assert!((sum - exact[0] - exact[1]).abs() < 1e-10);
    }

    /// On a periodic orbit the exponents are the logarithms of the multipliers over the period. Period three at `A = 1`;
    /// multipliers computed independently from the closed-form flow in 80-bit arithmetic, confirmed with 60 digits.
    #[test]
    fn on_a_periodic_orbit_they_are_those_of_the_multipliers() {
        let start = [-31.334_287_816_436_888, 0.605_360_285_158_400_4];
        // Whole turns of the frame: batches of many periods, so that what the turning adds is small.
        let found = exponents(1.0, start, 4, 3000);
        let modulus = 0.380_774_924_593_537_2_f64.hypot(0.817_888_662_584_343_5);
        let expected = modulus.ln() / 3.0;
        for exponent in &found.exponents {
            assert!(
                (exponent.value - expected).abs() < 1e-3,
                "{:?}",
                found.exponents
            );
        }
        assert!(
            (found.sum.value - 2.0 * expected).abs() < 1e-12,
            "{:?}",
            found.exponents
        );
        check_sum(&found);
    }

    /// Reference: 0.214 +- 0.004 per forcing period, from the closed-form flow in 80-bit arithmetic, independent of this project.
    #[test]
    fn beyond_the_interior_crisis() {
        let found = exponents(1.785, [0.0, 0.0], 40, 5000);
        let largest = found.exponents[0];
        let error = (largest.error.powi(2) + 0.004_f64.powi(2)).sqrt();
        assert!(largest.error < 0.01, "{largest}");
        assert!((largest.value - 0.214).abs() < 3.0 * error, "{largest}");
        check_sum(&found);
    }

    /// Reference: 0.0129 +- 0.0005, from the same source: type-I intermittency.
    #[test]
    fn in_intermittency() {
        let length = std::env::var("HERTZIAN_PERIODS").ok();
        let length = length.map_or(4000, |text| text.parse().expect("a number"));
        let found = exponents(1.78, [-0.35, 0.335], 40, length);
        let largest = found.exponents[0];
        let error = (largest.error.powi(2) + 0.0005_f64.powi(2)).sqrt();
        let most = 0.001 * (20_000.0 / length as f64).sqrt();
        assert!(largest.error < most, "{largest}");
        assert!((largest.value - 0.0129).abs() < 3.0 * error, "{largest}");
        check_sum(&found);
    }
}
