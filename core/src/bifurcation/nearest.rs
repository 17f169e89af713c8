//! The periodic orbit nearest to a state, stable or not.
//!
//! An orbit of `n` periods solves
//!
//! ```text
//! F(s, v) = P_v^n(s) - s = 0,                                                                                   (1)
//! ```
//!
//! where `P_v` is the map over one period at a value `v` of what is varied. These are as many equations as a state has entries, for one unknown
//! more: their solutions are the branches. Newton's method with the shortest step that solves the linearised equations,
//!
//! ```text
//! d = -A^+ F,   A = [ dP^n/ds - I,  dP^n/dv ]   =>   A^T = Q R,   d = -Q R^-T F,                                (2)
//! ```
//!
//! leads from a state and a value to a point of a branch near them, over folds too, where the columns of the state alone are dependent
//! (Ben-Israel 1966, J. Math. Anal. Appl. 15, 243; Allgower and Georg 1990, chapter 3). Lengths are measured in given units.

use nalgebra::{DMatrix, DVector};

use crate::system::Variable;
use crate::time::stroboscope::Stroboscope;
use crate::time::{FlowError, Tangent};

/// Updates of Newton's method.
const UPDATES: usize = 16;
/// Its largest entry is no longer than this, in units.
const LONGEST: f64 = 0.5;
/// One that is shorter is the last.
const SHORT: f64 = 1e-6;
/// A search ends where equations have not become better in so many updates.
const IDLE: usize = 4;
/// States of one orbit that were found in two ways differ by less.
const SAME: f64 = 1e-5;
/// An orbit on a branch is as near as this to the straight way between its neighbours, as a part of how far these are apart; and states of a
/// branch are known to this.
const NEAR: f64 = 0.25;
const ROUGH: f64 = 1e-3;

/// An orbit, stable or not.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NearestOrbit {
    pub(super) value: f64,
    /// Its states at phase zero, one for each of its periods.
    pub(super) states: Vec<Vec<f64>>,
}

/// Looks for orbits of a map.
pub(super) struct Nearest {
    map: Stroboscope,
    variable: Variable,
    tangent: Tangent,
    /// Of the entries of a state, and of the value.
    units: Vec<f64>,
    range: [f64; 2],
}

impl Nearest {
    /// In a range of values; `units` are those of the entries of a state and of the value.
    pub(super) fn new(
        map: Stroboscope,
        variable: Variable,
        units: Vec<f64>,
        range: [f64; 2],
    ) -> Self {
        Self {
            tangent: Tangent::of_state(map.order() / 2, [variable]),
            map,
            variable,
            units,
            range: [range[0].min(range[1]), range[0].max(range[1])],
        }
    }

    /// Periods that were computed so far.
    pub(super) fn periods(&self) -> u64 {
        self.map.periods()
    }

    /// Entries of a state have other sizes from here on.
    pub(super) fn measure_by(&mut self, units: &[f64]) {
        self.units[..units.len()].copy_from_slice(units);
    }

    /// Moves a state over some periods at a value.
    ///
    /// # Errors
    /// If the motion cannot be continued.
    pub(super) fn pass(
        &mut self,
        state: &mut [f64],
        value: f64,
        periods: usize,
    ) -> Result<(), FlowError> {
        self.map.set(self.variable, value)?;
        (0..periods).try_for_each(|_| self.map.map(state))
    }

    /// The orbit that Newton's method leads to from a state at a value, of so many periods or of a divisor of them.
    pub(super) fn orbit(
        &mut self,
        guess: &[f64],
        value: f64,
        period: usize,
    ) -> Option<NearestOrbit> {
        let (state, value) = self.newton(guess, value, period, true).ok()??;
        let mut states = vec![state];
        for index in 1..=period {
            let mut next = states[index - 1].clone();
            self.map.map(&mut next).ok()?;
            if self.apart(&next, &states[0]) <= SAME {
                // Only by rounding does it return after other parts of the period.
                let whole = period.is_multiple_of(index);
                return whole.then_some(NearestOrbit { value, states });
            }
            states.push(next);
        }
        // A short step beside a touch, where derivatives have no bound, is no sign of an orbit.
        None
    }

    /// Whether an orbit lies between two neighbours on a branch, given by their values and states: whether Newton's method leads to it from
    /// between them, and that is much nearer than they are to each other. Where
    /// that is not so it may lie there all the same.
    pub(super) fn is_between(
        &mut self,
        [(first, a), (second, b)]: [(f64, &[f64]); 2],
        orbit: &NearestOrbit,
    ) -> bool {
        let NearestOrbit { value, states } = orbit;
        let part = if first == second {
            0.5
        } else {
            (value - first) / (second - first)
        };
        let entries = a.iter().zip(b);
        let guess: Vec<f64> = entries.map(|(a, b)| a + part * (b - a)).collect();
        let far = NEAR * self.apart(a, b) + ROUGH;
        let is_near = |other: &Vec<f64>| self.apart(&guess, other) <= far;
        if !states.iter().any(is_near) {
            return false;
        }
        let found = self.newton(&guess, *value, states.len(), false);
        found.ok().flatten().is_some_and(|(state, _)| {
            let mut states = states.iter();
            states.any(|other| self.apart(&state, other) <= SAME)
        })
    }

    /// A state by (2), and a value with it if that is free.
    fn newton(
        &mut self,
        guess: &[f64],
        mut value: f64,
        period: usize,
        free: bool,
    ) -> Result<Option<(Vec<f64>, f64)>, FlowError> {
        let order = guess.len();
        let mut state = guess.to_vec();
        let (mut best, mut idle) = (f64::INFINITY, 0);
        for _ in 0..UPDATES {
            self.map.set(self.variable, value)?;
            let (image, mut matrix) = self.linearised(&state, period)?;
            if !free {
                matrix.column_mut(order).fill(0.0);
            }
            let off = image.iter().zip(&state).zip(&self.units);
            let off = off.map(|((a, b), unit)| (a - b) / unit);
            let off = DVector::from_iterator(order, off);
            let norm = off.norm();
            idle = if norm < best { 0 } else { idle + 1 };
            best = best.min(norm);
            if idle > IDLE {
                return Ok(None);
            }
            let (q, r) = matrix.transpose().qr().unpack();
            let Some(solved) = r.tr_solve_upper_triangular(&off) else {
                return Ok(None);
            };
            let step = q * solved;
            let length = step.amax();
            if !length.is_finite() {
                return Ok(None);
            }
            let part = (LONGEST / length).min(1.0);
            let moved = step
                .iter()
                .zip(&self.units)
                .map(|(d, unit)| part * d * unit);
            let moved: Vec<f64> = moved.collect();
            for (x, d) in state.iter_mut().zip(&moved) {
                *x -= d;
            }
            value = (value - moved[order]).clamp(self.range[0], self.range[1]);
            if length <= SHORT {
                self.map.set(self.variable, value)?;
                return Ok(Some((state, value)));
            }
        }
        Ok(None)
    }

    /// The image of a state after some periods, and the matrix of (2), in units.
    fn linearised(
        &mut self,
        state: &[f64],
        period: usize,
    ) -> Result<(Vec<f64>, DMatrix<f64>), FlowError> {
        let order = state.len();
        let image = self.map.linearised(state, period, &mut self.tangent)?;
        let columns = &self.tangent.columns;
        let units = &self.units;
        let matrix = DMatrix::from_fn(order, order + 1, |i, j| {
            let one = if i == j { 1.0 } else { 0.0 };
            (columns[j * order + i] - one) * units[j] / units[i]
        });
        Ok((image, matrix))
    }

    /// How far two states are apart, in units.
    fn apart(&self, a: &[f64], b: &[f64]) -> f64 {
        let entries = a.iter().zip(b).zip(&self.units);
        entries.fold(0.0, |most: f64, ((x, y), unit)| {
            most.max((x - y).abs() / unit)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::one_sided::one_sided;
    use crate::time;

    const UNITS: [f64; 3] = [2.0, 2.0, 0.1];

    fn nearest(omega: f64) -> Nearest {
        let model = one_sided(1.0);
        let flow = time::of(&model, omega, 1e-10).expect("a flow");
        Nearest::new(
            Stroboscope::new(flow),
            Variable::Omega,
            UNITS.to_vec(),
            [0.5, 1.5],
        )
    }

    /// What it leads to returns, at the value that it says, after no period that is shorter.
    #[test]
    fn what_is_found_returns() {
        let mut found = [0; 5];
        let mut nearest = nearest(1.0);
        for index in 0..60 {
            let part = |by: f64| 2.0 * (by * f64::from(index)).fract() - 1.0;
            let guess = [-4.0 + 4.0 * part(0.754_877), 3.0 * part(0.569_840)];
            for period in 1..=4 {
                let Some(orbit) = nearest.orbit(&guess, 1.0, period) else {
                    continue;
                };
                found[orbit.states.len()] += 1;
                assert!(period.is_multiple_of(orbit.states.len()));
                let mut state = orbit.states[0].clone();
                for count in 1..=orbit.states.len() {
                    nearest.pass(&mut state, orbit.value, 1).expect("a motion");
                    let off = nearest.apart(&state, &orbit.states[0]);
                    assert_eq!(off < 1e-5, count == orbit.states.len(), "{off:e}");
                }
            }
        }
        assert!(found[1] > 0 && found[2] > 0 && found[3] > 0, "{found:?}");
    }

    /// An orbit is between itself at values beside its own, and not between others.
    #[test]
    fn an_orbit_is_between_its_neighbours() {
        let mut nearest = nearest(1.0);
        let mut at = |value: f64, guess: &[f64]| {
            let (state, value) = nearest.newton(guess, value, 1, false).ok()??;
            Some(NearestOrbit {
                value,
                states: vec![state],
            })
        };
        let middle = at(1.0, &[-2.0, 0.18]).expect("an orbit");
        let [low, high] = [0.98, 1.02].map(|value| at(value, &middle.states[0]));
        let [low, high] = [low.expect("an orbit"), high.expect("an orbit")];
        let ends = [&low, &high].map(|orbit| (orbit.value, &orbit.states[0][..]));
        assert!(nearest.is_between(ends, &middle));
        let mut elsewhere = middle.clone();
        elsewhere.states[0][0] -= 3.0;
        assert!(!nearest.is_between(ends, &elsewhere));
    }
}
