//! A motion, step by step.

use crate::flow::{FlowError, See, Stretch, Tangent};

use super::crossing::Found;
use super::engine::Engine;
use super::map::{Map, Tables};
use super::rule::Rule;
use super::step::Solved;

/// The aim of a step's error, as a factor of its width.
const SAFETY: f64 = 0.9;
/// Least and largest factor from one width to the next.
const FACTORS: (f64, f64) = (0.2, 3.0);
/// Attempts at one step.
const MOST_ATTEMPTS: usize = 200;
/// A step is not tried if it is shorter than this, in parts of the phase and in radians.
const SHORTEST: f64 = 1e-15;

/// What became of a landing.
enum Landed {
    Yes,
    /// First a step of this width.
    Shorter(f64),
}

impl<const S: usize> Engine<'_, S> {
    pub(super) fn advance(
        &mut self,
        (from, to): (f64, f64),
        state: &mut [f64],
        tangent: Option<&mut Tangent>,
        see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        let n = self.field.coordinates();
        self.field.regular()?;
        let finite = state.iter().all(|x| x.is_finite()) && from.is_finite() && to.is_finite();
        if !finite {
            return Err(FlowError::NotFinite { phase: from });
        }
        self.begin(from, state, tangent.as_ref().and_then(|tangent| tangent.by));
        let result = self.run(to - from, tangent, see);
        state[..n].copy_from_slice(&self.here.q);
        state[n..].copy_from_slice(&self.here.v);
        result
    }

    fn run(
        &mut self,
        span: f64,
        mut tangent: Option<&mut Tangent>,
        mut see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        if span == 0.0 {
            return Ok(());
        }
        self.trial.width = span;
        self.settle(None)?;
        let order = 2 * self.here.q.len();
        let mut columns = Vec::new();
        if let Some(tangent) = &tangent {
            columns.resize(tangent.columns.len(), 0.0);
            self.column_sizes.clear();
            self.column_sizes
                .resize(tangent.columns.len() / order, [0.0; 2]);
        }
        self.widths = [self.first_width(span); 2];
        while self.here.passed != span {
            self.step(span, tangent.as_deref(), &mut columns)?;
            if let Some(see) = &mut see {
                see(&View { engine: self });
            }
            let landing = self.trial.landing;
            let ends = (self.here.passed + self.trial.width - span) * span.signum() >= 0.0;
            self.accept()?;
            if ends {
                self.here.passed = span;
            }
            if let Some(tangent) = &mut tangent {
                tangent.columns.copy_from_slice(&columns);
            }
            if let Some((contact, level)) = landing {
                self.here.on[contact] = Some(level);
                self.find_levels();
                self.cross(contact, level, tangent.as_deref_mut())?;
            }
            self.settle(tangent.as_deref_mut())?;
        }
        Ok(())
    }

    /// The angle of a vibration that the nodes resolve: the coefficients of `exp(i theta u)` fall as
    /// `(theta / 2)^n / (2 n - 1)!!`.
    fn first_width(&mut self, span: f64) -> f64 {
        let odd = (1..=S).fold(1.0, |product, n| product * (2 * n - 1) as f64);
        let angle = 2.0 * (self.tolerance * odd).powf(1.0 / S as f64);
        self.accelerate_here();
        self.field.linearise(
            &mut self.instant,
            &self.here.pieces,
            None,
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
        let width = angle / (frequency / base).max(self.field.highest_harmonic());
        if width.is_finite() {
            width.min(span.abs())
        } else {
            span.abs()
        }
    }

    /// Finds a step that is accurate, and stays on the pieces or ends on a level.
    fn step(
        &mut self,
        span: f64,
        tangent: Option<&Tangent>,
        columns: &mut [f64],
    ) -> Result<(), FlowError> {
        let left = span - self.here.passed;
        let power = self.start_power();
        let table = self.table(Map::FromStart(power));
        let graded = usize::from(power > 1);
        let mut width = self.widths[graded].min(left.abs()).copysign(left);
        // Two steps of equal width rather than a short last one.
        if width != left && left.abs() < 2.0 * width.abs() {
            width = 0.5 * left;
        }
        let mut limited = width.abs() < self.widths[graded];
        let mut turned = 0;
        self.accelerate_here();
        for _ in 0..MOST_ATTEMPTS {
            if width.abs() <= SHORTEST * self.phase().abs().max(1.0) && width != left {
                return Err(FlowError::StepTooShort {
                    phase: self.phase(),
                    step: width,
                });
            }
            if self.solve(width, table) == Solved::No {
                self.work.rejected += 1;
                width *= 0.4;
                limited = false;
                continue;
            }
            let mut error = self.error();
            // Close to its start a graded step shows crossings only once it is accurate.
            let trusted = power == 1 || error <= 1.0;
            if trusted && let Some(found) = self.crossing() {
                if found.at_once {
                    turned += 1;
                    if turned > 2 {
                        return Err(FlowError::Rests {
                            phase: self.phase(),
                        });
                    }
                    self.cross(found.contact, found.level, None)?;
                    self.accelerate_here();
                    continue;
                }
                match self.reach(found, power, left) {
                    Landed::Yes => {}
                    Landed::Shorter(shorter) => {
                        limited = true;
                        width = shorter;
                        continue;
                    }
                }
            }
            if self.trial.landing.is_some() {
                error = self.error();
            }
            if error <= 1.0
                && let Some(tangent) = tangent
            {
                self.linearise(tangent)?;
                error = error.max(self.carry(tangent, columns));
            }
            if !error.is_finite() {
                self.work.rejected += 1;
                width *= 0.4;
                continue;
            }
            let factor = SAFETY * error.powf(-1.0 / (S + 1) as f64);
            let factor = factor.clamp(FACTORS.0, FACTORS.1);
            let tried = self.trial.width.abs();
            if error <= 1.0 {
                let landed = self.trial.landing.is_some();
                let next = tried * factor;
                let known = self.widths[graded];
                self.widths[graded] = if limited || landed {
                    next.max(known)
                } else {
                    next
                };
                if graded == 1 {
                    self.widths[0] = next;
                }
                return Ok(());
            }
            self.work.rejected += 1;
            limited = false;
            width = if self.trial.landing.is_some() {
                // Land from where it will be accurate.
                limited = true;
                (tried * (1.0 - 0.8 * factor.min(1.0)))
                    .min(0.5 * tried)
                    .copysign(width)
            } else {
                (tried * factor.min(0.9)).copysign(width)
            };
        }
        Err(FlowError::StepTooShort {
            phase: self.phase(),
            step: width,
        })
    }

    /// Ends the step on a level that it was found to cross, or on one that it crosses before.
    fn reach(&mut self, mut found: Found, start: u32, left: f64) -> Landed {
        for _ in 0..8 {
            let map = self.tables[self.trial.table].map;
            let distance = self.trial.width * map.place(found.u);
            let power = self.power(found.contact, found.level);
            if start > 1 && power > 1 {
                return Landed::Shorter(0.5 * distance);
            }
            let map = if power > 1 {
                Map::ToEnd(power)
            } else {
                Map::FromStart(start)
            };
            let table = self.table(map);
            if self.land(distance, table, found.contact, found.level) == Solved::No
                || self.trial.width.abs() > left.abs()
            {
                self.work.rejected += 1;
                return Landed::Shorter(0.8 * distance);
            }
            match self.crossing() {
                None => return Landed::Yes,
                Some(earlier) => found = earlier,
            }
        }
        Landed::Shorter(0.5 * self.trial.width)
    }
}

/// The trial as a stretch of motion.
struct View<'b, 'a, const S: usize> {
    engine: &'b Engine<'a, S>,
}

impl<const S: usize> Stretch for View<'_, '_, S> {
    fn phases(&self) -> (f64, f64) {
        let start = self.engine.phase();
        (start, start + self.engine.trial.width)
    }

    fn state(&self, phase: f64, state: &mut [f64]) {
        let Engine {
            rule,
            tables,
            here,
            trial,
            batch,
            ..
        } = self.engine;
        let (start, end) = self.phases();
        let rule: &Rule<S> = rule;
        let tables: &Tables<S> = &tables[trial.table];
        let u = tables
            .map
            .inverse((phase - start) / trial.width, (end - phase) / trial.width);
        let mut weights = [0.0; super::roots::MOST];
        let weights = &mut weights[..S + 2];
        rule.interpolation(u, weights);
        let n = here.q.len();
        let at = |start: f64, row: &[f64; S], end: f64| {
            let inner: f64 = row.iter().zip(&weights[1..]).map(|(x, w)| x * w).sum();
            weights[0] * start + inner + weights[S + 1] * end
        };
        for i in 0..n {
            state[i] = at(here.q[i], &batch.q[i], trial.q[i]);
            state[n + i] = at(here.v[i], &batch.v[i], trial.v[i]);
        }
    }
}
