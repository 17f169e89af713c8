//! What happens where a gap stands on a level: the piece that the motion goes to, and the jump of its derivatives.
//!
//! Where a gap crosses a level with the rate `g'`, the force of its contact jumps by `[phi]`. The phase of the crossing
//! moves with the state, and a tangent column `(dq, dv)` jumps with the field (saltation):
//!
//! ```text
//! dv -> dv - M^-1 e [phi] / g' (d . dq + (dg/dp - dlevel/dp) )                                                 (1)
//! ```
//!
//! with the last two terms for a derivative by a variable `p`. (1) holds until the gap exactly touches: there the motion
//! has no derivative if the force jumps.
//!
//! Source: Leine and Nijmeijer (2004), Dynamics and Bifurcations of Non-Smooth Mechanical Systems, chapter 7.

use crate::time::field::Workspace;
use crate::time::{FlowError, Tangent};

use super::engine::{Engine, StepState};

/// A rate below this part of the rates that it is a sum of is none.
const AT_REST: f64 = 1e-14;
/// One below this part of the largest of the motion is hardly one.
const SLOW: f64 = 1e-4;

impl<const S: usize> Engine<S> {
    /// Finds the pieces that the motion goes to from here. Tangents jump, unless this is where the motion begins.
    pub(super) fn settle(&mut self, mut tangent: Option<&mut Tangent>) -> Result<(), FlowError> {
        self.find_levels();
        let forward = self.trial.width >= 0.0;
        for contact in 0..self.here.on.len() {
            let mut turns = 0;
            while let Some(level) = self.here.on[contact] {
                let gap = self.here.gaps[contact];
                let up = if forward { gap.rate } else { -gap.rate };
                let turns_here = self.turns(contact, level);
                let direction = if turns_here {
                    self.acceleration_of(contact)
                } else {
                    up
                };
                let above = self.here.pieces[contact] > level;
                if direction == 0.0 || (direction > 0.0) == above {
                    break;
                }
                turns += 1;
                if turns > 2 {
                    return Err(FlowError::Rests {
                        phase: self.phase(),
                    });
                }
                self.cross(
                    contact,
                    level,
                    if turns_here {
                        None
                    } else {
                        tangent.as_deref_mut()
                    },
                )?;
            }
        }
        Ok(())
    }

    /// Moves a contact to the piece on the other side of the level that it stands on.
    pub(super) fn cross(
        &mut self,
        contact: usize,
        level: usize,
        tangent: Option<&mut Tangent>,
    ) -> Result<(), FlowError> {
        let from = self.here.pieces[contact];
        let to = if from == level { level + 1 } else { level };
        self.here.pieces[contact] = to;
        self.here.on[contact] = Some(level);
        // A level that was ahead on the other side is behind now.
        if self.aim.is_some_and(|aim| aim.contact == contact) {
            self.aim = None;
        }
        if let Some(tangent) = tangent {
            self.saltate(contact, level, [from, to], tangent)?;
        }
        // Levels may coincide: the piece between them is crossed at once.
        self.here.gaps[contact].value = self.field.contacts[contact].levels[level];
        let next = if to > from {
            level + 1
        } else {
            level.wrapping_sub(1)
        };
        let levels = &self.field.contacts[contact].levels;
        if levels.get(next) == Some(&self.here.gaps[contact].value) {
            self.here.on[contact] = Some(next);
        }
        self.count_switch()
    }

    /// The gap has no rate, but for rounding.
    pub(super) fn is_at_rest(&self, contact: usize) -> bool {
        let StepState { q, v, gaps, .. } = &self.here;
        let rate = gaps[contact].rate.abs();
        let size = self.field.rate_size(contact, |i| [q[i].abs(), v[i].abs()]);
        rate <= AT_REST * size.max(rate)
    }

    /// The gap only touches the level that it stands on: it turns before it can be told apart from the level. Accelerations must be
    /// those of this instant.
    pub(super) fn touches(&self, contact: usize, level: usize) -> bool {
        let rate = self.here.gaps[contact].rate;
        let rounding = self.rounding(contact, level);
        rounding.is_some_and(|rounding| {
            0.5 * rate * rate <= rounding * self.acceleration_of(contact).abs()
        })
    }

    /// Whether the acceleration decides where a gap goes from the level that it stands on; it is that of this instant then.
    pub(super) fn turns(&mut self, contact: usize, level: usize) -> bool {
        if self.is_at_rest(contact) {
            self.accelerate_here();
            return true;
        }
        if !self.is_slow(contact) {
            return false;
        }
        self.accelerate_here();
        self.touches(contact, level)
    }

    /// The gap has hardly any rate.
    pub(super) fn is_slow(&self, contact: usize) -> bool {
        let size = self.field.rate_size(contact, |i| self.here.sizes[i]);
        self.here.gaps[contact].rate.abs() <= SLOW * size
    }

    /// The second derivative of a gap by time, from the accelerations here; zero within rounding.
    pub(super) fn acceleration_of(&self, contact: usize) -> f64 {
        let a = &self.instant.a;
        let phase = self.phase();
        let here = &self.here;
        self.field
            .gap_acceleration(contact, &here.q, &here.v, a, phase)
    }

    /// (1)
    fn saltate(
        &mut self,
        contact: usize,
        level: usize,
        [from, to]: [usize; 2],
        tangent: &mut Tangent,
    ) -> Result<(), FlowError> {
        let facts = self.field.law(contact).facts().levels[level];
        if !(facts.force_jumps || facts.by_rate_jumps) {
            return Ok(());
        }
        let phase = self.phase();
        let rate = self.here.gaps[contact].rate;
        let jump = self.field.force_at_level(contact, level, to, rate)
            - self.field.force_at_level(contact, level, from, rate);
        if jump == 0.0 {
            return Ok(());
        }
        let factor = jump / rate;
        if !factor.is_finite() {
            return Err(FlowError::Grazes { phase });
        }
        let order = 2 * self.here.q.len();
        let homogeneous = tangent.homogeneous(order);
        for (index, column) in tangent.columns.chunks_exact_mut(order).enumerate() {
            let by = index
                .checked_sub(homogeneous)
                .map(|index| tangent.by[index]);
            let workspace = Workspace {
                by: &mut self.slopes.coefficients,
                levels: &mut self.levels_by,
            };
            let by = by.map(|by| (by, workspace));
            let q = &self.here.q;
            let moved = self.field.gap_change(contact, level, column, q, phase, by);
            let (_, v) = column.split_at_mut(order / 2);
            self.field.push(contact, phase, -factor * moved, v);
        }
        Ok(())
    }
}
