//! A gap that rests on a level where the slopes of its force differ: there is no linearised equation.
//!
//! A gap that stays where it is for the whole period crosses nothing. If that is on a level, and force or slopes differ on its two
//! sides, perturbations see one of them or the other by their sign, and multipliers of either say nothing of the orbit.

use super::orbit::Orbit;
use crate::law::LevelFacts;

/// Distance of a gap from a level that it is on, in parts of its size and that of the orbit.
const ON: f64 = 1e-12;

/// Whether force or slopes differ on the two sides of a level.
fn differs(level: LevelFacts) -> bool {
    level.force_jumps || level.by_gap_jumps || level.by_rate_jumps
}

/// Looks for gaps that rest, and keeps its workspace.
#[derive(Debug, Default)]
pub(super) struct Rest {
    gap: Vec<f64>,
    arguments: Vec<f64>,
    levels: Vec<f64>,
}

impl Rest {
    /// Whether a contact rests on a level of its law.
    pub(super) fn on_a_level(&mut self, orbit: &Orbit<'_>) -> bool {
        let size = orbit.series.iter().map(|x| x.abs()).fold(0.0, f64::max);
        orbit.layout.contacts.iter().any(|layout| {
            let facts = orbit.system.law(layout.law).facts();
            if !facts.levels.iter().copied().any(differs) {
                return false;
            }
            orbit.gap(layout, &mut self.gap);
            let moves: f64 = self.gap[1..].iter().map(|x| x.abs()).sum();
            let near = ON * size.max(self.gap[0].abs());
            if moves > near {
                return false;
            }
            self.arguments.resize(layout.argument_count, 0.0);
            layout.arguments(orbit.coefficients, &mut self.arguments);
            orbit.levels(layout, &self.arguments, &mut self.levels);
            let mut levels = self.levels.iter().zip(facts.levels.iter());
            levels.any(|(value, &level)| differs(level) && (self.gap[0] - value).abs() <= near)
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    use std::ops::ControlFlow;

    use nalgebra::Complex;

    use crate::numeric::spectrum::distance;
    use crate::orbit::stability::{Method, Stability, Verdict};
    use crate::response::FrequencyResponse;
    use crate::system::System;

    hertzian::oscillator! {
        /// A spring that pushes away on one side of its rest.
        Tilting(x) {
            param drive;
            law s(g) { g > 0 => -0.5*g, else => g }
            ddot(x) + 0.1*dot(x) + s(x) = drive*cos(omega*t);
        }
    }

    hertzian::oscillator! {
        /// A contact that a load closes.
        Loaded(x) {
            param drive;
            law contact(gap) { gap > 0 => 0.1*dot(gap) + gap^1.5, else => 0 }
            ddot(x) + contact(x) = drive*cos(omega*t) + 1;
        }
    }

    fn undriven(system: &dyn System, method: Method) -> Stability {
        let request = FrequencyResponse::of(system)
            .vary("drive")
            .omega(0.7)
            .harmonics(5);
        let request = request.from(0.0).to(0.1).multipliers(method);
        let branch = request.run_with(|_| ControlFlow::Break(())).unwrap();
        branch.points[0].stability.clone()
    }

    /// `x = 0` is a solution, and a push to the right runs away.
    #[test]
    fn at_rest_on_a_level_nothing_is_said() {
        for method in [Method::Default, Method::Hill, Method::KoopmanHill] {
            let found = undriven(&Tilting { drive: 0.0 }, method);
            assert_eq!(found.verdict, Verdict::Undecided, "{method}");
            assert_eq!(found.error, f64::INFINITY, "{method}");
        }
    }

    /// Away from levels an equilibrium is an orbit like others: `x = 1`, stiffness 3/2.
    #[test]
    fn at_rest_elsewhere_multipliers_are_those_of_the_equilibrium() {
        let found = undriven(&Loaded { drive: 0.0 }, Method::Default);
        let period = TAU / 0.7;
        let one = Complex::new(-0.05 * period, (1.5_f64 - 0.0025).sqrt() * period).exp();
        assert_eq!(found.verdict, Verdict::Stable);
        let error = distance(&found.multipliers, &[one, one.conj()]);
        assert!(
            error < 1e-10 && found.error < 1e-9,
            "{error:e} {:e}",
            found.error
        );
    }
}
