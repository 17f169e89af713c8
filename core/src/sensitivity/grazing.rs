//! Where an orbit grazes a level, and how that place moves.
//!
//! An orbit grazes where a gap has an extreme on a level,
//!
//! ```text
//! g(s, lambda, p) = gap(tau*) - level = 0,   gap'(tau*) = 0,   dlambda/dp = - (g_s s_p + g_p) / (g_s s_lambda + g_lambda),   (1)
//! ```
//!
//! with the derivatives of the states at a fixed value of what is varied, since the place `tau*` of an extreme counts by its square only.
//!
//! Where the force jumps at the level, orbits that pass it have no derivative at the touch, but those that do not reach it are smooth up to
//! there: (1) holds with their derivatives. It is evaluated at two of them, whose gaps end a little before the level, and continued to it.
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2.

use std::sync::Arc;

use super::cycle::{Cycle, Stop};
use super::error::SensitivityError;
use super::fold::{LAST, Moving, STEPS};
use super::orbit::Start;
use super::scan::{Scan, Turn};
use super::slopes::{Direction, Slopes};
use crate::system::{System, Variable};

/// An extreme of a gap is taken to be on a level within this part of the orbit.
const TOUCH: f64 = 1e-2;
/// Where the force jumps, orbits end this part of their size before the level, and twice that.
const BEFORE: f64 = 1e-8;
const ENOUGH: f64 = 0.1;
/// Values at which an orbit that does not reach the level is looked for, by their distance as parts of the value.
const AWAY: [f64; 7] = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3];
/// A step that leads to where orbits pass the level is so often halved.
const HALVINGS: usize = 40;

/// The contact and the level that are touched, and the extreme.
type Place = (usize, usize, Turn);

/// The orbit near states that grazes, and how its place moves.
///
/// # Errors
/// If there is none, or its motion cannot be continued.
pub(super) fn grazing(
    cycle: &mut Cycle,
    system: &Arc<dyn System>,
    start: &Start,
    variables: &[Variable],
) -> Result<Moving, SensitivityError> {
    let mut slopes = Slopes::new(system, &[]);
    let Start {
        mut states,
        mut value,
    } = start.clone();
    let mut touch: Option<Place> = None;
    for _ in 0..STEPS {
        cycle.set(cycle.varied, value)?;
        cycle.solve(&mut states)?;
        slopes.set(&cycle.values, cycle.omega);
        let scan = Scan::of(cycle, &slopes, &states, true)?;
        let near = nearest(&slopes, &scan, touch)
            .filter(|(_, distance)| distance.abs() <= TOUCH * cycle.size(&states));
        let (place, distance) = near.ok_or(SensitivityError::NoTouch)?;
        let here = Here {
            start: Start { states, value },
            scan,
            place,
            distance,
        };
        if slopes.jumps(place.0, place.1) {
            return OneSided::of(cycle, slopes, here)?.moves(cycle, variables);
        }
        let grows = here.grows(cycle, &slopes, &[cycle.varied])?;
        let step = -distance / grows[0];
        if step.abs() <= LAST * value.abs() || !step.is_finite() {
            let by = here.moves(cycle, &slopes, variables)?;
            return Ok(Moving {
                states: here.start.states,
                value,
                by,
                errors: vec![0.0; variables.len()],
                near: None,
            });
        }
        touch = Some(place);
        states = here.start.states;
        value += step.clamp(-0.01 * value.abs(), 0.01 * value.abs());
    }
    Err(SensitivityError::NoTouch)
}

/// An orbit with an extreme of a gap near a level.
struct Here {
    start: Start,
    scan: Scan,
    place: Place,
    /// How far the extreme is above the level.
    distance: f64,
}

impl Here {
    /// How the distance grows with variables, at a fixed value of all others.
    fn grows(
        &self,
        cycle: &mut Cycle,
        slopes: &Slopes,
        variables: &[Variable],
    ) -> Result<Vec<f64>, SensitivityError> {
        let (contact, level, turn) = self.place;
        let arc = &self.scan.arcs[turn.arc];
        let stop = Stop {
            segment: arc.segment,
            phase: turn.phase,
        };
        let order = cycle.order();
        let evaluated = cycle.evaluate(&self.start.states, variables, &[stop])?;
        let lu = evaluated.jacobian.clone().lu();
        let at_stop = &evaluated.stops[0];
        let at = slopes.at(turn.phase, &at_stop.state, &arc.pieces);
        let mut here = vec![0.0; order];
        let grows = variables.iter().enumerate().map(|(index, &variable)| {
            let moved = lu
                .solve(&-&evaluated.by[index])
                .ok_or(SensitivityError::Singular)?;
            let begin = &moved.as_slice()[stop.segment * order..][..order];
            let own = (0..variables.len()).map(|other| f64::from(u8::from(other == index)));
            at_stop.moved(begin, own, &mut here);
            let by = slopes.by(variable);
            let along = Direction {
                state: &here,
                by: Some(&by),
                phase: 0.0,
            };
            Ok(slopes.distance_along(&at, contact, level, along)[0])
        });
        grows.collect()
    }

    /// (1)
    fn moves(
        &self,
        cycle: &mut Cycle,
        slopes: &Slopes,
        variables: &[Variable],
    ) -> Result<Vec<f64>, SensitivityError> {
        let asked: Vec<Variable> = std::iter::once(cycle.varied)
            .chain(variables.iter().copied())
            .collect();
        let grows = self.grows(cycle, slopes, &asked)?;
        Ok(grows[1..].iter().map(|by| -by / grows[0]).collect())
    }
}

/// Orbits that do not reach a level at which the force jumps.
struct OneSided {
    slopes: Slopes,
    /// One, where gaps below the level do not touch it, and minus one.
    side: f64,
    last: Here,
}

impl OneSided {
    /// From an orbit near the touch, on either side of it.
    fn of(cycle: &mut Cycle, slopes: Slopes, near: Here) -> Result<Self, SensitivityError> {
        let (contact, level, turn) = near.place;
        let arc = &near.scan.arcs[turn.arc];
        let mut state = vec![0.0; cycle.order()];
        cycle.trace(&near.start.states, &mut |segment, stretch| {
            let (from, to) = stretch.phases();
            if segment == arc.segment && from <= turn.phase && turn.phase <= to {
                stretch.state(turn.phase, &mut state);
            }
        })?;
        let bend = slopes.bend(&slopes.at(turn.phase, &state, &arc.pieces), contact);
        let side = if bend < 0.0 { 1.0 } else { -1.0 };
        let mut own = Self {
            slopes,
            side,
            last: near,
        };
        if own.short(&own.last) > 0.0 {
            return Ok(own);
        }
        let (start, place) = (own.last.start.clone(), (contact, level, turn));
        for away in AWAY {
            for value in [1.0 - away, 1.0 + away].map(|times| times * start.value) {
                if let Some(found) = own.at(cycle, &start.states, value, place)? {
                    own.last = found;
                    return Ok(own);
                }
            }
        }
        Err(SensitivityError::NoTouch)
    }

    /// How far the extreme of an orbit ends before the level.
    fn short(&self, here: &Here) -> f64 {
        -self.side * here.distance
    }

    /// The orbit at a value, if it does not reach the level.
    fn at(
        &mut self,
        cycle: &mut Cycle,
        states: &[f64],
        value: f64,
        place: Place,
    ) -> Result<Option<Here>, SensitivityError> {
        let mut states = states.to_vec();
        let found = cycle
            .set(cycle.varied, value)
            .map_err(SensitivityError::from)
            .and_then(|()| cycle.solve(&mut states));
        match found {
            Err(error) if error.is_cancelled() => return Err(error),
            Err(_) => return Ok(None),
            Ok(()) => {}
        }
        self.slopes.set(&cycle.values, cycle.omega);
        let scan = Scan::of(cycle, &self.slopes, &states, true)?;
        let near = nearest(&self.slopes, &scan, Some(place));
        let here = near.map(|(place, distance)| Here {
            start: Start { states, value },
            scan,
            place,
            distance,
        });
        Ok(here.filter(|here| self.short(here) > 0.0))
    }

    /// Goes to the orbit that ends so far before the level, but for a part of that.
    fn go(&mut self, cycle: &mut Cycle, before: f64) -> Result<(), SensitivityError> {
        for _ in 0..STEPS {
            let left = before - self.short(&self.last);
            if left.abs() <= ENOUGH * before {
                return Ok(());
            }
            let start = self.last.start.clone();
            let grows = self.last.grows(cycle, &self.slopes, &[cycle.varied])?;
            let most = 0.01 * start.value.abs();
            let mut step = (-self.side * left / grows[0]).clamp(-most, most);
            let mut next = None;
            for _ in 0..HALVINGS {
                let place = self.last.place;
                next = self.at(cycle, &start.states, start.value + step, place)?;
                if next.is_some() {
                    break;
                }
                step *= 0.5;
            }
            self.last = next.ok_or(SensitivityError::NoTouch)?;
        }
        Err(SensitivityError::NoTouch)
    }

    /// (1) at two orbits, continued to the level.
    fn moves(
        mut self,
        cycle: &mut Cycle,
        variables: &[Variable],
    ) -> Result<Moving, SensitivityError> {
        let before = BEFORE * cycle.size(&self.last.start.states);
        self.go(cycle, 2.0 * before)?;
        let far = self.last.moves(cycle, &self.slopes, variables)?;
        let (away, near) = (self.short(&self.last), self.last.start.clone());
        self.go(cycle, before)?;
        let close = self.last.moves(cycle, &self.slopes, variables)?;
        let here = self.short(&self.last);
        let changes = close.iter().zip(&far);
        let changes = changes.map(|(close, far)| (close - far) * here / (away - here));
        let changes: Vec<f64> = changes.collect();
        Ok(Moving {
            by: close
                .iter()
                .zip(&changes)
                .map(|(by, more)| by + more)
                .collect(),
            errors: changes.iter().map(|more| more.abs()).collect(),
            states: self.last.start.states,
            value: self.last.start.value,
            near: Some(near),
        })
    }
}

/// The extreme of a gap that is nearest to a level, and how far it is above it: of the contact, the level and the phase of the last one, if
/// that is known.
fn nearest(
    slopes: &Slopes,
    scan: &Scan,
    last: Option<(usize, usize, Turn)>,
) -> Option<((usize, usize, Turn), f64)> {
    let mut found: Option<((usize, usize, Turn), f64, f64)> = None;
    for turn in &scan.turns {
        for level in 0..slopes.levels(turn.contact) {
            let distance = turn.gap - slopes.level(turn.contact, level);
            let away = match last {
                None => distance.abs(),
                Some((contact, own, before)) if contact == turn.contact && own == level => {
                    (turn.phase - before.phase).abs()
                }
                Some(_) => continue,
            };
            if found.as_ref().is_none_or(|(_, _, least)| away < *least) {
                found = Some(((turn.contact, level, *turn), distance, away));
            }
        }
    }
    found.map(|(place, distance, _)| (place, distance))
}
