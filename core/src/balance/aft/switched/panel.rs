//! Panels on which the force is no polynomial: a Gauss-Legendre rule on a graded variable.
//!
//! Towards a level the force and its derivatives are sums of powers of the distance, and of logarithms for a derivative by
//! an exponent. The map of [`grading`](crate::numeric::fourier::grading) makes all of them smooth at once, so one set of nodes serves
//! the force and every derivative, whatever the exponents.
//!
//! How many nodes suffice, [`spectrum`](super::spectrum) tells. Where there is no rule with that number, the panel is cut in two.
//!
//! A sum of harmonics is rounded by about `e S`, with the sum `S` of their sizes and the unit roundoff `e`. Where the gap goes no farther
//! beyond its level than `h`, the force has a rounding of
//!
//! ```text
//! min(|phi| / h, |phi_g|) e S  +  |phi_r| e S_r                                                               (1)
//! ```
//!
//! with the sum `S_r` of the rate, and no rule has to see what is smaller: on a contact as short as that the halves of a part are as rough as the part.

use super::cut::{End, Panel};
use super::spectrum::Spectrum;
use super::{Changing, Sums, Wanted, overlooks};
use crate::balance::aft::ContactInput;
use crate::law::{Derivatives, On, PieceFacts, Variation};
use crate::laws::generic::scales::Scales;
use crate::numeric::fourier::gauss;
use crate::numeric::fourier::gauss::Rule;
use crate::numeric::fourier::grading::{Grading, power_for};
use crate::numeric::fourier::kernels::{evaluate, padded, project};
use crate::numeric::fourier::phases::sines_and_cosines;
use crate::numeric::fourier::series;
use crate::numeric::fourier::taylor::Taylor;

/// Nodes beyond those that the harmonics take, at first.
const MARGIN: f64 = 12.0;
/// Error aimed at in the harmonics of the force, relative to the largest force on the panel.
const FORCE_ERROR: f64 = 1e-15;
/// The same of the derivatives.
const SLOPE_ERROR: f64 = 1e-11;
/// Halvings of a panel, at most.
const DEPTH: u32 = 12;
/// Rounding of a sum of harmonics, in parts of the sum of their sizes.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Workspace for the nodes of one panel, and the graded rules met so far.
#[derive(Debug, Default)]
pub(super) struct Quadrature {
    rules: Vec<GradedRule>,
    cosines: Vec<f64>,
    sines: Vec<f64>,
    weights: Vec<f64>,
    gap: Vec<f64>,
    rate: Vec<f64>,
    force: Vec<f64>,
    by_gap: Vec<f64>,
    by_rate: Vec<f64>,
    by_argument: Vec<f64>,
    /// The rule in use, and the levels at the ends of the panel.
    current: usize,
    levels: [Option<f64>; 2],
    /// The same with those that the gap only comes near.
    nearest: [Option<f64>; 2],
    /// Rounding of gap and rate.
    rounding: [f64; 2],
    /// The phases while they are rotated.
    rotated: [Vec<f64>; 2],
    /// Multiplications so far, about.
    pub(super) operations: u64,
}

/// A rule on `[0, 1]`, nodes measured from the nearer end.
#[derive(Debug)]
struct GradedRule {
    grading: Grading,
    count: usize,
    /// Distance from the start, or from the end and negative.
    nodes: Vec<f64>,
    weights: Vec<f64>,
    /// Slope of the map.
    slopes: Vec<f64>,
    plain: &'static Rule,
}

/// A part of a panel, and what is known of the part that it is a half of.
#[derive(Debug, Clone, Copy)]
struct Part {
    piece: usize,
    start: f64,
    end: f64,
    /// The powers that its ends need; one where it was only cut.
    ends: Grading,
    /// Halvings that it may still have.
    depth: u32,
    spectra: [Spectrum; 4],
}

impl Part {
    /// Degree of a polynomial that follows one harmonic on it.
    fn degrees(&self) -> f64 {
        0.5 * (self.end - self.start) * self.ends.balanced().stretch()
    }
}

/// The harmonics that a panel must serve.
#[derive(Debug, Clone, Copy)]
struct Demand {
    /// Of the force.
    force: f64,
    /// Of the derivatives.
    slopes: f64,
    /// Of the gap itself.
    own: f64,
}

impl Quadrature {
    /// Adds the integrals over a panel.
    pub(super) fn add(
        &mut self,
        input: ContactInput<'_>,
        panel: &Panel,
        levels: &[f64],
        sums: &mut Sums<'_>,
        scales: &mut Option<Scales>,
    ) {
        let facts = &input.law.facts().pieces[panel.piece];
        let with_arguments = sums.slopes.as_ref().map_or(&[][..], |s| s.arguments());
        let power =
            |end: End, upper: bool| power_at(facts, input.arguments, with_arguments, end, upper);
        let ends = Grading {
            start: power(panel.from, is_upper(panel.from, panel.piece)),
            end: power(panel.to, is_upper(panel.to, panel.piece)),
        };
        let level = |end| match end {
            End::Level(index) => Some(levels[index]),
            End::Near(_) | End::Period => None,
        };
        self.levels = [level(panel.from), level(panel.to)];
        let near = |end| match end {
            End::Level(index) | End::Near(index) => Some(levels[index]),
            End::Period => None,
        };
        self.nearest = [near(panel.from), near(panel.to)];
        let sizes = |of: &[f64]| of.iter().map(|c| c.abs()).sum::<f64>();
        self.rounding = [input.gap, input.rate].map(|of| ROUNDING * sizes(of));
        let top = sums.slopes.as_ref().map_or(sums.force.len(), |slopes| {
            slopes.by_gap.len().max(sums.force.len())
        }) / 2;
        let demand = Demand {
            force: (sums.force.len() / 2) as f64,
            slopes: top as f64,
            own: series::harmonics(input.gap) as f64,
        };
        let part = Part {
            piece: panel.piece,
            start: panel.start,
            end: panel.end,
            ends,
            depth: DEPTH,
            spectra: [Spectrum::UNKNOWN; 4],
        };
        self.part(input, part, demand, sums, scales);
    }

    /// Adds the integrals over a part of a panel.
    fn part(
        &mut self,
        input: ContactInput<'_>,
        part: Part,
        demand: Demand,
        sums: &mut Sums<'_>,
        scales: &mut Option<Scales>,
    ) {
        let Part {
            piece,
            start,
            end,
            depth,
            mut spectra,
            ..
        } = part;
        let grading = part.ends.balanced();
        let degrees = part.degrees();
        let facts = &input.law.facts().pieces[piece];
        let mut wanted = 0.5 * degrees * (demand.slopes + demand.own) + MARGIN;
        let largest = gauss::COUNTS[gauss::COUNTS.len() - 1] as f64;
        while wanted <= largest || depth == 0 {
            self.place(start, end, grading, wanted.ceil() as usize);
            self.evaluate(input, Wanted::of(sums), &part);
            let count = self.rules[self.current].count as f64;
            let mut needed;
            (needed, spectra) = self.needed(facts, &part, demand, sums);
            let nodes = count as usize;
            if depth > 0 && overlooks(scales, piece, [&self.gap[..nodes], &self.rate[..nodes]]) {
                needed = needed.max(2.0 * count);
            }
            if depth == 0 || needed <= count {
                self.sum_up(input, piece, sums);
                return;
            }
            wanted = needed.max(count + 1.0);
        }
        let middle = 0.5 * (start + end);
        let (mut first, mut second) = (part, part);
        (first.end, first.ends.end) = (middle, 1);
        (second.start, second.ends.start) = (middle, 1);
        for mut half in [first, second] {
            (half.depth, half.spectra) = (depth - 1, spectra);
            self.part(input, half, demand, sums, scales);
        }
    }

    /// What the values at the nodes say, and how many nodes they ask for.
    fn needed(
        &self,
        piece: &PieceFacts,
        part: &Part,
        demand: Demand,
        sums: &Sums<'_>,
    ) -> (f64, [Spectrum; 4]) {
        let rule = &self.rules[self.current];
        let (width, degrees) = (part.end - part.start, part.degrees());
        let mut spectra = [Spectrum::UNKNOWN; 4];
        let mut most = 0.0_f64;
        let rounding = self.rounding_on(piece, sums.slopes.is_some());
        let mut look = |which: usize, values: &[f64], harmonics: f64, error: f64| {
            let parent = part.spectra[which];
            let spectrum = Spectrum::of(values, &rule.slopes, rule.plain, width, parent);
            let error = error.max(spectrum.rounding(rounding));
            most = most.max(spectrum.nodes(parent, degrees * harmonics, error));
            spectra[which] = spectrum;
        };
        look(0, &self.force, demand.force, FORCE_ERROR);
        if let Some(slopes) = &sums.slopes {
            look(1, &self.by_gap, demand.slopes, SLOPE_ERROR);
            if piece.by_rate == Variation::Varying {
                look(2, &self.by_rate, demand.slopes, SLOPE_ERROR);
            }
            if slopes.change.is_some_and(|change| change.arguments) {
                look(3, &self.by_argument, demand.force, SLOPE_ERROR);
            }
        }
        (most, spectra)
    }

    /// Rounding of the force at the nodes by (1), in parts of the largest there; that by the rate where slopes are known.
    fn rounding_on(&self, piece: &PieceFacts, with_slopes: bool) -> f64 {
        let count = self.rules[self.current].count;
        let largest = |of: &[f64]| of[..count].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let beyond = |gap: &f64| {
            let ways = self
                .nearest
                .iter()
                .flatten()
                .map(|level| (gap - level).abs());
            ways.fold(f64::INFINITY, f64::min)
        };
        let farthest = self.gap[..count].iter().map(beyond).fold(0.0, f64::max);
        let [gap, rate] = self.rounding;
        let force = largest(&self.force);
        let mut sum = gap / farthest;
        if with_slopes && force > 0.0 {
            // Less where the force is more than what it is of the gap, as behind a jump.
            sum = sum.min(largest(&self.by_gap) * gap / force);
            if piece.by_rate != Variation::Zero {
                sum += largest(&self.by_rate) * rate / force;
            }
        }
        sum
    }

    /// Puts nodes on a part of a panel.
    fn place(&mut self, start: f64, end: f64, grading: Grading, count: usize) {
        let index = self.rule(grading, count);
        let rule = &self.rules[index];
        let nodes = padded(rule.nodes.len());
        let [c, s] = &mut self.rotated;
        for workspace in [
            &mut self.cosines,
            &mut self.sines,
            &mut self.weights,
            &mut self.gap,
            &mut self.rate,
            &mut self.force,
            &mut self.by_gap,
            &mut self.by_rate,
            &mut self.by_argument,
            c,
            s,
        ] {
            workspace.resize(nodes, 0.0);
        }
        let width = end - start;
        for (j, (node, weight)) in rule.nodes.iter().zip(&rule.weights).enumerate() {
            let base = if node.is_sign_negative() { end } else { start };
            // Phases stand where the gaps will.
            self.gap[j] = base + width * node;
            self.weights[j] = weight * width / std::f64::consts::TAU;
        }
        // Nodes that only fill the last group stand where the last one stands and weigh nothing.
        let count = rule.nodes.len();
        for j in count..nodes {
            self.gap[j] = self.gap[count - 1];
            self.weights[j] = 0.0;
        }
        sines_and_cosines(&self.gap, &mut self.sines, &mut self.cosines);
        self.current = index;
    }

    fn rule(&mut self, grading: Grading, count: usize) -> usize {
        let plain = gauss::rule(count);
        let count = plain.nodes.len();
        let known = self
            .rules
            .iter()
            .position(|rule| rule.grading == grading && rule.count == count);
        known.unwrap_or_else(|| {
            let mut rule = GradedRule {
                grading,
                count,
                nodes: Vec::new(),
                weights: Vec::new(),
                slopes: Vec::new(),
                plain,
            };
            for (s, w) in plain.nodes.iter().zip(&plain.weights) {
                let (distance, slope, from_start) = grading.distance(*s);
                rule.nodes
                    .push(if from_start { distance } else { -distance });
                rule.weights.push(w * slope);
                rule.slopes.push(slope);
            }
            self.rules.push(rule);
            self.rules.len() - 1
        })
    }

    /// The law at the nodes, as far as wanted.
    fn evaluate(&mut self, input: ContactInput<'_>, wanted: Wanted<'_>, part: &Part) {
        // At each node two series and what is projected on harmonics, sine and cosine, and the law.
        self.operations += (self.gap.len() * (4 * input.gap.len() + 64)) as u64;
        evaluate(
            [input.gap, input.rate],
            &self.cosines,
            &self.sines,
            &mut self.gap,
            &mut self.rate,
        );
        self.sharpen(input, part);
        let (on, gap, rate) = (On::Piece(part.piece), &self.gap, &self.rate);
        let changing = match wanted {
            Wanted::Force => {
                input
                    .law
                    .force(on, input.arguments, gap, rate, &mut self.force);
                return;
            }
            Wanted::Slopes => None,
            Wanted::Changes(changing) => Some(changing),
        };
        let mut changing = changing.into_iter().flat_map(Changing::arguments);
        let out = Derivatives {
            force: &mut self.force,
            by_gap: &mut self.by_gap,
            by_rate: &mut self.by_rate,
        };
        let Some((argument, by)) = changing.next() else {
            input.law.derivatives(on, input.arguments, gap, rate, out);
            return;
        };
        let by_argument = &mut self.by_argument;
        input
            .law
            .derivatives_and_by(argument, on, input.arguments, gap, rate, out, by_argument);
        for slope in by_argument.iter_mut() {
            *slope *= by;
        }
        for (argument, by) in changing {
            let out = Derivatives {
                force: &mut self.force,
                by_gap: &mut self.by_gap,
                by_rate: &mut self.by_rate,
            };
            let [other, _] = &mut self.rotated;
            input
                .law
                .derivatives_and_by(argument, on, input.arguments, gap, rate, out, other);
            for (sum, slope) in self.by_argument.iter_mut().zip(other) {
                *sum += by * *slope;
            }
        }
    }

    /// Replaces the gap close to a singular end by its Taylor polynomial there: a small distance from the level keeps all its
    /// digits then, which an exponent below one needs. (Where the level is not zero, the sum of both is rounded.)
    fn sharpen(&mut self, input: ContactInput<'_>, part: &Part) {
        let near = Taylor::reach(input.gap);
        let width = part.end - part.start;
        let rule = &self.rules[self.current];
        let [first, last] = self.levels;
        if let Some(level) = first.filter(|_| part.ends.start > 1) {
            let taylor = Taylor::at(input.gap, part.start);
            let nodes = rule.nodes.iter().zip(&mut self.gap);
            let close = |node: f64| !node.is_sign_negative() && node * width < near;
            for (node, gap) in nodes.take_while(|(node, _)| close(**node)) {
                *gap = taylor.value(level, width * node);
            }
        }
        if let Some(level) = last.filter(|_| part.ends.end > 1) {
            let taylor = Taylor::at(input.gap, part.end);
            let nodes = rule.nodes.iter().zip(&mut self.gap).rev();
            let close = |node: f64| node.is_sign_negative() && -node * width < near;
            for (node, gap) in nodes.take_while(|(node, _)| close(**node)) {
                *gap = taylor.value(level, width * node);
            }
        }
    }

    /// Adds the weighted harmonics of what was evaluated.
    fn sum_up(&mut self, input: ContactInput<'_>, piece: usize, sums: &mut Sums<'_>) {
        self.add_weighted(Which::Force, sums.force);
        let Some(slopes) = &mut sums.slopes else {
            return;
        };
        let facts = &input.law.facts().pieces[piece];
        if facts.by_gap != Variation::Zero {
            self.add_weighted(Which::ByGap, slopes.by_gap);
        }
        if facts.by_rate != Variation::Zero {
            self.add_weighted(Which::ByRate, slopes.by_rate);
        }
        if let Some(changing) = slopes.change {
            self.add_by_parameter(facts, changing, slopes.by_parameter);
        }
    }

    /// Adds `phi_g dg + phi_r dr + phi_a da`; the first two factors have been weighted already.
    fn add_by_parameter(&mut self, facts: &PieceFacts, changing: Changing<'_>, to: &mut [f64]) {
        if changing.arguments {
            weigh(&self.weights, &mut self.by_argument);
        } else {
            self.by_argument.fill(0.0);
        }
        if changing.motion {
            evaluate(
                [changing.change.gap, changing.change.rate],
                &self.cosines,
                &self.sines,
                &mut self.gap,
                &mut self.rate,
            );
            let mut add = |slopes: &[f64], change: &[f64]| {
                for ((sum, slope), by) in self.by_argument.iter_mut().zip(slopes).zip(change) {
                    *sum += slope * by;
                }
            };
            if facts.by_gap != Variation::Zero {
                add(&self.by_gap, &self.gap);
            }
            if facts.by_rate != Variation::Zero {
                add(&self.by_rate, &self.rate);
            }
        }
        if changing.motion || changing.arguments {
            let [c, s] = &mut self.rotated;
            project(&self.by_argument, &self.cosines, &self.sines, c, s, to);
        }
    }

    fn add_weighted(&mut self, which: Which, series: &mut [f64]) {
        let values = match which {
            Which::Force => &mut self.force,
            Which::ByGap => &mut self.by_gap,
            Which::ByRate => &mut self.by_rate,
        };
        weigh(&self.weights, values);
        let [c, s] = &mut self.rotated;
        project(values, &self.cosines, &self.sines, c, s, series);
    }
}

/// A quantity at the nodes.
#[derive(Clone, Copy)]
enum Which {
    Force,
    ByGap,
    ByRate,
}

fn weigh(weights: &[f64], values: &mut [f64]) {
    for (value, weight) in values.iter_mut().zip(weights) {
        *value *= weight;
    }
}

/// Whether an end of a panel is at the upper level of its piece.
fn is_upper(end: End, piece: usize) -> bool {
    matches!(end, End::Level(level) | End::Near(level) if level == piece)
}

/// The power of the grading that an end of a panel needs: by the exponents of the force and its derivatives there.
pub(super) fn power_at(
    facts: &PieceFacts,
    arguments: &[f64],
    changing: &[f64],
    end: End,
    upper: bool,
) -> u32 {
    if end == End::Period {
        return 1;
    }
    let terms = facts.terms.iter().filter(|term| match term.of {
        crate::law::Quantity::ByArgument(index) => changing.get(index).is_some_and(|by| *by != 0.0),
        _ => true,
    });
    power_for(&terms.map(|term| {
        let exponent = if upper { term.upper } else { term.lower };
        (exponent.value(arguments), term.logarithm)
    }))
}
