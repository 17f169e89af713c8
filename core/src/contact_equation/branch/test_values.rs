//! Test functions at an orbit, by the map of its states over the periods, and what they follow from at the last orbit, whose equations may
//! be others.

use nalgebra::DMatrix;

use super::method::ContactBranch;
use crate::branches::problem::Zero;
use crate::continuation::follow::CurvePoint;
use crate::event::EventKind;
use crate::shooting::test_functions::{self, Tests};

/// A test function must vanish as exactly as this.
pub(super) const VANISHING: f64 = 1e-9;

/// What test functions of an orbit follow from, whatever its equations.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::contact_equation) struct Last {
    /// What is varied, and what the bordered determinant is divided by.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) value: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) slope: f64,
    /// The map of the states column by column, if it is known.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(super) map: Vec<f64>,
}

impl Last {
    pub(super) fn tests(&self) -> Tests {
        let order = self.map.len().isqrt();
        let map = (order > 0).then(|| DMatrix::from_column_slice(order, order, &self.map));
        Tests::of(map.as_ref(), self.slope)
    }

    /// Whether it is one of so many states: it may have been read from a file.
    pub(super) fn is_of(&self, order: usize) -> bool {
        let whole = self.map.is_empty() || self.map.len() == order * order;
        let slope = self.slope.is_nan() || self.slope.is_finite() && self.slope != 0.0;
        whole && slope && self.map.iter().chain([&self.value]).all(|x| x.is_finite())
    }
}

/// What the bordered determinant is divided by. Where the slope is rounding, nothing is known of the quotient.
pub(super) fn divisor(at: &CurvePoint) -> f64 {
    at.known_slope(VANISHING).unwrap_or(f64::NAN)
}

impl ContactBranch<'_, '_> {
    pub(super) fn tests(&mut self, at: &CurvePoint) -> &Tests {
        let known = self.tested.take().filter(|(u, _)| *u == at.u);
        let found = known.unwrap_or_else(|| {
            let own = self.run.equations.map(&at.u);
            let last = self.last.as_ref();
            let known = |last: &&Last| last.value == at.parameter() && !last.map.is_empty();
            let tests = match (own, last.filter(known)) {
                (Some(own), _) => {
                    let values = self.run.last_map.values(&own).to_vec();
                    Tests::with(Some(&own), values, divisor(at))
                }
                // The last orbit may have other equations, in which it was looked at.
                (None, Some(last)) => last.tests(),
                (None, None) => {
                    let ordered = self.run.ordered(at);
                    let ordered = ordered.map(|(mut equations, at)| {
                        let map = equations.map(&at.u);
                        Tests::of(map.as_ref(), divisor(&at))
                    });
                    ordered.unwrap_or_else(|| Tests::of(None, divisor(at)))
                }
            };
            (at.u.clone(), tests)
        });
        &self.tested.insert(found).1
    }

    /// How well multipliers are known along the last step.
    pub(super) fn last_error(&self) -> f64 {
        self.run.record.last_error(VANISHING)
    }

    /// What happens at a zero, if anything does: as by shooting. What it asks (`tests`, `last_error`) is of each method, and test functions
    /// are computed for moduli alone, so that neither can be handed to one function before.
    pub(super) fn kind(&mut self, zero: &Zero) -> Option<EventKind> {
        let test_functions::Test::Modulus(place) = test_functions::Test::of(zero.change.test)
        else {
            return Some(zero.change.kind);
        };
        let tells = zero.told || zero.least <= self.last_error();
        let doubling = self.watched[test_functions::DOUBLING].kind;
        let tests = self.tests(&zero.root.located.point);
        tests.seen_by_modulus(place, tells, doubling)
    }
}
