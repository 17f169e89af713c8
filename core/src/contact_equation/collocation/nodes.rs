//! Gauss nodes of a stretch, and integrals of the polynomials through them.
//!
//! A stretch of motion is measured by `psi` from 0 to 1, and by a finer variable `y` from -1 to 1 whose polynomials stand for the force:
//!
//! ```text
//! d psi / dy ~ (1 + y)^(p - 1) (1 - y)^(q - 1)                                                                (1)
//! S1_jl = int_0^psi_j l_l d psi,    S2_jl = int_0^psi_j (psi_j - psi) l_l d psi                               (2)
//! ```
//!
//! Nodes are those of Gauss and Legendre in `y`, targets are the nodes and the end. A force that leaves its level like a power of the
//! distance is smoother in `y` than in time. Where `p` or `q` is larger than two, polynomials stand for the force times (1),
//!
//! ```text
//! f d psi/dy = sum_l l_l(y) f_l psi'(y_l)                                                                     (3)
//! ```
//!
//! in (2) too: a power of `psi` is one of `y` that is higher by `p - 1` then. What is smooth in time is one of a higher degree in exchange, which pays where
//! many nodes are left for it.
//!
//! Source: Davis and Rabinowitz (1984), Methods of Numerical Integration, section 2.9 (variable transformations); Berrut and Trefethen
//! (2004), Barycentric Lagrange interpolation, equation (4.2).

use std::ops::Range;
use std::sync::{Mutex, OnceLock, PoisonError};

use multiversion::multiversion;

use super::grading::{Grading, STEEPEST, power_with};
use super::partway::Partway;
use crate::numeric::fourier::gauss;

/// Numbers of nodes of a stretch.
pub(in crate::contact_equation) const COUNTS: [usize; 6] = [8, 12, 16, 20, 24, 32];
// Sums over nodes go over groups of four.
const _: () = {
    let mut place = 0;
    while place < COUNTS.len() {
        assert!(COUNTS[place].is_multiple_of(4));
        place += 1;
    }
};
/// Points of the rules between two targets, and up to which angle of a kernel on the way each serves: polynomials through nodes turn by half of a period
/// there, and with `n` points what is left of a wave that turns by `T` is as large as the Bessel function `J_2n(T / 2)`.
const POINTS: [usize; RULES] = [12, 16, 20, 24, 32, 48];
const TURNS: [f64; RULES] = [5.5, 13.0, 18.0, 30.0, 56.0, 90.0];
/// How many rules there are.
pub(in crate::contact_equation) const RULES: usize = 6;
/// The largest power of which polynomials stand for the force itself.
const PLAIN_POWER: usize = 2;
/// Points of the rule for (2).
const PLAIN: usize = 24;

/// What turns over a stretch is followed by the polynomial through its targets if that is as near as this, of its amplitude.
const FOLLOWED: f64 = 1e-12;
/// Angles that are tried, and by what they grow.
const SLOW: f64 = 0.5;
const FAST: f64 = 50.0;
const FASTER: f64 = 1.4;

/// Nodes with everything that depends on their number and grading alone.
#[derive(Debug)]
pub(in crate::contact_equation) struct Nodes {
    /// `p` and `q` of (1).
    pub(in crate::contact_equation) grading: [usize; 2],
    map: Grading,
    /// The nodes in `y`, and their barycentric weights.
    y: Vec<f64>,
    barycentric: Vec<f64>,
    /// By (3), and then `d psi / dy` at the nodes; else one.
    steep: bool,
    slopes: Vec<f64>,
    /// Weights of the nodes beside both ends: `1 / P_n'(y_l)`, for an even number of nodes with the other sign.
    inner: Vec<f64>,
    /// Rows that give the last two coefficients of a function in Legendre polynomials of `y`.
    last: [Vec<f64>; 2],
    /// What forces are at the nodes of the next count, row by row of those, for each of its gradings.
    next: [OnceLock<Vec<f64>>; STEEPEST * STEEPEST],
    /// Targets in `psi`: the nodes, then one.
    pub(in crate::contact_equation) targets: Vec<f64>,
    /// (2), row by row of targets.
    pub(in crate::contact_equation) once: Vec<f64>,
    pub(in crate::contact_equation) twice: Vec<f64>,
    /// Rules between successive targets, coarser ones first.
    between: [OnceLock<Between>; RULES],
    /// The ways between targets.
    ways: Vec<f64>,
    /// By how much a kernel that turns once over the whole stretch may turn on each way between two targets, and the most of these.
    reaches: Vec<f64>,
    reach: f64,
    /// The longest way between two targets.
    widest: f64,
    /// See [`Nodes::follows`].
    followed: OnceLock<f64>,
}

/// A rule between successive targets.
#[derive(Debug)]
pub(in crate::contact_equation) struct Between {
    /// Where the points of each way begin, and where all end.
    pub(in crate::contact_equation) starts: Vec<usize>,
    /// What is left to the end of the way, for every point of it.
    pub(in crate::contact_equation) left: Vec<f64>,
    /// Weight times every polynomial there.
    pub(in crate::contact_equation) weighted: Vec<f64>,
}

impl Between {
    /// The points of a way.
    pub(in crate::contact_equation) fn points(&self, way: usize) -> Range<usize> {
        self.starts[way]..self.starts[way + 1]
    }
}

impl Nodes {
    /// So many nodes, with the powers that the ends ask for as far as so many have them.
    pub(in crate::contact_equation) fn graded(count: usize, asked: [usize; 2]) -> &'static Self {
        Self::of(count, asked.map(|power| power_with(count, power)))
    }

    /// So many nodes, graded so.
    pub(in crate::contact_equation) fn of(count: usize, grading: [usize; 2]) -> &'static Self {
        type Kept = Vec<&'static Nodes>;
        static KEPT: Mutex<Kept> = Mutex::new(Vec::new());
        let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        let found = kept
            .iter()
            .find(|nodes| nodes.count() == count && nodes.grading == grading);
        if let Some(nodes) = found {
            return nodes;
        }
        // There are as many as counts and gradings, and they are kept for ever.
        let made: &'static Self = Box::leak(Box::new(Self::new(count, grading)));
        kept.push(made);
        made
    }

    pub(in crate::contact_equation) fn count(&self) -> usize {
        self.y.len()
    }

    fn new(count: usize, grading: [usize; 2]) -> Self {
        let rule = gauss::rule(count);
        let y: Vec<f64> = rule.nodes.iter().map(|s| 2.0 * s - 1.0).collect();
        // Of Gauss-Legendre nodes: (-1)^j sqrt((1 - y^2) w).
        let signs = [1.0, -1.0].into_iter().cycle();
        let pairs = rule.nodes.iter().zip(&rule.weights).zip(signs);
        let barycentric: Vec<f64> = pairs
            .map(|((s, w), sign)| sign * (4.0 * s * (1.0 - s) * w).sqrt())
            .collect();
        let inner = y.iter().zip(&barycentric);
        let inner = inner.map(|(node, weight)| weight / (node * node - 1.0));
        let n_less = |by: usize| {
            let degree = count.saturating_sub(by);
            let pairs = y.iter().zip(&rule.weights);
            let row = pairs.map(|(y, w)| (2 * degree + 1) as f64 * w * legendre(degree, *y));
            row.collect()
        };
        let map = Grading::new(grading);
        let steep = grading.iter().any(|power| *power > PLAIN_POWER);
        let psi: Vec<f64> = y.iter().map(|y| map.psi(*y)).collect();
        let mut nodes = Self {
            grading,
            map,
            inner: inner.collect(),
            steep,
            slopes: y
                .iter()
                .map(|y| if steep { map.slope(*y) } else { 1.0 })
                .collect(),
            last: [n_less(1), n_less(2)],
            next: std::array::from_fn(|_| OnceLock::new()),
            barycentric,
            targets: psi.iter().copied().chain([1.0]).collect(),
            once: Vec::new(),
            twice: Vec::new(),
            between: Default::default(),
            ways: Vec::new(),
            reaches: Vec::new(),
            reach: 0.0,
            widest: 0.0,
            followed: OnceLock::new(),
            y,
        };
        nodes.integrate();
        nodes
    }

    /// Fills (2) by sums over the ways between targets.
    fn integrate(&mut self) {
        let n = self.count();
        self.ways = vec![self.targets[0]];
        let pairs = self.targets.windows(2);
        self.ways.extend(pairs.map(|pair| pair[1] - pair[0]));
        let ways = &self.ways;
        self.widest = ways.iter().copied().fold(0.0, f64::max);
        let ends = [-1.0].iter().chain(&self.y);
        let pairs = ends.zip(self.y.iter().chain(&[1.0]));
        self.reaches = pairs.map(|(a, b)| self.reach(*a, *b)).collect();
        self.reach = self.reaches.iter().copied().fold(0.0, f64::max);
        let rule = self.rule_between(|_| PLAIN);
        let (mut once, mut twice) = (vec![0.0; n], vec![0.0; n]);
        for (way, length) in ways.iter().enumerate() {
            for l in 0..n {
                twice[l] += length * once[l];
            }
            for place in rule.points(way) {
                for l in 0..n {
                    let weighted = rule.weighted[place * n + l];
                    once[l] += weighted;
                    twice[l] += rule.left[place] * weighted;
                }
            }
            self.once.extend_from_slice(&once);
            self.twice.extend_from_slice(&twice);
        }
    }

    /// How far it is at most between two places in `y` at the slope that is steepest there.
    fn reach(&self, from: f64, to: f64) -> f64 {
        let places = [from, 0.5 * (from + to), to];
        let slopes = places.map(|y| self.map.slope(y));
        (to - from) * slopes.into_iter().fold(0.0, f64::max)
    }

    /// With so many points in every way.
    fn rule_between(&self, points: impl Fn(usize) -> usize) -> Between {
        let n = self.count();
        let map = &self.map;
        let ends: Vec<f64> = [-1.0]
            .iter()
            .chain(&self.y)
            .chain(&[1.0])
            .copied()
            .collect();
        let mut rule = Between {
            starts: vec![0],
            left: Vec::new(),
            weighted: Vec::new(),
        };
        let mut values = vec![0.0; n];
        for (way, (pair, end)) in ends.windows(2).zip(&self.targets).enumerate() {
            let gauss = gauss::rule(points(way));
            let length = pair[1] - pair[0];
            for (s, w) in gauss.nodes.iter().zip(&gauss.weights) {
                let y = pair[0] + length * s;
                self.polynomials_at(y, &mut values);
                rule.left.push(end - map.psi(y));
                let pairs = values.iter().zip(&self.slopes);
                let weight = w * length * self.left_of_slope(y);
                rule.weighted
                    .extend(pairs.map(|(value, slope)| weight * value * slope));
            }
            rule.starts.push(rule.left.len());
        }
        rule
    }

    /// The ways between targets, as parts of the stretch.
    pub(in crate::contact_equation) fn ways(&self) -> &[f64] {
        &self.ways
    }

    /// The place of the rule that serves a kernel which turns by this angle, or decays by so many powers of `e`, over a whole stretch.
    pub(in crate::contact_equation) fn place_for(&self, fast: f64) -> usize {
        place_for(fast * self.reach)
    }

    /// The rule in this place.
    pub(in crate::contact_equation) fn rule(&self, place: usize) -> &Between {
        self.between[place].get_or_init(|| {
            let part = TURNS[place] / self.reach;
            self.rule_between(|way| POINTS[place_for(part * self.reaches[way])])
        })
    }

    /// Writes every polynomial `l_l` at a `psi` of the stretch.
    pub(in crate::contact_equation) fn polynomials(&self, psi: f64, values: &mut [f64]) {
        self.polynomials_at(self.map.inverse(psi), values);
    }

    /// Writes the weights of the targets in the value at a `psi` of what is known at all of them, and is zero at the beginning: of the
    /// polynomial through all of them. Nodes and ends have the barycentric weights of `(y^2 - 1) P_n(y)`.
    pub(in crate::contact_equation) fn through_ends(&self, psi: f64, weights: &mut Vec<f64>) {
        let n = self.count();
        weights.clear();
        weights.resize(n + 1, 0.0);
        if psi >= 1.0 {
            weights[n] = 1.0;
            return;
        }
        if psi <= 0.0 {
            return;
        }
        let y = self.map.inverse(psi);
        let sign = if n.is_multiple_of(2) { -1.0 } else { 1.0 };
        // P_n(-1) = (-1)^n, and the derivative of y^2 - 1 is -2 there.
        let mut sum = 1.0 / (2.0 * (y + 1.0));
        sum += weigh(y, &self.y, &self.inner, weights);
        weights[n] = sign / (2.0 * (y - 1.0));
        sum += weights[n];
        let per = 1.0 / sum;
        if per == 0.0 || per.is_nan() {
            // At a node, or so near that its weight is no number.
            let near = |node: &&f64| (**node - y).abs() <= f64::MIN_POSITIVE;
            for (weight, node) in weights.iter_mut().zip(&self.y) {
                *weight = f64::from(u8::from(near(&node)));
            }
            weights[n] = 0.0;
            return;
        }
        for weight in weights {
            *weight *= per;
        }
    }

    /// The last target that is not beyond a `psi`, if there is one, and a rule from there to it which serves a kernel that turns by this angle over a whole
    /// stretch.
    pub(in crate::contact_equation) fn partway(&self, psi: f64, fast: f64, rule: &mut Partway) {
        let n = self.count();
        let done = self.targets.partition_point(|target| *target <= psi);
        rule.done = done.checked_sub(1);
        let known = rule.done.map_or(0.0, |target| self.targets[target]);
        rule.left = psi - known;
        rule.points.clear();
        if done > n || psi <= known {
            rule.values.clear();
            return;
        }
        let from = rule.done.map_or(-1.0, |target| self.y[target]);
        let to = self.map.inverse(psi);
        let length = to - from;
        let gauss = gauss::rule(POINTS[place_for(fast * self.reach(from, to))]);
        rule.values.resize(gauss.nodes.len() * n, 0.0);
        let rows = rule.values.chunks_exact_mut(n);
        for ((s, w), values) in gauss.nodes.iter().zip(&gauss.weights).zip(rows) {
            let y = from + length * s;
            self.polynomials_at(y, values);
            if self.steep {
                for (value, slope) in values.iter_mut().zip(&self.slopes) {
                    *value *= slope;
                }
            }
            let weight = w * length * self.left_of_slope(y);
            rule.points.push([psi - self.map.psi(y), weight]);
        }
    }

    /// Whether the polynomial through all targets follows what turns by this angle over the stretch.
    pub(in crate::contact_equation) fn follows(&self, turn: f64) -> bool {
        turn == 0.0 || turn <= *self.followed.get_or_init(|| self.find_followed())
    }

    /// The largest of the angles that are tried which is followed; zero if none is.
    fn find_followed(&self) -> f64 {
        let (mut followed, mut fast) = (0.0, SLOW);
        while fast < FAST && self.missed(fast) < FOLLOWED {
            followed = fast;
            fast *= FASTER;
        }
        followed
    }

    /// How far the polynomials through all targets are from sine and cosine of such a turn, between targets.
    fn missed(&self, fast: f64) -> f64 {
        let mut weights = Vec::new();
        let ends = [-1.0].iter().chain(&self.y);
        let middles = ends.zip(self.y.iter().chain(&[1.0]));
        let missed = middles.map(|(a, b)| {
            let psi = self.map.psi(0.5 * (a + b));
            self.through_ends(psi, &mut weights);
            let of = |wave: &dyn Fn(f64) -> f64| {
                let pairs = weights.iter().zip(&self.targets);
                let found: f64 = pairs.map(|(weight, target)| weight * wave(*target)).sum();
                (found - wave(psi)).abs()
            };
            of(&|psi| (fast * psi).sin()).max(of(&|psi| 1.0 - (fast * psi).cos()))
        });
        missed.fold(0.0, f64::max)
    }

    /// What forces at the nodes are at those of the next count, row by row of these.
    pub(in crate::contact_equation) fn at_next(&self, next: &Self) -> &[f64] {
        let [p, q] = next.grading;
        self.next[(p - 1) * STEEPEST + q - 1].get_or_init(|| {
            let mut matrix = vec![0.0; next.count() * self.count()];
            let rows = matrix.chunks_exact_mut(self.count());
            for (row, y) in rows.zip(&next.y) {
                self.forces_at(*y, row);
            }
            matrix
        })
    }

    /// What of `d psi / dy` is no part of the polynomials.
    fn left_of_slope(&self, y: f64) -> f64 {
        if self.steep { 1.0 } else { self.map.slope(y) }
    }

    /// Writes the weights of forces at the nodes in the force at a `psi` between both ends, by (3).
    pub(in crate::contact_equation) fn forces(&self, psi: f64, values: &mut [f64]) {
        self.forces_at(self.map.inverse(psi), values);
    }

    fn forces_at(&self, y: f64, values: &mut [f64]) {
        self.polynomials_at(y, values);
        if !self.steep {
            return;
        }
        let per = 1.0 / self.map.slope(y);
        for (value, slope) in values.iter_mut().zip(&self.slopes) {
            *value *= per * slope;
        }
    }

    /// The larger one of the last two coefficients of a function in Legendre polynomials, from its values at the nodes.
    pub(in crate::contact_equation) fn tail(&self, values: &[f64]) -> f64 {
        self.larger(values.iter().copied())
    }

    /// The same of what polynomials stand for, from forces at the nodes.
    pub(in crate::contact_equation) fn tail_of_force(&self, forces: &[f64]) -> f64 {
        let pairs = forces.iter().zip(&self.slopes);
        self.larger(pairs.map(|(force, slope)| force * slope))
    }

    fn larger(&self, values: impl Iterator<Item = f64>) -> f64 {
        let [one, other] = &self.last;
        let mut sums = [0.0; 2];
        for ((a, b), value) in one.iter().zip(other).zip(values) {
            sums[0] += a * value;
            sums[1] += b * value;
        }
        sums[0].abs().max(sums[1].abs())
    }

    /// The longest way between two targets, as a part of all.
    pub(in crate::contact_equation) fn widest(&self) -> f64 {
        self.widest
    }

    /// Writes every polynomial at a `y`, and beyond the ends too.
    fn polynomials_at(&self, y: f64, values: &mut [f64]) {
        let per = 1.0 / weigh(y, &self.y, &self.barycentric, values);
        if per == 0.0 || per.is_nan() {
            // At a node, or so near that its weight is no number.
            let near = |node: &f64| (*node - y).abs() <= f64::MIN_POSITIVE;
            for (value, node) in values.iter_mut().zip(&self.y) {
                *value = f64::from(u8::from(near(node)));
            }
            return;
        }
        for value in values {
            *value *= per;
        }
    }
}

/// Writes weights by the ways from their nodes, and returns the sum of these. Nodes are a multiple of four.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn weigh(y: f64, nodes: &[f64], weights: &[f64], to: &mut [f64]) -> f64 {
    let (nodes, weights) = (nodes.as_chunks::<4>().0, weights.as_chunks::<4>().0);
    let mut sums = [0.0; 4];
    for ((to, node), weight) in to.as_chunks_mut::<4>().0.iter_mut().zip(nodes).zip(weights) {
        for l in 0..4 {
            to[l] = weight[l] / (y - node[l]);
            sums[l] += to[l];
        }
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3])
}

/// The place of the rule that serves a kernel which turns by this angle, or decays by so many powers of `e`, on a way.
fn place_for(turn: f64) -> usize {
    let fits = |most: &f64| turn <= *most;
    TURNS.iter().position(fits).unwrap_or(TURNS.len() - 1)
}

/// `P_n(y)` by its recurrence (Abramowitz and Stegun (1964), equation 22.7.10).
fn legendre(n: usize, y: f64) -> f64 {
    let (mut before, mut p) = (0.0, 1.0);
    for k in 0..n {
        let next = ((2 * k + 1) as f64 * y * p - k as f64 * before) / (k + 1) as f64;
        (before, p) = (p, next);
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the powers of `psi`, whose antiderivatives are known.
    #[test]
    fn antiderivatives_of_powers_are_exact() {
        for grading in [[1, 1], [2, 1], [2, 2], [3, 2]] {
            let nodes = Nodes::of(16, grading);
            let n = nodes.count();
            for power in 0..4 {
                let f: Vec<f64> = nodes.targets[..n]
                    .iter()
                    .map(|psi| psi.powi(power))
                    .collect();
                for (j, psi) in nodes.targets.iter().enumerate() {
                    let of = |table: &[f64]| -> f64 {
                        table[j * n..][..n].iter().zip(&f).map(|(a, b)| a * b).sum()
                    };
                    let k = f64::from(power);
                    let once = psi.powi(power + 1) / (k + 1.0);
                    let twice = psi.powi(power + 2) / ((k + 1.0) * (k + 2.0));
                    assert!(
                        (of(&nodes.once) - once).abs() < 1e-14,
                        "{grading:?} {power} {j}"
                    );
                    assert!(
                        (of(&nodes.twice) - twice).abs() < 1e-14,
                        "{grading:?} {power} {j}"
                    );
                }
            }
        }
    }

    /// `y^n - ...`: the leading coefficient of `P_n` is `(2n)! / (2^n n!^2)`.
    #[test]
    fn the_last_coefficients_are_those_of_powers() {
        let nodes = Nodes::of(8, [1, 1]);
        let power = |n: i32| nodes.y.iter().map(|y| y.powi(n)).collect::<Vec<f64>>();
        let leading = |n: i32| {
            (1..=n)
                .map(|k| f64::from(2 * k - 1) / f64::from(k))
                .product::<f64>()
        };
        for n in [6, 7] {
            let tail = nodes.tail(&power(n));
            assert!((tail * leading(n) - 1.0).abs() < 1e-12, "{n} {tail}");
        }
        assert!(nodes.tail(&power(5)) < 1e-15);
    }

    #[test]
    fn polynomials_through_the_ends_interpolate() {
        let mut weights = Vec::new();
        for (count, grading) in [(8, [1, 1]), (12, [3, 1]), (16, [2, 3])] {
            let nodes = Nodes::of(count, grading);
            for psi in [1e-4, 0.123, 0.5, 0.987, 1.0 - 1e-5, 1.0] {
                let of = |psi: f64| psi * (1.0 + psi);
                nodes.through_ends(psi, &mut weights);
                let pairs = weights.iter().zip(&nodes.targets);
                let found: f64 = pairs.map(|(weight, target)| weight * of(*target)).sum();
                assert!((found - of(psi)).abs() < 1e-12, "{grading:?} {psi} {found}");
            }
        }
    }

    #[test]
    fn polynomials_interpolate() {
        for grading in [[1, 1], [3, 1], [2, 3]] {
            let nodes = Nodes::of(12, grading);
            let mut values = vec![0.0; 12];
            for psi in [0.0, 0.123, 0.5, 0.987, 1.0] {
                nodes.polynomials(psi, &mut values);
                let pairs = values.iter().zip(&nodes.targets);
                let sum: f64 = pairs.map(|(l, node)| l * node * node).sum();
                assert!((sum - psi * psi).abs() < 1e-12, "{grading:?} {psi} {sum}");
            }
        }
    }
}
