//! The system at present values: its terms, its levels, and the combinations of pieces that motions have met.

use std::collections::HashMap;
use std::sync::Arc;

use nalgebra::DMatrix;

use super::equations::Assembly;
use super::exponential::Workspace;
use super::ladder::{self, Ladder};
use super::table::{ExitLevel, Table};
use super::terms::{Basis, Line, Terms};
use crate::error::Error;
use crate::model::error::ModelError;
use crate::model::layout::Layout;
use crate::model::validate;
use crate::model::validate::in_order;
use crate::system::{Place, System, Variable, Wave};
use crate::time::FlowError;
use crate::time::error::check_value;

/// Cells in a period at most. Beyond, the fastest rate of the system is so high that the phase hardly resolves it.
const FINEST: f64 = 1e8;

/// Every contact on one of its pieces.
#[derive(Debug)]
pub(super) struct Combination {
    pub(super) pieces: Vec<usize>,
    pub(super) table: Table,
    ladder: Option<Ladder>,
    /// The table belongs to the present values.
    filled: bool,
    /// Its derivatives do too, by the variable of the model.
    differentiated: bool,
}

/// What a contact is now.
#[derive(Debug, Clone)]
pub(super) struct Contact {
    pub(super) levels: Vec<f64>,
    /// Their derivatives by the variable, and room for those by an argument.
    pub(super) levels_by: Vec<f64>,
    by_argument: Vec<f64>,
    /// `M^-1 e`
    pub(super) push: Vec<f64>,
    /// All pieces of its law, and their derivatives by the variable.
    lines: Vec<Line>,
    lines_by: Vec<Line>,
}

/// The system at present values of its parameters and of `omega`.
pub(super) struct Model {
    system: Arc<dyn System>,
    layout: Layout,
    pub(super) basis: Basis,
    pub(super) parameters: Vec<f64>,
    pub(super) omega: f64,
    /// The motion is `q(-t)`.
    backwards: bool,
    coefficients: Vec<f64>,
    pub(super) terms: Terms,
    /// Derivatives by the variable.
    pub(super) terms_by: Terms,
    variable: Option<Variable>,
    pub(super) contacts: Vec<Contact>,
    /// An offset depends on the phase.
    pub(super) moving: bool,
    /// Nothing belongs to the present values yet.
    stale: bool,
    combinations: Vec<Combination>,
    known: HashMap<Vec<usize>, usize>,
    lines: Vec<Line>,
    lines_by: Vec<Line>,
    assembly: Assembly,
    workspace: Workspace,
}

impl Combination {
    /// Its table, and the steps over many ranges of it, if they are worth it.
    pub(super) fn tabulated(&self) -> (&Table, Option<&Ladder>) {
        (&self.table, self.ladder.as_ref())
    }
}

impl Model {
    /// # Errors
    /// Unless every piece is affine, and stiffness and directions are constant; if values are not usable.
    pub(super) fn new(system: &dyn System, parameters: &[f64], omega: f64) -> Result<Self, Error> {
        if system.facts().coordinates.is_empty() {
            return Err(ModelError::NoCoordinates.into());
        }
        if !is_covered(system) {
            return Err(ModelError::NotAffine.into());
        }
        validate::values(system, parameters, omega)?;
        Ok(Self::of(system, parameters, omega, false))
    }

    /// The same system at the same values, of which nothing is tabulated yet.
    pub(super) fn again(&self) -> Self {
        Self::of(&self.system, &self.parameters, self.omega, self.backwards)
    }

    /// The same system at the same values, with time reversed.
    pub(super) fn reversed(&self) -> Self {
        Self::of(&self.system, &self.parameters, self.omega, !self.backwards)
    }

    fn of(system: &dyn System, parameters: &[f64], omega: f64, backwards: bool) -> Self {
        let layout = Layout::of(system);
        let basis = Basis::of(&layout);
        let moves = |contact: &crate::model::layout::ContactLayout| contact.offset_harmonic() > 0;
        let moving = layout.contacts.iter().any(moves);
        let contacts = layout.contacts.iter().map(|contact| {
            let pieces = system.law(contact.law).facts().pieces.len();
            Contact {
                levels: vec![0.0; pieces - 1],
                levels_by: vec![0.0; pieces - 1],
                by_argument: vec![0.0; pieces - 1],
                push: vec![0.0; layout.coordinates],
                lines: vec![Line::default(); pieces],
                lines_by: vec![Line::default(); pieces],
            }
        });
        Self {
            system: system.shared(),
            parameters: parameters.to_vec(),
            omega,
            backwards,
            coefficients: vec![0.0; layout.coefficients],
            terms: Terms::new(&layout, &basis),
            terms_by: Terms::new(&layout, &basis),
            variable: None,
            contacts: contacts.collect(),
            moving,
            stale: true,
            combinations: Vec::new(),
            known: HashMap::new(),
            lines: vec![Line::default(); layout.contacts.len()],
            lines_by: vec![Line::default(); layout.contacts.len()],
            assembly: Assembly::new(&basis),
            workspace: Workspace::new(&basis, rows(&basis, moving)),
            basis,
            layout,
        }
    }

    pub(super) fn system(&self) -> &dyn System {
        self.system.as_ref()
    }

    /// Changes the frequency or a parameter; not if the equations could not be evaluated then.
    pub(super) fn set(&mut self, variable: Variable, value: f64) -> Result<(), FlowError> {
        check_value(self.system.as_ref(), variable, value)?;
        let present = match variable {
            Variable::Omega => &mut self.omega,
            Variable::Parameter(index) => &mut self.parameters[index],
        };
        let before = std::mem::replace(present, value);
        self.stale = true;
        let refreshed = self.refresh(None, 0.0);
        if refreshed.is_err() {
            match variable {
                Variable::Omega => self.omega = before,
                Variable::Parameter(index) => self.parameters[index] = before,
            }
            self.stale = true;
        }
        refreshed
    }

    /// Makes everything belong to the present values, and the derivatives to a variable.
    pub(super) fn refresh(&mut self, by: Option<Variable>, phase: f64) -> Result<(), FlowError> {
        if self.stale {
            self.refresh_values(phase)?;
            self.stale = false;
            self.variable = None;
        }
        if by.is_some() && by != self.variable {
            self.refresh_derivatives(by);
            self.variable = by;
        }
        Ok(())
    }

    fn refresh_values(&mut self, phase: f64) -> Result<(), FlowError> {
        let (system, layout, basis) = (self.system.as_ref(), &self.layout, &self.basis);
        system.coefficients(&self.parameters, self.omega, &mut self.coefficients);
        if self.coefficients.iter().any(|x| !x.is_finite()) {
            return Err(FlowError::NotFinite { phase });
        }
        self.terms.fill(layout, basis, &self.coefficients);
        if self.backwards {
            self.terms.reverse(basis);
        }
        self.terms.base = self.omega / f64::from(system.facts().divisor);
        if self.assembly.set_mass(basis, &self.terms).is_err() {
            let n = basis.coordinates;
            let determinant = DMatrix::from_row_slice(n, n, &self.terms.mass).determinant();
            return Err(FlowError::SingularMass { determinant });
        }
        for (index, contact) in self.contacts.iter_mut().enumerate() {
            let law = system.law(layout.contacts[index].law);
            let terms = &self.terms.contacts[index];
            law.levels(&terms.arguments, &mut contact.levels);
            if !in_order(&contact.levels) {
                return Err(FlowError::Levels { contact: index });
            }
            contact.push.copy_from_slice(&terms.force);
            self.assembly.solve(&mut contact.push);
            for (piece, line) in contact.lines.iter_mut().enumerate() {
                *line = Line::of(law, &terms.arguments, &contact.levels, piece);
                if self.backwards {
                    line.by_rate = -line.by_rate;
                }
            }
        }
        for combination in &mut self.combinations {
            combination.filled = false;
            combination.differentiated = false;
        }
        Ok(())
    }

    fn refresh_derivatives(&mut self, by: Option<Variable>) {
        let Some(variable) = by else {
            return;
        };
        let (system, layout, basis) = (self.system.as_ref(), &self.layout, &self.basis);
        let derivatives = &mut self.coefficients;
        system.coefficients_by(variable, &self.parameters, self.omega, derivatives);
        self.terms_by.fill(layout, basis, derivatives);
        if self.backwards {
            self.terms_by.reverse(basis);
        }
        self.terms_by.base = match variable {
            Variable::Omega => 1.0 / f64::from(system.facts().divisor),
            Variable::Parameter(_) => 0.0,
        };
        for (index, contact) in self.contacts.iter_mut().enumerate() {
            let law = system.law(layout.contacts[index].law);
            let arguments = &self.terms.contacts[index].arguments;
            contact.levels_by.fill(0.0);
            contact.lines_by.fill(Line::default());
            let factors = self.terms_by.contacts[index].arguments.iter().enumerate();
            for (argument, &factor) in factors.filter(|&(_, &factor)| factor != 0.0) {
                law.levels_by(arguments, argument, &mut contact.by_argument);
                for (sum, by) in contact.levels_by.iter_mut().zip(&contact.by_argument) {
                    *sum += factor * by;
                }
                for (piece, line) in contact.lines_by.iter_mut().enumerate() {
                    let levels = &contact.levels;
                    line.add_derivative(law, arguments, levels, piece, argument, factor);
                }
            }
            if self.backwards {
                for line in &mut contact.lines_by {
                    line.by_rate = -line.by_rate;
                }
            }
        }
        for combination in &mut self.combinations {
            combination.differentiated = false;
        }
    }

    /// The combination of given pieces, ready for use.
    pub(super) fn combination(
        &mut self,
        pieces: &[usize],
        phase: f64,
        derivatives: bool,
    ) -> Result<usize, FlowError> {
        let index = if let Some(&index) = self.known.get(pieces) {
            index
        } else {
            self.add(pieces)
        };
        let combination = &self.combinations[index];
        if !combination.filled || (derivatives && !combination.differentiated) {
            self.fill(index, phase, derivatives)?;
        }
        Ok(index)
    }

    pub(super) fn at(&self, index: usize) -> &Combination {
        &self.combinations[index]
    }

    /// The table of a combination, and the steps over many of its ranges, if they are worth it.
    pub(super) fn ladder(&mut self, index: usize) -> Option<(&Table, &mut Ladder)> {
        let Combination { table, ladder, .. } = &mut self.combinations[index];
        ladder.as_mut().map(|ladder| (&*table, ladder))
    }

    fn add(&mut self, pieces: &[usize]) -> usize {
        let mut exits = Vec::new();
        for (contact, &piece) in pieces.iter().enumerate() {
            let exit = |level, upper| ExitLevel {
                contact,
                level,
                upper,
                row: vec![0.0; self.basis.order()],
                ends: Vec::new(),
                series: Vec::new(),
                bound: Vec::new(),
            };
            if piece > 0 {
                exits.push(exit(piece - 1, false));
            }
            if piece < self.contacts[contact].levels.len() {
                exits.push(exit(piece, true));
            }
        }
        let index = self.combinations.len();
        self.combinations.push(Combination {
            pieces: pieces.to_vec(),
            table: Table::new(&self.basis, rows(&self.basis, self.moving), exits),
            ladder: None,
            filled: false,
            differentiated: false,
        });
        self.known.insert(pieces.to_vec(), index);
        index
    }

    fn fill(&mut self, index: usize, phase: f64, derivatives: bool) -> Result<(), FlowError> {
        let (basis, terms) = (&self.basis, &self.terms);
        let combination = &mut self.combinations[index];
        for (contact, &piece) in combination.pieces.iter().enumerate() {
            self.lines[contact] = self.contacts[contact].lines[piece];
            self.lines_by[contact] = self.contacts[contact].lines_by[piece];
        }
        self.assembly.assemble(basis, terms, &self.lines);
        let time = Table::time_for(self.assembly.rate(basis, terms));
        let cell = time * terms.base;
        let resolved = cell * FINEST > std::f64::consts::TAU;
        if !resolved {
            return Err(FlowError::StepTooShort { phase, step: cell });
        }
        if derivatives {
            self.assembly
                .differentiate(basis, terms, &self.lines, &self.terms_by, &self.lines_by);
        }
        for exit in &mut combination.table.exits {
            let contact = &terms.contacts[exit.contact];
            let level = self.contacts[exit.contact].levels[exit.level];
            exit.set_row(&contact.gap, &contact.offset, level);
        }
        let matrix = &self.assembly.matrix;
        let by = derivatives.then_some(&self.assembly.derivative[..]);
        combination
            .table
            .fill(matrix, by, [time, cell], &mut self.workspace);
        let table = &combination.table;
        if ladder::is_needed(table) {
            let units = self.assembly.units(basis, terms);
            let ladder = combination.ladder.get_or_insert_default();
            ladder.fill(table, matrix, &units, &self.workspace, derivatives);
        } else {
            combination.ladder = None;
        }
        combination.filled = true;
        combination.differentiated = derivatives;
        Ok(())
    }

    /// The gap direction and the constant offset of a contact, of one coordinate.
    pub(super) fn position(&self, contact: usize) -> (f64, f64) {
        let contact = &self.terms.contacts[contact];
        (contact.gap[0], contact.offset[0])
    }

    /// A gap and its rate.
    pub(super) fn gap(&self, contact: usize, z: &[f64]) -> (f64, f64) {
        let n = self.basis.coordinates;
        let contact = &self.terms.contacts[contact];
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let gap = dot(&contact.gap, z) - dot(&contact.offset, &z[2 * n..]);
        let mut rate = dot(&contact.gap, &z[n..]);
        let waves = z[2 * n + 1..].chunks_exact(2);
        let offsets = contact.offset[1..].chunks_exact(2);
        for ((wave, offset), &harmonic) in waves.zip(offsets).zip(&self.basis.harmonics) {
            let by_phase = offset[1] * wave[0] - offset[0] * wave[1];
            rate -= self.terms.base * f64::from(harmonic) * by_phase;
        }
        (gap, rate)
    }

    /// The derivative of a gap by the variable, at a fixed state.
    pub(super) fn gap_by(&self, contact: usize, z: &[f64]) -> f64 {
        let n = self.basis.coordinates;
        let contact = &self.terms_by.contacts[contact];
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        dot(&contact.gap, z) - dot(&contact.offset, &z[2 * n..])
    }

    /// How the force of a contact changes from below a level to above it: by a constant, and by a multiple of the rate.
    pub(super) fn jump(&self, contact: usize, level: usize) -> (f64, f64) {
        let facts = self.system.law(self.layout.contacts[contact].law).facts();
        let contact = &self.contacts[contact];
        let (below, above) = (contact.lines[level], contact.lines[level + 1]);
        let force = |line: Line| line.force + line.by_gap * (contact.levels[level] - line.at);
        let facts = &facts.levels[level];
        let of_force = if facts.force_jumps {
            force(above) - force(below)
        } else {
            0.0
        };
        let of_rate = if facts.by_rate_jumps {
            above.by_rate - below.by_rate
        } else {
            0.0
        };
        (of_force, of_rate)
    }
}

/// Rows of a table: the coordinates, and the waves if an offset moves.
fn rows(basis: &Basis, moving: bool) -> usize {
    let waves = if moving { basis.waves() - 1 } else { 0 };
    basis.coordinates + waves
}

/// Every piece is affine, and stiffness and directions are constant.
fn is_covered(system: &dyn System) -> bool {
    let facts = system.facts();
    let affine = |law| {
        let facts = system.law(law).facts();
        facts.pieces.iter().all(|piece| piece.affine)
    };
    let constant = |place: &Place| match place {
        Place::Stiffness { wave, .. }
        | Place::ForceDirection { wave, .. }
        | Place::GapDirection { wave, .. } => *wave == Wave::CONSTANT,
        _ => true,
    };
    (0..facts.laws).all(affine) && facts.places.iter().all(constant)
}
