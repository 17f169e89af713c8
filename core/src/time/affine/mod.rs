//! The flow of systems whose forces are piecewise affine: closed forms from switch to switch.
//!
//! While no gap leaves its piece, the motion is that of a linear system with constant coefficients, and is tabulated as series
//! that end below rounding (`table`); where a period has many of them, it is passed in longer steps (`ladder`, `modes`, `leap`). The first
//! meeting of a gap with an end of its piece is proven to be the first (`search`, `crossing`). There the state is continuous, and
//! perturbations jump (`tangent`). One coordinate under one harmonic has the same in arrays of fixed size (`scalar`, `interval`).
//!
//! A motion that touches an end without crossing it stays on its piece; perturbations do not jump there.

mod backwards;
mod crossing;
mod equations;
mod exponential;
mod interval;
mod ladder;
mod leap;
mod model;
mod modes;
mod scalar;
mod search;
mod table;
mod tangent;
mod terms;
#[cfg(test)]
mod tests;
mod variables;

use std::f64::consts::TAU;

use self::model::Model;
use self::scalar::{Scalar, Span};
use self::table::{COEFFICIENTS, ExitLevel, Polynomial, Table};
use crate::cancel::Cancel;
use crate::error::Error;
use crate::system::{System, Variable};
use crate::time::error::{admits, check_entries};
use crate::time::{Flow, FlowError, See, Show, Stretch, Tangent, Work};

/// Switches in one period beyond which the motion is taken for chatter.
const MOST_SWITCHES: usize = 10_000;

/// The flow of a system of which every piece of every law is affine, and stiffness and directions are constant in time.
pub struct Affine {
    model: Model,
    /// The same for one coordinate under at most one harmonic.
    scalar: Option<Scalar>,
    /// It belongs to the present values.
    filled: bool,
    /// The state with the constant and the waves.
    z: Vec<f64>,
    rows: Vec<Polynomial>,
    rows_by: Vec<Polynomial>,
    /// The piece of every contact, and the level it is at.
    pieces: Vec<usize>,
    at: Vec<Option<usize>>,
    column: Vec<f64>,
    propagator: Vec<f64>,
    room: leap::Room,
    /// The state at the end of a stretch.
    next: Vec<f64>,
    /// The flow of the reversed motion; made when it is needed.
    reversed: Option<Box<Self>>,
    /// Flows whose tables have derivatives by other variables, at the present values; made when they are needed.
    beside: Vec<(Variable, Self)>,
    work: Work,
    cancel: Cancel,
}

impl std::fmt::Debug for Affine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Affine")
            .field("coordinates", &self.model.basis.coordinates)
            .field("work", &self.work)
            .finish_non_exhaustive()
    }
}

impl Affine {
    /// The flow at given values.
    ///
    /// # Errors
    /// [`ModelError::NotAffine`](crate::ModelError::NotAffine) if the system is not of this kind; if parameters or the frequency are outside their ranges, levels are
    /// out of order, or the mass matrix is singular.
    pub fn new(system: &dyn System, parameters: &[f64], omega: f64) -> Result<Self, Error> {
        Model::new(system, parameters, omega).map(Self::of)
    }

    fn of(model: Model) -> Self {
        let (order, contacts) = (model.basis.order(), model.contacts.len());
        let most = order - 1 - model.basis.coordinates;
        Self {
            z: vec![0.0; order],
            rows: vec![[0.0; COEFFICIENTS]; most],
            rows_by: vec![[0.0; COEFFICIENTS]; most],
            pieces: vec![0; contacts],
            at: vec![None; contacts],
            column: vec![0.0; 2 * model.basis.coordinates],
            next: vec![0.0; 2 * model.basis.coordinates],
            propagator: vec![0.0; 4 * model.basis.coordinates.pow(2)],
            room: leap::Room::new(&model.basis),
            work: Work::default(),
            cancel: Cancel::new(),
            scalar: Scalar::new(&model),
            filled: false,
            reversed: None,
            beside: Vec::new(),
            model,
        }
    }

    /// Moves over at most one period.
    fn advance_span(
        &mut self,
        span: Span,
        state: &mut [f64],
        tangent: &mut Option<&mut Tangent>,
        see: &mut Option<See<'_>>,
    ) -> Result<(), FlowError> {
        self.room.begin();
        let passed = self.pass_span(span, state, tangent, see);
        // After a failure too perturbations are those of the state that it leaves.
        self.catch_up(tangent);
        self.show(see);
        passed
    }

    fn pass_span(
        &mut self,
        span: Span,
        state: &mut [f64],
        tangent: &mut Option<&mut Tangent>,
        see: &mut Option<See<'_>>,
    ) -> Result<(), FlowError> {
        let n = self.model.basis.coordinates;
        let mut done = 0.0;
        let mut switches = 0;
        self.z[..2 * n].copy_from_slice(state);
        self.model
            .basis
            .write_waves(span.first, &mut self.z[2 * n..]);
        self.choose_pieces(span.begin)?;
        loop {
            self.goes_on(span.begin + done)?;
            let passed = self.pass_segment(span, done, state, tangent, see)?;
            let Some(next) = passed.goes_on_at else {
                return Ok(());
            };
            done = next;
            self.z[..2 * n].copy_from_slice(state);
            let waves = &mut self.z[2 * n..];
            self.model.basis.write_waves(span.first + done, waves);
            if passed.cells > 0.0 {
                self.at.fill(None);
            }
            if let Some(switch) = passed.switch {
                switches += 1;
                self.work.switches += 1;
                if switches > MOST_SWITCHES {
                    let phase = span.begin + done;
                    return Err(FlowError::TooManySwitches { phase, switches });
                }
                self.catch_up(tangent);
                self.show(see);
                self.cross(switch, tangent.as_deref_mut());
            }
        }
    }

    /// Moves on one combination of pieces, to the next switch or as far as its table reaches.
    fn pass_segment(
        &mut self,
        span: Span,
        done: f64,
        state: &mut [f64],
        tangent: &mut Option<&mut Tangent>,
        see: &mut Option<See<'_>>,
    ) -> Result<Passed, FlowError> {
        let by = tangent.as_ref().and_then(|tangent| tangent.by.first());
        let phase = span.begin + done;
        let combination = self.model.combination(&self.pieces, phase, by.is_some())?;
        if tangent.is_some() {
            self.wait(combination);
        }
        if let Some(passed) = self.leap_on(combination, span, done, state, see) {
            return Ok(passed);
        }
        let (table, ladder) = self.model.at(combination).tabulated();
        let rows = &mut self.rows[..table.rows];
        let left = (span.length - done) / table.cell;
        let range = left.min(table.range());
        let at = &self.at;
        let begins = |exit: &ExitLevel| at[exit.contact] == Some(exit.level);
        let hit = table.first_hit(&self.z, range, begins);
        let cells = hit.map_or(range, |hit| hit.at);
        let last = hit.is_none() && range == left;
        let next = done + cells * table.cell;
        let end = if last { span.end } else { span.begin + next };
        let piece = Piece {
            table,
            z: &self.z,
            phases: (phase, end),
            base: self.model.terms.base,
        };
        match ladder.filter(|_| cells == table.range()) {
            Some(ladder) => ladder.pass_range(&self.z, &mut self.next),
            None => table.state(cells, &self.z, piece.base, &mut self.next),
        }
        if self.next.iter().any(|x| !x.is_finite()) {
            return Err(FlowError::NotFinite { phase });
        }
        state.copy_from_slice(&self.next);
        if let Some(tangent) = tangent.as_deref_mut().filter(|_| ladder.is_none()) {
            let workspace = tangent::Workspace {
                rows: &mut *rows,
                rows_by: &mut self.rows_by[..table.rows],
                column: &mut self.column,
                propagator: &mut self.propagator,
            };
            tangent::advance(&self.model, table, &self.z, cells, tangent, workspace);
        }
        if let Some(see) = see.as_mut().filter(|_| ladder.is_none()) {
            see(&piece);
        }
        let switch = hit.map(|hit| Switch::over(&table.exits[hit.exit]));
        self.work.steps += 1;
        self.room.waits(cells);
        self.go_on_stretch(cells, end, see);
        Ok(Passed {
            goes_on_at: (!last).then_some(next),
            cells,
            switch,
        })
    }

    /// Whether nobody has cancelled the motion.
    fn goes_on(&self, phase: f64) -> Result<(), FlowError> {
        if self.cancel.is_cancelled() {
            return Err(FlowError::Cancelled { phase });
        }
        Ok(())
    }

    /// Takes a contact over one of its levels, upwards or downwards.
    fn cross(&mut self, switch: Switch, tangent: Option<&mut Tangent>) {
        if let Some(tangent) = tangent {
            tangent::switch(&self.model, &self.z, switch, tangent);
        }
        self.pieces[switch.contact] = switch.level + usize::from(switch.upwards);
        self.at[switch.contact] = Some(switch.level);
    }

    /// Whether the arrays of fixed size serve the present values, and not only the pieces that a motion meets.
    fn fill_scalar(&mut self, phase: f64) -> bool {
        if let Some(scalar) = self.scalar.as_mut().filter(|_| !self.filled) {
            self.filled = scalar.fill(&mut self.model, phase).is_ok();
        }
        self.filled
    }

    /// The piece that every gap is on, or is about to enter.
    fn choose_pieces(&mut self, phase: f64) -> Result<(), FlowError> {
        self.at.fill(None);
        for index in 0..self.pieces.len() {
            let (gap, _) = self.model.gap(index, &self.z);
            let levels = &self.model.contacts[index].levels;
            self.pieces[index] = levels.iter().filter(|&&level| gap > level).count();
            self.at[index] = levels.iter().position(|&level| gap == level);
        }
        for index in 0..self.pieces.len() {
            let Some(level) = self.at[index] else {
                continue;
            };
            let (_, rate) = self.model.gap(index, &self.z);
            self.pieces[index] = level + 1;
            let rises = rate > 0.0 || (rate == 0.0 && self.rises(index, level, phase)?);
            self.pieces[index] = level + usize::from(rises);
        }
        Ok(())
    }

    /// Whether a gap at rest at a level is accelerated upwards on the piece above it.
    fn rises(&mut self, contact: usize, level: usize, phase: f64) -> Result<bool, FlowError> {
        let combination = self.model.combination(&self.pieces, phase, false)?;
        let table = &self.model.at(combination).table;
        let mut exits = table.exits.iter();
        let exit = exits.find(|exit| exit.contact == contact && exit.level == level);
        let distance = exit.map(|exit| table.distance(exit, 0, &self.z));
        Ok(distance.is_some_and(|distance| crossing::derivatives(&distance, 0.0)[2] > 0.0))
    }

    /// Moves with derivatives by one variable at most.
    fn advance_one(
        &mut self,
        from: f64,
        to: f64,
        state: &mut [f64],
        mut tangent: Option<&mut Tangent>,
        mut see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        let by = tangent
            .as_ref()
            .and_then(|tangent| tangent.by.first().copied());
        self.model.refresh(by, from)?;
        if state.iter().any(|x| !x.is_finite()) || !from.is_finite() || !to.is_finite() {
            return Err(FlowError::NotFinite { phase: from });
        }
        let plain = see.is_none() && by.is_none() && self.fill_scalar(from);
        for span in spans(from, to) {
            match &self.scalar {
                Some(scalar) if plain => {
                    // A period of it takes no longer than a step of others.
                    self.goes_on(span.begin)?;
                    let columns = tangent.as_mut().map(|tangent| &mut tangent.columns[..]);
                    let columns = columns.unwrap_or(&mut []).as_chunks_mut().0;
                    let (state, _) = state.as_chunks_mut();
                    scalar.advance(span, &mut state[0], columns, &mut self.work)?;
                }
                _ => self.advance_span(span, state, &mut tangent, &mut see)?,
            }
        }
        Ok(())
    }
}

impl Flow for Affine {
    fn coordinates(&self) -> usize {
        self.model.basis.coordinates
    }

    fn admits(&self, variable: Variable, value: f64) -> bool {
        admits(self.model.system(), variable, value)
    }

    fn set(&mut self, variable: Variable, value: f64) -> Result<(), FlowError> {
        self.filled = false;
        self.beside.clear();
        self.model.set(variable, value)?;
        self.reversed
            .as_mut()
            .map_or(Ok(()), |reversed| reversed.set(variable, value))
    }

    fn until(&mut self, cancel: &Cancel) {
        self.cancel = cancel.clone();
        // These are made anew, with the token.
        self.reversed = None;
        self.beside.clear();
    }

    fn advance(
        &mut self,
        from: f64,
        to: f64,
        state: &mut [f64],
        tangent: Option<&mut Tangent>,
        see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        check_entries(self.coordinates(), state, tangent.as_deref())?;
        if to < from {
            return self.go_back(from, to, state, tangent, see);
        }
        match tangent {
            Some(tangent) if tangent.by.len() > 1 => {
                self.advance_by_each([from, to], state, tangent, see)
            }
            tangent => self.advance_one(from, to, state, tangent, see),
        }
    }

    fn advance_by(
        &mut self,
        ends: [f64; 2],
        stops: &[f64],
        state: &mut [f64],
        tangent: &mut Tangent,
        show: Show<'_>,
    ) -> Result<(), FlowError> {
        check_entries(self.coordinates(), state, Some(tangent))?;
        self.shown_by_each(ends, stops, state, tangent, show)
    }

    fn is_closed_form(&self) -> bool {
        true
    }

    fn work(&self) -> Work {
        self.work
    }
}

/// The periods from a phase to a later one, and what is left. Lengths are not differences of phases, which grow without end.
fn spans(from: f64, to: f64) -> impl Iterator<Item = Span> {
    let resolution = 2.0 * f64::EPSILON * (from.abs() + to.abs());
    let length = to - from;
    let periods = if length < TAU - resolution {
        0
    } else {
        ((length + resolution) / TAU) as usize
    };
    let rest = length - periods as f64 * TAU;
    let count = periods + usize::from(rest > resolution);
    let first = if (0.0..TAU).contains(&from) {
        from
    } else {
        from.rem_euclid(TAU)
    };
    let phase = move |k: usize| from + k as f64 * TAU;
    (0..count).map(move |k| Span {
        begin: phase(k),
        end: if k + 1 == count { to } else { phase(k + 1) },
        first,
        length: if k < periods { TAU } else { rest },
    })
}

/// What became of a motion on one combination of pieces.
struct Passed {
    /// Where it goes on, since the beginning of the span; nothing at its end.
    goes_on_at: Option<f64>,
    /// Cells of the table that it took.
    cells: f64,
    switch: Option<Switch>,
}

/// A contact that crosses one of its levels.
#[derive(Debug, Clone, Copy)]
struct Switch {
    contact: usize,
    level: usize,
    upwards: bool,
}

impl Switch {
    fn over(exit: &ExitLevel) -> Self {
        Self {
            contact: exit.contact,
            level: exit.level,
            upwards: exit.upper,
        }
    }
}

/// A motion on one combination of pieces, from the phase where its table begins.
struct Piece<'t> {
    table: &'t Table,
    /// Where it begins.
    z: &'t [f64],
    phases: (f64, f64),
    /// `nu`
    base: f64,
}

impl Stretch for Piece<'_> {
    fn phases(&self) -> (f64, f64) {
        self.phases
    }

    fn state(&self, phase: f64, state: &mut [f64]) {
        let cells = (phase - self.phases.0) / self.table.cell;
        self.table.state(cells, self.z, self.base, state);
    }
}
