//! Where an orbit's switches are, before there are equations: from samples of a motion, or from an orbit of other equations.
//!
//! Switches that may meet are told in pairs: those with a short way between them, and the extremes of gaps that are short of a level, with `H`
//! by (3) of [`skeleton`](crate::contact_equation::skeleton). How a motion is sampled is in [`gaps`](crate::contact_equation::orbit::gaps).

use crate::branches::recurrence::Recurrence;
use crate::contact_equation::equations::Equations;
use crate::contact_equation::equations::pass_results::GapExtreme;
use crate::contact_equation::equations::setting::{Frame, Setting};
use crate::contact_equation::linear_part::contact::Contact;
use crate::contact_equation::orbit::gaps::{BEND, Gaps, Shape, beginning, piece, room, seen};
use crate::contact_equation::orbit::kinks::kinks;
use crate::contact_equation::skeleton::Skeleton;
use crate::contact_equation::skeleton::placement::{
    Beginning, Placed, Placement, Switch, Told, length,
};
use crate::law::{Derivatives, Law, On};

/// Two switches of a gap at one level with a shorter way between them are a pair; pairs part beyond the other length.
const SHORT: f64 = 0.5;
pub(super) const SHORTER: f64 = 0.4;
/// The beginning is not moved where the way around it is as short as this.
pub(super) const CLOSE: f64 = 0.1;
pub(super) const LONG: f64 = 1.4;
/// An extreme is watched from this `-H` on until it is more than the other one. With another extreme of its gap at the phase `d` beside it a gap
/// falls by `g'' d^2 / 6` between both, an `H` of `d^2 / 3`, so that `-H` is looked at in parts of `d^2` too: none is watched where both meet.
pub(super) const NEAR: f64 = 0.4;
const FAR: f64 = 1.0;
const NEAR_ANOTHER: f64 = 0.75;
const FAR_FOR_ANOTHER: f64 = 1.5;
/// Where the force jumps at the level the orbit beyond it is another one at once, and extremes near each other change with it: there they are
/// watched from this phase between them on, and until it is the other one.
const LONELY: f64 = 0.45;
const TOO_NEAR: f64 = 0.3;
/// Extremes of different gaps as near as this are in one place.
const TOGETHER: f64 = 1e-6;

/// How far an extreme is from the next one of its gap.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room {
    /// From one that is there.
    seen: f64,
    /// The same, or from where the next one would be if the third derivative of the gap stayed as it is here, whichever is less: where a gap is almost
    /// straight its extreme moves fast, and equations in its phase turn back where the branch does not.
    bent: f64,
}

impl Room {
    pub(super) fn of(
        gaps: &Gaps<'_>,
        extreme: &GapExtreme,
        extremes: &[GapExtreme],
        length: f64,
    ) -> Self {
        let seen = room(extreme, extremes, length);
        let bent = seen.min(gaps.lone(extreme.contact, extreme.phase));
        Self { seen, bent }
    }
}

/// Whether an extreme that is short of a level by this `H` is to be watched, with so much room until the next one.
pub(super) fn is_near(square: f64, room: Room, jumps: bool) -> bool {
    let clear = if jumps {
        room.seen > LONELY
    } else {
        square >= -NEAR_ANOTHER * room.bent * room.bent
    };
    clear && (-NEAR..=0.0).contains(&square)
}

/// Whether one that is watched is to be watched no more.
pub(super) fn is_far(square: f64, room: Room, jumps: bool) -> bool {
    let near = if jumps {
        square <= 0.0 && room.seen <= TOO_NEAR
    } else {
        square < -FAR_FOR_ANOTHER * room.bent * room.bent
    };
    near || square < -FAR
}

/// A switch with the value of its unknown, and the phase that it has in the order of time.
#[derive(Debug, Clone, Copy)]
struct Planned {
    placed: Placed,
    /// `c` or `H` where it is one of two.
    value: f64,
}

/// The plan of an orbit.
pub(in crate::contact_equation) struct Plan {
    beginning: Beginning,
    planned: Vec<Planned>,
}

impl Plan {
    /// Of a motion that comes back like this.
    pub(in crate::contact_equation) fn sampled(gaps: &Gaps<'_>, recurrence: &Recurrence) -> Self {
        let length = length(recurrence);
        let (crossings, extremes) = seen(gaps, 0.0, length);
        if recurrence.parts == 1 {
            return Self::of(gaps, recurrence, crossings, &extremes);
        }
        // Contacts may be in each other's place behind the end: what is seen has to be between beginning and end.
        let begin = begun(gaps, length, &crossings, &extremes);
        let (crossings, extremes) = seen(gaps, begin, length);
        Self::from_beginning(gaps, recurrence, begin, crossings, &extremes)
    }

    /// From the places where gaps cross levels, and their extremes.
    pub(in crate::contact_equation) fn of(
        gaps: &Gaps<'_>,
        recurrence: &Recurrence,
        crossings: Vec<Placed>,
        extremes: &[GapExtreme],
    ) -> Self {
        let begin = begun(gaps, length(recurrence), &crossings, extremes);
        Self::from_beginning(gaps, recurrence, begin, crossings, extremes)
    }

    fn from_beginning(
        gaps: &Gaps<'_>,
        recurrence: &Recurrence,
        begin: f64,
        mut crossings: Vec<Placed>,
        extremes: &[GapExtreme],
    ) -> Self {
        let length = length(recurrence);
        let within = |phase: f64| begin + (phase - begin).rem_euclid(length);
        for placed in &mut crossings {
            placed.phase = within(placed.phase);
        }
        crossings.sort_by(|a, b| a.phase.total_cmp(&b.phase));
        let mut short = short_pairs(gaps, length, extremes);
        short.retain(|[(first, _), _]| is_short(&crossings, &first.switch, within(first.phase)));
        let mut planned: Vec<Planned> = crossings
            .into_iter()
            .map(|placed| Planned {
                placed,
                value: placed.phase - begin,
            })
            .collect();
        pair_up(gaps, begin, &mut planned);
        for (mut placed, square) in nested(short) {
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
                recurrence: recurrence.clone(),
                pieces: pieces.collect(),
            },
            planned,
        }
    }

    /// The equations on it, and the extended unknowns of the motion.
    pub(in crate::contact_equation) fn equations(
        &self,
        setting: &Setting,
        value: f64,
        gaps: &Gaps<'_>,
        frame: &Frame,
    ) -> Option<(Equations, Vec<f64>)> {
        let placement = Placement {
            beginning: self.beginning.clone(),
            placed: self.planned.iter().map(|planned| planned.placed).collect(),
            kinks: Vec::new(),
            resolution: frame.resolution,
        };
        let new =
            |placement: Placement| Skeleton::new(setting.system.as_ref(), gaps.values, placement);
        let mut skeleton = new(placement);
        let reference = frame.reference.clone();
        let told = self.told(&skeleton, gaps, &reference);
        let kinks = kinks(setting, gaps, &skeleton, &told);
        if !kinks.is_empty() {
            skeleton = new(Placement {
                kinks,
                ..skeleton.placement
            });
        }
        let equations = Equations::new(setting.clone(), value, skeleton, reference, frame.size)?;
        let mut u = told;
        u.resize(equations.skeleton.unknowns(), 0.0);
        u.push(value);
        write_forces(&equations, gaps, &mut u);
        Some((equations, u))
    }

    /// Unknowns that are no forces.
    fn told(&self, skeleton: &Skeleton, gaps: &Gaps<'_>, reference: &[f64]) -> Vec<f64> {
        let mut u = gaps.state(skeleton.begin);
        for (x, origin) in u.iter_mut().zip(reference) {
            *x -= origin;
        }
        let told = self.planned.iter().enumerate();
        u.extend(
            told.map(|(index, planned)| match planned.placed.switch.told {
                Told::Second { .. } => skeleton.opened(index).unknown(planned.value),
                _ => planned.value,
            }),
        );
        u
    }
}

/// Writes the forces at the nodes that the gaps of a motion have there.
pub(super) fn write_forces(equations: &Equations, gaps: &Gaps<'_>, u: &mut [f64]) {
    let skeleton = &equations.skeleton;
    for interval in &skeleton.intervals {
        let from = skeleton.place(u, interval.from).phase;
        let length = skeleton.place(u, interval.to).phase - from;
        if length <= 0.0 {
            continue;
        }
        if interval.active.is_empty() {
            continue;
        }
        for node in 0..interval.nodes.count() {
            let phase = from + interval.nodes.targets[node] * length;
            let state = gaps.state(phase);
            for active in &interval.active {
                let of = &gaps.values.contacts[active.contact];
                let law = equations.setting.system.law(of.law);
                let gap = gaps.gap_of(active.contact, phase, &state);
                u[active.first + node] = force(law, of, active.piece, gap);
            }
        }
    }
}

/// Force on a piece. Beyond its levels, where a guess may lie, it is that at the level.
fn force(law: &dyn Law, of: &Contact, piece: usize, [gap, rate]: [f64; 2]) -> f64 {
    let (mut force, mut by_gap, mut by_rate) = ([0.0], [0.0], [0.0]);
    let out = Derivatives {
        force: &mut force,
        by_gap: &mut by_gap,
        by_rate: &mut by_rate,
    };
    let gap = of.held(piece, gap);
    law.derivatives(On::Piece(piece), &of.arguments, &[gap], &[rate], out);
    force[0]
}

/// Makes pairs of successive switches of a gap with a short way between them, the shortest first. Those of other gaps may lie between:
/// which of them do changes along a branch.
fn pair_up(gaps: &Gaps<'_>, begin: f64, planned: &mut [Planned]) {
    loop {
        let mut best: Option<(f64, [usize; 2])> = None;
        for first in 0..planned.len() {
            let switches = planned.iter().map(|planned| planned.placed.switch);
            let Some(second) = next_of_gap(switches, first) else {
                continue;
            };
            let [a, b] = [first, second].map(|index| planned[index].placed);
            let alone = a.switch.told == Told::Alone && b.switch.told == Told::Alone;
            let way = b.phase - a.phase;
            if alone && a.switch.can_meet(&b.switch) && way < SHORT {
                let pair = Some((way, [first, second]));
                best = best.filter(|best| best.0 <= way).or(pair);
            }
        }
        let Some((way, [first, second])) = best else {
            return;
        };
        let middle = planned[first].placed.phase + 0.5 * way;
        let contact = planned[first].placed.switch.contact;
        let half = 0.5 * way;
        let level = planned[first].placed.switch.level;
        let (shape, square) = (gaps.shape(contact, middle, half.max(BEND)), half * half);
        let told = first_of_two(gaps, [contact, level], shape, second);
        planned[first].placed.switch.told = told;
        planned[first].value = middle - told.lean() * square - begin;
        planned[second].placed.switch.told = Told::Second { other: first };
        planned[second].value = square;
    }
}

/// The first switch of two, of a contact at a level, around an extreme of this shape. Where the force jumps there the gap has another one beyond it at once.
fn first_of_two(gaps: &Gaps<'_>, [contact, level]: [usize; 2], shape: Shape, other: usize) -> Told {
    let jumps = gaps.values.contacts[contact].jumps[level];
    Told::First {
        other,
        bend: shape.bend,
        lean: if jumps { 0.0 } else { shape.lean },
    }
}

/// The next switch of the gap that one of these is of.
pub(super) fn next_of_gap(switches: impl Iterator<Item = Switch>, first: usize) -> Option<usize> {
    let mut later = switches.enumerate().skip(first);
    let (_, own) = later.next()?;
    let next = later.find(|(_, switch)| switch.contact == own.contact);
    next.map(|(index, _)| index)
}

/// Where what is followed begins.
fn begun(gaps: &Gaps<'_>, length: f64, crossings: &[Placed], extremes: &[GapExtreme]) -> f64 {
    let short = short_pairs(gaps, length, extremes);
    let known = crossings
        .iter()
        .chain(short.iter().map(|[(first, _), _]| first));
    beginning(gaps, length, known.map(|placed| placed.phase))
}

/// The pairs of switches that watch extremes.
fn short_pairs(gaps: &Gaps<'_>, length: f64, extremes: &[GapExtreme]) -> Vec<[(Placed, f64); 2]> {
    let mut short = Vec::new();
    for extreme in extremes {
        let room = Room::of(gaps, extreme, extremes, length);
        for level in 0..gaps.values.contacts[extreme.contact].levels.len() {
            short.extend(short_pair(gaps, extreme, level, room));
        }
    }
    short
}

/// Whether crossings in the order of time agree that the extreme which a pair begins at is short of its level. Where it touches, rounding may say
/// so of one that the crossings around it are beyond.
fn is_short(crossings: &[Placed], first: &Switch, phase: f64) -> bool {
    let place = (first.contact, first.level);
    let mut before = None;
    for placed in crossings {
        if (placed.switch.contact, placed.switch.level) != place {
            continue;
        }
        if placed.phase > phase {
            return before.map_or(placed.switch.rises == first.rises, |rises: bool| {
                rises != first.rises
            });
        }
        before = Some(placed.switch.rises);
    }
    before.is_none_or(|rises| rises != first.rises)
}

/// The switches of pairs in the order that they have where they are in one place: those of the gap that is nearest to its level, which
/// touches it first, around the others.
fn nested(mut short: Vec<[(Placed, f64); 2]>) -> Vec<(Placed, f64)> {
    short.sort_by(|[_, a], [_, b]| b.1.total_cmp(&a.1));
    for index in 1..short.len() {
        let place = |pair: &[(Placed, f64); 2]| pair[0].0.phase;
        let own = place(&short[index]);
        let mut others = short[..index].iter().map(place);
        if let Some(phase) = others.find(|phase| (phase - own).abs() < TOGETHER) {
            for (placed, _) in &mut short[index] {
                placed.phase = phase;
            }
        }
    }
    let firsts = short.iter().map(|[first, _]| *first);
    let seconds = short.iter().rev().map(|[_, second]| *second);
    firsts.chain(seconds).collect()
}

/// The two switches that watch an extreme which is short of a level by little, both at its phase, with `H`.
fn short_pair(
    gaps: &Gaps<'_>,
    extreme: &GapExtreme,
    level: usize,
    room: Room,
) -> Option<[(Placed, f64); 2]> {
    let short = extreme.gap - gaps.values.contacts[extreme.contact].levels[level];
    if (short < 0.0) != extreme.maximum {
        return None;
    }
    let shape = gaps.shape(extreme.contact, extreme.phase, BEND);
    let square = -short / shape.bend;
    if !is_near(
        square,
        room,
        gaps.values.contacts[extreme.contact].jumps[level],
    ) {
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
    let told = first_of_two(gaps, [extreme.contact, level], shape, 0);
    let first = switch(extreme.maximum, told);
    let second = switch(!extreme.maximum, Told::Second { other: 0 });
    Some([(first, square), (second, square)])
}

/// Tells the two of every pair of each other: of a contact at a level they stand like brackets, a pair within another one.
fn join(planned: &mut [Planned]) {
    let mut open: Vec<usize> = Vec::new();
    for index in 0..planned.len() {
        let own = planned[index].placed.switch;
        match own.told {
            Told::Alone => {}
            Told::First { .. } => open.push(index),
            Told::Second { .. } => {
                let place = |first: &usize| {
                    let first = planned[*first].placed.switch;
                    first.can_meet(&own)
                };
                let Some(first) = open.iter().rposition(place).map(|at| open.remove(at)) else {
                    continue;
                };
                if let Told::First { other, .. } = &mut planned[first].placed.switch.told {
                    *other = index;
                }
                planned[index].placed.switch.told = Told::Second { other: first };
            }
        }
    }
}
