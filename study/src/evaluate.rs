//! One variant: what is computed of it, and its rows.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};

use hertzian::bifurcation::{Bifurcations, Diagram, Reason, Settling};
use hertzian::error::{ErrorKind, chain};
use hertzian::{
    Branch, Cancel, Chosen, ContactEquation, Error, FrequencyResponse, HarmonicBalance,
    OrbitMethod, Shooting, System,
};

use crate::plan::{Method, What};
use crate::rows::Orbit;
use crate::study::Prepared;
use crate::table::{About, Value, kind};

/// What came of a variant.
#[derive(Debug, Clone, Default)]
pub(crate) struct Found {
    pub(crate) rows: Vec<Vec<Value>>,
    /// The branches, where they are kept.
    pub(crate) branches: Vec<Branch>,
    pub(crate) failed: bool,
}

/// It was cancelled: nothing of the variant is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Cancelled;

impl Prepared {
    /// The rows of a variant, by its number from zero on. A variant that cannot be computed has one that says why.
    pub fn rows(&self, index: usize) -> Vec<Vec<Value>> {
        if index >= self.count() {
            return Vec::new();
        }
        self.found(index, &Cancel::new())
            .map_or_else(|_| Vec::new(), |found| found.rows)
    }

    /// As [`rows`](Self::rows), unless it is cancelled.
    pub(crate) fn found(&self, index: usize, cancel: &Cancel) -> Result<Found, Cancelled> {
        let mut of = Of {
            study: self,
            begin: self.beginning(index),
            found: Found::default(),
        };
        let computed = catch_unwind(AssertUnwindSafe(|| of.compute(index, cancel)));
        if cancel.is_cancelled() {
            return Err(Cancelled);
        }
        let failed = match computed {
            Ok(Ok(())) => None,
            Ok(Err(error)) if error.kind() == ErrorKind::Cancelled => return Err(Cancelled),
            Ok(Err(error)) => Some(chain(&error).to_string()),
            // A broken promise between parts of the program: it must not cost the other variants.
            Err(panic) => Some(format!("the program failed: {}", said(&*panic))),
        };
        if let Some(why) = failed {
            of.found.rows.clear();
            of.fail(&why);
        }
        Ok(of.found)
    }

    /// What every row of a variant begins with.
    fn beginning(&self, index: usize) -> Vec<Value> {
        let values = self.designed.values(index).into_iter().map(Value::Number);
        std::iter::once(Value::count(index)).chain(values).collect()
    }
}

/// What a panic said.
fn said(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("it panicked")
}

/// A variant that is computed.
pub(crate) struct Of<'s> {
    pub(crate) study: &'s Prepared,
    pub(crate) begin: Vec<Value>,
    pub(crate) found: Found,
}

impl Of<'_> {
    fn compute(&mut self, index: usize, cancel: &Cancel) -> Result<(), Error> {
        let asked = &self.study.plan.request;
        let (system, omega) = self.study.variant(index);
        let mut request = FrequencyResponse::of(&system)
            .from(asked.from)
            .to(asked.to)
            .cancel(cancel);
        if asked.vary != "omega" {
            request = request.vary(&asked.vary);
            if let Some(omega) = omega {
                request = request.omega(omega);
            }
        }
        if let Some(tolerance) = asked.tolerance {
            request = request.tolerance(tolerance);
        }
        if let Some(period) = asked.period {
            request = request.period(period);
        }
        if let Some(wanted) = asked.stability {
            request = request.stability(wanted);
        }
        if let Some(points) = asked.max_points {
            request = request.max_points(points);
        }
        let default = match asked.what {
            What::Solutions => Some(Method::Shooting),
            // An option of the balance.
            What::Response if asked.bifurcations => Some(Method::Balance),
            _ => None,
        };
        match asked.method.or(default) {
            None => self.by(request, &system, cancel),
            Some(Method::Balance) => {
                let balance = HarmonicBalance::new().bifurcations(asked.bifurcations);
                self.by(request.by(balance), &system, cancel)
            }
            Some(Method::Shooting) => self.by(request.by(Shooting::new()), &system, cancel),
            Some(Method::ContactEquation) => {
                self.by(request.by(ContactEquation::new()), &system, cancel)
            }
        }
    }

    fn by<M: OrbitMethod>(
        &mut self,
        request: FrequencyResponse<M>,
        system: &dyn System,
        cancel: &Cancel,
    ) -> Result<(), Error> {
        match self.study.plan.request.what {
            What::Response => {
                let branch = request.run()?;
                self.take(0, &branch)?;
                self.keep(branch, cancel);
            }
            What::Bifurcations => {
                let diagram = self.bifurcations(request)?;
                for (number, found) in diagram.branches.iter().enumerate() {
                    self.take(number, &found.branch)?;
                }
                self.omitted(&diagram);
                for found in diagram.branches {
                    self.keep(found.branch, cancel);
                }
            }
            What::Solutions => self.solutions(&request, system)?,
        }
        if self.found.rows.is_empty() {
            self.branch_row(About::Nothing, 0, Orbit::default());
        }
        Ok(())
    }

    fn bifurcations<M: OrbitMethod>(
        &self,
        request: FrequencyResponse<M>,
    ) -> Result<Diagram, Error> {
        let request = Bifurcations::starting_with(request);
        match self.study.plan.request.method {
            None => self.diagram(request.by(Chosen::new())),
            Some(Method::Balance) => self.diagram(request.by(HarmonicBalance::new())),
            Some(Method::Shooting) => self.diagram(request.by(Shooting::new())),
            Some(Method::ContactEquation) => self.diagram(request.by(ContactEquation::new())),
        }
    }

    fn diagram<M: OrbitMethod>(&self, mut request: Bifurcations<M>) -> Result<Diagram, Error> {
        let asked = &self.study.plan.request;
        if let Some(depth) = asked.depth {
            request = request.depth(depth);
        }
        if let Some(period) = asked.max_period {
            request = request.max_period(period);
        }
        if asked.cover {
            request = request.cover(Settling::new());
        }
        request.run()
    }

    /// The rows of a branch.
    fn take(&mut self, number: usize, branch: &Branch) -> Result<(), Error> {
        if is_interrupted(branch) {
            return Ok(());
        }
        let before = self.found.rows.len();
        for event in &branch.events {
            if self.study.keeps(event.kind) {
                let orbit = self.event(branch, event)?;
                self.branch_row(About::Event, number, orbit);
            }
        }
        for turn in &branch.turns {
            if self.study.keeps(turn.kind) {
                let orbit = Orbit {
                    kind: turn.kind.to_string(),
                    period: Value::count(branch.period()),
                    value: Value::Number(turn.value),
                    ended: branch.stopped.to_string(),
                    ..Orbit::default()
                };
                self.branch_row(About::NotLocated, number, orbit);
            }
        }
        for wanted in &self.study.largest {
            if let Some(point) = branch.largest(&wanted.to_string())? {
                let orbit = self.orbit(branch, point, wanted.to_string())?;
                self.branch_row(About::Largest, number, orbit);
            }
        }
        for &value in &self.study.at {
            for point in branch.at(value)? {
                let orbit = self.orbit(branch, &point, String::new())?;
                self.branch_row(About::At, number, orbit);
            }
        }
        if self.found.rows.len() == before {
            let orbit = Orbit {
                ended: branch.stopped.to_string(),
                period: Value::count(branch.period()),
                ..Orbit::default()
            };
            self.branch_row(About::Nothing, number, orbit);
        }
        Ok(())
    }

    /// Bifurcations whose branches were not followed: those that begin nothing new are left out.
    fn omitted(&mut self, diagram: &Diagram) {
        for omitted in &diagram.omitted {
            if matches!(omitted.reason, Reason::BranchEnds { .. } | Reason::Mirrored) {
                continue;
            }
            let branch = &diagram.branches[omitted.branch].branch;
            let event = &branch.events[omitted.event];
            let orbit = Orbit {
                kind: kind(event),
                period: Value::count(event.point.orbit.period),
                value: Value::Number(event.point.value),
                error: Value::Number(event.error),
                ended: omitted.reason.to_string(),
                ..Orbit::default()
            };
            self.branch_row(About::NotFollowed, omitted.branch, orbit);
        }
        for (value, reason) in &diagram.missed {
            let orbit = Orbit {
                value: Value::Number(*value),
                ended: reason.to_string(),
                ..Orbit::default()
            };
            self.branch_row(About::NotFollowed, 0, orbit);
        }
    }

    /// Keeps a branch, if that is asked for, with everything that can be read off its orbits: who reads it has no model. Orbits whose
    /// motion cannot be computed are kept without.
    fn keep(&mut self, mut branch: Branch, cancel: &Cancel) {
        if !self.study.plan.keep.branches {
            return;
        }
        let _ = branch.complete_all_with(|_| {
            if cancel.is_cancelled() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        self.found.branches.push(branch);
    }

    /// A row for every value: a row of a map, whose second parameter is any that the variant has.
    fn solutions<M: OrbitMethod>(
        &mut self,
        request: &FrequencyResponse<M>,
        system: &dyn System,
    ) -> Result<(), Error> {
        let values = &self.study.at;
        let (name, value) = self.study.second(system);
        let map = request.map_with(values, name, &[value], |_| ControlFlow::Continue(()))?;
        for (&value, cell) in values.iter().zip(&map.cells) {
            self.cell_row(value, cell, &map.signal);
        }
        Ok(())
    }
}

/// Whether a branch was interrupted.
fn is_interrupted(branch: &Branch) -> bool {
    branch.stopped == hertzian::Stop::Interrupted
        || branch.begin == Some(hertzian::Stop::Interrupted)
}
