//! What the reduction changes of the exponent of a Floquet mode.
//!
//! A mode pushes contacts with forces that have harmonics `p_bk` at the frequencies `k w + Im s`, and the adjoint mode answers to gaps that are off
//! there by `a_ck` ([`crate::floquet`]). The error `E` of the compliance changes the exponent by
//!
//! ```text
//! ds = sum_k sum_cb a_ck E_cb(k w + Im s) p_bk                                                                (1)
//! ```
//!
//! to first order. `E` is measured without damping. Where it is interpolated its sign is not known, and sizes are added up. With the compliance
//! itself instead of `E` the sum is minus what the mode keeps its forces up by: (1) is of first order where it is a small part of that.
//!
//! What is not known of damping is added ([`crate::doubt`]), and what contacts are otherwise where gaps of the orbit are off
//! ([`crate::feedback`]), whose phases are not known.
//!
//! Source: Yakubovich and Starzhinskii (1975), Linear Differential Equations with Periodic Coefficients, chapter IV.

use std::f64::consts::TAU;

use hertzian::Complex;
use hertzian::structure::DMatrix;

use crate::arms::Arm;
use crate::at_orbit::{AtOrbit, HARMONICS};
use crate::floquet::Mode;
use crate::gaps::{Gap, Slopes, TIMES};
use crate::reduced::Reduced;

/// Gaps and rates are moved by this part of their span at least to see what contacts are otherwise.
const MOVED: f64 = 1e-3;
/// Frequencies of modes are known to this part.
const KNOWN: f64 = 1e-9;
/// An error of a compliance that grows with this power of the frequency, the least one of static vectors, is turned by so many times the
/// damping ratio.
const POWER: f64 = 4.0;

/// Frequencies at which compliances are measured for a mode.
pub(crate) fn frequencies(mode: &Mode, base: f64) -> impl Iterator<Item = f64> {
    let near = HARMONICS as i32;
    let shift = mode.exponent.im;
    (-near..=near).map(move |k| (f64::from(k) * base + shift).abs())
}

/// What the reduction changes of an exponent.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Change {
    compliance: Compliance,
    /// The largest damping ratio of vectors besides modes.
    ratio: f64,
    /// By what frequencies of modes are known to.
    modes: f64,
    /// By ratios of damping, and by what damping couples vectors with.
    damping: [f64; 2],
    /// By other orbits, and the real part of that.
    orbit: [f64; 2],
}

impl Change {
    /// What is of the second and of higher orders: terms of a series in the part that is left of a geometric one. None is known where the error is
    /// no small part of what keeps the mode up.
    fn second(&self) -> f64 {
        let share = self.compliance.share();
        if share < 1.0 {
            self.compliance.sizes * share / (1.0 - share)
        } else {
            f64::INFINITY
        }
    }

    /// How much it is at most, with what is of the second order.
    pub(crate) fn most(&self) -> f64 {
        let damping = self.damping[0] + self.damping[1];
        self.compliance.sizes + self.second() + damping + self.orbit[0] + self.modes
    }

    /// How much of that is growth or decay.
    pub(crate) fn growth(&self) -> f64 {
        self.first_growth() + self.second() + self.damping[1]
    }

    /// To first order, without what damping couples the vectors with, which takes energy from what is left out.
    pub(crate) fn first_growth(&self) -> f64 {
        let Compliance {
            signed, unsigned, ..
        } = self.compliance;
        let turned = (POWER * self.ratio).min(1.0) * signed.norm();
        signed.re.abs() + turned + unsigned + self.damping[0] + self.orbit[1]
    }
}

/// What contacts are to motions beside an orbit, and otherwise for other orbits.
#[derive(Debug)]
pub(crate) struct Contacts {
    means: Vec<Slopes>,
    moved: Option<Moved>,
}

/// By how much gaps are off, and what contacts are otherwise for that: by gap, and by rate, of each contact.
#[derive(Debug)]
struct Moved {
    off: [Vec<DMatrix<f64>>; 2],
    slopes: [Vec<Slopes>; 2],
}

impl Contacts {
    /// At an orbit.
    pub(crate) fn of(reduced: &Reduced, at: &AtOrbit<'_>) -> Self {
        Self {
            means: at.gaps.iter().map(|gap| gap.means([0.0; 2])).collect(),
            moved: Moved::of(reduced, at),
        }
    }

    /// What changes the exponent of a mode, with compliances that are measured at its [frequencies].
    pub(crate) fn change(
        &self,
        reduced: &Reduced,
        at: &AtOrbit<'_>,
        measured: &Reduced,
        mode: &Mode,
    ) -> Change {
        let along = Along::of(reduced, &self.means, &at.arms, mode);
        let waves = Waves::new();
        let of_static = reduced.modes..reduced.vectors();
        let ratio = of_static.map(|i| {
            let critical = 2.0 * reduced.squares[i].max(0.0).sqrt();
            reduced.damping(i, i) / critical.max(f64::MIN_POSITIVE)
        });
        Change {
            compliance: along.by_compliance(&waves, at.base, measured),
            ratio: ratio.fold(0.0, f64::max),
            modes: KNOWN * mode.frequency(&reduced.frequencies()),
            damping: by_damping(&waves, reduced, at, mode),
            orbit: self
                .moved
                .as_ref()
                .map_or([f64::INFINITY; 2], |moved| along.by_orbit(moved)),
        }
    }
}

impl Moved {
    /// None where forces of contacts are not determined.
    fn of(reduced: &Reduced, at: &AtOrbit<'_>) -> Option<Self> {
        let off = at.feedback(reduced, false).gaps_off(&at.off())?;
        let slopes = [0, 1].map(|i| {
            let all = at.gaps.iter().zip(&off[i]);
            all.map(|(gap, off)| changed(gap, i, largest(off).max(MOVED * gap.spans()[i])))
                .collect()
        });
        Some(Self { off, slopes })
    }
}

/// The largest sum at a time of what all sources come to, of which two columns are cosine and sine.
fn largest(off: &DMatrix<f64>) -> f64 {
    let at = |time: usize| -> f64 {
        let sources = 0..off.ncols() / 2;
        let both = |i: usize| off[(time, 2 * i)].hypot(off[(time, 2 * i + 1)]);
        sources.map(both).sum()
    };
    (0..TIMES).map(at).fold(0.0, f64::max)
}

/// What means around all times change by where a gap, or its rate, is moved by one, of what moves by so much make of them.
fn changed(gap: &Gap<'_>, which: usize, by: f64) -> Slopes {
    let moved = |by: f64| {
        let mut both = [0.0; 2];
        both[which] = by;
        gap.means(both)
    };
    let (up, here, down) = (moved(by), moved(0.0), moved(-by));
    // The larger one of both sides: where a contact just closes, or a slope is even about the gap, they differ.
    let slope = |up: &[f64], here: &[f64], down: &[f64]| {
        let change = |to: f64, from: f64| if to == from { 0.0 } else { (to - from) / by };
        let all = up.iter().zip(here).zip(down);
        let sides = all.map(|((up, here), down)| [change(*up, *here), change(*here, *down)]);
        let larger = |[up, down]: [f64; 2]| if up.abs() > down.abs() { up } else { down };
        sides.map(larger).collect()
    };
    Slopes {
        by_gap: slope(&up.by_gap, &here.by_gap, &down.by_gap),
        by_rate: slope(&up.by_rate, &here.by_rate, &down.by_rate),
    }
}

/// Harmonics of what changes with the period, from that of the least frequency on, and what they are around it.
struct Waves {
    circle: Vec<Complex<f64>>,
}

impl Waves {
    fn new() -> Self {
        let at = |time: usize| Complex::from_polar(1.0, TAU * time as f64 / TIMES as f64);
        Self {
            circle: (0..TIMES).map(at).collect(),
        }
    }

    fn all() -> impl Iterator<Item = i32> {
        let half = (TIMES / 2) as i32;
        -half..half
    }

    /// Means of a function times `exp(i k w t)`, or with the other sign.
    fn means(&self, values: &[Complex<f64>], sign: i32) -> Vec<Complex<f64>> {
        let mean = |k: i32| {
            let each = (sign * k).rem_euclid(TIMES as i32) as usize;
            let terms = values.iter().enumerate();
            let terms = terms.map(|(time, x)| x * self.circle[(each * time) % TIMES]);
            terms.sum::<Complex<f64>>() / TIMES as f64
        };
        Self::all().map(mean).collect()
    }
}

/// What (1) comes to.
#[derive(Debug, Clone, Copy)]
struct Compliance {
    /// Of sizes of all terms.
    sizes: f64,
    /// With signs, as far as errors have any, and of sizes of the rest.
    signed: Complex<f64>,
    unsigned: f64,
    /// What the mode keeps its forces up by.
    kept: f64,
}

impl Compliance {
    fn share(&self) -> f64 {
        let size = self.signed.norm() + self.unsigned;
        if size == 0.0 { 0.0 } else { size / self.kept }
    }
}

/// A mode at contacts: gaps, rates of them, and the adjoint mode along forces, of each contact over time.
struct Along<'m> {
    mode: &'m Mode,
    means: &'m [Slopes],
    arms: &'m [Vec<Arm>],
    gaps: Vec<Vec<Complex<f64>>>,
    rates: Vec<Vec<Complex<f64>>>,
    adjoint: Vec<Vec<Complex<f64>>>,
}

impl<'m> Along<'m> {
    fn of(reduced: &Reduced, means: &'m [Slopes], arms: &'m [Vec<Arm>], mode: &'m Mode) -> Self {
        // Along the rows of all arms, times their weights or what these change by.
        let along = |vectors: &DMatrix<Complex<f64>>, row: &dyn Fn(&Arm) -> usize, which: usize| {
            let of = |arms: &Vec<Arm>| -> Vec<Complex<f64>> {
                let columns = vectors.column_iter().enumerate();
                let at = columns.map(|(time, column)| {
                    let terms = arms.iter().map(|arm| {
                        let pairs = column.iter().zip(&reduced.rows[row(arm)]);
                        pairs.map(|(x, d)| x * *d).sum::<Complex<f64>>() * arm.at_time(time)[which]
                    });
                    terms.sum()
                });
                at.collect()
            };
            arms.iter().map(of).collect::<Vec<_>>()
        };
        let (read, driven) = (&|arm: &Arm| arm.read, &|arm: &Arm| arm.driven);
        let mut rates = along(&mode.rates, read, 0);
        let turned = along(&mode.positions, read, 1);
        for (rates, turned) in rates.iter_mut().zip(&turned) {
            rates
                .iter_mut()
                .zip(turned)
                .for_each(|(rate, by)| *rate += by);
        }
        Self {
            mode,
            means,
            arms,
            gaps: along(&mode.positions, read, 0),
            rates,
            adjoint: along(&mode.adjoint, driven, 0),
        }
    }

    /// Force of a contact at a time, where it has these slopes.
    fn force(&self, contact: usize, time: usize, slopes: &Slopes) -> Complex<f64> {
        let (gap, rate) = (self.gaps[contact][time], self.rates[contact][time]);
        gap * slopes.by_gap[time] + rate * slopes.by_rate[time]
    }

    /// (1)
    fn by_compliance(&self, waves: &Waves, base: f64, measured: &Reduced) -> Compliance {
        let mut kept = Complex::new(0.0, 0.0);
        let (mut pushes, mut answers) = (Vec::new(), Vec::new());
        for (contact, means) in self.means.iter().enumerate() {
            let adjoint = &self.adjoint[contact];
            let force: Vec<_> = (0..TIMES)
                .map(|time| self.force(contact, time, means))
                .collect();
            let products = adjoint.iter().zip(&force).map(|(y, p)| y * p);
            kept += products.sum::<Complex<f64>>() / TIMES as f64;
            for arm in &self.arms[contact] {
                let times = |of: &dyn Fn(usize, [f64; 2]) -> f64| -> Vec<_> {
                    let adjoint = adjoint.iter().enumerate();
                    let all = adjoint.map(|(time, y)| y * of(time, arm.at_time(time)));
                    all.collect()
                };
                let by_gap = times(&|time, [weight, by_time]| {
                    weight * means.by_gap[time] + by_time * means.by_rate[time]
                });
                let by_gap = waves.means(&by_gap, 1);
                let by_rate = times(&|time, [weight, _]| weight * means.by_rate[time]);
                let by_rate = waves.means(&by_rate, 1);
                let both = Waves::all().zip(by_gap.iter().zip(&by_rate));
                let answer = both.map(|(k, (by_gap, by_rate))| {
                    by_gap + (self.mode.exponent + Complex::new(0.0, f64::from(k) * base)) * by_rate
                });
                answers.push((arm.read, answer.collect::<Vec<_>>()));
                let force = force.iter().enumerate();
                let force = force.map(|(time, p)| p * arm.at_time(time)[0]);
                pushes.push((arm.driven, waves.means(&force.collect::<Vec<_>>(), -1)));
            }
        }
        let mut found = Compliance {
            sizes: 0.0,
            signed: Complex::new(0.0, 0.0),
            unsigned: 0.0,
            kept: kept.norm(),
        };
        for (place, k) in Waves::all().enumerate() {
            let frequency = (f64::from(k) * base + self.mode.exponent.im).abs();
            // Forces and answers fall with the harmonic where contacts jump: those that are not seen come to what the upper half of the others does.
            let times = if k.unsigned_abs() as usize >= TIMES / 4 {
                2.0
            } else {
                1.0
            };
            for (read, answer) in &answers {
                for (pushed, push) in &pushes {
                    let product = answer[place] * push[place];
                    let error = measured.compliance_error(*read, *pushed, frequency);
                    let size = times * error * product.norm();
                    found.sizes += size;
                    match measured.measured_error(*read, *pushed, frequency) {
                        Some(error) => found.signed += product * error,
                        None => found.unsigned += size,
                    }
                }
            }
        }
        found
    }

    /// What contacts are otherwise where gaps of the orbit are off, and the real part of that.
    fn by_orbit(&self, moved: &Moved) -> [f64; 2] {
        let sources = moved.off[0].first().map_or(0, DMatrix::ncols);
        let mut changes = vec![Complex::new(0.0, 0.0); sources];
        for (off, slopes) in moved.off.iter().zip(&moved.slopes) {
            for (contact, (off, slopes)) in off.iter().zip(slopes).enumerate() {
                for time in 0..TIMES {
                    let force = self.force(contact, time, slopes);
                    let weight = self.adjoint[contact][time] * force / TIMES as f64;
                    for (source, change) in changes.iter_mut().enumerate() {
                        *change += weight * off[(time, source)];
                    }
                }
            }
        }
        let both = changes.chunks_exact(2);
        let sizes = both.map(|pair| {
            let (all, real) = (
                pair[0].norm().hypot(pair[1].norm()),
                pair[0].re.hypot(pair[1].re),
            );
            [all, real]
        });
        sizes.fold([0.0; 2], |[all, real], size| {
            [all + size[0], real + size[1]]
        })
    }
}

/// What is not known of damping.
fn by_damping(waves: &Waves, reduced: &Reduced, at: &AtOrbit<'_>, mode: &Mode) -> [f64; 2] {
    if at.doubt.is_none() {
        return [0.0; 2];
    }
    let of = |vectors: &DMatrix<Complex<f64>>, sign: i32| {
        let rows = vectors.row_iter();
        let rows = rows.map(|row| {
            let values: Vec<_> = row.iter().copied().collect();
            waves.means(&values, sign)
        });
        rows.collect::<Vec<_>>()
    };
    let (positions, adjoint) = (of(&mode.positions, -1), of(&mode.adjoint, 1));
    let terms = Waves::all().enumerate().map(|(place, k)| {
        let here =
            |all: &[Vec<Complex<f64>>]| -> Vec<_> { all.iter().map(|of| of[place]).collect() };
        let frequency = f64::from(k) * at.base + mode.exponent.im;
        let (positions, adjoint) = (here(&positions), here(&adjoint));
        at.doubt
            .of_exponent(reduced, frequency, &positions, &adjoint)
    });
    terms.fold([0.0; 2], |[ratios, coupled], term| {
        [ratios + term[0], coupled + term[1]]
    })
}
