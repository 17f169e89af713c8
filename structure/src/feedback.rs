//! What the forces of contacts make of an error of the compliance.
//!
//! The gaps of the whole structure differ from those of the reduced one by what the error of the compliance makes of the forces, `e_c`, and
//! by what the reduced structure answers to the forces `-p_c` that contacts change by for that. With the slopes `k_c` and `r_c` of their laws
//! by gap and rate along the orbit, and the compliance `R` along their directions, which may turn ([`crate::arms`]),
//!
//! ```text
//! p_c = k_c (e_c - sum_b R_cb p_b) + r_c (e_c - sum_b R_cb p_b)'                                              (1)
//! ```
//!
//! which is linear in `p`, at equal times of the period where a contact has a slope at all. What an output differs by for that is
//! `-sum_b R_yb p_b`. The phases of `e` are not known: every harmonic of it at every contact is taken by itself, and all of what they come to
//! is added up.
//!
//! At a fold (1) is singular: at a fixed frequency there is no bound. There the part along the branch is left out, and what is said is how
//! far the two branches are apart.
//!
//! Source: Krack and Gross (2019), Harmonic Balance for Nonlinear Vibration Problems, section 2.4 (alternating between frequency and time);
//! Nayfeh and Balachandran (1995), Applied Nonlinear Dynamics, section 3.2 (the variational equation).

use std::f64::consts::TAU;

use hertzian::Complex;
use hertzian::structure::DMatrix;

use crate::arms::Arm;
use crate::doubt::{self, COUPLED};
use crate::gaps::{Slopes, TIMES};
use crate::reduced::Reduced;

/// Times at which some contact has a slope, at most: beyond, every second, third and so on is left out.
const UNKNOWNS: usize = 600;
/// Harmonics of less than this part of the largest do not matter.
const NOTHING: f64 = 1e-4;
/// A frequency of zero is this part of the excitation's highest one where nothing holds the structure but its contacts.
const SLOW: f64 = 1e-4;

/// What is read: a row of the reduced structure, and its derivatives by time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Read {
    pub(crate) row: usize,
    pub(crate) derivatives: i32,
}

/// A harmonic of the amplitude `off` by which what is along a row is off. All contacts along it are off together.
#[derive(Debug, Clone, Copy)]
struct Source {
    row: usize,
    harmonic: usize,
    off: f64,
}

impl Source {
    /// Its cosine, or sine, and the rate of that.
    fn at(self, time: usize, part: usize, base: f64) -> [f64; 2] {
        let phase = TAU * ((self.harmonic * time) % TIMES) as f64 / TIMES as f64;
        let phase = phase - TAU / 4.0 * part as f64;
        let rate = -(self.harmonic as f64) * base * phase.sin();
        [self.off * phase.cos(), self.off * rate]
    }
}

/// An orbit of a reduced structure, and what its contacts do there.
#[derive(Debug)]
pub(crate) struct Feedback<'r> {
    reduced: &'r Reduced,
    base: f64,
    channels: Vec<Channel>,
    /// Amplitudes of all vectors for a force along each channel, harmonic by harmonic.
    answers: Vec<DMatrix<Complex<f64>>>,
    slopes: Vec<Slopes>,
    /// Whether the branch turns at the orbit.
    at_fold: bool,
    /// Contact and time of each unknown.
    unknowns: Vec<(usize, usize)>,
    /// The matrix of (1).
    matrix: Option<DMatrix<f64>>,
}

/// An arm of a contact.
#[derive(Debug)]
struct Channel {
    contact: usize,
    arm: Arm,
    /// The first row like that along which it is read.
    row: usize,
    /// Its weight and the rate of that at all times.
    weights: Vec<[f64; 2]>,
}

/// Inverse iterations for the direction in which a matrix is nearest to a singular one.
const ITERATIONS: usize = 4;

/// The direction in which forces change along a branch at a fold of it: that of the smallest singular value.
fn along_branch(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (straight, transposed) = (matrix.clone().lu(), matrix.transpose().lu());
    let mut along = DMatrix::from_element(matrix.nrows(), 1, 1.0);
    for _ in 0..ITERATIONS {
        along = straight.solve(&transposed.solve(&along)?)?;
        let size = along.norm();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        along /= size;
    }
    Some(along)
}

/// By how much something that is read changes at most.
#[derive(Debug, Clone)]
pub(crate) struct Changed {
    /// At any time.
    pub(crate) largest: f64,
    /// The same without the mean.
    pub(crate) swing: f64,
    /// In the mean, and in the amplitude of each harmonic.
    pub(crate) harmonics: Vec<f64>,
}

impl Changed {
    /// All by as much.
    fn by(much: f64) -> Self {
        Self {
            largest: much,
            swing: much,
            harmonics: vec![much; TIMES / 2],
        }
    }
}

/// The largest value of what all sources come to, of which two columns are cosine and sine, with or without its mean.
fn largest(changes: &DMatrix<f64>, about_mean: bool) -> f64 {
    let of = |source: usize| {
        let means = [0, 1].map(|part| {
            let mean = changes.column(2 * source + part).sum() / TIMES as f64;
            if about_mean { mean } else { 0.0 }
        });
        let at = |time: usize, part: usize| changes[(time, 2 * source + part)] - means[part];
        let both = (0..TIMES).map(|time| at(time, 0).hypot(at(time, 1)));
        both.fold(0.0, f64::max)
    };
    (0..changes.ncols() / 2).map(of).sum()
}

/// Amplitudes of harmonics of what all sources come to, of which two columns are cosine and sine; their phases are not known.
fn harmonics(changes: &DMatrix<f64>) -> Vec<f64> {
    let circle = (0..TIMES).map(|i| (TAU * i as f64 / TIMES as f64).sin_cos());
    let circle: Vec<(f64, f64)> = circle.collect();
    let amplitude = |column: usize, harmonic: usize| {
        let mut sum = Complex::new(0.0, 0.0);
        for time in 0..TIMES {
            let (sine, cosine) = circle[(harmonic * time) % TIMES];
            sum += Complex::new(cosine, sine) * changes[(time, column)];
        }
        let times = if harmonic == 0 { 1.0 } else { 2.0 };
        times * sum.norm() / TIMES as f64
    };
    let of = |harmonic: usize| {
        let sources = 0..changes.ncols() / 2;
        let both =
            sources.map(|i| amplitude(2 * i, harmonic).hypot(amplitude(2 * i + 1, harmonic)));
        both.sum()
    };
    (0..TIMES / 2).map(of).collect()
}

/// Values of a periodic function at all times, by its harmonics.
fn over_period(harmonics: &[Complex<f64>]) -> Vec<f64> {
    let at = |time: usize| {
        let terms = harmonics.iter().enumerate().skip(1);
        let terms = terms.map(|(k, z)| {
            let phase = TAU * ((k * time) % TIMES) as f64 / TIMES as f64;
            2.0 * (z.re * phase.cos() - z.im * phase.sin())
        });
        harmonics[0].re + terms.sum::<f64>()
    };
    (0..TIMES).map(at).collect()
}

/// Amplitudes of all vectors for a force along each channel.
fn answer(
    reduced: &Reduced,
    damping: &DMatrix<f64>,
    channels: &[Channel],
    harmonic: usize,
    base: f64,
) -> DMatrix<Complex<f64>> {
    let m = reduced.vectors();
    let frequency = (harmonic as f64 * base).max(SLOW * reduced.to);
    let push = DMatrix::from_fn(m, channels.len(), |i, j| {
        Complex::new(reduced.rows[channels[j].arm.driven][i], 0.0)
    });
    let apart = |i: usize, j: usize| damping[(i, j)] == 0.0 && damping[(j, i)] == 0.0;
    let is_diagonal = (0..m).all(|i| (0..i).all(|j| apart(i, j)));
    if !is_diagonal && harmonic <= COUPLED {
        let whole = doubt::dynamic(reduced, damping, frequency);
        if let Some(answer) = whole.lu().solve(&push) {
            return answer;
        }
    }
    let own = |i: usize| {
        let stiffness = reduced.squares[i] - frequency * frequency;
        Complex::new(stiffness, frequency * damping[(i, i)])
    };
    DMatrix::from_fn(m, channels.len(), |i, j| push[(i, j)] / own(i))
}

impl<'r> Feedback<'r> {
    /// Of an orbit of this base frequency, where the vectors have this damping.
    pub(crate) fn of(
        reduced: &'r Reduced,
        damping: &DMatrix<f64>,
        base: f64,
        slopes: Vec<Slopes>,
        arms: &[Vec<Arm>],
        at_fold: bool,
    ) -> Self {
        let channels = arms.iter().enumerate().flat_map(|(contact, arms)| {
            arms.iter().map(move |arm| Channel {
                contact,
                arm: *arm,
                row: reduced.first_like(arm.read),
                weights: (0..TIMES).map(|time| arm.at_time(time)).collect(),
            })
        });
        let channels: Vec<Channel> = channels.collect();
        let answers =
            (0..TIMES / 2).map(|harmonic| answer(reduced, damping, &channels, harmonic, base));
        let acts = |of: &Slopes, time: usize| of.by_gap[time] != 0.0 || of.by_rate[time] != 0.0;
        let all = slopes.iter().enumerate();
        let all = all.flat_map(|(contact, of)| {
            let times = (0..TIMES).filter(move |time| acts(of, *time));
            times.map(move |time| (contact, time))
        });
        let all: Vec<_> = all.collect();
        let every = all.len().div_ceil(UNKNOWNS).max(1);
        let unknowns = all.into_iter().step_by(every).collect();
        let mut feedback = Self {
            reduced,
            base,
            answers: answers.collect(),
            channels,
            slopes,
            at_fold,
            unknowns,
            matrix: None,
        };
        feedback.matrix = feedback.of_forces(every as f64);
        feedback
    }

    /// Harmonics of the answer to a force along a channel, one for each thing that is read.
    fn answers(&self, read: &[Read], channel: usize) -> Vec<Vec<Complex<f64>>> {
        let of = |read: &Read| {
            let row = &self.reduced.rows[read.row];
            let harmonics = self.answers.iter().enumerate();
            let harmonics = harmonics.map(|(harmonic, answer)| {
                let rate = Complex::new(0.0, harmonic as f64 * self.base);
                let terms = row.iter().enumerate();
                let terms = terms.map(|(i, d)| answer[(i, channel)] * *d);
                terms.sum::<Complex<f64>>() * rate.powi(read.derivatives)
            });
            harmonics.collect()
        };
        read.iter().map(of).collect()
    }

    /// `1 + k R + r R'` of (1), of forces each of which stands for so many times.
    fn of_forces(&self, each: f64) -> Option<DMatrix<f64>> {
        let n = self.unknowns.len();
        if n == 0 {
            return None;
        }
        let mut matrix = DMatrix::identity(n, n);
        let read = self.along_channels();
        for (pushed, push) in self.channels.iter().enumerate() {
            let kernels = self.kernels(&read, pushed, each);
            for (column, &(_, then)) in self.of_contact(push.contact) {
                let share = push.weights[then][0];
                for (row, &(contact, time)) in self.unknowns.iter().enumerate() {
                    let since = (TIMES + time - then) % TIMES;
                    let at = |of: &Vec<f64>| of[since];
                    let [gap, rate] = self.of_gap(contact, time, &kernels, at);
                    let slopes = &self.slopes[contact];
                    matrix[(row, column)] +=
                        share * (slopes.by_gap[time] * gap + slopes.by_rate[time] * rate);
                }
            }
        }
        Some(matrix)
    }

    /// What is along each channel, and its rate.
    fn along_channels(&self) -> Vec<Read> {
        let both = self.channels.iter().flat_map(|channel| {
            [0, 1].map(|derivatives| Read {
                row: channel.arm.read,
                derivatives,
            })
        });
        both.collect()
    }

    /// Gap and rate of a contact at a time, of what was read [along all channels](Self::along_channels).
    fn of_gap<T>(
        &self,
        contact: usize,
        time: usize,
        read: &[T],
        at: impl Fn(&T) -> f64,
    ) -> [f64; 2] {
        let own = self.channels.iter().zip(read.chunks_exact(2));
        let own = own.filter(|(channel, _)| channel.contact == contact);
        own.fold([0.0; 2], |[gap, rate], (channel, read)| {
            let [weight, by_time] = channel.weights[time];
            let [along, faster] = [at(&read[0]), at(&read[1])];
            [
                gap + weight * along,
                rate + weight * faster + by_time * along,
            ]
        })
    }

    fn of_contact(&self, wanted: usize) -> impl Iterator<Item = (usize, &(usize, usize))> {
        let unknowns = self.unknowns.iter().enumerate();
        unknowns.filter(move |(_, (contact, _))| *contact == wanted)
    }

    /// What a force at one time, which stands for so many, makes of what is read at each time after it.
    fn kernels(&self, read: &[Read], pushed: usize, each: f64) -> Vec<Vec<f64>> {
        let answers = self.answers(read, pushed);
        let share = each / TIMES as f64;
        let kernel = |answer: &Vec<Complex<f64>>| {
            let values = over_period(answer);
            values.into_iter().map(|x| share * x).collect()
        };
        answers.iter().map(kernel).collect()
    }

    /// The largest changes of everything that is read, where rows are off by these amplitudes of each harmonic; not numbers where forces are
    /// not determined.
    pub(crate) fn changes(&self, read: &[Read], off: &[(usize, Vec<f64>)]) -> Vec<Changed> {
        if self.matrix.is_none() {
            return vec![Changed::by(0.0); read.len()];
        }
        let Some(changes) = self.answered(read, &Self::sources(off)) else {
            return vec![Changed::by(f64::NAN); read.len()];
        };
        let changes = changes.iter().map(|changes| Changed {
            largest: largest(changes, false),
            swing: largest(changes, true),
            harmonics: harmonics(changes),
        });
        changes.collect()
    }

    /// By how much gaps, and then rates, of all contacts are off over time: two columns for cosine and sine of each harmonic by which one of them
    /// is off without what contacts make of that. None where forces are not determined.
    pub(crate) fn gaps_off(&self, off: &[(usize, Vec<f64>)]) -> Option<[Vec<DMatrix<f64>>; 2]> {
        let sources = Self::sources(off);
        let answered = self.answered(&self.along_channels(), &sources)?;
        let of = |derivatives: usize| {
            let all = (0..self.slopes.len()).map(|contact| {
                DMatrix::from_fn(TIMES, 2 * sources.len(), |time, column| {
                    let source = sources[column / 2];
                    let own = self.gap_of(source, contact, time, column % 2)[derivatives];
                    let at = |of: &DMatrix<f64>| of[(time, column)];
                    own - self.of_gap(contact, time, &answered, at)[derivatives]
                })
            });
            all.collect()
        };
        Some([of(0), of(1)])
    }

    /// What is read of the reduced structure for the forces that contacts change by, over time, a column for cosine and sine of each source.
    fn answered(&self, read: &[Read], sources: &[Source]) -> Option<Vec<DMatrix<f64>>> {
        let n = self.unknowns.len();
        let Some(matrix) = &self.matrix else {
            return Some(vec![DMatrix::zeros(TIMES, 2 * sources.len()); read.len()]);
        };
        let every = self.every();
        let mut forces = matrix.clone().lu().solve(&self.driven(sources))?;
        if self.at_fold
            && let Some(along) = along_branch(matrix)
        {
            let part = along.transpose() * &forces;
            forces -= along * part;
        }
        let mut whole = vec![DMatrix::<f64>::zeros(TIMES, n); read.len()];
        for (pushed, push) in self.channels.iter().enumerate() {
            let kernels = self.kernels(read, pushed, every);
            for (whole, kernel) in whole.iter_mut().zip(&kernels) {
                for (column, &(_, then)) in self.of_contact(push.contact) {
                    let share = push.weights[then][0];
                    for time in 0..TIMES {
                        whole[(time, column)] += share * kernel[(TIMES + time - then) % TIMES];
                    }
                }
            }
        }
        Some(whole.iter().map(|whole| whole * &forces).collect())
    }

    /// What a source makes of the gap of a contact at a time, and of its rate: of its cosine, or sine.
    fn gap_of(&self, source: Source, contact: usize, time: usize, part: usize) -> [f64; 2] {
        let own = self.channels.iter();
        let own = own.filter(|of| of.contact == contact && of.row == source.row);
        let [along, faster] = source.at(time, part, self.base);
        own.fold([0.0; 2], |[gap, rate], channel| {
            let [weight, by_time] = channel.weights[time];
            [
                gap + weight * along,
                rate + weight * faster + by_time * along,
            ]
        })
    }

    /// Every harmonic that a row is off by, where it matters.
    fn sources(off: &[(usize, Vec<f64>)]) -> Vec<Source> {
        let all = off.iter().flat_map(|(_, off)| off);
        let largest = all.fold(0.0, |most: f64, x| most.max(*x));
        let all = off.iter().flat_map(|(row, off)| {
            let harmonics = off.iter().enumerate();
            let matter = harmonics.filter(|(_, off)| **off > NOTHING * largest);
            matter.map(move |(harmonic, off)| Source {
                row: *row,
                harmonic,
                off: *off,
            })
        });
        all.collect()
    }

    /// The right-hand side of (1) for cosine and sine of every source.
    fn driven(&self, sources: &[Source]) -> DMatrix<f64> {
        let mut forces = DMatrix::zeros(self.unknowns.len(), 2 * sources.len());
        for (index, source) in sources.iter().enumerate() {
            for (row, &(contact, time)) in self.unknowns.iter().enumerate() {
                let slopes = &self.slopes[contact];
                for part in 0..2 {
                    let [gap, rate] = self.gap_of(*source, contact, time, part);
                    forces[(row, 2 * index + part)] =
                        slopes.by_gap[time] * gap + slopes.by_rate[time] * rate;
                }
            }
        }
        forces
    }

    /// How many times an unknown stands for.
    fn every(&self) -> f64 {
        let acts = |of: &Slopes| {
            let pairs = of.by_gap.iter().zip(&of.by_rate);
            pairs.filter(|(k, r)| **k != 0.0 || **r != 0.0).count()
        };
        let all: usize = self.slopes.iter().map(acts).sum();
        all.div_ceil(UNKNOWNS).max(1) as f64
    }
}
