//! Two folds within a step, which leave no change of sign of the slope at its ends.
//!
//! The parabola through the slopes at three successive points tells where the slope comes nearest to zero. If that is much nearer
//! than at the points beside, the orbit there is computed, and the parabola taken again through the lowest of them, until one has
//! the other sign or none comes lower. It may be in the step before the last one, since a point beside the second fold says nothing
//! until the next one is known.
//!
//! Source: successive parabolic interpolation, as in Brent (1973), Algorithms for Minimization without Derivatives, chapter 5.

use super::Run;
use super::watch::Between;
use crate::balance::Balance;
use crate::continuation::follow::CurvePoint;
use crate::continuation::locate::inside;
use crate::continuation::newton::Newton;

/// A slope that comes nearer to zero than this part of what it is beside is looked at.
const NEAR: f64 = 0.5;
/// So many orbits, and until they come this near to each other, as a part of the step.
const LOOKS: usize = 6;
const CLOSE: f64 = 1e-3;

impl Run<'_> {
    /// Locates two folds in one of the last two steps.
    pub(super) fn hidden(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        (before, behind): Between<'_>,
    ) {
        let after = self.points.len() - 1;
        let earlier = self.earlier.replace(before.clone());
        let Some(earlier) = earlier.filter(|earlier| earlier.u.len() == before.u.len()) else {
            return;
        };
        let sign = before.parameter_slope().signum();
        let slopes = [&earlier, before, behind].map(|point| sign * point.parameter_slope());
        let lengths = [(&earlier, before), (before, behind)].map(|(a, b)| length(newton, a, b));
        let known = [
            (-lengths[0], slopes[0]),
            (0.0, slopes[1]),
            (lengths[1], slopes[2]),
        ];
        if slopes.iter().any(|slope| *slope <= 0.0) {
            return;
        }
        let Some((place, _)) = vertex(known) else {
            return;
        };
        let (between, after, known) = if place > 0.0 {
            ((before, behind), after, known)
        } else {
            let shifted = known.map(|(s, slope)| (s + lengths[0], slope));
            ((&earlier, before), after - 1, shifted)
        };
        if self.split == Some(after) {
            // Found as the last step, when it was that.
            return;
        }
        if let Some(inner) = self.turned_inside(balance, newton, between, (known, sign)) {
            self.split = Some(after);
            self.turn(balance, newton, (between.0, &inner), after);
            self.turn(balance, newton, (&inner, between.1), after);
        }
    }

    /// An orbit between two points where the slope has the other sign than at both.
    fn turned_inside(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        (a, b): Between<'_>,
        (mut known, sign): ([(f64, f64); 3], f64),
    ) -> Option<CurvePoint> {
        let whole = length(newton, a, b);
        let least = [a, b].map(|point| sign * point.parameter_slope());
        let least = least[0].min(least[1]);
        let mut lowest = f64::NAN;
        for _ in 0..LOOKS {
            let (place, foretold) = vertex(known)?;
            let close = CLOSE * whole;
            let is_within = place > close && place < whole - close;
            if !is_within || foretold > NEAR * least || (place - lowest).abs() < close {
                return None;
            }
            let options = self.options.newton;
            let inner = inside(balance, newton, (a, b), place / whole, options)?;
            let slope = sign * inner.parameter_slope();
            if slope < 0.0 {
                return Some(inner);
            }
            let mut all = [&known[..], &[(place, slope)]].concat();
            all.sort_by(|x, y| x.0.total_cmp(&y.0));
            let at = (1..all.len() - 1).min_by(|i, j| all[*i].1.total_cmp(&all[*j].1))?;
            known = [all[at - 1], all[at], all[at + 1]];
            lowest = place;
        }
        None
    }
}

/// How far apart two points are.
fn length(newton: &Newton, a: &CurvePoint, b: &CurvePoint) -> f64 {
    let pairs = b.u.iter().zip(&a.u);
    let difference: Vec<f64> = pairs.map(|(x, y)| x - y).collect();
    newton.norm().length(a.scale, &difference)
}

/// Place and value of the lowest point of the parabola through three points; `None` if it has none.
fn vertex([(x, p), (y, q), (z, r)]: [(f64, f64); 3]) -> Option<(f64, f64)> {
    let (left, right) = ((q - p) / (y - x), (r - q) / (z - y));
    let bend = (right - left) / (z - x);
    // q + s (u - y) + bend (u - y)^2
    let s = left + bend * (y - x);
    let lowest = y - 0.5 * s / bend;
    (bend > 0.0 && lowest.is_finite()).then_some((lowest, q - 0.25 * s * s / bend))
}
