//! Motion back in time: `q(-t)` is the motion of a system whose rates and phases have the opposite sign, and is again piecewise
//! affine.

use super::Affine;
use crate::time::{Flow, FlowError, See, Stretch, Tangent, Work};

impl Affine {
    /// Moves from a phase to an earlier one.
    pub(super) fn go_back(
        &mut self,
        from: f64,
        to: f64,
        state: &mut [f64],
        mut tangent: Option<&mut Tangent>,
        see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        let (model, cancel) = (&self.model, &self.cancel);
        let reversed = self.reversed.get_or_insert_with(|| {
            let mut flow = Box::new(Self::of(model.reversed()));
            flow.until(cancel);
            flow
        });
        let before = reversed.work;
        turn(state);
        turn_all(tangent.as_deref_mut(), state.len());
        let result = match see {
            None => reversed.advance(-from, -to, state, tangent.as_deref_mut(), None),
            Some(see) => {
                let mut show = |inner: &dyn Stretch| see(&Reversed { inner });
                let tangent = tangent.as_deref_mut();
                reversed.advance(-from, -to, state, tangent, Some(&mut show))
            }
        };
        turn(state);
        turn_all(tangent, state.len());
        self.work = sum(self.work, before, reversed.work);
        result.map_err(|error| error.moved(|phase| -phase))
    }
}

/// Changes the signs of the rates.
fn turn(state: &mut [f64]) {
    let coordinates = state.len() / 2;
    for rate in &mut state[coordinates..] {
        *rate = -*rate;
    }
}

fn turn_all(tangent: Option<&mut Tangent>, order: usize) {
    if let Some(tangent) = tangent {
        tangent.columns.chunks_exact_mut(order).for_each(turn);
    }
}

/// What was done with what has been done since.
fn sum(work: Work, before: Work, after: Work) -> Work {
    Work {
        steps: work.steps + after.steps - before.steps,
        rejected: work.rejected + after.rejected - before.rejected,
        forces: work.forces + after.forces - before.forces,
        switches: work.switches + after.switches - before.switches,
    }
}

/// A stretch of the reversed motion, as it is in time.
struct Reversed<'s> {
    inner: &'s dyn Stretch,
}

impl Stretch for Reversed<'_> {
    fn phases(&self) -> (f64, f64) {
        let (from, to) = self.inner.phases();
        (-from, -to)
    }

    fn state(&self, phase: f64, state: &mut [f64]) {
        self.inner.state(-phase, state);
        turn(state);
    }
}
