//! Where the motion is, and the workspace of its steps.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::cancel::Cancel;
use crate::law::{Quantity, TermFacts, is_unbounded};
use crate::laws::generic::scales::{Scales, Sight};
use crate::numeric::fourier::grading;
use crate::numeric::linear::{Lu, Matrix};
use crate::system::Variable;
use crate::time::field::batch::{Anchor, Batch, End};
use crate::time::field::slopes::Slopes;
use crate::time::field::{Field, Gap};
use crate::time::{FlowError, Work};

use super::kept::kept;
use super::map::{Map, Tables};
use super::rule::Rule;
use super::step_control::{Aim, SHORTEST};

/// A coordinate that hardly moves is held to this part of the accuracy of the one that moves most.
const LEAST_SCALE: f64 = 1e-3;

/// A gap stands on a level if it is within this many rounding errors of what it is a sum of, or beyond.
const ON_LEVEL: f64 = 16.0 * f64::EPSILON;

/// Rounding of the distance of a gap from a level, in parts of what it is a sum of where the motion was largest.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// So much of what [`Scales`] say may change from node to node, and the width in radians below which a step is not asked.
const PART: f64 = 1.5;
const NARROW: f64 = 1e-9;

/// The state of a motion from switch to switch.
#[derive(Debug)]
pub(super) struct StepState {
    /// Where the motion began.
    pub(super) from: f64,
    /// Phase since then: small, so that a short step is not lost in it.
    pub(super) passed: f64,
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    /// The piece of every contact.
    pub(super) pieces: Vec<usize>,
    /// The level on which its gap stands.
    pub(super) on: Vec<Option<usize>>,
    /// Its gap; exactly that of the level if it stands on one.
    pub(super) gaps: Vec<Gap>,
    /// The largest size of every coordinate and rate so far.
    pub(super) sizes: Vec<[f64; 2]>,
}

/// One step that is being tried.
#[derive(Debug)]
pub(super) struct Trial {
    /// In phase; negative backwards.
    pub(super) width: f64,
    /// Position of its map.
    pub(super) table: usize,
    /// Contact and level that it ends on.
    pub(super) landing: Option<(usize, usize)>,
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    /// The sizes of the motion so far, with this step.
    pub(super) sizes: Vec<[f64; 2]>,
}

impl StepState {
    fn new(coordinates: usize, contacts: usize) -> Self {
        let zero = Gap {
            value: 0.0,
            rate: 0.0,
            size: 0.0,
        };
        Self {
            from: 0.0,
            passed: 0.0,
            q: vec![0.0; coordinates],
            v: vec![0.0; coordinates],
            pieces: vec![0; contacts],
            on: vec![None; contacts],
            gaps: vec![zero; contacts],
            sizes: vec![[0.0; 2]; coordinates],
        }
    }
}

impl Trial {
    fn new(coordinates: usize) -> Self {
        Self {
            width: 0.0,
            table: 0,
            landing: None,
            q: vec![0.0; coordinates],
            v: vec![0.0; coordinates],
            sizes: vec![[0.0; 2]; coordinates],
        }
    }
}

pub(super) struct Engine<const S: usize> {
    pub(super) field: Field,
    pub(super) tolerance: f64,
    pub(super) rule: Arc<Rule<S>>,
    /// One for each map that has been needed; the first is plain.
    pub(super) tables: Vec<Arc<Tables<S>>>,
    /// Powers that grade a step at the lower and the upper end of each piece of each contact, and for which variables.
    pub(super) powers: Vec<Vec<[u32; 2]>>,
    powers_by: Vec<Variable>,
    /// Where the law of each contact may be sharp.
    pub(super) sharp: Vec<Option<Scales>>,
    /// They belong to the present values.
    powers_known: bool,
    pub(super) here: StepState,
    pub(super) trial: Trial,
    pub(super) batch: Batch<S>,
    pub(super) instant: Batch<1>,
    pub(super) anchors: Vec<Anchor>,
    /// States at the nodes of an earlier trial, and accelerations of the sweep before.
    pub(super) before: [Vec<[f64; S]>; 2],
    pub(super) values: Vec<f64>,
    /// A gap and its rate at both ends and at the nodes.
    pub(super) motion: [Vec<f64>; 2],
    pub(super) coefficients: Vec<f64>,
    pub(super) weights: Vec<f64>,
    pub(super) slopes: Slopes<S>,
    /// Workspace for derivatives of the levels of one contact.
    pub(super) levels_by: Vec<f64>,
    pub(super) slopes_here: Slopes<1>,
    pub(super) matrix: Matrix,
    pub(super) lu: Lu,
    pub(super) right: Vec<f64>,
    /// Sizes of the columns of the tangent so far, `(by q, by v)`.
    pub(super) column_sizes: Vec<[f64; 2]>,
    /// Workspace for tangent columns.
    pub(super) columns: Vec<f64>,
    /// Derivatives of the accelerations at the nodes, coordinate by coordinate of each column.
    pub(super) moved: Vec<[f64; S]>,
    /// Workspace for what a force does to the rates.
    pub(super) pushed: Vec<f64>,
    /// What errors of coordinates and rates are relative to.
    pub(super) scales: Vec<[f64; 2]>,
    /// Widths to try next: of a plain step, and of steps that are graded at their start and at their end.
    pub(super) widths: [f64; 3],
    /// A level that the next step is to reach.
    pub(super) aim: Option<Aim>,
    /// The step is to end where a slope jumps.
    pub(super) ends_at_kink: bool,
    /// Switches, and where they began to be counted.
    pub(super) switches: (usize, f64),
    /// Steps, and where they began to be counted.
    pub(super) steps: (usize, f64),
    pub(super) work: Work,
    pub(super) cancel: Cancel,
}

impl<const S: usize> Engine<S> {
    pub(super) fn new(field: Field, tolerance: f64) -> Self {
        let n = field.coordinates();
        let contacts = field.contacts.len();
        let rule = kept(Map::PLAIN, Rule::new);
        let rows = || vec![[0.0; S]; n];
        let (end, gap) = (End::Start, 0.0);
        let anchor = Anchor { end, gap };
        let points = rule.points.len();
        let levels = field.contacts.iter().map(|contact| contact.levels.len());
        let levels = levels.max().unwrap_or(0);
        Self {
            tolerance,
            tables: vec![Tables::kept(&rule, Map::PLAIN)],
            powers: (0..contacts)
                .map(|contact| vec![[1; 2]; field.law(contact).facts().pieces.len()])
                .collect(),
            powers_by: Vec::new(),
            sharp: (0..contacts)
                .map(|contact| Scales::of(field.law(contact)))
                .collect(),
            powers_known: false,
            here: StepState::new(n, contacts),
            trial: Trial::new(n),
            batch: Batch::new(&field),
            instant: Batch::new(&field),
            anchors: vec![anchor; contacts],
            before: [rows(), rows()],
            values: vec![0.0; points],
            motion: [vec![0.0; points], vec![0.0; points]],
            coefficients: vec![0.0; points],
            weights: vec![0.0; points],
            slopes: Slopes::new(&field),
            levels_by: vec![0.0; levels],
            slopes_here: Slopes::new(&field),
            matrix: Matrix::zeros(n * S),
            lu: Lu::new(n * S),
            right: vec![0.0; n * S],
            column_sizes: Vec::new(),
            columns: Vec::new(),
            moved: Vec::new(),
            pushed: vec![0.0; n],
            scales: vec![[0.0; 2]; n],
            widths: [0.0; 3],
            aim: None,
            ends_at_kink: false,
            switches: (0, 0.0),
            steps: (0, 0.0),
            work: Work::default(),
            cancel: Cancel::new(),
            rule,
            field,
        }
    }

    /// Changes the frequency or a parameter.
    pub(super) fn set(&mut self, variable: Variable, value: f64) -> Result<(), FlowError> {
        self.powers_known = false;
        self.field.set(variable, value)
    }

    /// The phase.
    pub(super) fn phase(&self) -> f64 {
        self.here.from + self.here.passed
    }

    /// The time that the trial takes.
    pub(super) fn time(&self) -> f64 {
        self.trial.width / self.field.base()
    }

    /// Takes a state over.
    pub(super) fn begin(&mut self, from: f64, state: &[f64], by: &[Variable]) {
        let n = self.field.coordinates();
        let here = &mut self.here;
        (here.from, here.passed) = (from, 0.0);
        here.q.copy_from_slice(&state[..n]);
        here.v.copy_from_slice(&state[n..]);
        here.sizes.fill([0.0; 2]);
        for i in 0..n {
            here.sizes[i] = [here.q[i].abs(), here.v[i].abs()];
        }
        write_scales(&self.here.sizes, self.field.base(), &mut self.scales);
        self.switches = (0, 0.0);
        self.steps = (0, 0.0);
        self.aim = None;
        for contact in 0..self.here.on.len() {
            self.here.on[contact] = None;
            let gap = self.field.gap(contact, &self.here.q, &self.here.v, from);
            let levels = &self.field.contacts[contact].levels;
            let facts = self.field.law(contact).facts();
            let above = levels.iter().zip(&*facts.levels).filter(|(level, facts)| {
                gap.value > **level || gap.value == **level && facts.belongs_above
            });
            self.here.pieces[contact] = above.count();
            self.here.gaps[contact] = gap;
        }
        self.find_levels();
        if !self.powers_known || self.powers_by != by {
            self.find_powers(by);
            self.powers_by.clear();
            self.powers_by.extend_from_slice(by);
            self.powers_known = true;
        }
    }

    /// Moves the state by what rounding has left between a gap and the level that a step has ended on. The next step takes the gap
    /// for the level's own, and what is left would grow by the square of its angle from one level to the next.
    pub(super) fn put_on_level(&mut self, contact: usize, level: usize) {
        let phase = self.phase();
        let StepState { q, v, .. } = &mut self.here;
        let gap = self.field.gap(contact, q, v, phase);
        let left = self.field.contacts[contact].levels[level] - gap.value;
        self.field.move_gap(contact, phase, left, q);
    }

    /// Notes which contacts stand on a level of their piece, within rounding or less than the shortest step away; and those that have left it within the
    /// tolerance, too little to have been seen.
    pub(super) fn find_levels(&mut self) {
        let phase = self.phase();
        for contact in 0..self.here.on.len() {
            let gap = self.field.gap(contact, &self.here.q, &self.here.v, phase);
            self.here.gaps[contact] = gap;
            let levels = &self.field.contacts[contact].levels;
            let piece = self.here.pieces[contact];
            // No step is as short as the one from here to a level that is nearer than this.
            let shortest = SHORTEST * phase.abs().max(1.0);
            let reach = shortest * gap.rate.abs() / self.field.base().abs();
            let rounding = |level: f64| ON_LEVEL * (gap.size + level.abs()) + reach;
            let lower = piece
                .checked_sub(1)
                .filter(|&lower| gap.value - levels[lower] <= rounding(levels[lower]));
            let upper = levels
                .get(piece)
                .filter(|&&upper| upper - gap.value <= rounding(upper))
                .map(|_| piece);
            let on = &mut self.here.on[contact];
            *on = on.or(lower).or(upper);
            if let Some(level) = *on {
                self.here.gaps[contact].value = levels[level];
            }
        }
    }

    /// What rounding leaves in the distance of a gap from a level, where a motion that is beyond it by no more may as well not be: there
    /// are neither jumps nor unbounded derivatives. A state errs by parts of the largest one of the motion.
    pub(super) fn rounding(&self, contact: usize, level: usize) -> Option<f64> {
        let facts = self.field.law(contact).facts();
        let arguments = &self.field.contacts[contact].arguments;
        if facts.levels[level].force_jumps || is_unbounded(facts, level, arguments) {
            return None;
        }
        let size = self.field.gap_size(contact, &self.here.sizes, self.phase());
        let level = self.field.contacts[contact].levels[level];
        Some(ROUNDING * (size + level.abs()))
    }

    /// The powers that make the force and its derivatives analytic at either end of each piece.
    fn find_powers(&mut self, by: &[Variable]) {
        // Sums of the sizes of what any of the variables changes.
        let depends = &mut self.slopes_here.coefficients;
        depends.fill(0.0);
        for &variable in by {
            let slopes = &mut self.slopes.coefficients;
            self.field.coefficients_by(variable, slopes);
            let both = depends.iter_mut().zip(&*slopes);
            both.for_each(|(sum, slope)| *sum += slope.abs());
        }
        for (contact, scales) in self.sharp.iter_mut().enumerate() {
            let of = &self.field.contacts[contact];
            if let Some(scales) = scales {
                scales.set(&of.arguments, &of.levels);
            }
        }
        for (contact, powers) in self.powers.iter_mut().enumerate() {
            let facts = self.field.law(contact).facts();
            let arguments = &self.field.contacts[contact].arguments;
            let used = |term: &&TermFacts| match term.of {
                Quantity::ByArgument(argument) => {
                    !by.is_empty() && self.field.depends(contact, argument, depends)
                }
                _ => true,
            };
            for (piece, powers) in facts.pieces.iter().zip(powers) {
                let terms = piece.terms.iter().filter(used);
                let lower = terms
                    .clone()
                    .map(|term| (term.lower.value(arguments), term.logarithm));
                let upper = terms.map(|term| (term.upper.value(arguments), term.logarithm));
                *powers = [grading::power_for(&lower), grading::power_for(&upper)];
            }
        }
    }

    /// Whether a law changes between the nodes of the trial where they do not see it.
    pub(super) fn overlooks(&mut self) -> bool {
        if self.trial.width.abs() < NARROW {
            return false;
        }
        let contacts = self.sharp.iter_mut().zip(&self.batch.contacts);
        let mut contacts = contacts.zip(&self.here.pieces);
        contacts.any(|((scales, samples), &piece)| {
            let [gap, rate] = samples.motion();
            scales
                .as_mut()
                .is_some_and(|scales| scales.look(piece, gap, rate, PART) == Sight::Missed)
        })
    }

    /// The power at a level, from the side of the present piece.
    pub(super) fn power(&self, contact: usize, level: usize) -> u32 {
        let piece = self.here.pieces[contact];
        self.powers[contact][piece][usize::from(level == piece)]
    }

    /// The power at the start of a step from here.
    pub(super) fn start_power(&self) -> u32 {
        let standing = self.here.on.iter().enumerate();
        standing
            .filter_map(|(contact, on)| on.map(|level| self.power(contact, level)))
            .max()
            .unwrap_or(1)
    }

    /// The position of the tables of a map.
    pub(super) fn table(&mut self, map: Map) -> usize {
        let known = self.tables.iter().position(|tables| tables.map == map);
        known.unwrap_or_else(|| {
            self.tables.push(Tables::kept(&self.rule, map));
            self.tables.len() - 1
        })
    }

    /// Evaluates the acceleration here.
    pub(super) fn accelerate_here(&mut self) {
        let phase = self.phase();
        let batch = &mut self.instant;
        self.field.place(batch, phase, 0.0, (&[0.0], &[1.0]));
        for i in 0..self.here.q.len() {
            (batch.q[i], batch.v[i]) = ([self.here.q[i]], [self.here.v[i]]);
            batch.shift[0][i] = [0.0];
            batch.ends[0][i] = self.here.q[i];
        }
        for (anchor, gap) in self.anchors.iter_mut().zip(&self.here.gaps) {
            *anchor = Anchor {
                end: End::Start,
                gap: gap.value,
            };
        }
        self.field
            .accelerate(batch, &self.here.pieces, &self.anchors);
        self.work.forces += 1;
    }

    /// Counts a step, unless the motion was cancelled.
    pub(super) fn count_step(&mut self) -> Result<(), FlowError> {
        if self.cancel.is_cancelled() {
            let phase = self.phase();
            return Err(FlowError::Cancelled { phase });
        }
        if (self.here.passed - self.steps.1).abs() > TAU {
            self.steps = (0, self.here.passed);
        }
        self.steps.0 += 1;
        if self.steps.0 > MOST_STEPS {
            return Err(FlowError::TooManySteps {
                phase: self.phase(),
                steps: self.steps.0,
            });
        }
        Ok(())
    }

    /// Counts a switch.
    pub(super) fn count_switch(&mut self) -> Result<(), FlowError> {
        self.work.switches += 1;
        if (self.here.passed - self.switches.1).abs() > TAU {
            self.switches = (0, self.here.passed);
        }
        self.switches.0 += 1;
        let most = MOST_SWITCHES * self.here.on.len().max(1);
        if self.switches.0 > most {
            return Err(FlowError::TooManySwitches {
                phase: self.phase(),
                switches: self.switches.0,
            });
        }
        Ok(())
    }
}

/// The scales that errors of each coordinate and of its rate are relative to, from sizes.
pub(super) fn write_scales(sizes: &[[f64; 2]], base: f64, scales: &mut [[f64; 2]]) {
    let largest = |part: usize| sizes.iter().fold(0.0_f64, |m, size| m.max(size[part]));
    let [q, v] = [0, 1].map(|part| LEAST_SCALE * largest(part));
    for (scale, size) in scales.iter_mut().zip(sizes) {
        let position = size[0].max(q);
        let rate = size[1].max(v).max(base.abs() * position);
        *scale = [position.max(f64::MIN_POSITIVE), rate.max(f64::MIN_POSITIVE)];
    }
}

/// Steps within one period, those that were tried and not taken among them.
const MOST_STEPS: usize = 400_000;

/// Switches of one contact within one period.
const MOST_SWITCHES: usize = 2000;
