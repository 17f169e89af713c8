//! Where an orbit's switches are, before there are equations: from samples of a motion, or from an orbit of other equations.
//!
//! Switches that may meet are told in pairs ([`skeleton`](super::skeleton)): those with a short way between them, and the extremes of gaps
//! that are short of a level.

use super::equations::{Equations, Setting};
use super::motion::{GapExtreme, Motion};
use super::skeleton::{Beginning, Placed, Resolution, Skeleton, Switch, Told};
use super::values::{Values, dot};
use crate::law::{Derivatives, Law, On};
use crate::numeric::roots::{self, Place};

/// Samples in a period of the declaration.
const SAMPLES: f64 = 400.0;
/// Two switches of a gap at one level with a shorter way between them are a pair; pairs part beyond the other length.
const SHORT: f64 = 0.5;
pub(super) const SHORTER: f64 = 0.4;
/// The beginning is not moved where the way around it is as short as this.
pub(super) const CLOSE: f64 = 0.1;
pub(super) const LONG: f64 = 1.4;
/// An extreme is watched from this `H` on until it is less than the other one.
pub(super) const NEAR: f64 = -0.4;
pub(super) const FAR: f64 = -1.0;
/// Extremes are watched as long as those of the other kind are farther than this phase, and from the other one on.
pub(super) const TOO_NEAR: f64 = 0.3;
pub(super) const LONELY: f64 = 0.45;
/// Where a period begins, in parts of the way between two switches, or of the period where there are none: not where a motion that is
/// symmetric in time turns.
const ASIDE: f64 = 0.46;
const ANYWHERE: f64 = 0.0217;
/// A switch of an orbit near another one has moved by less than this phase.
const MOVED: f64 = 0.7;
/// Phase over which a gap is differentiated twice.
const BEND: f64 = 1e-3;

/// Positions and velocities at a phase.
pub(super) type At<'a> = &'a dyn Fn(f64, &mut [f64]);

/// A switch with the value of its unknown, and the phase that it has in the order of time.
#[derive(Debug, Clone, Copy)]
struct Planned {
    placed: Placed,
    /// Middle or `H` where it is one of two.
    value: f64,
}

/// Gaps of a motion that is given by samples.
pub(super) struct Gaps<'a> {
    pub(super) values: &'a Values,
    pub(super) at: At<'a>,
    pub(super) coordinates: usize,
}

impl Gaps<'_> {
    /// Positions and velocities at a phase.
    fn state(&self, phase: f64) -> Vec<f64> {
        let mut state = vec![0.0; 2 * self.coordinates];
        (self.at)(phase, &mut state);
        state
    }

    /// States of the linear part at a phase.
    fn states(&self, phase: f64) -> Vec<f64> {
        self.values.linear.states(&self.state(phase))
    }

    /// Gap and rate by the time.
    pub(super) fn gap(&self, contact: usize, phase: f64) -> [f64; 2] {
        let states = self.states(phase);
        let of = &self.values.contacts[contact];
        let mut row = vec![0.0; states.len()];
        of.gap.write(phase, 0, &mut row);
        let gap = dot(&row, &states) - of.offset.value(phase, 0);
        of.gap.write(phase, 1, &mut row);
        let turning = dot(&row, &states) - of.offset.value(phase, 1);
        of.rate.write(phase, 0, &mut row);
        [gap, dot(&row, &states) + self.values.base * turning]
    }

    /// Half of the second derivative by the phase, beside a phase on both sides.
    pub(super) fn bend(&self, contact: usize, phase: f64) -> f64 {
        let rate = |phase: f64| self.gap(contact, phase)[1];
        (rate(phase + BEND) - rate(phase - BEND)) / (4.0 * BEND * self.values.base)
    }
}

/// The plan of an orbit.
pub(super) struct Plan {
    beginning: Beginning,
    planned: Vec<Planned>,
}

impl Plan {
    /// Of a motion with a period of so long from phase zero.
    pub(super) fn sampled(gaps: &Gaps<'_>, length: f64) -> Self {
        let mut crossings = Vec::new();
        let mut extremes = Vec::new();
        for contact in 0..gaps.values.contacts.len() {
            let levels = &gaps.values.contacts[contact].levels;
            if !levels.is_empty() {
                look(gaps, contact, length, &mut crossings, &mut extremes);
            }
        }
        Self::of(gaps, length, crossings, &extremes)
    }

    /// From the places where gaps cross levels, and their extremes.
    pub(super) fn of(
        gaps: &Gaps<'_>,
        length: f64,
        mut crossings: Vec<Placed>,
        extremes: &[GapExtreme],
    ) -> Self {
        let mut short = Vec::new();
        for extreme in extremes {
            let levels = &gaps.values.contacts[extreme.contact].levels;
            if is_lonely(extreme, extremes, length, LONELY) {
                for level in 0..levels.len() {
                    short.extend(short_pair(gaps, extreme, level));
                }
            }
        }
        let known = crossings
            .iter()
            .chain(short.iter().map(|[(first, _), _]| first));
        let begin = beginning(gaps, length, known.map(|placed| placed.phase));
        let within = |phase: f64| begin + (phase - begin).rem_euclid(length);
        for placed in &mut crossings {
            placed.phase = within(placed.phase);
        }
        crossings.sort_by(|a, b| a.phase.total_cmp(&b.phase));
        let mut planned: Vec<Planned> = crossings
            .into_iter()
            .map(|placed| Planned {
                placed,
                value: placed.phase - begin,
            })
            .collect();
        pair_up(gaps, begin, &mut planned);
        for (mut placed, square) in short.into_iter().flatten() {
            placed.phase = within(placed.phase);
            let value = match placed.switch.told {
                Told::Second { .. } => square,
                _ => placed.phase - begin,
            };
            planned.push(Planned { placed, value });
        }
        planned.sort_by(|a, b| a.placed.phase.total_cmp(&b.placed.phase));
        join(&mut planned);
        let pieces = (0..gaps.values.contacts.len()).map(|contact| piece(gaps, contact, begin));
        Self {
            beginning: Beginning {
                phase: begin,
                length,
                pieces: pieces.collect(),
            },
            planned,
        }
    }

    /// The equations on it, and the extended unknowns of the motion.
    pub(super) fn equations(
        &self,
        setting: &Setting,
        value: f64,
        gaps: &Gaps<'_>,
        frame: &Frame,
    ) -> Option<(Equations, Vec<f64>)> {
        let placed: Vec<Placed> = self.planned.iter().map(|planned| planned.placed).collect();
        let skeleton = Skeleton::new(
            setting.system.as_ref(),
            &gaps.values.contacts,
            gaps.values.order(),
            &self.beginning,
            &placed,
            frame.resolution,
        );
        let reference = frame.reference.clone();
        let equations = Equations::new(setting.clone(), value, skeleton, reference, frame.size)?;
        let u = self.unknowns(&equations, gaps, value);
        Some((equations, u))
    }

    fn unknowns(&self, equations: &Equations, gaps: &Gaps<'_>, value: f64) -> Vec<f64> {
        let skeleton = &equations.skeleton;
        let mut u = gaps.state(skeleton.begin);
        for (x, origin) in u.iter_mut().zip(&equations.reference) {
            *x -= origin;
        }
        u.extend(self.planned.iter().map(|planned| planned.value));
        u.resize(skeleton.unknowns(), 0.0);
        u.push(value);
        write_forces(equations, gaps, &mut u);
        u
    }
}

/// Writes the forces at the nodes that the gaps of a motion have there.
fn write_forces(equations: &Equations, gaps: &Gaps<'_>, u: &mut [f64]) {
    let skeleton = &equations.skeleton;
    for interval in &skeleton.intervals {
        let from = skeleton.place(u, interval.from).phase;
        let length = skeleton.place(u, interval.to).phase - from;
        if length <= 0.0 {
            continue;
        }
        for active in &interval.active {
            let of = &gaps.values.contacts[active.contact];
            let law = equations.setting.system.law(of.law);
            for node in 0..interval.nodes.count() {
                let phase = from + interval.nodes.targets[node] * length;
                let [gap, rate] = gaps.gap(active.contact, phase);
                u[active.first + node] = force(law, &of.arguments, active.piece, gap, rate);
            }
        }
    }
}

/// The unknowns of an orbit of other equations, from the motion of their last pass, or `None` where these have no place for it. An orbit
/// near it has the unknowns `near` here.
pub(super) fn transferred(
    motion: &Motion<'_>,
    u: &[f64],
    gaps: &Gaps<'_>,
    equations: &Equations,
    near: &[f64],
) -> Option<Vec<f64>> {
    let (old, new) = (&motion.equations.skeleton, &equations.skeleton);
    let mut to = near.to_vec();
    to[near.len() - 1] = u[u.len() - 1];
    let state = gaps.state(new.begin);
    for ((x, state), origin) in to.iter_mut().zip(&state).zip(&equations.reference) {
        *x = state - origin;
    }
    let known = crossings(old, u);
    for (index, switch) in new.switches.iter().enumerate() {
        let slot = new.slot(index);
        match switch.told {
            Told::Alone => {
                let from = new.begin + near[slot];
                to[slot] = near[slot] + nearest(&known, switch, from, new.length)?;
            }
            Told::First { other, bend } => {
                let from = new.begin + near[slot];
                let pair = [switch, &new.switches[other]];
                let ends = pair.map(|switch| nearest(&known, switch, from, new.length));
                let [by, square] = match ends {
                    [Some(a), Some(b)] if a < b => [0.5 * (a + b), 0.25 * (b - a) * (b - a)],
                    _ => short_of(motion, gaps, switch, [from, bend])?,
                };
                to[slot] = near[slot] + by;
                to[new.slot(other)] = square;
            }
            Told::Second { .. } => {}
        }
    }
    write_forces(equations, gaps, &mut to);
    Some(to)
}

/// How far a phase is from another one, around a period of this length.
fn apart(phase: f64, from: f64, length: f64) -> f64 {
    let ahead = (phase - from).rem_euclid(length);
    if ahead > 0.5 * length {
        ahead - length
    } else {
        ahead
    }
}

/// How far the nearest crossing of the same kind is from a phase.
fn nearest(known: &[Placed], switch: &Switch, from: f64, length: f64) -> Option<f64> {
    let place = |switch: &Switch| (switch.contact, switch.level, switch.rises);
    known
        .iter()
        .filter(|placed| place(&placed.switch) == place(switch))
        .map(|placed| apart(placed.phase, from, length))
        .min_by(|a, b| a.abs().total_cmp(&b.abs()))
        .filter(|apart| apart.abs() < MOVED)
}

/// How far the extreme that is short of a level is from a phase, and its `H`.
fn short_of(
    motion: &Motion<'_>,
    gaps: &Gaps<'_>,
    switch: &Switch,
    [from, bend]: [f64; 2],
) -> Option<[f64; 2]> {
    let extremes = &motion.extremes().gaps[switch.contact];
    let length = motion.equations.skeleton.length;
    let level = gaps.values.contacts[switch.contact].levels[switch.level];
    let found = extremes
        .iter()
        .filter(|extreme| extreme.maximum == switch.rises)
        .map(|extreme| {
            [
                apart(extreme.phase, from, length),
                -(extreme.gap - level) / bend,
            ]
        })
        .min_by(|a, b| a[0].abs().total_cmp(&b[0].abs()))?;
    (found[0].abs() < MOVED && found[1] <= 0.0).then_some(found)
}

/// The crossings of an orbit.
fn crossings(skeleton: &Skeleton, u: &[f64]) -> Vec<Placed> {
    let mut crossings = Vec::new();
    for (index, switch) in skeleton.switches.iter().enumerate() {
        let square = match switch.told {
            Told::Alone => f64::INFINITY,
            Told::First { other, .. } => u[skeleton.slot(other)],
            Told::Second { .. } => u[skeleton.slot(index)],
        };
        if square > 0.0 {
            crossings.push(Placed {
                switch: Switch {
                    told: Told::Alone,
                    ..*switch
                },
                phase: skeleton.phase(u, index),
            });
        }
    }
    crossings
}

/// What the unknowns of a branch count from.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    /// Positions and velocities.
    pub(super) reference: Vec<f64>,
    pub(super) size: f64,
    pub(super) resolution: Resolution,
}

/// Force on a piece. Beyond its levels, where a guess may lie, it is that at the level.
fn force(law: &dyn Law, arguments: &[f64], piece: usize, gap: f64, rate: f64) -> f64 {
    let mut levels = vec![0.0; law.facts().levels.len()];
    law.levels(arguments, &mut levels);
    let above = piece
        .checked_sub(1)
        .map_or(f64::NEG_INFINITY, |level| levels[level]);
    let below = levels.get(piece).copied().unwrap_or(f64::INFINITY);
    let (mut force, mut by_gap, mut by_rate) = ([0.0], [0.0], [0.0]);
    let out = Derivatives {
        force: &mut force,
        by_gap: &mut by_gap,
        by_rate: &mut by_rate,
    };
    law.derivatives(
        On::Piece(piece),
        arguments,
        &[gap.clamp(above, below)],
        &[rate],
        out,
    );
    force[0]
}

/// Crossings of levels and extremes of a gap, from samples.
fn look(
    gaps: &Gaps<'_>,
    contact: usize,
    length: f64,
    crossings: &mut Vec<Placed>,
    extremes: &mut Vec<GapExtreme>,
) {
    let levels = &gaps.values.contacts[contact].levels;
    let samples = (SAMPLES * length / std::f64::consts::TAU).ceil() as usize;
    let at = |index: usize| {
        let phase = length * (index as f64 / samples as f64);
        (phase, gaps.gap(contact, phase))
    };
    let mut before = at(0);
    for index in 1..=samples {
        let next = at(index);
        let within = 1e-12 * length;
        // Between two samples the gap is followed to its extreme and from there.
        let mut ends = vec![before];
        if before.1[1] * next.1[1] < 0.0 {
            let [a, b] = [before, next].map(|(x, gap)| Place { x, value: gap[1] });
            if let Some(phase) = roots::root(a, b, within, |x| gaps.gap(contact, x)[1]) {
                let gap = gaps.gap(contact, phase);
                extremes.push(GapExtreme {
                    contact,
                    interval: 0,
                    phase,
                    gap: gap[0],
                    maximum: a.value > 0.0,
                });
                ends.push((phase, gap));
            }
        }
        ends.push(next);
        for pair in ends.windows(2) {
            for (level, value) in levels.iter().enumerate() {
                let [a, b] = [pair[0], pair[1]].map(|(x, gap)| Place {
                    x,
                    value: gap[0] - value,
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

/// In the middle of the longest way between two of these phases, of those where all gaps are at their lowest if there are any.
fn beginning(gaps: &Gaps<'_>, length: f64, phases: impl Iterator<Item = f64>) -> f64 {
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

/// Whether an extreme is away from those of the other kind of its gap. Two that meet are none any more.
pub(super) fn is_lonely(
    extreme: &GapExtreme,
    extremes: &[GapExtreme],
    length: f64,
    distance: f64,
) -> bool {
    extremes.iter().all(|other| {
        other.contact != extreme.contact
            || other.maximum == extreme.maximum
            || apart(other.phase, extreme.phase, length).abs() > distance
    })
}

/// The piece that a gap is on.
fn piece(gaps: &Gaps<'_>, contact: usize, phase: f64) -> usize {
    let gap = gaps.gap(contact, phase)[0];
    let levels = gaps.values.contacts[contact].levels.iter();
    levels.filter(|level| gap > **level).count()
}

/// Makes pairs of switches with a short way between them, the shortest first.
fn pair_up(gaps: &Gaps<'_>, begin: f64, planned: &mut [Planned]) {
    loop {
        let mut best: Option<(f64, usize)> = None;
        for index in 1..planned.len() {
            let [a, b] = [planned[index - 1].placed, planned[index].placed];
            let same = (a.switch.contact, a.switch.level) == (b.switch.contact, b.switch.level);
            let alone = a.switch.told == Told::Alone && b.switch.told == Told::Alone;
            let way = b.phase - a.phase;
            if same && alone && a.switch.rises != b.switch.rises && way < SHORT {
                best = best.filter(|best| best.0 <= way).or(Some((way, index)));
            }
        }
        let Some((way, second)) = best else { return };
        let first = second - 1;
        let middle = planned[first].placed.phase + 0.5 * way;
        let contact = planned[first].placed.switch.contact;
        let half = 0.5 * way;
        let beside = half.max(BEND);
        let rates = [middle - beside, middle + beside].map(|phase| gaps.gap(contact, phase)[1]);
        let bend = (rates[1] - rates[0]) / (4.0 * beside * gaps.values.base);
        planned[first].placed.switch.told = Told::First {
            other: second,
            bend,
        };
        planned[first].value = middle - begin;
        planned[second].placed.switch.told = Told::Second { other: first };
        planned[second].value = half * half;
    }
}

/// The two switches that watch an extreme which is short of a level by little, both at its phase, with `H`.
fn short_pair(gaps: &Gaps<'_>, extreme: &GapExtreme, level: usize) -> Option<[(Placed, f64); 2]> {
    let short = extreme.gap - gaps.values.contacts[extreme.contact].levels[level];
    if (short < 0.0) != extreme.maximum {
        return None;
    }
    let bend = gaps.bend(extreme.contact, extreme.phase);
    let square = -short / bend;
    if !(NEAR..=0.0).contains(&square) {
        return None;
    }
    let switch = |rises: bool, told: Told| Placed {
        switch: Switch {
            contact: extreme.contact,
            level,
            rises,
            told,
        },
        phase: extreme.phase,
    };
    // The place of the other one is written by `join`.
    let first = switch(extreme.maximum, Told::First { other: 0, bend });
    let second = switch(!extreme.maximum, Told::Second { other: 0 });
    Some([(first, square), (second, square)])
}

/// Tells the two of every pair of each other: of a contact at a level the second follows the first.
fn join(planned: &mut [Planned]) {
    for first in 0..planned.len() {
        let own = planned[first].placed.switch;
        let Told::First { bend, .. } = own.told else {
            continue;
        };
        let is_second = |planned: &Planned| {
            let switch = planned.placed.switch;
            matches!(switch.told, Told::Second { .. })
                && (switch.contact, switch.level) == (own.contact, own.level)
        };
        let Some(after) = planned[first + 1..].iter().position(is_second) else {
            continue;
        };
        let second = first + 1 + after;
        planned[first].placed.switch.told = Told::First {
            other: second,
            bend,
        };
        planned[second].placed.switch.told = Told::Second { other: first };
    }
}

/// Adds the switches around an extreme that is beyond the levels of its piece, where the parabola of the gap has them.
fn add_beyond(
    gaps: &Gaps<'_>,
    skeleton: &Skeleton,
    extreme: &GapExtreme,
    crossings: &mut Vec<Placed>,
) {
    let GapExtreme {
        contact,
        interval,
        phase,
        gap,
        maximum,
    } = *extreme;
    let piece = skeleton.intervals[interval].pieces[contact];
    for (level, value) in gaps.values.contacts[contact].levels.iter().enumerate() {
        let beyond = if level < piece {
            gap < *value
        } else {
            gap > *value
        };
        if !beyond || maximum != (level >= piece) {
            continue;
        }
        let square = (value - gap) / gaps.bend(contact, phase);
        if square.is_nan() || square <= 0.0 {
            continue;
        }
        let half = square.sqrt();
        for (rises, phase) in [(maximum, phase - half), (!maximum, phase + half)] {
            crossings.push(Placed {
                switch: Switch {
                    contact,
                    level,
                    rises,
                    told: Told::Alone,
                },
                phase,
            });
        }
    }
}

/// The plan of an orbit of other equations, from the motion of their last pass.
pub(super) fn replanned(motion: &Motion<'_>, u: &[f64], gaps: &Gaps<'_>) -> Plan {
    let skeleton = &motion.equations.skeleton;
    let mut crossings = crossings(skeleton, u);
    let extremes = motion.extremes().gaps.concat();
    for extreme in &extremes {
        add_beyond(gaps, skeleton, extreme, &mut crossings);
    }
    Plan::of(gaps, skeleton.length, crossings, &extremes)
}
