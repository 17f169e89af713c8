//! How many periods transients last, by the damping of the linear oscillations.
//!
//! With every contact on one piece of its law, and its derivatives there, a system of mass `M`, damping `C` and stiffness `K` has the modes
//!
//! ```text
//! ( lambda^2 M + lambda C + K ) q = 0,                                                                          (1)
//! ```
//!
//! of which the slowest decays as `exp(-sigma t)`. A motion passes from piece to piece, and a gap that is open may have no damping at all; of
//! the pieces that one counts where the slowest mode decays fastest. Then a transient falls to a part `eps` in
//!
//! ```text
//! n = ln(1 / eps) / (sigma T)                                                                                   (2)
//! ```
//!
//! periods `T`. What turns with time counts by its mean over the period.

use std::f64::consts::TAU;

use nalgebra::DMatrix;

use crate::error::Error;
use crate::law::{Law, On};
use crate::laws::single::Single;
use crate::model::layout::{ContactLayout, Layout, Term, constant};
use crate::numeric::spectrum::eigenvalues;
use crate::response::{FrequencyResponse, OrbitMethod};
use crate::system::Variable;

/// A transient is over at this part of it.
const LEFT: f64 = 1e-6;
/// Motions are followed for so many periods, at least and at most.
const FEWEST: usize = 500;
const MOST: usize = 20_000;
/// A mode that is slower than this part of the fastest one is a rigid motion, up to rounding.
const RIGID: f64 = 1e-6;

impl<M: OrbitMethod> FrequencyResponse<M> {
    /// Periods of the declaration for which to follow motions until they have settled: those in which the slowest linear oscillation falls to
    /// a millionth, at either end of the range, from 500 to 20000. Of the pieces of the contacts that one counts on which it is damped most.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Stopped(x) {
    ///         param zeta;
    ///         law stop(gap) { gap > 0 => 10*gap, else => 0 }
    ///         ddot(x) + 2*zeta*dot(x) + x + stop(x - 1) = 0.3*cos(omega*t);
    ///     }
    /// }
    ///
    /// let periods = |zeta: f64| {
    ///     FrequencyResponse::of(&Stopped { zeta }).from(0.5).to(1.5).transient_periods()
    /// };
    /// // ln(1e6) / (zeta T) at omega = 1.5.
    /// assert_eq!(periods(0.001)?, 3299);
    /// assert_eq!(periods(0.1)?, 500);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// If what is varied is not usable, or an end of the range was not given.
    pub fn transient_periods(&self) -> Result<usize, Error> {
        let variable = self.request.variable()?;
        let held = self.request.held_omega(variable)?;
        let mut periods = FEWEST;
        for value in self.request.range()? {
            let mut parameters = self.request.parameters();
            if let Variable::Parameter(index) = variable {
                parameters[index] = value;
            }
            let omega = held.unwrap_or(value);
            let system = self.request.system.as_ref();
            let mut coefficients = vec![0.0; system.facts().places.len()];
            system.coefficients(&parameters, omega, &mut coefficients);
            let linear = Linear {
                layout: Layout::of(system),
                coefficients,
            };
            let period = TAU * f64::from(system.facts().divisor) / omega;
            let lasts = match linear.decay(|contact| system.law(contact.law)) {
                Some(decay) => -LEFT.ln() / (decay * period),
                None => continue,
            };
            periods = periods.max(lasts.ceil() as usize).min(MOST);
        }
        Ok(periods)
    }
}

/// A system at values of its parameters.
struct Linear {
    layout: Layout,
    coefficients: Vec<f64>,
}

impl Linear {
    /// How fast the slowest mode decays, with the contacts on the pieces where that is fastest; `None` where nothing decays.
    fn decay<'l>(&self, law: impl Fn(&ContactLayout) -> &'l dyn Law) -> Option<f64> {
        let contacts = &self.layout.contacts;
        let pieces = contacts.iter().map(|c| law(c).facts().pieces.len()).max();
        let decays = (0..pieces.unwrap_or(1)).filter_map(|piece| {
            let n = self.layout.coordinates;
            let mut damping = constant(&self.layout.damping, &self.coefficients, n);
            let mut stiffness = constant(&self.layout.stiffness, &self.coefficients, n);
            for contact in contacts {
                let slopes = self.slopes(contact, law(contact), piece);
                let along = self.along(contact);
                damping += slopes.by_rate * &along;
                stiffness += slopes.by_gap * along;
            }
            self.slowest(&damping, &stiffness)
        });
        decays.reduce(f64::max)
    }

    /// Derivatives of a law inside of a piece, or the last one if it has fewer: in the middle, or one from its only end.
    fn slopes(&self, contact: &ContactLayout, law: &dyn Law, piece: usize) -> Single {
        let mut arguments = vec![0.0; contact.argument_count];
        contact.arguments(&self.coefficients, &mut arguments);
        let mut levels = vec![0.0; law.facts().levels.len()];
        law.levels(&arguments, &mut levels);
        let piece = piece.min(levels.len());
        let below = piece.checked_sub(1).map(|index| levels[index]);
        let gap = match (below, levels.get(piece)) {
            (Some(low), Some(high)) => 0.5 * (low + high),
            (Some(low), None) => low + 1.0,
            (None, Some(high)) => high - 1.0,
            (None, None) => 1.0,
        };
        Single::of(law, On::Piece(piece), &arguments, [gap, 0.0])
    }

    /// The direction of a contact's force times that of its gap, in the mean over the period.
    fn along(&self, contact: &ContactLayout) -> DMatrix<f64> {
        let n = self.layout.coordinates;
        let mut along = DMatrix::zeros(n, n);
        let value = |term: &Term| self.coefficients[term.coefficient];
        for force in &contact.force {
            for gap in contact.gap.iter().filter(|gap| gap.wave == force.wave) {
                let mean = if gap.wave.harmonic == 0 { 1.0 } else { 0.5 };
                along[(force.index, gap.index)] += mean * value(force) * value(gap);
            }
        }
        along
    }

    /// How fast the slowest mode of (1) decays that is no rigid motion; `None` if none decays, or one grows.
    fn slowest(&self, damping: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> Option<f64> {
        let n = self.layout.coordinates;
        let mass = self.layout.mass(&self.coefficients).lu();
        let [damping, stiffness] = [damping, stiffness].map(|matrix| mass.solve(matrix));
        let mut companion = DMatrix::zeros(2 * n, 2 * n);
        companion.view_mut((0, n), (n, n)).fill_with_identity();
        companion.view_mut((n, 0), (n, n)).copy_from(&-stiffness?);
        companion.view_mut((n, n), (n, n)).copy_from(&-damping?);
        // Of a matrix that is exactly singular the iteration for eigenvalues may not end.
        let shift = companion.norm();
        companion += DMatrix::identity(2 * n, 2 * n) * shift;
        let modes: Vec<_> = (eigenvalues(&companion).iter())
            .map(|mode| mode - shift)
            .collect();
        let fastest = modes.iter().map(|mode| mode.norm()).fold(0.0, f64::max);
        let modes = modes.iter().filter(|mode| mode.norm() > RIGID * fastest);
        let slowest = modes.map(|mode| -mode.re).reduce(f64::min)?;
        (slowest > 0.0).then_some(slowest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::oscillator! {
        /// Damped in contact alone, where it flies without.
        OneSided(x) {
            param zeta;
            law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
            ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
        }
    }

    crate::oscillator! {
        /// Two masses, free to move together, and a spring with a small damping between them.
        Pair(x, y) {
            param damping;
            ddot(x) + damping*(dot(x) - dot(y)) + x - y = cos(omega*t);
            ddot(y) + damping*(dot(y) - dot(x)) + y - x = 0;
        }
    }

    #[test]
    fn what_is_damped_in_contact_is_known_by_it() {
        let request = |zeta: f64| {
            FrequencyResponse::of(&OneSided { zeta })
                .from(0.5)
                .to(1.0)
                .transient_periods()
                .unwrap()
        };
        assert_eq!(
            request(0.001),
            (1e6_f64.ln() / (0.001 * TAU)).ceil() as usize
        );
        assert_eq!((request(0.0), request(1e-6)), (FEWEST, MOST));
    }

    #[test]
    fn a_rigid_motion_is_no_transient() {
        // The mode of both masses against each other: sigma is the damping.
        let request = FrequencyResponse::of(&Pair { damping: 0.001 });
        let periods = request.from(0.5).to(2.0).transient_periods().unwrap();
        let period = TAU / 2.0;
        assert_eq!(periods, (1e6_f64.ln() / (0.001 * period)).ceil() as usize);
    }
}
