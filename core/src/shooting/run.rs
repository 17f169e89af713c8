//! What is done with the curve of orbits that is followed: multipliers and extremes of every orbit, events, and where it ends.

use std::ops::ControlFlow;

use nalgebra::DMatrix;

use super::companion::{Companion, multipliers};
use super::cycle::{Cycle, CycleEvent, End};
use super::equations::Equations;
use super::extremes::{self, Extremes};
use super::method::ShootingBranch;
use super::recurrence::Recurrence;
use super::setting::Setting;
use crate::branches::engine;
use crate::branches::error::OrbitError;
use crate::continuation::follow::{FollowOptions, Start, Stop};
use crate::continuation::newton::{NewtonError, NewtonOptions};
use crate::continuation::statistics::Statistics;
use crate::error::Error;
use crate::event::Turn;
use crate::numeric::spectrum::distance;
use crate::orbit::stability::Stability;
use crate::time::MotionError;
use crate::time::{FlowError, Stretch, Work};

/// What a run has gathered.
pub(super) struct Run<'r> {
    pub(super) setting: &'r Setting,
    pub(super) options: NewtonOptions,
    companion: Companion,
    size: f64,
    /// What the branch has met.
    pub(super) joined: Option<Recurrence>,
    pub(super) cycles: Vec<Cycle>,
    pub(super) events: Vec<CycleEvent>,
    pub(super) turns: Vec<Turn>,
    /// Why an orbit that was found could not be read.
    pub(super) failure: Option<FlowError>,
    pub(super) statistics: Statistics,
    /// Work of flows that are no more.
    pub(super) work: Work,
}

impl<'r> Run<'r> {
    pub(super) fn new(
        setting: &'r Setting,
        options: NewtonOptions,
        companion: Companion,
        size: f64,
    ) -> Self {
        Self {
            setting,
            options,
            companion,
            size,
            joined: None,
            cycles: Vec::new(),
            events: Vec::new(),
            turns: Vec::new(),
            failure: None,
            statistics: Statistics::default(),
            work: Work::default(),
        }
    }

    /// Follows the branch from where it starts to its end.
    ///
    /// # Errors
    /// If there is no first orbit.
    pub(super) fn follow(
        &mut self,
        equations: Equations,
        start: Start,
        options: FollowOptions,
        visit: &mut dyn FnMut(&Cycle) -> ControlFlow<()>,
    ) -> Result<End, Error> {
        let mut branch = ShootingBranch::new(self, equations, visit);
        let outcome = engine::run(&mut branch, start, options);
        branch.count_flows();
        let failed = branch.equations.failure;
        let failure = self.failure.or(failed);
        self.statistics += self.companion.newton.statistics;
        add(&mut self.work, self.companion.work());
        if let Some(Recurrence { period, odd }) = self.joined {
            return Ok(End::Joined {
                period,
                symmetric: odd,
            });
        }
        let last = self.cycles.last().map_or(options.from, |cycle| cycle.value);
        let end = match (outcome, failure) {
            (Ok(_), Some(FlowError::Cancelled { .. })) if !self.cycles.is_empty() => {
                return Ok(End::Stopped(Stop::Interrupted));
            }
            (Err(reason), failure) => return Err(no_orbit(options.from, reason, failure)),
            (Ok(Stop::StepTooShort { .. }), Some(reason)) => {
                let value = last;
                End::Motion { value, reason }
            }
            (Ok(stop), _) => End::Stopped(stop),
        };
        Ok(match self.failure {
            Some(reason) => End::Motion {
                value: last,
                reason,
            },
            None => end,
        })
    }

    /// The size of the orbits, and by what part of it two states differ that are one.
    pub(super) fn regular(&self, equations: &Equations) -> (f64, f64) {
        (self.size, self.setting.same(equations.frame.ratio))
    }

    /// Whether the orbit at the last event is more regular than asked for: then the branch ends there, and what follows is the
    /// same orbits again, looked at from elsewhere.
    pub(super) fn meets(&mut self, equations: &mut Equations) -> bool {
        let odd = self.setting.odd;
        let Some(event) = self.events.last() else {
            return false;
        };
        if equations.span.period == 1 && !odd {
            return false;
        }
        let after = event.after;
        let u = equations.unknowns_of(&event.cycle.states, event.cycle.value);
        let Ok(recurrence) = Recurrence::at_point(equations, &u, self.regular(equations), odd)
        else {
            return false;
        };
        let regular =
            recurrence.period < equations.span.period || recurrence.odd != equations.span.half;
        if regular {
            // The orbits behind the point are those before it.
            self.cycles.truncate(after);
            self.joined = Some(recurrence);
        }
        regular
    }

    /// An orbit with everything that is read off it, and its map if the stability is wanted. With a flow that has a tolerance, it
    /// is the orbit corrected for that.
    pub(super) fn read(
        &mut self,
        equations: &mut Equations,
        u: &[f64],
    ) -> Result<(Cycle, Option<DMatrix<f64>>), FlowError> {
        let Self {
            setting, companion, ..
        } = self;
        if !setting.stability {
            return observe(setting, equations, u);
        }
        self.statistics.monodromies += 1;
        let corrected = companion.correct(u);
        let finer = corrected.as_ref().filter(|_| companion.finer);
        let (at, known) = match finer {
            Some(finer) => (&mut companion.equations, &finer.u[..]),
            None => (equations, u),
        };
        let (mut cycle, map) = observe(setting, at, known)?;
        let Some(map) = map else {
            return Ok((cycle, None));
        };
        let found = multipliers(&map, companion.equations.span.half);
        let (mut spread, relative) = companion.errors(&map, &found);
        let mut error = relative * self.size;
        if let Some(corrected) = &corrected {
            let other = companion.multipliers_beside(corrected);
            spread += companion.part * distance(&found, &other);
            error += companion.part * companion.equations.apart(u, &corrected.u);
        } else {
            spread = f64::INFINITY;
            error = f64::INFINITY;
        }
        cycle.error = Some(error);
        cycle.stability = if found.is_empty() {
            Stability::unknown()
        } else {
            Stability::of(found, spread)
        };
        Ok((cycle, Some(map)))
    }
}

/// An orbit without its stability, and its map if the stability is wanted.
pub(super) fn observe(
    setting: &Setting,
    equations: &mut Equations,
    u: &[f64],
) -> Result<(Cycle, Option<DMatrix<f64>>), FlowError> {
    let value = u[u.len() - 1];
    let rate = setting.rate_at(value);
    let mut extremes = vec![Extremes::NONE; equations.order() / 2];
    let see = &mut |stretch: &dyn Stretch| extremes::include(stretch, rate, &mut extremes);
    let before = equations.flow.work().switches;
    let map = if setting.stability {
        Some(equations.map(u, see)?)
    } else {
        equations.trace(u, see)?;
        None
    };
    let switches = equations.flow.work().switches - before;
    let half = equations.span.half;
    if half {
        for extremes in &mut extremes {
            *extremes = extremes.mirrored();
        }
    }
    let cycle = Cycle {
        value,
        parameters: setting.parameters_at(value),
        omega: setting.omega_at(value),
        period: equations.span.period,
        symmetric: half,
        states: equations.states_of(u),
        stability: Stability::unknown(),
        extremes,
        switches: switches * if half { 2 } else { 1 },
        error: None,
        iterations: 0,
    };
    Ok((cycle, map))
}

/// Why there is no orbit.
pub(super) fn no_orbit(value: f64, reason: NewtonError, failure: Option<FlowError>) -> Error {
    match failure {
        Some(reason) => MotionError { value, reason }.into(),
        None => OrbitError::NoStart { value, reason }.into(),
    }
}

/// Adds up work.
pub(super) fn add(sum: &mut Work, other: Work) {
    sum.steps += other.steps;
    sum.rejected += other.rejected;
    sum.forces += other.forces;
    sum.switches += other.switches;
}
