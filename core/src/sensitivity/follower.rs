//! Orbits that are found again after parameters have changed: the one of a branch that is nearest to a measured place, and folds.
//!
//! With the extended unknowns `u = (s, lambda)`, what is read off `y(u; p)`, and the tangent `t` of the branch, the orbit nearest to a target
//! `(lambda*, y*)`, in units `e` of both, has
//!
//! ```text
//! F(u; p) = 0,     (lambda* - lambda) t_lambda / e_0^2 + sum_j (y*_j - y_j) y_j' / e_j^2 = 0,                 (1)
//! y_j' = y_s t_s + y_lambda t_lambda.
//! ```
//!
//! Newton's method corrects `F` across the tangent, and goes along it by what the second equation says where the branch is straight. This
//! is regular at folds. Across the tangent the orbit moves with a parameter by
//!
//! ```text
//! [ F_s  F_lambda ] [ u_p ]   [ -F_p ]
//! [      t        ] [     ] = [   0  ],        dy/dp = y_u u_p + y_p.                                         (2)
//! ```
//!
//! Source: Boggs, Byrd and Schnabel (1987), SIAM Journal on Scientific and Statistical Computing 8, 1052 (orthogonal distance); Govaerts
//! (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapter 3.

use std::sync::Arc;

use nalgebra::DVector;

use super::cycle::{Cycle, Evaluated};
use super::error::SensitivityError;
use super::moments::{Along, Places, Reader};
use super::place;
use super::slopes::{Asked, Slopes};
use super::{Row, needs, row};
use crate::branches::branch::Model;
use crate::branches::point::Point;
use crate::cancel::Cancel;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::orbit::observe::{Measure, Wanted};
use crate::system::{System, Variable};

/// Corrections, at most.
const ITERATIONS: usize = 40;
/// Both corrections are below this part of the orbit at the end: what is left is their square.
const CLOSE: f64 = 1e-7;
/// The longest step along the branch, as a part of the units of the target.
const STEP: f64 = 0.2;
/// Nodes of a rule, where integrals are read.
const NODES: usize = 16;

/// A measured place on a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Frequency.
    pub omega: f64,
    /// What was measured, in the order in which the follower reads.
    pub values: Vec<f64>,
    /// The units in which distances count: of the frequency, then of each value. They are positive.
    pub units: Vec<f64>,
}

/// An orbit that is followed.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Followed {
    /// Frequency.
    pub omega: f64,
    /// What is read off.
    pub measured: Vec<f64>,
    /// Derivatives along the branch, of the frequency and of what is read off; the length along the branch has any unit.
    pub along: Vec<f64>,
    /// Derivatives across the tangent by every free parameter: of the frequency, then of what is read off. Of a fold only the first. Empty until
    /// [`Follower::differentiate`].
    pub by: Vec<Vec<f64>>,
    states: Vec<f64>,
    tangent: DVector<f64>,
    /// How the extended unknowns move with every free parameter.
    moves: Vec<DVector<f64>>,
    /// The parameters that it was found at.
    values: Vec<f64>,
}

impl Followed {
    /// The state `(q, dq/dt)` at phase zero.
    pub fn state(&self, coordinates: usize) -> &[f64] {
        &self.states[..2 * coordinates]
    }
}

/// Finds orbits of one system again, over the frequency, as its parameters change.
///
/// ```
/// use hertzian::sensitivity::{Follower, Target};
/// use hertzian::{Cancel, FrequencyResponse};
///
/// hertzian::oscillator! {
///     Linear(x) {
///         param zeta in 0.0..;
///         ddot(x) + 2*zeta*dot(x) + x = cos(omega*t);
///     }
/// }
///
/// let model = Linear { zeta: 0.1 };
/// let point = FrequencyResponse::of(&model).orbit(0.9)?;
/// let wanted = ["x:p2p".parse()?];
/// let mut follower = Follower::new(&model, &point, &wanted, &["zeta"], 1e-10, &Cancel::new())?;
/// let mut orbit = follower.start(&point)?;
/// follower.set(&[0.2])?;
/// let target = Target { omega: 1.0, values: vec![5.0], units: vec![1.0, 10.0] };
/// follower.nearest(&mut orbit, &target)?;
/// follower.differentiate(&mut orbit)?;
/// let response = 2.0 / ((1.0 - orbit.omega.powi(2)).powi(2) + (0.4 * orbit.omega).powi(2)).sqrt();
/// assert!((orbit.measured[0] - response).abs() < 1e-8);
/// # Ok::<(), hertzian::Error>(())
/// ```
pub struct Follower {
    system: Arc<dyn System>,
    cycle: Cycle,
    slopes: Slopes,
    rows: Vec<Row>,
    asked: Vec<Asked>,
    pieces: Vec<usize>,
    free: Vec<Variable>,
}

impl std::fmt::Debug for Follower {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Follower")
            .field("system", &self.system)
            .field("free", &self.free)
            .finish_non_exhaustive()
    }
}

/// The orbit at the present unknowns.
struct Here {
    places: Places,
    evaluated: Evaluated,
}

impl Follower {
    /// Of orbits of the period of this one. What is free is named, and so is what is read off. The tolerance is that of the flow.
    ///
    /// # Errors
    /// If there is no such name, or no flow with that tolerance.
    pub fn new(
        system: &dyn System,
        like: &Point,
        wanted: &[Wanted],
        free: &[&str],
        tolerance: f64,
        cancel: &Cancel,
    ) -> Result<Self, Error> {
        let system = system.shared();
        let model = Model::of(system.as_ref());
        let free = free.iter().map(|&name| {
            let index = model.parameters.iter().position(|own| own.name == name);
            let known = || {
                model
                    .parameters
                    .iter()
                    .map(|own| own.name.clone())
                    .collect()
            };
            let unknown = || RequestError::UnknownParameter {
                name: name.to_owned(),
                known: known(),
            };
            index.map(Variable::Parameter).ok_or_else(unknown)
        });
        let free = free.collect::<Result<Vec<Variable>, RequestError>>()?;
        let rows = wanted.iter().map(|wanted| row(&model, wanted));
        let rows = rows.collect::<Result<Vec<Row>, Error>>()?;
        let mut asked: Vec<Asked> = Vec::new();
        for row in &rows {
            if !asked.contains(&row.asked) {
                asked.push(row.asked);
            }
        }
        let (values, orbit) = (&like.parameters, &like.orbit);
        let cycle = Cycle::new(&system, values, orbit, Variable::Omega, tolerance, cancel)?;
        Ok(Self {
            slopes: Slopes::new(&system, &asked),
            pieces: model.pieces,
            system,
            cycle,
            rows,
            asked,
            free,
        })
    }

    /// Goes over to other values of all parameters.
    ///
    /// # Errors
    /// If the system cannot have them.
    pub fn set(&mut self, values: &[f64]) -> Result<(), Error> {
        let expected = self.cycle.values.len();
        if values.len() != expected {
            let values = values.len();
            return Err(RequestError::Values { values, expected }.into());
        }
        self.cycle.set_all(values)?;
        Ok(())
    }

    /// Takes up an orbit of the period that the follower is for, at its own parameters.
    ///
    /// # Errors
    /// If its motion cannot be continued, or it is not found again.
    pub fn start(&mut self, point: &Point) -> Result<Followed, Error> {
        self.set(&point.parameters)?;
        self.set_omega(point.orbit.omega)?;
        let mut states = self.cycle.states(&point.orbit)?;
        // Beside a fold there may be none at this very frequency: the first step corrects it across the branch.
        let mut solved = states.clone();
        if self.cycle.solve(&mut solved).is_ok() && self.is_near(&solved, &states) {
            states = solved;
        }
        let evaluated = self.cycle.evaluate(&states, &[Variable::Omega], &[])?;
        let tangent = self.cycle.tangent(&evaluated, None)?;
        Ok(Followed {
            omega: point.orbit.omega,
            measured: Vec::new(),
            along: Vec::new(),
            by: Vec::new(),
            states,
            tangent,
            moves: Vec::new(),
            values: self.cycle.values.clone(),
        })
    }

    fn is_near(&self, a: &[f64], b: &[f64]) -> bool {
        let apart: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
        self.cycle.size(&apart) <= 1e-2 * self.cycle.size(b)
    }

    fn set_omega(&mut self, omega: f64) -> Result<(), SensitivityError> {
        Ok(self.cycle.set(Variable::Omega, omega)?)
    }

    /// Moves an orbit to where it should be at the present parameters, to first order.
    fn predict(&self, orbit: &mut Followed) {
        let n = orbit.states.len();
        for (variable, moves) in self.free.iter().zip(&orbit.moves) {
            let Variable::Parameter(index) = *variable else {
                continue;
            };
            let step = self.cycle.values[index] - orbit.values[index];
            for (x, d) in orbit.states.iter_mut().zip(moves.iter()) {
                *x += step * d;
            }
            orbit.omega += step * moves[n];
        }
        orbit.moves.clear();
        orbit.by.clear();
    }

    fn here(&mut self, orbit: &Followed, variables: &[Variable]) -> Result<Here, SensitivityError> {
        self.set_omega(orbit.omega)?;
        self.slopes.set(&self.cycle.values, self.cycle.omega);
        let needs = needs(self.rows.iter().map(|row| row.measure), NODES);
        let places = Places::of(&mut self.cycle, &self.slopes, &orbit.states, needs)?;
        let evaluated = self
            .cycle
            .evaluate(&orbit.states, variables, &places.stops)?;
        Ok(Here { places, evaluated })
    }

    /// What is read off, with its derivatives along directions.
    fn read(
        &self,
        here: &Here,
        variables: &[Variable],
        directions: &[Along],
    ) -> Vec<(f64, Vec<f64>)> {
        let Here { places, evaluated } = here;
        let cycle = &self.cycle;
        let reader = Reader::new(
            places,
            &self.slopes,
            evaluated,
            variables,
            directions,
            cycle,
        );
        let moments = reader.moments();
        let read = self.rows.iter().map(|row| {
            if let (Measure::OnPiece(piece), Asked::Contact(contact)) = (row.measure, row.asked) {
                let on = reader.on_pieces(contact, self.pieces[contact]);
                return (on[piece - 1].value, on[piece - 1].by.clone());
            }
            let signal = self.asked.iter().position(|asked| *asked == row.asked);
            let slope = signal.and_then(|signal| moments[signal].measure(row.measure));
            slope.map_or_else(
                || (0.0, vec![0.0; directions.len()]),
                |slope| (slope.value, slope.by),
            )
        });
        read.collect()
    }

    /// Moves an orbit along its branch to where it is nearest to a target, at the present parameters.
    ///
    /// # Errors
    /// If its motion cannot be continued, or the iteration does not converge. The orbit is then as before.
    pub fn nearest(&mut self, orbit: &mut Followed, target: &Target) -> Result<(), Error> {
        let mut next = orbit.clone();
        self.predict(&mut next);
        self.approach(&mut next, target)?;
        next.values.clone_from(&self.cycle.values);
        *orbit = next;
        Ok(())
    }

    fn approach(&mut self, orbit: &mut Followed, target: &Target) -> Result<(), SensitivityError> {
        let n = orbit.states.len();
        let variables = [Variable::Omega];
        let mut left = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let here = self.here(orbit, &variables)?;
            let evaluated = &here.evaluated;
            let tangent = self.cycle.tangent(evaluated, Some(&orbit.tangent))?;
            let mut right = DVector::zeros(n + 1);
            right.rows_mut(0, n).copy_from(&-&evaluated.residual);
            let across = self.cycle.bordered(evaluated, &tangent, &right)?;
            let directions = [&across, &tangent].map(|u| Along {
                states: u.rows(0, n).into_owned(),
                weights: vec![u[n]],
            });
            let read = self.read(&here, &variables, &directions);
            let [mut pull, mut length] = [0.0; 2];
            let mut count = |distance: f64, slope: f64, unit: f64| {
                pull += distance * slope / (unit * unit);
                length += slope * slope / (unit * unit);
            };
            let distance = target.omega - orbit.omega - across[n];
            count(distance, tangent[n], target.units[0]);
            let values = target.values.iter().zip(&target.units[1..]);
            for ((value, by), (aim, &unit)) in read.iter().zip(values) {
                count(aim - value - by[0], by[1], unit);
            }
            let reach = STEP / length.sqrt();
            let step = (pull / length).clamp(-reach, reach);
            let size = self.cycle.size(&orbit.states).max(f64::MIN_POSITIVE);
            let moved = self.cycle.size(&across.as_slice()[..n]) / size;
            left = moved.max((across[n] / orbit.omega).abs());
            let along = step.abs() * length.sqrt();
            if !left.is_finite() || !along.is_finite() || left > 1.0 {
                break;
            }
            let shift = &across + &tangent * step;
            let states = orbit.states.iter_mut().zip(shift.iter());
            states.for_each(|(x, d)| *x += d);
            orbit.omega += shift[n];
            orbit.measured = read
                .iter()
                .map(|(y, by)| y + by[0] + step * by[1])
                .collect();
            orbit.along = std::iter::once(tangent[n])
                .chain(read.iter().map(|(_, by)| by[1]))
                .collect();
            orbit.tangent = tangent;
            if left <= CLOSE && along <= CLOSE {
                return Ok(());
            }
        }
        Err(SensitivityError::Diverged { left })
    }

    /// Computes the derivatives of an orbit by all free parameters, where it is.
    ///
    /// # Errors
    /// If its motion cannot be continued.
    pub fn differentiate(&mut self, orbit: &mut Followed) -> Result<(), Error> {
        let n = orbit.states.len();
        let mut variables = vec![Variable::Omega];
        variables.extend(&self.free);
        let here = self.here(orbit, &variables)?;
        let mut directions = Vec::with_capacity(self.free.len());
        let mut moves = Vec::with_capacity(self.free.len());
        for index in 1..variables.len() {
            let mut right = DVector::zeros(n + 1);
            right.rows_mut(0, n).copy_from(&-&here.evaluated.by[index]);
            let moved = self
                .cycle
                .bordered(&here.evaluated, &orbit.tangent, &right)?;
            let mut weights = vec![0.0; variables.len()];
            (weights[0], weights[index]) = (moved[n], 1.0);
            let states = moved.rows(0, n).into_owned();
            directions.push(Along { states, weights });
            moves.push(moved);
        }
        let read = self.read(&here, &variables, &directions);
        orbit.by = moves
            .iter()
            .enumerate()
            .map(|(index, moved)| {
                let of_read = read.iter().map(|(_, by)| by[index]);
                std::iter::once(moved[n]).chain(of_read).collect()
            })
            .collect();
        orbit.moves = moves;
        orbit.values.clone_from(&self.cycle.values);
        Ok(())
    }

    /// Moves an orbit to the fold nearby, with the derivative of its frequency by all free parameters.
    ///
    /// # Errors
    /// If there is none, or its motion cannot be continued. The orbit is then as before.
    pub fn fold(&mut self, orbit: &mut Followed) -> Result<(), Error> {
        let (states, omega) = (orbit.states.clone(), orbit.omega);
        let found = place::fold(&mut self.cycle, &states, omega, &self.free)?;
        orbit.states = found.states;
        orbit.omega = found.value;
        orbit.by = found.by.into_iter().map(|by| vec![by]).collect();
        orbit.moves.clear();
        orbit.values.clone_from(&self.cycle.values);
        Ok(())
    }
}
