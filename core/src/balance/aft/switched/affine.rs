//! Pieces on which the force is `c_0 + c_1 g + c_2 r`, in closed form.
//!
//! Let `chi` be one on the panels of the piece and zero elsewhere. Its harmonics are
//!
//! ```text
//! 1/pi sum over panels int_a^b e^(i k tau) dtau = 1/pi sum [ e^(i k b) - e^(i k a) ] / (i k)                  (1)
//! ```
//!
//! and the force is `chi (c_0 + c_1 g + c_2 r)`, its derivatives `c_1 chi` and `c_2 chi`: products of series.

use std::f64::consts::{FRAC_1_PI, TAU};

use super::cut::Panel;
use super::{Changing, Sums};
use crate::balance::aft::ContactInput;
use crate::law::{Derivatives, On};
use crate::laws::single::Single;
use crate::numeric::fourier::kernels::Product;
use crate::numeric::fourier::series;

/// Workspace for the series of `chi` and of the force on the piece.
#[derive(Debug, Default)]
pub(super) struct Affine {
    indicator: Vec<f64>,
    inside: Vec<f64>,
    /// Multiplications so far, about.
    pub(super) operations: u64,
}

/// `c_0 + c_1 g + c_2 r`
#[derive(Debug, Clone, Copy)]
struct Form {
    constant: f64,
    by_gap: f64,
    by_rate: f64,
}

/// A gap on the piece, and the levels.
#[derive(Debug, Clone, Copy)]
struct Place<'l> {
    piece: usize,
    point: f64,
    levels: &'l [f64],
}

impl Affine {
    /// Adds the panels of one piece that is affine.
    pub(super) fn add<'p>(
        &mut self,
        input: ContactInput<'_>,
        levels: &[f64],
        panels: impl Iterator<Item = &'p Panel> + Clone,
        product: &mut Product,
        sums: &mut Sums<'_>,
    ) {
        let Some(first) = panels.clone().next() else {
            return;
        };
        let point = series::value(input.gap, 0.5 * (first.start + first.end));
        let piece = first.piece;
        let place = Place {
            piece,
            point,
            levels,
        };
        let form = Form::of(input, piece, point);
        if panels.clone().any(Panel::is_period) {
            add_everywhere(input, form, place, sums);
            return;
        }
        let slopes = sums.slopes.as_ref().map_or(0, |s| s.by_gap.len());
        let needed = (sums.force.len() + input.gap.len() - 1).max(slopes);
        self.operations += (sums.force.len() * input.gap.len()) as u64;
        self.indicator.clear();
        self.indicator.resize(needed, 0.0);
        for panel in panels {
            add_step(panel.end, 1.0, &mut self.indicator);
            add_step(panel.start, -1.0, &mut self.indicator);
            self.indicator[0] += (panel.end - panel.start) / TAU;
        }
        self.times(input, form, product, sums.force);
        if let Some(slopes) = &mut sums.slopes {
            add_scaled(&self.indicator, form.by_gap, slopes.by_gap);
            add_scaled(&self.indicator, form.by_rate, slopes.by_rate);
            if let Some(changing) = slopes.change {
                self.inside.clear();
                self.inside.resize(input.gap.len(), 0.0);
                form.add_change(input, changing, place, &mut self.inside);
                product.add(&self.indicator, &self.inside, slopes.by_parameter);
            }
        }
    }

    /// Adds `chi (c_0 + c_1 g + c_2 r)`.
    fn times(
        &mut self,
        input: ContactInput<'_>,
        form: Form,
        product: &mut Product,
        to: &mut [f64],
    ) {
        self.inside.clear();
        self.inside.resize(input.gap.len(), 0.0);
        form.add_to(input, &mut self.inside);
        product.add(&self.indicator, &self.inside, to);
    }
}

/// The orbit never leaves the piece: the answer is the linear one.
fn add_everywhere(input: ContactInput<'_>, form: Form, place: Place<'_>, sums: &mut Sums<'_>) {
    form.add_to(input, sums.force);
    if let Some(slopes) = &mut sums.slopes {
        slopes.by_gap[0] += form.by_gap;
        slopes.by_rate[0] += form.by_rate;
        if let Some(changing) = slopes.change {
            form.add_change(input, changing, place, slopes.by_parameter);
        }
    }
}

/// Adds `[e^(i k tau) / (i k)] / pi` for every harmonic but the mean, times a sign.
fn add_step(tau: f64, sign: f64, to: &mut [f64]) {
    let (sine, cosine) = tau.sin_cos();
    let (mut c, mut s) = (sign * FRAC_1_PI, 0.0);
    for (index, pair) in to[1..].chunks_exact_mut(2).enumerate() {
        (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
        let k = (index + 1) as f64;
        pair[0] += s / k;
        pair[1] -= c / k;
    }
}

fn add_scaled(from: &[f64], factor: f64, to: &mut [f64]) {
    if factor != 0.0 {
        for (to, from) in to.iter_mut().zip(from) {
            *to += factor * from;
        }
    }
}

impl Form {
    /// Of the force on a piece, from its values near a gap that lies on the piece.
    fn of(input: ContactInput<'_>, piece: usize, gap: f64) -> Self {
        let at = Single::of(input.law, On::Piece(piece), input.arguments, [gap, 0.0]);
        Self {
            constant: at.force - at.by_gap * gap,
            by_gap: at.by_gap,
            by_rate: at.by_rate,
        }
    }

    /// Adds `c_0 + c_1 g + c_2 r`, dropping harmonics that there is no room for.
    fn add_to(self, input: ContactInput<'_>, to: &mut [f64]) {
        to[0] += self.constant;
        add_scaled(input.gap, self.by_gap, to);
        add_scaled(input.rate, self.by_rate, to);
    }

    /// Adds what the parameter does, dropping harmonics that there is no room for.
    fn add_change(
        self,
        input: ContactInput<'_>,
        changing: Changing<'_>,
        place: Place<'_>,
        to: &mut [f64],
    ) {
        add_scaled(changing.change.gap, self.by_gap, to);
        add_scaled(changing.change.rate, self.by_rate, to);
        if changing.arguments {
            by_arguments(input, changing, place).add_to(input, to);
        }
    }
}

/// The change of the force with the arguments that change: affine as the force is.
fn by_arguments(input: ContactInput<'_>, changing: Changing<'_>, place: Place<'_>) -> Form {
    let Place {
        piece,
        point: gap,
        levels,
    } = place;
    let mut sum = Form {
        constant: 0.0,
        by_gap: 0.0,
        by_rate: 0.0,
    };
    // Three points on the piece: the middle of a panel, halfway to the nearest level, and another rate.
    let level = nearest_level(levels, piece, gap);
    let other = level.map_or(gap + gap.abs().max(1.0), |level| 0.5 * (gap + level));
    let gaps = [gap, other, gap];
    let speed = input.base * (gap - other).abs();
    let rates = [0.0, 0.0, speed];
    let mut workspace = [[0.0; 3]; 3];
    for (argument, by) in changing.arguments() {
        let [force, by_gap, by_rate] = &mut workspace;
        let out = Derivatives {
            force,
            by_gap,
            by_rate,
        };
        let mut values = [0.0; 3];
        input.law.derivatives_and_by(
            argument,
            On::Piece(piece),
            input.arguments,
            &gaps,
            &rates,
            out,
            &mut values,
        );
        let slope = (values[1] - values[0]) / (other - gap);
        sum.constant += by * (values[0] - slope * gap);
        sum.by_gap += by * slope;
        if speed > 0.0 {
            sum.by_rate += by * (values[2] - values[0]) / speed;
        }
    }
    sum
}

fn nearest_level(levels: &[f64], piece: usize, gap: f64) -> Option<f64> {
    let below = piece.checked_sub(1).map(|index| levels[index]);
    let above = levels.get(piece).copied();
    let distance = |level: &f64| (level - gap).abs();
    below
        .into_iter()
        .chain(above)
        .filter(|level| *level != gap)
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
}
