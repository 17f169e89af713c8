//! What is read off where the [engine](crate::branches::engine) has located a fold.

use super::Run;
use crate::balance::Balance;
use crate::balance::subharmonics::is_shifted;
use crate::branches::point::Event;
use crate::branches::problem::{Zero, ZeroOutcome};
use crate::continuation::follow::Stop;
use crate::continuation::newton::Newton;

/// The test function of a fold is driven below this.
pub(super) const FOLD_TOLERANCE: f64 = 1e-10;

impl Run<'_> {
    /// Reads a fold that was located, or a place where the branch ends on another one. A fold of longer orbits that was passed before,
    /// but for a shift in time, is the sign of a branch that closes after a part of the period.
    pub(super) fn fold(
        &mut self,
        balance: &mut Balance<'_>,
        newton: &mut Newton,
        zero: &Zero,
    ) -> ZeroOutcome {
        let located = &zero.root.located;
        let (kind, after) = (zero.change.kind, zero.after);
        let u = &located.point.u;
        let error = self.evaluator.finer.fold_error(u, newton);
        let point = self.evaluator.read(balance, newton, u, None);
        let turns = |after: usize, value: f64| self.record.points[after - 1].value < value;
        let same_way = turns(after, point.value);
        let near = |other: &&Event| {
            let apart = (other.point.value - point.value).abs();
            let errors = other.error + error;
            let range = (self.options.to - self.options.from).abs();
            // The two folds of a narrow hysteresis turn opposite ways.
            let alike = turns(other.after, other.point.value) == same_way;
            other.kind == kind && alike && errors.is_finite() && apart <= errors + 1e-9 * range
        };
        let mut passed = self.record.events.iter().filter(near);
        let stride = self.context.stride;
        let later = point.orbit.period > 1 || stride > point.orbit.recurrence().stride();
        if later && passed.any(|other| is_shifted(&other.point.orbit, &point.orbit, stride)) {
            return ZeroOutcome::Ends(Stop::Closed);
        }
        self.record.events.push(Event {
            kind,
            point,
            error,
            test: located.test,
            after,
            contacts: 0,
            tangent: Vec::new(),
        });
        ZeroOutcome::Event
    }
}
