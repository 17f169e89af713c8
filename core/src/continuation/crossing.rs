//! Locating where branches cross.
//!
//! There the matrix of a continuation step is singular, and Newton's method finds nothing close by. But the branch passes
//! through smoothly, and so do the test functions along it. They are computed at orbits on both sides, at distances `1` to
//! [`SIDE`] times a width, and interpolated; then once more about the zero, over a smaller width. The orbit itself is
//! interpolated too, and is as good as any if it solves the equations.
//!
//! The curve is parametrised by its arc length along the first tangent, as in [`locate`](super::locate).
//!
//! Source: Berrut and Trefethen (2004), Barycentric Lagrange interpolation, SIAM Review 46, equation (4.2).

use super::follow::{CurvePoint, Step};
use super::locate::ArcLength;
use super::problem::{AsProblem, Problem};
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::numeric::roots::{self, Place};

/// Orbits on each side.
const SIDE: usize = 4;
/// Widths, as parts of the step that passed over the point.
const WIDTHS: [f64; 2] = [0.1, 0.02];
/// Fewer orbits than this are not enough.
const FEWEST: usize = 5;
/// Cosine of the angle between tangents of one branch near the point.
const ALIKE: f64 = 0.9;
/// Errors of all orbits together, in units of what the worst of them does to the result when it is left out.
const LEFT_OUT: f64 = 4.0;

/// A solution with the derivative of the curve by the arc length.
struct Node {
    s: f64,
    u: Vec<f64>,
    slope: Vec<f64>,
    test: f64,
}

/// Where branches cross.
pub(crate) struct Crossing {
    pub(crate) point: CurvePoint,
    /// Value of the test function there.
    pub(crate) test: f64,
    /// What the interpolation leaves in the parameter.
    pub(crate) error: f64,
}

/// Where a test function vanishes between two points although the bordered matrix is singular there.
pub(crate) fn locate_crossing<P: AsProblem + ?Sized>(
    problem: &mut P,
    newton: &mut Newton,
    Step { before: a, next: b }: Step<'_>,
    options: NewtonOptions,
    mut test: impl FnMut(&mut P, &CurvePoint) -> f64,
) -> Option<Crossing> {
    let arc = ArcLength::from(newton, a);
    let ends = [a, b].map(|point| {
        let along = arc.along(&point.tangent);
        Node {
            s: arc.at(&point.u),
            u: point.u.clone(),
            slope: point.tangent.iter().map(|t| t / along).collect(),
            test: test(problem, point),
        }
    });
    let mut search = Search {
        arc,
        like: a,
        options,
        zero: ends[1].s * ends[0].test / (ends[0].test - ends[1].test),
        ends,
        nodes: Vec::new(),
    };
    for width in WIDTHS {
        search.sample(problem, newton, width, &mut test)?;
    }
    let point = search.point(newton);
    let solves = search
        .newton_update(problem.problem(), newton, &point)
        .is_some_and(|update| update <= options.tolerance);
    let error = search.error(&point)?;
    solves.then(|| Crossing {
        test: test(problem, &point),
        error: LEFT_OUT * error,
        point,
    })
}

/// A zero between two points, as it is closed in on.
struct Search<'s> {
    arc: ArcLength,
    ends: [Node; 2],
    /// Points have its scale.
    like: &'s CurvePoint,
    options: NewtonOptions,
    /// Where the zero is.
    zero: f64,
    /// Solutions about it.
    nodes: Vec<Node>,
}

impl Search<'_> {
    /// Computes orbits about the zero, over a part of the step, and interpolates it anew. `None` if there are too few.
    fn sample<P: AsProblem + ?Sized>(
        &mut self,
        problem: &mut P,
        newton: &mut Newton,
        width: f64,
        test: &mut dyn FnMut(&mut P, &CurvePoint) -> f64,
    ) -> Option<()> {
        let width = width * self.ends[1].s;
        let mut found = Vec::with_capacity(2 * SIDE);
        for index in 1..=SIDE {
            for sign in [-1.0, 1.0] {
                let s = self.zero + sign * width * index as f64;
                let Some((u, slope)) = self.solution(problem.problem(), newton, s) else {
                    continue;
                };
                let point = normalised(newton, self.like, u, slope.clone());
                let test = test(problem, &point);
                let u = point.u;
                found.push(Node { s, u, slope, test });
            }
        }
        self.leave_other_branch(newton, &mut found);
        if found.len() < FEWEST {
            return None;
        }
        self.nodes = found;
        self.zero = root(&self.nodes)?;
        Some(())
    }

    /// Leaves out solutions on the branch that crosses: their tangents are none of most others, or of those at the ends of the step.
    fn leave_other_branch(&self, newton: &Newton, found: &mut Vec<Node>) {
        let (norm, scale) = (newton.norm(), self.like.scale);
        let alike = |a: &Node, b: &Node| {
            let lengths = norm.length(scale, &a.slope) * norm.length(scale, &b.slope);
            norm.product(scale, &a.slope, &b.slope).abs() > ALIKE * lengths
        };
        let votes = |node: &Node| {
            let count = |nodes: &[Node]| nodes.iter().filter(|other| alike(node, other)).count();
            (count(found), count(&self.ends))
        };
        let Some(best) = (0..found.len()).max_by_key(|index| votes(&found[*index])) else {
            return;
        };
        let kept: Vec<bool> = found.iter().map(|node| alike(node, &found[best])).collect();
        let mut kept = kept.into_iter();
        found.retain(|_| kept.next().unwrap_or(false));
    }

    /// The solution at a place, and its tangent.
    fn solution(
        &self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
        s: f64,
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let mut u = if self.nodes.is_empty() {
            cubic(&self.ends, s)
        } else {
            interpolated(&self.nodes, s, |node| &node.u)
        };
        let row = self.arc.border(s);
        let corrected = newton.correct(problem, &mut u, row, self.like.scale, self.options);
        corrected.ok()?;
        let mut slope = vec![0.0; u.len()];
        newton.tangent(problem, &u, &mut slope, true);
        Some((u, slope))
    }

    /// The point at the zero.
    fn point(&self, newton: &Newton) -> CurvePoint {
        let u = interpolated(&self.nodes, self.zero, |node| &node.u);
        let slope = interpolated(&self.nodes, self.zero, |node| &node.slope);
        normalised(newton, self.like, u, slope)
    }

    /// What the parameter changes by, at most, where one of the nodes is left out.
    fn error(&mut self, point: &CurvePoint) -> Option<f64> {
        let nodes = &mut self.nodes;
        let mut error = 0.0_f64;
        for left_out in 0..nodes.len() {
            let node = nodes.remove(left_out);
            let zero = root(nodes)?;
            let other = interpolated(nodes, zero, |node| &node.u);
            error = error.max((other[other.len() - 1] - point.parameter()).abs());
            nodes.insert(left_out, node);
        }
        Some(error)
    }

    /// Length of the update that Newton's method would make at a point, with the matrix of the first node: at the point itself it is
    /// singular, and a residual has units that say nothing of how far a solution is. The first node is the nearest to the zero.
    fn newton_update(
        &self,
        problem: &mut dyn Problem,
        newton: &mut Newton,
        point: &CurvePoint,
    ) -> Option<f64> {
        let mut near = self.nodes.first()?.u.clone();
        let row = self.arc.border_at(&near);
        let corrected = newton.correct(problem, &mut near, row, point.scale, self.options);
        corrected.ok()?;
        let mut update = vec![0.0; point.u.len()];
        let last = update.len() - 1;
        problem.evaluate(&point.u, &mut update[..last], None);
        newton.statistics.residuals += 1;
        newton.solve(&mut update);
        Some(newton.norm().length(point.scale, &update))
    }
}

/// A point in the scale of another, with its tangent made a unit.
fn normalised(
    newton: &Newton,
    like: &CurvePoint,
    u: Vec<f64>,
    mut tangent: Vec<f64>,
) -> CurvePoint {
    let length = newton.norm().length(like.scale, &tangent);
    for t in &mut tangent {
        *t /= length;
    }
    CurvePoint {
        u,
        tangent,
        scale: like.scale,
    }
}

/// The cubic through two points with their slopes (Hermite's).
fn cubic([a, b]: &[Node; 2], s: f64) -> Vec<f64> {
    let h = b.s - a.s;
    let p = (s - a.s) / h;
    let (from, to) = (
        (1.0 + 2.0 * p) * (1.0 - p) * (1.0 - p),
        p * p * (3.0 - 2.0 * p),
    );
    let (leave, arrive) = (h * p * (1.0 - p) * (1.0 - p), h * p * p * (p - 1.0));
    let entries = 0..a.u.len();
    entries
        .map(|i| from * a.u[i] + to * b.u[i] + leave * a.slope[i] + arrive * b.slope[i])
        .collect()
}

/// Barycentric weights, divided by the distances from `s`, and their sum. None of the nodes is at `s`.
fn weights(nodes: &[Node], s: f64) -> (Vec<f64>, f64) {
    let weights: Vec<f64> = nodes
        .iter()
        .map(|node| {
            let others = nodes.iter().filter(|other| other.s != node.s);
            let product: f64 = others.map(|other| node.s - other.s).product();
            1.0 / (product * (s - node.s))
        })
        .collect();
    let sum = weights.iter().sum();
    (weights, sum)
}

fn interpolated(nodes: &[Node], s: f64, of: impl Fn(&Node) -> &Vec<f64>) -> Vec<f64> {
    if let Some(node) = nodes.iter().find(|node| node.s == s) {
        return of(node).clone();
    }
    let (weights, sum) = weights(nodes, s);
    let mut values = vec![0.0; of(&nodes[0]).len()];
    for (node, weight) in nodes.iter().zip(&weights) {
        for (value, x) in values.iter_mut().zip(of(node)) {
            *value += weight / sum * x;
        }
    }
    values
}

/// Zero of the interpolated test function between the nodes of opposite sign that are next to each other.
fn root(nodes: &[Node]) -> Option<f64> {
    let mut order: Vec<&Node> = nodes.iter().collect();
    order.sort_by(|x, y| x.s.total_cmp(&y.s));
    let pair = order
        .windows(2)
        .find(|pair| pair[0].test * pair[1].test <= 0.0)?;
    let [low, high] = [pair[0], pair[1]].map(|node| Place {
        x: node.s,
        value: node.test,
    });
    roots::root(low, high, 0.0, |s| {
        let (weights, sum) = weights(nodes, s);
        let pairs = nodes.iter().zip(&weights);
        pairs.map(|(node, weight)| weight * node.test).sum::<f64>() / sum
    })
}
