//! How far a gap is from touching a level, as a function of an orbit.
//!
//! Along the orbit the gap has extremes, where its rate vanishes. Grazing is an extreme on a level,
//!
//! ```text
//! g(s, lambda, mu) = gap(tau*) - level = 0,    gap'(tau*) = 0                                                 (1)
//! ```
//!
//! of the extreme that is nearest to where the last one was. Since the rate vanishes there, an error of `tau*` counts by its
//! square only.
//!
//! Source: di Bernardo, Budd, Champneys and Kowalczyk (2008), Piecewise-smooth Dynamical Systems, section 6.2 (grazing).

use crate::model::layout::Layout;
use crate::shooting::equations::Equations;
use crate::shooting::gap_scan::{self, Extreme, Room};
use crate::shooting::problem::ShootingProblem;
use crate::system::{System, Variable};
use crate::time::gap::Gap;

/// One gap and one of its levels.
#[derive(Clone)]
pub(super) struct GrazingCondition<'a> {
    system: &'a dyn System,
    layout: Layout,
    contact: usize,
    level: usize,
    /// The last extreme.
    near: Extreme,
    gap: Gap,
    base: f64,
    parameters: Vec<f64>,
    coefficients: Vec<f64>,
    arguments: Vec<f64>,
    levels: Vec<f64>,
    state: Vec<f64>,
    ends: [Vec<f64>; 2],
}

impl<'a> GrazingCondition<'a> {
    /// The gap and the level that an orbit comes nearest to touching; `None` if it touches none.
    pub(super) fn of(
        system: &'a dyn System,
        problem: &ShootingProblem,
        equations: &mut Equations,
        u: &[f64],
    ) -> Option<Self> {
        let layout = Layout::of(system);
        let mut nearest: Option<(f64, Self)> = None;
        for contact in 0..layout.contacts.len() {
            let law = system.law(layout.contacts[contact].law);
            for level in 0..law.facts().levels.len() {
                let mut grazing = Self {
                    system,
                    contact,
                    level,
                    near: Extreme {
                        passed: 0.0,
                        gap: 0.0,
                        largest: false,
                    },
                    gap: Gap::default(),
                    base: 0.0,
                    parameters: problem.parameters.clone(),
                    coefficients: vec![0.0; layout.coefficients],
                    arguments: vec![0.0; layout.contacts[contact].argument_count],
                    levels: vec![0.0; law.facts().levels.len()],
                    state: vec![0.0; equations.order()],
                    ends: [vec![0.0; equations.order()], vec![0.0; equations.order()]],
                    layout: layout.clone(),
                };
                let value = u[u.len() - 1];
                grazing.set(problem.omega_at(value), &[(problem.variable, value)]);
                let at = grazing.levels[level];
                let mut extremes = Vec::new();
                grazing.extremes(equations, u, &mut |extreme| extremes.push(extreme))?;
                for extreme in extremes {
                    let apart = (extreme.gap - at).abs();
                    if nearest.as_ref().is_none_or(|(least, _)| apart < *least) {
                        grazing.near = extreme;
                        nearest = Some((apart, grazing.clone()));
                    }
                }
            }
        }
        nearest.map(|(_, grazing)| grazing)
    }

    /// Puts the gap and its levels where parameters have values.
    fn set(&mut self, mut omega: f64, values: &[(Variable, f64)]) {
        for &(variable, value) in values {
            match variable {
                Variable::Omega => omega = value,
                Variable::Parameter(index) => self.parameters[index] = value,
            }
        }
        let system = self.system;
        system.coefficients(&self.parameters, omega, &mut self.coefficients);
        let contact = &self.layout.contacts[self.contact];
        self.base = omega / f64::from(system.facts().divisor);
        self.gap.set(contact, &self.coefficients, self.base);
        contact.arguments(&self.coefficients, &mut self.arguments);
        let law = system.law(contact.law);
        law.levels(&self.arguments, &mut self.levels);
    }

    /// `g` of (1); not a number if the extreme is not there any more. The last of the unknowns is a value of `second`.
    pub(super) fn distance(
        &mut self,
        equations: &mut Equations,
        u: &[f64],
        omega: f64,
        second: Variable,
    ) -> f64 {
        let near = self.nearest(equations, u, omega, second);
        near.map_or(f64::NAN, |extreme| extreme.gap - self.levels[self.level])
    }

    /// Remembers where the extreme is at these unknowns.
    pub(super) fn follow(
        &mut self,
        equations: &mut Equations,
        u: &[f64],
        omega: f64,
        second: Variable,
    ) {
        if let Some(extreme) = self.nearest(equations, u, omega, second) {
            self.near = extreme;
        }
    }

    fn nearest(
        &mut self,
        equations: &mut Equations,
        u: &[f64],
        omega: f64,
        second: Variable,
    ) -> Option<Extreme> {
        let last = u.len() - 1;
        let first = equations.frame.variable;
        self.set(omega, &[(first, u[last - 1]), (second, u[last])]);
        equations.flow.set(second, u[last]).ok()?;
        let near = self.near;
        let (from, to) = equations.span.phases(0);
        let whole = (to - from) * equations.span.segments as f64;
        let away = |extreme: &Extreme| {
            let apart = (extreme.passed - near.passed).rem_euclid(whole);
            apart.min(whole - apart)
        };
        let mut found: Option<Extreme> = None;
        self.extremes(equations, &u[..last], &mut |extreme| {
            let nearer = found.is_none_or(|found| away(&extreme) < away(&found));
            if extreme.largest == near.largest && nearer {
                found = Some(extreme);
            }
        })?;
        found
    }

    /// Shows all extremes of the gap along an orbit.
    fn extremes(
        &mut self,
        equations: &mut Equations,
        u: &[f64],
        see: &mut dyn FnMut(Extreme),
    ) -> Option<()> {
        let [first, end] = &mut self.ends;
        let room = Room {
            state: &mut self.state,
            first,
            end,
        };
        gap_scan::extremes(&self.gap, equations, u, room, see)
    }
}
