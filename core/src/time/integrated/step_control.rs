//! The width of the steps of a motion: tried, judged by their error, and cut where a gap comes to a level.

use crate::time::{FlowError, Tangent};

use super::crossing::Found;
use super::engine::Engine;
use super::map::Map;
use super::step::{Solved, larger};
use super::view::{View, Watch};

/// The aim of a step's error, as a factor of its width.
const SAFETY: f64 = 0.9;
/// Least and largest factor from one width to the next.
const FACTORS: (f64, f64) = (0.2, 3.0);
/// The first width, in parts of what a vibration would allow; and that of a graded step, in parts of that.
const FIRST: f64 = 0.6;
const GRADED: f64 = 0.3;
/// Least first width in radians: beside a level with an exponent below one, stiffness says nothing of the motion.
const LEAST_FIRST: f64 = 1e-6;
/// How many times narrower a step must be, about, whose nodes do not see a law.
const OVERLOOKED: f64 = 2.0;
/// Attempts at one step.
const MOST_ATTEMPTS: usize = 200;
/// A step to a level may be so many times as wide as the widest that is known to be accurate: the step before it would be next to
/// nothing otherwise.
const WIDER: f64 = 1.1;
/// Attempts at landing on a level in one step. Where a gap nearly touches it, a landing may find the second of two crossings
/// again and again.
const MOST_LANDINGS: usize = 6;
/// A crossing before this part of a step is believed only of a step that is solved.
const EARLY: f64 = 0.01;
/// The factor of a step that could not be solved.
const SHORTEN: f64 = 0.4;
/// A step is not tried if it is shorter than this, in parts of the phase and in radians.
pub(super) const SHORTEST: f64 = 1e-15;

/// What is tried next.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Plan {
    /// A step of this width.
    Span(f64),
    /// A step to a level, about this far away.
    Land(Aim),
}

/// A level that the motion is about to reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Aim {
    pub(super) contact: usize,
    level: usize,
    distance: f64,
    /// From the trial that showed it, or else from the acceleration here.
    seen: bool,
}

/// What became of a trial.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Tried {
    Solved,
    /// Try this instead.
    Instead(Plan),
}

impl<const S: usize> Engine<S> {
    pub(super) fn advance(
        &mut self,
        from: f64,
        to: f64,
        state: &mut [f64],
        tangent: Option<&mut Tangent>,
        see: Option<Watch<'_, S>>,
    ) -> Result<(), FlowError> {
        let n = self.field.coordinates();
        let finite = state.iter().all(|x| x.is_finite()) && from.is_finite() && to.is_finite();
        if !finite {
            return Err(FlowError::NotFinite { phase: from });
        }
        let by = tangent.as_ref().map_or(&[][..], |tangent| &tangent.by);
        self.begin(from, state, by);
        // Workspace for the columns at the end of a step, borrowed apart from the rest.
        let mut columns = std::mem::take(&mut self.columns);
        let result = self.run(to - from, tangent, &mut columns, see);
        self.columns = columns;
        state[..n].copy_from_slice(&self.here.q);
        state[n..].copy_from_slice(&self.here.v);
        result
    }

    fn run(
        &mut self,
        span: f64,
        mut tangent: Option<&mut Tangent>,
        columns: &mut Vec<f64>,
        mut see: Option<Watch<'_, S>>,
    ) -> Result<(), FlowError> {
        if span == 0.0 {
            return Ok(());
        }
        self.trial.width = span;
        self.settle(None)?;
        let order = 2 * self.here.q.len();
        if let Some(tangent) = &tangent {
            columns.resize(tangent.columns.len(), 0.0);
            self.column_sizes.clear();
            self.column_sizes
                .resize(tangent.columns.len() / order, [0.0; 2]);
        }
        self.first_widths(span);
        while self.here.passed != span {
            self.step(span, tangent.as_deref(), columns)?;
            if let Some(see) = &mut see {
                see(&View {
                    engine: self,
                    tangent: tangent.as_deref(),
                });
            }
            let landing = self.trial.landing;
            let ends = (self.here.passed + self.trial.width - span) * span.signum() >= 0.0;
            self.accept()?;
            if ends {
                self.here.passed = span;
            }
            if let Some(tangent) = &mut tangent {
                tangent.columns.copy_from_slice(columns);
            }
            if let Some((contact, level)) = landing {
                self.here.on[contact] = Some(level);
                self.put_on_level(contact, level);
                self.find_levels();
                if !self.turns(contact, level) {
                    self.cross(contact, level, tangent.as_deref_mut())?;
                }
            }
            self.settle(tangent.as_deref_mut())?;
        }
        Ok(())
    }

    /// Widths to begin with, from the angle of a vibration that the nodes resolve: the coefficients of `exp(i theta u)`
    /// fall as `(theta / 2)^n / (2 n - 1)!!`.
    fn first_widths(&mut self, span: f64) {
        let odd = (1..=S).fold(1.0, |product, n| product * (2 * n - 1) as f64);
        let angle = 2.0 * (self.tolerance * odd).powf(1.0 / S as f64);
        self.accelerate_here();
        self.field.linearise(
            &mut self.instant,
            &self.here.pieces,
            &[],
            &mut self.slopes_here,
        );
        let n = self.here.q.len();
        let row = |matrix: &[[f64; 1]]| {
            let rows = matrix.chunks_exact(n);
            rows.map(|row| row.iter().map(|x| x[0].abs()).sum::<f64>())
                .fold(0.0, f64::max)
        };
        let frequency = row(&self.slopes_here.by_q)
            .sqrt()
            .max(row(&self.slopes_here.by_v));
        let base = self.field.base().abs();
        let width = FIRST * angle / (frequency / base).max(self.field.highest_harmonic());
        let width = if width.is_finite() {
            width.max(LEAST_FIRST).min(span.abs())
        } else {
            span.abs()
        };
        self.widths = [width, GRADED * width, GRADED * width];
    }

    /// Finds a step that is accurate, and stays on the pieces or ends on a level.
    fn step(
        &mut self,
        span: f64,
        tangent: Option<&Tangent>,
        columns: &mut [f64],
    ) -> Result<(), FlowError> {
        let left = span - self.here.passed;
        self.accelerate_here();
        self.ends_at_kink = false;
        let mut plan = self.first_plan(left);
        let (mut turned, mut landings) = (0, 0);
        for _ in 0..MOST_ATTEMPTS {
            self.count_step()?;
            self.scale();
            let tried = match plan {
                Plan::Span(width) => self.try_span(width, left, &mut turned)?,
                Plan::Land(aim) if landings < MOST_LANDINGS => {
                    landings += 1;
                    self.try_landing(aim, left)
                }
                // From halfway the two are farther apart, in parts of the step.
                Plan::Land(aim) => {
                    landings = 0;
                    Tried::Instead(Plan::Span(0.5 * aim.distance))
                }
            };
            plan = match tried {
                Tried::Instead(plan) => plan,
                Tried::Solved => match self.judge(tangent, columns)? {
                    None => return Ok(()),
                    Some(plan) => plan,
                },
            };
        }
        Err(self.too_short(self.trial.width))
    }

    /// To the level that is about to be reached, or as far as steps went before.
    fn first_plan(&mut self, left: f64) -> Plan {
        let graded = usize::from(self.start_power() > 1);
        let most = self.widths[graded];
        if let Some(aim) = self.aim.take()
            && aim.distance.abs() <= most.max(self.widths[2])
        {
            return Plan::Land(aim);
        }
        if left.abs() <= most {
            Plan::Span(left)
        } else {
            // Two steps of equal width rather than a short last one.
            Plan::Span(most.min(0.5 * left.abs()).copysign(left))
        }
    }

    fn too_short(&self, step: f64) -> FlowError {
        FlowError::StepTooShort {
            phase: self.phase(),
            step,
        }
    }

    /// Tries a step of a width.
    fn try_span(&mut self, width: f64, left: f64, turned: &mut usize) -> Result<Tried, FlowError> {
        if width.abs() <= SHORTEST * self.phase().abs().max(1.0) && width != left {
            return Err(self.too_short(width));
        }
        let table = self.table(Map::FromStart(self.start_power()));
        let mut solved = self.solve(width, table, true);
        if solved == Solved::No {
            self.work.rejected += 1;
            return Ok(Tried::Instead(Plan::Span(SHORTEN * width)));
        }
        let mut crossing = self.crossing();
        if solved == Solved::Strays && crossing.is_none() {
            solved = self.solve(width, table, false);
            crossing = self.crossing();
        }
        Ok(match crossing {
            None if solved == Solved::No => {
                self.work.rejected += 1;
                Tried::Instead(Plan::Span(SHORTEN * width))
            }
            None => Tried::Solved,
            // A polynomial that begins almost as a square may seem to cross again at once.
            Some(found) if found.doubtful => {
                self.work.rejected += 1;
                Tried::Instead(Plan::Span(SHORTEN * width))
            }
            Some(found) if solved != Solved::Yes && self.is_early(found) => {
                self.work.rejected += 1;
                Tried::Instead(Plan::Span(SHORTEN * width))
            }
            Some(found) if found.at_once => {
                *turned += 1;
                if *turned > 2 {
                    let phase = self.phase();
                    return Err(FlowError::Rests { phase });
                }
                self.cross(found.contact, found.level, None)?;
                self.accelerate_here();
                Tried::Instead(Plan::Span(width))
            }
            Some(found) => Tried::Instead(self.towards(found)),
        })
    }

    /// Whether a crossing is too close to the start of the trial to be believed of an iterate that is not solved to the end. Beyond its
    /// piece a law may grow without bound, as an even power does, and the iterate with it: where that one crosses, even at once, says
    /// nothing then.
    fn is_early(&self, found: Found) -> bool {
        let map = self.tables[self.trial.table].map;
        found.at_once || map.place(found.u) < EARLY
    }

    /// To a level that the trial crosses. If both ends are to be graded, half of the way first; if the end is, first to
    /// where a step that ends there is accurate.
    fn towards(&mut self, found: Found) -> Plan {
        let map = self.tables[self.trial.table].map;
        let distance = self.trial.width * map.place(found.u);
        let aim = Aim {
            contact: found.contact,
            level: found.level,
            distance,
            seen: true,
        };
        if self.power(found.contact, found.level) == 1 {
            return Plan::Land(aim);
        }
        let last = if self.start_power() > 1 {
            self.widths[2].min(0.5 * distance.abs())
        } else {
            self.widths[2]
        };
        if distance.abs() <= WIDER * last {
            return Plan::Land(aim);
        }
        let distance = last.max(0.1 * distance.abs()).copysign(distance);
        self.aim = Some(Aim {
            distance,
            seen: false,
            ..aim
        });
        Plan::Span(aim.distance - distance)
    }

    /// Tries a step that ends on a level.
    fn try_landing(&mut self, aim: Aim, left: f64) -> Tried {
        let power = self.power(aim.contact, aim.level);
        let map = if power > 1 {
            Map::ToEnd(power)
        } else {
            Map::FromStart(self.start_power())
        };
        let table = self.table(map);
        if aim.seen {
            self.resample(aim.distance, table);
        } else {
            self.guess(aim.distance, table);
        }
        let solved = self.land(aim.distance, table, aim.contact, aim.level);
        if solved != Solved::Yes || self.trial.width.abs() > left.abs() {
            self.work.rejected += 1;
            return Tried::Instead(Plan::Span(0.8 * aim.distance));
        }
        match self.crossing() {
            None => Tried::Solved,
            Some(found) if found.doubtful => {
                self.work.rejected += 1;
                Tried::Instead(Plan::Span(SHORTEN * aim.distance))
            }
            Some(found) => Tried::Instead(self.towards(found)),
        }
    }

    /// Whether the trial is accurate, and otherwise what to try.
    fn judge(
        &mut self,
        tangent: Option<&Tangent>,
        columns: &mut [f64],
    ) -> Result<Option<Plan>, FlowError> {
        if let Some(part) = self.kink() {
            self.ends_at_kink = true;
            self.work.rejected += 1;
            return Ok(Some(Plan::Span(part * self.trial.width)));
        }
        let mut error = self.error();
        if error <= 1.0 && self.overlooks() {
            // As an error that half of the width mends.
            error = OVERLOOKED.powi(S as i32 + 1);
        }
        if error <= 1.0
            && let Some(tangent) = tangent
        {
            self.linearise(tangent)?;
            let mut of_tangent = self.carry(tangent, columns);
            if of_tangent > 1.0 {
                of_tangent /= (self.level_noise() / self.tolerance).max(1.0);
            }
            error = larger(error, of_tangent);
        }
        let width = self.trial.width;
        if !error.is_finite() {
            self.work.rejected += 1;
            return Ok(Some(Plan::Span(SHORTEN * width)));
        }
        // Where t = T u^p, an error of degree S + 1 in u is one of degree (S + 1) / p in T.
        let map = self.tables[self.trial.table].map;
        let factor = SAFETY * error.powf(-f64::from(map.power()) / (S + 1) as f64);
        let factor = factor.clamp(FACTORS.0, FACTORS.1);
        if error <= 1.0 {
            self.remember(width.abs() * factor);
            return Ok(None);
        }
        self.work.rejected += 1;
        let Some((contact, level)) = self.trial.landing else {
            return Ok(Some(Plan::Span(width * factor.min(0.9))));
        };
        // Land from where it will be accurate.
        let part = (1.0 - factor).clamp(0.2, 0.9);
        let last = (1.0 - part) * width;
        self.widths[2] = self.widths[2].min(last.abs());
        self.aim = Some(Aim {
            contact,
            level,
            distance: last,
            seen: false,
        });
        Ok(Some(Plan::Span(part * width)))
    }

    /// Notes how wide the next steps may be, by one that was accurate.
    fn remember(&mut self, next: f64) {
        let map = self.tables[self.trial.table].map;
        let kind = match map {
            Map::FromStart(1) | Map::ToEnd(1) => 0,
            Map::FromStart(_) => 1,
            Map::ToEnd(_) => 2,
        };
        let cut = self.trial.landing.is_some() || self.aim.is_some() || self.ends_at_kink;
        let known = self.widths[kind];
        self.widths[kind] = if cut { next.max(known) } else { next };
        if kind == 1 {
            self.widths[0] = next;
        }
    }
}
