//! One coordinate under at most one harmonic: every level is a position, and the pieces are intervals between positions.
//!
//! The motion on an interval is in [`interval`](super::interval). Waves turn with the motion, from their values at its beginning;
//! they begin anew in every period.

use super::interval::{Interval, Meeting, ORDER, RANGE, place};
use super::model::Model;
use crate::time::{FlowError, Work};

/// A system of one coordinate at present values.
#[derive(Debug)]
pub(super) struct Scalar {
    /// From the lowest positions to the highest.
    intervals: Vec<Interval>,
    /// Between them.
    boundaries: Vec<Boundary>,
    harmonic: f64,
    /// Workspace for the piece of every contact.
    pieces: Vec<usize>,
}

/// A position where pieces meet, and how the acceleration changes there in the direction of increasing positions: by a constant
/// and by a multiple of the velocity.
#[derive(Debug, Clone, Copy)]
struct Boundary {
    at: f64,
    constant: f64,
    by_velocity: f64,
}

/// What a motion extends over.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    /// First and last phase.
    pub(super) begin: f64,
    pub(super) end: f64,
    /// The first phase within the first period.
    pub(super) first: f64,
    /// At most one period.
    pub(super) length: f64,
}

impl Scalar {
    /// `None` if the system has more coordinates or harmonics, or a moving offset.
    pub(super) fn new(model: &Model) -> Option<Self> {
        let simple = model.basis.coordinates == 1 && model.basis.harmonics.len() <= 1;
        (simple && !model.moving).then(|| Self {
            intervals: Vec::new(),
            boundaries: Vec::new(),
            harmonic: model.basis.harmonics.first().map_or(0.0, |&h| f64::from(h)),
            pieces: vec![0; model.contacts.len()],
        })
    }

    /// Fills all intervals from the present values of the model.
    ///
    /// # Errors
    /// If one of them cannot be, also one that no motion meets.
    pub(super) fn fill(&mut self, model: &mut Model, phase: f64) -> Result<(), FlowError> {
        self.set_boundaries(model);
        let count = self.boundaries.len() + 1;
        self.intervals.resize_with(count, Interval::new);
        for (index, interval) in self.intervals.iter_mut().enumerate() {
            let lower = match index {
                0 => f64::NEG_INFINITY,
                _ => self.boundaries[index - 1].at,
            };
            let upper = self
                .boundaries
                .get(index)
                .map_or(f64::INFINITY, |end| end.at);
            choose_pieces(model, inside(lower, upper), &mut self.pieces);
            let combination = model.combination(&self.pieces, phase, false)?;
            let table = &model.at(combination).table;
            interval.fill(table, self.harmonic, model.terms.base, [lower, upper]);
        }
        Ok(())
    }

    /// The positions where pieces meet, in increasing order.
    fn set_boundaries(&mut self, model: &Model) {
        let boundaries = &mut self.boundaries;
        boundaries.clear();
        for (index, contact) in model.contacts.iter().enumerate() {
            let (direction, offset) = model.position(index);
            if direction == 0.0 {
                continue;
            }
            for (level, &value) in contact.levels.iter().enumerate() {
                let (force, by_rate) = model.jump(index, level);
                // Upwards through the level if the gap grows with the position.
                let push = -contact.push[0] * direction.signum();
                boundaries.push(Boundary {
                    at: (value + offset) / direction,
                    constant: push * force,
                    by_velocity: push * by_rate * direction,
                });
            }
        }
        boundaries.sort_unstable_by(|a, b| a.at.total_cmp(&b.at));
        boundaries.dedup_by(|next, kept| {
            let same = next.at == kept.at;
            if same {
                kept.constant += next.constant;
                kept.by_velocity += next.by_velocity;
            }
            same
        });
    }

    /// A state at the beginning of a span, with the constant and the wave.
    #[inline]
    fn begin(&self, span: Span, [position, velocity]: [f64; 2]) -> [f64; ORDER] {
        let (sine, cosine) = match span.first {
            0.0 => (0.0, 1.0),
            first => (self.harmonic * first).sin_cos(),
        };
        [position, velocity, 1.0, cosine, sine]
    }

    /// Moves a state, and perturbations of it.
    #[inline]
    pub(super) fn advance(
        &self,
        span: Span,
        state: &mut [f64; 2],
        columns: &mut [[f64; 2]],
        work: &mut Work,
    ) -> Result<(), FlowError> {
        let mut z = self.begin(span, *state);
        let mut index = self.choose(&z);
        let mut begins = true;
        let mut done = 0.0;
        let mut switches = 0;
        loop {
            let interval = &self.intervals[index];
            let left = (span.length - done) * interval.density;
            let range = left.min(RANGE);
            work.steps += 1;
            let Some(meeting) = interval.meeting(&z, range, begins) else {
                let (cell, s) = place(range);
                let next = interval.state(cell, s, &z);
                if !(next[0].is_finite() && next[1].is_finite()) {
                    *state = [z[0], z[1]];
                    let phase = span.begin + done;
                    return Err(FlowError::NotFinite { phase });
                }
                *state = next;
                interval.advance_columns(cell, s, columns);
                if range == left {
                    return Ok(());
                }
                z = interval.advance(cell, s, next, &z);
                done += range * interval.cell;
                begins = false;
                continue;
            };
            let Meeting {
                cell,
                s,
                velocity,
                upper,
            } = meeting;
            let boundary = &self.boundaries[index - usize::from(!upper)];
            z = interval.advance(cell, s, [boundary.at, velocity], &z);
            done += (cell as f64 + s) * interval.cell;
            if !columns.is_empty() {
                interval.advance_columns(cell, s, columns);
                boundary.switch(velocity, upper, columns);
            }
            index = if upper { index + 1 } else { index - 1 };
            begins = true;
            switches += 1;
            work.switches += 1;
            if switches > super::MOST_SWITCHES {
                *state = [z[0], z[1]];
                let phase = span.begin + done;
                return Err(FlowError::TooManySwitches { phase, switches });
            }
        }
    }

    /// The interval of a state; at a boundary the one that it is about to enter.
    fn choose(&self, z: &[f64; ORDER]) -> usize {
        let below = |boundary: &&Boundary| boundary.at < z[0];
        let index = self.boundaries.iter().filter(below).count();
        let at = self.boundaries.get(index);
        if at.is_none_or(|boundary| boundary.at != z[0]) {
            return index;
        }
        let rises = z[1] > 0.0 || (z[1] == 0.0 && self.intervals[index + 1].accelerates_up(z));
        index + usize::from(rises)
    }
}

impl Boundary {
    /// The saltation of perturbations, see [`tangent`](super::tangent), equation (1).
    fn switch(&self, velocity: f64, upwards: bool, columns: &mut [[f64; 2]]) {
        let steepness = if self.constant == 0.0 {
            self.by_velocity
        } else {
            self.constant / velocity + self.by_velocity
        };
        let steepness = if upwards { steepness } else { -steepness };
        for column in columns {
            column[1] += steepness * column[0];
        }
    }
}

/// A position between two others.
fn inside(lower: f64, upper: f64) -> f64 {
    match (lower.is_finite(), upper.is_finite()) {
        (true, true) => 0.5 * (lower + upper),
        (true, false) => lower + lower.abs().max(1.0),
        (false, true) => upper - upper.abs().max(1.0),
        (false, false) => 0.0,
    }
}

/// The pieces that all gaps are on at a position.
fn choose_pieces(model: &Model, x: f64, pieces: &mut [usize]) {
    for (index, piece) in pieces.iter_mut().enumerate() {
        let (direction, offset) = model.position(index);
        let gap = direction * x - offset;
        let levels = &model.contacts[index].levels;
        *piece = levels.iter().filter(|&&level| gap > level).count();
    }
}
