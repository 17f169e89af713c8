//! From a state that nearly returns to a stable periodic orbit, or to the knowledge that there is none.

use nalgebra::{Complex, DMatrix, DVector};

use super::attractor::Attractor;
use super::ball::Ball;
use super::catalogue::Catalogue;
use crate::numeric::spectrum::eigenvalues;
use crate::time::stroboscope::Stroboscope;
use crate::time::{FlowError, Tangent};

/// Updates of Newton's method.
const UPDATES: usize = 14;
/// An update that moves a state by less, relative to its size, is the last one.
const SMALL: f64 = 1e-13;
/// A state that returns to within this, relative to its size, returns, unless motions are known less well.
const RETURNS: f64 = 1e-9;
/// An orbit that is near is no farther than this, relative to the size of a state.
const NEAR: f64 = 0.5;
/// Points of an orbit that get a neighbourhood. More would be met sooner, and take longer to verify.
const BALLS: usize = 4;
/// Multipliers nearer to the unit circle are not told from it.
const MARGIN: f64 = 1e-6;

/// What Newton's method led to.
pub(super) enum Refined {
    /// A stable orbit that is not in the catalogues.
    New(Attractor),
    /// An orbit that is.
    Known,
    /// No stable orbit.
    Nothing,
}

/// Looks for periodic orbits of a map.
pub(crate) struct Finder {
    tangent: Tangent,
    /// A state that returns to within this, relative to its size, returns.
    returns: f64,
    /// An update that is longer than this, relative to the size of a state, is the end of a search.
    longest: f64,
}

impl Finder {
    pub(crate) fn new(order: usize) -> Self {
        Self {
            tangent: Tangent::of_state(order / 2, None),
            returns: RETURNS,
            longest: f64::INFINITY,
        }
    }

    /// The same for motions that are known less well, so that states return to within this, relative to their size; and for orbits
    /// that are near.
    pub(crate) fn near(self, returns: f64) -> Self {
        let longest = NEAR;
        Self {
            returns,
            longest,
            ..self
        }
    }

    /// The state near a guess that returns after some periods, if it is on a stable orbit.
    pub(crate) fn stable(
        &mut self,
        map: &mut Stroboscope,
        guess: &[f64],
        period: usize,
    ) -> Option<Vec<f64>> {
        let state = self.newton(map, guess, period).ok()??;
        let jacobian = self.jacobian(map, &state, period).ok()?.1;
        is_stable(&eigenvalues(&jacobian)).then_some(state)
    }

    /// Refines a state that nearly returns after some periods.
    pub(super) fn refine(
        &mut self,
        map: &mut Stroboscope,
        guess: &[f64],
        period: usize,
        known: [&Catalogue; 2],
    ) -> Refined {
        self.try_refine(map, guess, period, known)
            .ok()
            .flatten()
            .unwrap_or(Refined::Nothing)
    }

    /// An error or `None` says that there is no stable orbit.
    fn try_refine(
        &mut self,
        map: &mut Stroboscope,
        guess: &[f64],
        period: usize,
        known: [&Catalogue; 2],
    ) -> Result<Option<Refined>, FlowError> {
        let Some(point) = self.newton(map, guess, period)? else {
            return Ok(None);
        };
        if known.iter().any(|known| known.find(&point).is_some()) {
            return Ok(Some(Refined::Known));
        }
        let mut points = points(map, &point, period)?;
        let size = sizes(&points);
        let returns = |d: &usize| {
            let off = points[*d].iter().zip(&points[0]).zip(&size);
            off.clone()
                .all(|((a, b), size)| (a - b).abs() <= 1e3 * RETURNS * size)
        };
        let shortest = (1..period)
            .filter(|d| period.is_multiple_of(*d))
            .find(returns);
        points.truncate(shortest.unwrap_or(period));
        rotate_to_first(&mut points);
        let period = points.len();
        // Once more from the point that stands for the orbit.
        let Some(first) = self.newton(map, &points[0], period)? else {
            return Ok(None);
        };
        let points = self::points(map, &first, period)?;
        let jacobian = self.jacobian(map, &first, period)?.1;
        let multipliers = eigenvalues(&jacobian);
        if !is_stable(&multipliers) {
            return Ok(None);
        }
        let step = period.div_ceil(BALLS);
        let mut balls = Vec::new();
        for centre in points.iter().step_by(step) {
            let jacobian = self.jacobian(map, centre, period)?.1;
            balls.extend(Ball::grow(map, centre, period, &jacobian, &size));
        }
        let attractor = Attractor {
            period,
            points,
            multipliers,
            balls,
        };
        Ok((!attractor.balls.is_empty()).then_some(Refined::New(attractor)))
    }

    /// The fixed point of the map over some periods by Newton's method: `(I - J) d = Q(s) - s`.
    fn newton(
        &mut self,
        map: &mut Stroboscope,
        guess: &[f64],
        period: usize,
    ) -> Result<Option<Vec<f64>>, FlowError> {
        let order = guess.len();
        let mut point = guess.to_vec();
        let mut last = f64::INFINITY;
        for _ in 0..UPDATES {
            let (image, jacobian) = self.jacobian(map, &point, period)?;
            let off = DVector::from_iterator(order, image.iter().zip(&point).map(|(a, b)| a - b));
            let Some(step) = (DMatrix::identity(order, order) - jacobian)
                .lu()
                .solve(&off)
            else {
                return Ok(None);
            };
            let size = sizes(&[&point[..], &image].map(<[f64]>::to_vec));
            let length = step.iter().zip(&size).map(|(d, size)| (d / size).abs());
            let length = length.fold(0.0, f64::max);
            for (x, d) in point.iter_mut().zip(step.iter()) {
                *x += d;
            }
            if length > self.longest || !point.iter().all(|x| x.is_finite()) {
                return Ok(None);
            }
            // At the end rounding keeps the updates from becoming smaller.
            if length <= SMALL || (length < self.returns && length >= 0.5 * last) {
                return Ok(Some(point));
            }
            last = length;
        }
        Ok((last < self.returns).then_some(point))
    }

    /// The image of a state after some periods, and its derivatives.
    fn jacobian(
        &mut self,
        map: &mut Stroboscope,
        state: &[f64],
        period: usize,
    ) -> Result<(Vec<f64>, DMatrix<f64>), FlowError> {
        let order = state.len();
        let image = map.linearised(state, period, &mut self.tangent)?;
        let jacobian = DMatrix::from_column_slice(order, order, &self.tangent.columns);
        Ok((image, jacobian))
    }
}

/// Whether the largest multiplier is inside the unit circle.
fn is_stable(multipliers: &[Complex<f64>]) -> bool {
    multipliers
        .first()
        .is_some_and(|largest| largest.norm() < 1.0 - MARGIN)
}

/// The states of some periods from a first one.
fn points(map: &mut Stroboscope, first: &[f64], period: usize) -> Result<Vec<Vec<f64>>, FlowError> {
    let mut points = vec![first.to_vec()];
    for i in 1..period {
        let mut next = points[i - 1].clone();
        map.map(&mut next)?;
        points.push(next);
    }
    Ok(points)
}

/// The largest entries of some states; none vanishes beside the others.
fn sizes(states: &[Vec<f64>]) -> Vec<f64> {
    let largest = |i: usize| states.iter().map(|s| s[i].abs()).fold(0.0, f64::max);
    let sizes: Vec<f64> = (0..states[0].len()).map(largest).collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    let least = if most > 0.0 { 1e-3 * most } else { 1.0 };
    sizes.into_iter().map(|size| size.max(least)).collect()
}

/// Begins with the point whose first entry is the smallest; where it is the same, the second decides.
fn rotate_to_first(points: &mut [Vec<f64>]) {
    let compare = |a: &[f64], b: &[f64]| {
        let entries = a.iter().zip(b).map(|(x, y)| x.total_cmp(y));
        entries.into_iter().find(|order| order.is_ne())
    };
    let least = (0..points.len())
        .min_by(|&a, &b| compare(&points[a], &points[b]).unwrap_or(std::cmp::Ordering::Equal));
    points.rotate_left(least.unwrap_or(0));
}
