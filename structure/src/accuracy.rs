//! What the reduction changes of an orbit.
//!
//! The whole structure and the reduced one answer equal forces with amplitudes that differ by
//!
//! ```text
//! sum_c sum_k E_yc(k w) |f_ck| + sum_l E_yl(h_l w) |b_l|                                                      (1)
//! ```
//!
//! at most, of which the mean, `k = 0`, does not count in peak-to-peaks, with the errors `E` of the compliance and the harmonics `f_ck` of the forces that were computed; for a rate `E` is multiplied by
//! the frequency of its harmonic, for an acceleration by the square. Gaps differ as much, and change the forces, to which the reduced
//! structure answers with all of its compliance: that is added ([`crate::feedback`]). At a fold it is what lies beside the branch.
//! Both are of first order, and say too little where the stiffness of a contact is as large as one over the error of the compliance.

use hertzian::observe::Measure;
use hertzian::{Branch, Cancel, Point};

use crate::at_orbit::AtOrbit;
use crate::description::output::OutputKind;
use crate::description::structure::SparseStructure;
use crate::feedback::{Changed, Read};
use crate::multipliers::ReducedStability;
use crate::reduced::{Reduced, ReducedError};

/// A multiplier so near to one is that of a fold.
const TURNS: f64 = 1e-4;

/// What the reduction changes of an output at an orbit, to first order (1).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OutputError {
    /// The output.
    pub name: String,
    /// Of its peak-to-peak, as a part of it.
    pub error: f64,
    /// By how much it changes at most at any time, in its unit. Extremes change by no more.
    pub largest: f64,
    /// The same without the change of its mean: peak-to-peak changes by no more than twice of it.
    pub swing: f64,
    /// Of the root of its mean square, in its unit.
    pub rms: f64,
    /// Of its mean, and of the amplitude of each harmonic of the orbit from the first one on, in its unit. As many as 128 times of the
    /// period tell.
    pub harmonics: Vec<f64>,
}

impl OutputError {
    /// Of what is measured of the output, in its unit; none of what has no bound: of phases, and of the crest factor.
    pub fn of(&self, measure: Measure) -> Option<f64> {
        match measure {
            Measure::PeakToPeak => Some(2.0 * self.swing),
            Measure::Maximum | Measure::Minimum => Some(self.largest),
            Measure::Mean => self.harmonics.first().copied(),
            Measure::Rms => Some(self.rms),
            Measure::Amplitude(harmonic) => self.harmonics.get(harmonic).copied(),
            _ => None,
        }
    }
}

/// What a reduction changes along a branch of the reduced structure.
///
/// ```
/// use hertzian::observe::Measure;
/// use hertzian::structure::parameter;
/// use hertzian::{Cancel, FrequencyResponse};
/// use hertzian_structure::{Damping, Direction, Load, Reduction, SparseMatrix, SparseStructure};
///
/// // Two masses on three springs.
/// let of = |own: f64, beside: f64| {
///     let entries = [(0, 0, own), (0, 1, beside), (1, 0, beside), (1, 1, own)];
///     SparseMatrix::from_triplets(2, 2, entries)
/// };
/// let structure = SparseStructure::new(of(1.0, 0.0)?, of(2.0, -1.0)?)
///     .damping(Damping::ratio(0.05))
///     .load(Load::force(Direction::at(1), parameter("drive", 0.1)))
///     .output("first", Direction::at(0));
/// // One mode of the two. The other one has the static compliance 1/6 of that between the masses.
/// let reduced = Reduction::to(1.2).modes(1).steps(0).run(&structure)?;
/// let branch = FrequencyResponse::of(&reduced.structure(&structure)?).from(0.1).to(0.2).run()?;
/// let token = Cancel::new();
/// let effects = reduced.effects(&structure, &branch).cancel(&token);
/// let first = &effects.errors(&branch.points[0])?[0];
/// assert!((first.of(Measure::Amplitude(1)).unwrap() - 0.1 / 6.0).abs() < 2e-4);
/// token.cancel();
/// assert!(effects.errors(&branch.points[0]).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Effects<'r> {
    reduced: &'r Reduced,
    structure: &'r SparseStructure,
    branch: &'r Branch,
    cancel: Cancel,
}

impl Reduced {
    /// What the reduction changes along a branch of the [reduced structure](Self::structure).
    pub fn effects<'r>(
        &'r self,
        structure: &'r SparseStructure,
        branch: &'r Branch,
    ) -> Effects<'r> {
        Effects {
            reduced: self,
            structure,
            branch,
            cancel: Cancel::new(),
        }
    }

    /// What the reduction changes of each output of a structure at an orbit of a branch of it.
    ///
    /// # Errors
    /// If it is a reduction of [another structure](Self::is_of), or the orbit cannot be read.
    pub fn errors_at(
        &self,
        structure: &SparseStructure,
        branch: &Branch,
        point: &Point,
    ) -> Result<Vec<OutputError>, ReducedError> {
        self.effects(structure, branch).errors(point)
    }
}

impl Effects<'_> {
    /// Stops where the token is cancelled.
    #[must_use]
    pub fn cancel(mut self, cancel: &Cancel) -> Self {
        self.cancel = cancel.clone();
        self
    }

    /// At an orbit, which is read once for all that is asked of it.
    ///
    /// # Errors
    /// If it is a reduction of [another structure](Reduced::is_of), the orbit cannot be read, or it was cancelled.
    pub fn at<'e>(&'e self, point: &'e Point) -> Result<EffectsAt<'e>, ReducedError> {
        let Self {
            reduced,
            structure,
            branch,
            cancel,
        } = self;
        Ok(EffectsAt {
            at: AtOrbit::of(reduced, structure, branch, point, cancel)?,
            effects: self,
            point,
        })
    }

    /// Of each output at an orbit.
    ///
    /// # Errors
    /// As of [`at`](Self::at).
    pub fn errors(&self, point: &Point) -> Result<Vec<OutputError>, ReducedError> {
        self.at(point)?.errors()
    }

    /// Of Floquet multipliers at an orbit, and the verdict on the whole structure, as [`Reduced::stability_at`].
    ///
    /// # Errors
    /// As of [`at`](Self::at).
    pub fn stability(&self, point: &Point) -> Result<ReducedStability, ReducedError> {
        self.at(point)?.stability()
    }

    /// Of the frequency of each orbit of a branch of free oscillations, as [`Reduced::frequency_errors`].
    ///
    /// # Errors
    /// If it is a reduction of [another structure](Reduced::is_of), an orbit cannot be read, or it was cancelled.
    pub fn frequencies(&self) -> Result<Vec<f64>, ReducedError> {
        self.reduced
            .frequencies_until(self.structure, self.branch, &self.cancel)
    }
}

/// What a reduction changes at an orbit: see [`Effects::at`].
#[derive(Debug)]
pub struct EffectsAt<'e> {
    at: AtOrbit<'e>,
    effects: &'e Effects<'e>,
    point: &'e Point,
}

impl EffectsAt<'_> {
    /// Of each output.
    ///
    /// # Errors
    /// If it was cancelled.
    pub fn errors(&self) -> Result<Vec<OutputError>, ReducedError> {
        let Self { at, effects, point } = self;
        let structure = effects.structure;
        let feedback = at.feedback(effects.reduced, turns(point));
        let first = 2 * structure.contacts.len() + structure.loads.len();
        let read = structure.outputs.iter().enumerate();
        let read = read.map(|(index, output)| Read {
            row: first + index,
            derivatives: output.kind.derivatives(),
        });
        let read: Vec<_> = read.collect();
        if effects.cancel.is_cancelled() {
            return Err(ReducedError::Cancelled);
        }
        let changes = feedback.changes(&read, &at.off());
        let outputs = structure.outputs.iter().zip(&at.outputs);
        let changes = outputs.zip(read.iter().zip(changes));
        let errors = changes.map(|((output, motion), (read, change))| {
            let off = Off::of(at, read.row, output.kind, &change);
            OutputError {
                name: output.name.clone(),
                error: part(off.swing, motion.peak_to_peak()),
                swing: known(off.swing),
                rms: known(off.rms()),
                largest: known(off.largest),
                harmonics: off.harmonics.into_iter().map(known).collect(),
            }
        });
        Ok(errors.collect())
    }

    /// Of Floquet multipliers, and the verdict on the whole structure, as [`Reduced::stability_at`].
    ///
    /// # Errors
    /// If it was cancelled.
    pub fn stability(&self) -> Result<ReducedStability, ReducedError> {
        let Self { at, effects, point } = self;
        let Effects {
            reduced,
            structure,
            cancel,
            ..
        } = effects;
        reduced.stability_until(structure, at, point, cancel)
    }
}

/// By how much an output is off at most.
struct Off {
    largest: f64,
    /// The same without the mean.
    swing: f64,
    harmonics: Vec<f64>,
    /// Amplitudes of harmonics beyond, in sum.
    beyond: f64,
}

impl Off {
    /// (1), and what contacts make of it.
    fn of(at: &AtOrbit<'_>, row: usize, kind: OutputKind, change: &Changed) -> Self {
        let measured = &at.measured;
        let alone = measured.response_off(row, kind, at.base, &at.forces, &at.doubt);
        let harmonics = measured.harmonics_off(row, kind, at.base, &at.forces, &at.doubt);
        let beyond = alone - harmonics.iter().sum::<f64>();
        let both = harmonics.iter().zip(&change.harmonics);
        Self {
            largest: alone + change.largest,
            swing: alone - harmonics.first().copied().unwrap_or(0.0) + change.swing,
            harmonics: both.map(|(alone, change)| alone + change).collect(),
            beyond: beyond.max(0.0),
        }
    }

    /// The root of a sum is at most the sum of roots (Minkowski), and that of several harmonics at most their sum.
    fn rms(&self) -> f64 {
        let squares = self.harmonics.iter().enumerate();
        let squares = squares.map(|(k, x)| x * x * if k == 0 { 1.0 } else { 0.5 });
        (squares.sum::<f64>() + 0.5 * self.beyond * self.beyond).sqrt()
    }
}

/// Whether a branch turns at an orbit.
fn turns(point: &Point) -> bool {
    let mut multipliers = point.stability.multipliers.iter();
    multipliers.any(|multiplier| (multiplier - 1.0).norm() < TURNS)
}

/// What is not a number is unbounded.
fn known(error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { error }
}

/// What an amplitude is of a peak-to-peak; what is not a number is unbounded.
fn part(amplitude: f64, size: f64) -> f64 {
    if amplitude == 0.0 {
        0.0
    } else if amplitude.is_nan() {
        f64::INFINITY
    } else {
        2.0 * amplitude / size
    }
}
