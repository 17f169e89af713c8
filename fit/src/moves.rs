//! How the curve moves across itself with the unknowns, along a sheet: `W` of [`trial`](crate::trial) at some orbits, and between them.

use crate::curve::Curve;
use crate::path::{Path, Sheet};
use crate::problem::Problem;
use crate::spline::Spline;

/// Orbits of one sheet at which derivatives are computed.
const NODES: usize = 14;

/// What is read along a sheet of a path.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Along<'p> {
    pub(crate) path: &'p Path,
    pub(crate) sheet: &'p Sheet,
    /// Its place among what a group wants.
    pub(crate) wanted: usize,
    /// What counts as one along both axes.
    pub(crate) size: [f64; 2],
}

/// Nodes of a path at which derivatives are computed: of those between the feet, and one on either side of them, so many, evenly by their number,
/// since steps are short where a branch bends; and turns, with their neighbours.
pub(crate) fn chosen(path: &Path, sheet: &Sheet, feet: &[f64]) -> Vec<usize> {
    let [low, high] = crate::checks::extremes(feet);
    let [first, last] = sheet.within(path);
    let from = (first..=last).rfind(|&node| path.along[node] <= low);
    let to = (first..=last).find(|&node| path.along[node] >= high);
    let (from, to) = (from.unwrap_or(first), to.unwrap_or(last));
    let step = (to - from).div_ceil(NODES).max(1);
    let is_turn = |node: usize| {
        path.nodes
            .get(node)
            .is_some_and(|node| node.event.is_some())
    };
    let is_near = |node: usize| {
        is_turn(node) || is_turn(node + 1) || node.checked_sub(1).is_some_and(is_turn)
    };
    let taken = |&node: &usize| (node - from) % step == 0 || node == to || is_near(node);
    (from..=to).filter(taken).collect()
}

/// `W` of each unknown along a sheet.
pub(crate) fn splines(
    problem: &Problem,
    curve: &mut Curve,
    of: Along<'_>,
    nodes: &[usize],
) -> Result<Vec<Spline>, String> {
    let mut along = Vec::with_capacity(nodes.len());
    let mut moves: Vec<Vec<f64>> = vec![Vec::with_capacity(nodes.len()); problem.unknowns.len()];
    let mut failed = None;
    for &node in nodes {
        // Next to a fold there may be none, and the others are enough.
        match moved(problem, curve, of, node) {
            Ok(by) => {
                along.push(of.path.along[node]);
                for (moves, by) in moves.iter_mut().zip(by) {
                    moves.push(by);
                }
            }
            Err(reason) => failed = Some(reason),
        }
    }
    if along.is_empty() {
        return Err(failed.unwrap_or_else(|| "no orbit of the curve has derivatives".to_owned()));
    }
    let spline = |moves| Spline::through(along.clone(), moves);
    Ok(moves.into_iter().map(spline).collect())
}

/// `W` at a node. At a fold, which moves along the axis of the places, it is `-y' x_p`.
fn moved(
    problem: &Problem,
    curve: &mut Curve,
    of: Along<'_>,
    node: usize,
) -> Result<Vec<f64>, String> {
    let Along {
        path,
        sheet,
        wanted,
        size,
    } = of;
    let branch = path.branch;
    if let Some(event) = path.nodes[node].event {
        if !path.nodes[node].turns {
            // Its two sides move each in its own way.
            return Err("a corner of the curve".to_owned());
        }
        let (_, [_, dy]) = path.at(path.along[node]);
        let by = curve.fold_slopes(problem, branch, event)?;
        return Ok(by.iter().map(|by| -dy * by).collect());
    }
    let point = path.nodes[node].point.ok_or("a node without an orbit")?;
    let slopes = curve.slopes_of(problem, branch, point)?;
    let found = slopes.of[wanted].as_ref();
    let (_, slope, by) = found.ok_or("a reading without derivatives")?;
    let inside = (sheet.nodes[0]..=sheet.nodes[1]).contains(&node);
    let direction = if inside {
        sheet.direction
    } else {
        -sheet.direction
    };
    let dx = direction / (1.0 / size[0]).hypot(slope / size[1]);
    Ok(by.iter().map(|by| by * dx).collect())
}
