//! An orbit of other equations: its unknowns in these, and the plan of equations that fit it.
//!
//! Switches are those of the other equations, or of the parabola of a gap at an extreme beyond its level, at `-+ sqrt(H)` with `H` by (3) of
//! [`skeleton`](crate::contact_equation::skeleton).

use super::plan::{Plan, write_forces};
use crate::contact_equation::equations::Equations;
use crate::contact_equation::equations::pass_results::GapExtreme;
use crate::contact_equation::orbit::gaps::{Gaps, apart, seen};
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::skeleton::Skeleton;
use crate::contact_equation::skeleton::placement::{Placed, Switch, Told};

/// A switch of an orbit near another one has moved by less than this phase.
const MOVED: f64 = 0.7;

/// The unknowns of an orbit of other equations, from the motion of their last pass, or `None` where these have no place for it. An orbit
/// near it has the unknowns `near` here.
pub(in crate::contact_equation) fn transferred(
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
    // Behind an end contacts may be in each other's place: what is beyond is seen there.
    let (known, extremes) = if old.recurrence().parts == 1 {
        (crossings(old, u), motion.gap_extremes().concat())
    } else {
        seen(gaps, new.begin, new.length)
    };
    for (index, switch) in new.switches.iter().enumerate() {
        let slot = new.slot(index);
        match switch.told {
            Told::Alone => {
                let from = new.begin + near[slot];
                to[slot] = near[slot] + nearest(&known, switch, from, new.length)?;
            }
            Told::First { other, bend, .. } => {
                let from = new.begin + near[slot];
                let pair = [switch, &new.switches[other]];
                let extreme = extreme_of(&extremes, gaps, switch, [from, bend, new.length]);
                let ends = pair.map(|switch| nearest(&known, switch, from, new.length));
                let [by, square] = match (extreme, ends) {
                    // Crossings are those of a neighbour then.
                    (Some(short @ [_, square]), _) if square <= 0.0 => short,
                    (_, [Some(a), Some(b)]) if a < b => {
                        let square = 0.25 * (b - a) * (b - a);
                        [0.5 * (a + b) - switch.told.lean() * square, square]
                    }
                    _ => return None,
                };
                to[slot] = near[slot] + by;
                to[new.slot(other)] = new.opened(other).unknown(square);
            }
            Told::Second { .. } => {}
        }
    }
    write_forces(equations, gaps, &mut to);
    Some(to)
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

/// How far the nearest extreme of a switch's gap is from a phase, and its `H`.
fn extreme_of(
    extremes: &[GapExtreme],
    gaps: &Gaps<'_>,
    switch: &Switch,
    [from, bend, length]: [f64; 3],
) -> Option<[f64; 2]> {
    let level = gaps.values.contacts[switch.contact].levels[switch.level];
    let found = extremes
        .iter()
        .filter(|extreme| extreme.contact == switch.contact && extreme.maximum == switch.rises)
        .map(|extreme| {
            [
                apart(extreme.phase, from, length),
                -(extreme.gap - level) / bend,
            ]
        })
        .min_by(|a, b| a[0].abs().total_cmp(&b[0].abs()))?;
    (found[0].abs() < MOVED).then_some(found)
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

/// The plan of an orbit of other equations, from the motion of their last pass.
pub(in crate::contact_equation) fn replanned(
    motion: &Motion<'_>,
    u: &[f64],
    gaps: &Gaps<'_>,
) -> Plan {
    let skeleton = &motion.equations.skeleton;
    if skeleton.recurrence().parts > 1 {
        return Plan::sampled(gaps, skeleton.recurrence());
    }
    let mut crossings = crossings(skeleton, u);
    let mut extremes = motion.gap_extremes().to_vec();
    if !motion.equations.is_in_order() {
        for of_gap in &mut extremes {
            alternate(of_gap);
        }
    }
    let extremes = extremes.concat();
    for extreme in &extremes {
        add_beyond(gaps, skeleton, extreme, &mut crossings);
    }
    Plan::of(gaps, skeleton.recurrence(), crossings, &extremes)
}

/// Leaves one of successive extremes of a gap that are both maxima, or both minima: the farther one. Where switches of different gaps have
/// passed each other, intervals overlap, and both of two see one extreme.
fn alternate(of_gap: &mut Vec<GapExtreme>) {
    of_gap.sort_by(|a, b| a.phase.total_cmp(&b.phase));
    of_gap.dedup_by(|next, kept| {
        let same = next.maximum == kept.maximum;
        if same && (next.gap > kept.gap) == kept.maximum {
            *kept = *next;
        }
        same
    });
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_two_maxima_in_turn_the_higher_one_is_left() {
        let extreme = |phase: f64, gap: f64, maximum: bool| GapExtreme {
            contact: 0,
            interval: 0,
            phase,
            gap,
            maximum,
        };
        let mut seen = vec![
            extreme(0.4, -0.2, true),
            extreme(0.1, -0.7, false),
            extreme(0.2, -0.1, true),
            extreme(0.6, -0.3, false),
            extreme(0.5, -0.4, false),
            extreme(0.7, -0.6, true),
            extreme(0.8, -0.5, true),
        ];
        alternate(&mut seen);
        let phases: Vec<f64> = seen.iter().map(|extreme| extreme.phase).collect();
        assert_eq!(phases, [0.1, 0.2, 0.5, 0.8]);
    }
}
