//! Which parts of a range branches have orbits in, and stable ones.

use super::diagram::DiagramBranch;
use crate::branches::branch::Branch;
use crate::orbit::stability::Verdict;

/// Stretches that are apart by less than this part of the range touch each other.
const TOUCHING: f64 = 1e-9;

/// What a part of the range lacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lacking {
    /// There is no orbit of any branch.
    Orbits,
    /// All orbits there are unstable.
    StableOrbits,
}

/// The parts of a range that lack something and are longer than a part of it, in order.
pub(super) fn without(
    lacking: Lacking,
    branches: &[DiagramBranch],
    range: [f64; 2],
    longer: f64,
) -> Vec<[f64; 2]> {
    let [low, high] = [range[0].min(range[1]), range[0].max(range[1])];
    let length = high - low;
    let mut covered: Vec<[f64; 2]> = branches
        .iter()
        .flat_map(|branch| stretches(lacking, &branch.branch))
        .collect();
    covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut gaps = Vec::new();
    let mut reached = low;
    for [begin, end] in covered.into_iter().chain([[high, high]]) {
        let begin = begin.min(high);
        if begin - reached > longer.max(TOUCHING) * length {
            gaps.push([reached, begin]);
        }
        reached = reached.max(end);
    }
    gaps
}

/// The stretches between neighbours of a branch, events included, that have what others lack.
fn stretches(lacking: Lacking, branch: &Branch) -> Vec<[f64; 2]> {
    let mut places: Vec<(f64, Option<Verdict>)> = Vec::new();
    let mut events = branch.events.iter().peekable();
    for (index, point) in branch.points.iter().enumerate() {
        while let Some(event) = events.next_if(|event| event.after <= index) {
            places.push((event.point.value, None));
        }
        places.push((point.value, Some(point.stability.verdict)));
    }
    places.extend(events.map(|event| (event.point.value, None)));
    let has = |pair: &&[(f64, Option<Verdict>)]| {
        let [a, b] = [pair[0].1, pair[1].1];
        // Where it is not known, there may be a stable one.
        let stable = |verdict: Option<Verdict>| verdict.is_some_and(|v| v != Verdict::Unstable);
        lacking == Lacking::Orbits || stable(a) || stable(b) || (a.is_none() && b.is_none())
    };
    let pairs = places.windows(2).filter(has);
    pairs
        .map(|pair| [pair[0].0.min(pair[1].0), pair[0].0.max(pair[1].0)])
        .collect()
}
