//! The gaps of a motion that is given at any phase: where they cross levels, and their extremes.
//!
//! Gap and rate are sampled 400 times in a period of the declaration. A rate that changes its sign between two samples has an extreme there,
//! and a gap that changes sides of a level between two samples, or between one and an extreme, a crossing; both are located as roots. Two
//! extremes between the same samples are not seen. That is enough to begin: switches are unknowns of the equations that are made then, and
//! the extremes of the orbit that solves them are looked for anew, by [`extremes`](super::extremes).
//!
//! Half of the second derivative at an extreme is taken from rates on both sides,
//!
//! ```text
//! g''/2 = (g'(tau + d) - g'(tau - d)) / (4 d) + O(d^2)                                                         (1)
//! ```
//!
//! and with the second derivative of the rate, from the same ones, the next extreme of the gap is at
//!
//! ```text
//! 2 |g''/g'''| = d |g'(tau + d) - g'(tau - d)| / |g'(tau + d) - 2 g'(tau) + g'(tau - d)|                       (2)
//! ```
//!
//! if the third derivative stays as it is, which is `1 / (3 |l|)` with the lean of (4) of [`skeleton`](crate::contact_equation::skeleton). Where there is no extreme at that place, one is about to be born there with another, and this one moves as fast as if it
//! were about to end there.
//!
//! Source: Abramowitz and Stegun (1964), Handbook of Mathematical Functions, section 25.3 (numerical differentiation).

use crate::contact_equation::equations::pass_results::GapExtreme;
use crate::contact_equation::linear_part::values::Values;
use crate::contact_equation::skeleton::placement::{Placed, Switch, Told};
use crate::numeric::roots::{self, Place};

/// Samples in a period of the declaration.
const SAMPLES: f64 = 400.0;
/// Where a period begins, in parts of the way between two switches, or of the period where there are none: not where a motion that is
/// symmetric in time turns.
const ASIDE: f64 = 0.46;
const ANYWHERE: f64 = 0.0217;
/// Phase over which a gap is differentiated twice.
pub(in crate::contact_equation) const BEND: f64 = 1e-3;

/// Positions and velocities at a phase.
pub(in crate::contact_equation) type At<'a> = &'a dyn Fn(f64, &mut [f64]);

/// How a gap goes through an extreme, by the phase.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact_equation) struct Shape {
    /// Half of its second derivative.
    pub(in crate::contact_equation) bend: f64,
    /// How the middle of two crossings of a level beside it moves with `H`.
    pub(in crate::contact_equation) lean: f64,
}

/// Gaps of a motion that is given by samples.
pub(in crate::contact_equation) struct Gaps<'a> {
    pub(in crate::contact_equation) values: &'a Values,
    pub(in crate::contact_equation) at: At<'a>,
    pub(in crate::contact_equation) coordinates: usize,
}

impl Gaps<'_> {
    /// Positions and velocities at a phase.
    pub(in crate::contact_equation) fn state(&self, phase: f64) -> Vec<f64> {
        let mut state = vec![0.0; 2 * self.coordinates];
        (self.at)(phase, &mut state);
        state
    }

    /// Gap and rate by the time.
    pub(in crate::contact_equation) fn gap(&self, contact: usize, phase: f64) -> [f64; 2] {
        self.gap_of(contact, phase, &self.state(phase))
    }

    /// The same in a state.
    pub(in crate::contact_equation) fn gap_of(
        &self,
        contact: usize,
        phase: f64,
        state: &[f64],
    ) -> [f64; 2] {
        self.values.contacts[contact].gap_of(phase, self.values.base, state)
    }

    /// (1), by the phase.
    pub(in crate::contact_equation) fn bend(&self, contact: usize, phase: f64) -> f64 {
        self.shape(contact, phase, BEND).bend
    }

    /// (2): how far an extreme is from the one that its gap would have next.
    pub(in crate::contact_equation) fn lone(&self, contact: usize, phase: f64) -> f64 {
        1.0 / (3.0 * self.shape(contact, phase, BEND).lean.abs())
    }

    /// (1), and (4) of [`skeleton`](crate::contact_equation::skeleton) from the same rates, by the phase, over so much of it.
    pub(in crate::contact_equation) fn shape(&self, contact: usize, phase: f64, d: f64) -> Shape {
        let at = [phase - d, phase, phase + d];
        let [before, here, after] = at.map(|phase| self.gap(contact, phase)[1]);
        let lean = -(after - 2.0 * here + before) / (3.0 * d * (after - before));
        Shape {
            bend: (after - before) / (4.0 * d * self.values.base),
            lean: if lean.is_finite() { lean } else { 0.0 },
        }
    }
}

/// A gap with its rate at a phase.
#[derive(Debug, Clone, Copy)]
struct Sample {
    phase: f64,
    gap: [f64; 2],
}

/// Crossings of levels and extremes of all gaps from a phase on, from samples. The motion is looked at once for all of them.
pub(in crate::contact_equation) fn seen(
    gaps: &Gaps<'_>,
    from: f64,
    length: f64,
) -> (Vec<Placed>, Vec<GapExtreme>) {
    let (mut crossings, mut extremes) = (Vec::new(), Vec::new());
    let contacts = gaps.values.contacts.iter().enumerate();
    let contacts = contacts.filter(|(_, of)| !of.levels.is_empty());
    let contacts: Vec<usize> = contacts.map(|(contact, _)| contact).collect();
    if contacts.is_empty() {
        return (crossings, extremes);
    }
    let count = (SAMPLES * length / std::f64::consts::TAU).ceil() as usize;
    let mut samples = vec![Vec::with_capacity(count + 1); contacts.len()];
    let mut state = vec![0.0; 2 * gaps.coordinates];
    for index in 0..=count {
        let phase = from + length * (index as f64 / count as f64);
        (gaps.at)(phase, &mut state);
        for (contact, samples) in contacts.iter().zip(&mut samples) {
            samples.push(Sample {
                phase,
                gap: gaps.gap_of(*contact, phase, &state),
            });
        }
    }
    for (contact, samples) in contacts.iter().zip(&samples) {
        look(gaps, *contact, samples, &mut crossings, &mut extremes);
    }
    (crossings, extremes)
}

/// The same of one gap, from its samples.
fn look(
    gaps: &Gaps<'_>,
    contact: usize,
    samples: &[Sample],
    crossings: &mut Vec<Placed>,
    extremes: &mut Vec<GapExtreme>,
) {
    let levels = &gaps.values.contacts[contact].levels;
    let within = 1e-12 * (samples[samples.len() - 1].phase - samples[0].phase);
    let mut before = samples[0];
    for &next in &samples[1..] {
        // Between two samples the gap is followed to its extreme and from there.
        let mut ends = vec![before];
        if before.gap[1] * next.gap[1] < 0.0 {
            let [a, b] = [before, next].map(|at| Place {
                x: at.phase,
                value: at.gap[1],
            });
            if let Some(phase) = roots::root(a, b, within, |x| gaps.gap(contact, x)[1]) {
                let gap = gaps.gap(contact, phase);
                extremes.push(GapExtreme {
                    contact,
                    interval: 0,
                    phase,
                    gap: gap[0],
                    maximum: a.value > 0.0,
                });
                ends.push(Sample { phase, gap });
            }
        }
        ends.push(next);
        for pair in ends.windows(2) {
            for (level, value) in levels.iter().enumerate() {
                let [a, b] = [pair[0], pair[1]].map(|at| Place {
                    x: at.phase,
                    value: at.gap[0] - value,
                });
                if (a.value > 0.0) == (b.value > 0.0) {
                    continue;
                }
                let root = roots::root(a, b, within, |x| gaps.gap(contact, x)[0] - value);
                crossings.push(Placed {
                    switch: Switch {
                        contact,
                        level,
                        rises: b.value > 0.0,
                        told: Told::Alone,
                    },
                    phase: root.unwrap_or(b.x),
                });
            }
        }
        before = next;
    }
}

/// How far an extreme is from the nearest one of the other kind of its gap. Two that meet are none any more.
pub(in crate::contact_equation) fn room(
    extreme: &GapExtreme,
    extremes: &[GapExtreme],
    length: f64,
) -> f64 {
    extremes
        .iter()
        .filter(|other| other.contact == extreme.contact && other.maximum != extreme.maximum)
        .map(|other| apart(other.phase, extreme.phase, length).abs())
        .fold(f64::INFINITY, f64::min)
}

/// The piece that a gap is on.
pub(in crate::contact_equation) fn piece(gaps: &Gaps<'_>, contact: usize, phase: f64) -> usize {
    let gap = gaps.gap(contact, phase)[0];
    let levels = gaps.values.contacts[contact].levels.iter();
    levels.filter(|level| gap > **level).count()
}

/// In the middle of the longest way between two of these phases, of those where all gaps are at their lowest if there are any.
pub(in crate::contact_equation) fn beginning(
    gaps: &Gaps<'_>,
    length: f64,
    phases: impl Iterator<Item = f64>,
) -> f64 {
    let mut phases: Vec<f64> = phases.map(|phase| phase.rem_euclid(length)).collect();
    phases.sort_by(f64::total_cmp);
    let Some(last) = phases.last() else {
        return ANYWHERE * length;
    };
    let mut from = last - length;
    let mut best = (0.0, 0.0);
    for phase in phases {
        let way = phase - from;
        let middle = from + ASIDE * way;
        let open = (0..gaps.values.contacts.len()).all(|contact| {
            gaps.values.contacts[contact].levels.is_empty() || piece(gaps, contact, middle) == 0
        });
        let worth = if open { 2.0 * way } else { way };
        if worth > best.0 {
            best = (worth, middle);
        }
        from = phase;
    }
    best.1.rem_euclid(length)
}

/// How far a phase is from another one, around a period of this length.
pub(in crate::contact_equation) fn apart(phase: f64, from: f64, length: f64) -> f64 {
    let ahead = (phase - from).rem_euclid(length);
    if ahead > 0.5 * length {
        ahead - length
    } else {
        ahead
    }
}
