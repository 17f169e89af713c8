//! Exact switching against quadrature by another rule, and its Jacobian against differences.

use std::f64::consts::{PI, TAU};

use super::*;
use crate::law::Law;
use crate::numeric::fourier::crossings::{Crossing, crossings};
use crate::system::System;
use crate::testing::by_hand::PowerForm;
use crate::testing::random::Random;

const BASE: f64 = 0.9;

/// One contact and its gap.
struct Case {
    system: PowerForm,
    arguments: [f64; 2],
    gap: Vec<f64>,
}

impl Case {
    fn new(one_sided: bool, alpha: f64, gap: Vec<f64>) -> Self {
        let zeta = 0.05;
        Self {
            system: PowerForm::new(one_sided, alpha, zeta, 1.0, 1.0),
            arguments: [zeta, alpha],
            gap,
        }
    }

    fn law(&self) -> &dyn Law {
        self.system.law(0)
    }

    fn rate(gap: &[f64]) -> Vec<f64> {
        let mut rate = gap.to_vec();
        crate::balance::rate_series(gap, BASE, &mut rate);
        rate
    }

    fn force(&self, aft: &mut SwitchedAft, gap: &[f64], arguments: &[f64]) -> Vec<f64> {
        let mut force = vec![0.0; gap.len()];
        let input = ContactInput {
            law: self.law(),
            arguments,
            gap,
            rate: &Self::rate(gap),
            base: BASE,
        };
        aft.force(input, &mut force);
        force
    }
}

/// A gap of a few harmonics that falls off as those of an oscillator do.
fn random_gap(random: &mut Random, harmonics: usize) -> Vec<f64> {
    let mut gap = vec![random.between(-0.8, 0.8)];
    for k in 1..=harmonics {
        let size = 1.0 / (k * k) as f64;
        gap.push(random.between(-size, size));
        gap.push(random.between(-size, size));
    }
    gap
}

/// Smallest speed `|g'|` at which a gap crosses zero; infinity if it does not.
fn slowest(gap: &[f64]) -> f64 {
    let mut found: Vec<Crossing> = Vec::new();
    crossings(gap, 0.0, &mut found);
    found
        .iter()
        .map(|c| series::value_and_derivatives(gap, c.tau).1.abs())
        .fold(f64::INFINITY, f64::min)
}

/// Smallest `|g|` at an extremum: how near the gap comes to grazing.
fn nearest_miss(gap: &[f64]) -> f64 {
    let mut slope = gap.to_vec();
    series::differentiate(gap, &mut slope);
    let mut found = Vec::new();
    crossings(&slope, 0.0, &mut found);
    found
        .iter()
        .map(|c| series::value(gap, c.tau).abs())
        .fold(f64::INFINITY, f64::min)
}

/// Harmonics of the force by the doubly exponential rule of Takahasi and Mori (1974) on every panel.
fn by_another_rule(case: &Case) -> Vec<f64> {
    let mut found: Vec<Crossing> = Vec::new();
    crossings(&case.gap, 0.0, &mut found);
    let mut ends: Vec<f64> = found.iter().map(|c| c.tau).collect();
    if ends.is_empty() {
        ends.push(0.0);
    }
    ends.push(ends[0] + TAU);
    let rate = Case::rate(&case.gap);
    let mut force = vec![0.0; case.gap.len()];
    let pieces = if found.is_empty() { 64 } else { 1 };
    for pair in ends.windows(2) {
        let middle = series::value(&case.gap, 0.5 * (pair[0] + pair[1]));
        let piece = usize::from(middle > 0.0);
        for part in 0..pieces {
            let width = (pair[1] - pair[0]) / f64::from(pieces);
            let start = pair[0] + width * f64::from(part);
            doubly_exponential(start, start + width, |tau, weight| {
                let (gap, rate) = ([series::value(&case.gap, tau)], [series::value(&rate, tau)]);
                let mut at = [0.0];
                case.law()
                    .force(On::Piece(piece), &case.arguments, &gap, &rate, &mut at);
                force[0] += weight * at[0] / TAU;
                for k in 1..=force.len() / 2 {
                    let (sine, cosine) = (k as f64 * tau).sin_cos();
                    force[2 * k - 1] += weight * at[0] * cosine / PI;
                    force[2 * k] += weight * at[0] * sine / PI;
                }
            });
        }
    }
    force
}

fn doubly_exponential(start: f64, end: f64, mut add: impl FnMut(f64, f64)) {
    let h = 1.0 / 128.0;
    for step in -512..=512 {
        let t = h * f64::from(step);
        let (inner, slope) = (0.5 * PI * t.sinh(), 0.5 * PI * t.cosh());
        // The distance from the nearer end, without cancellation.
        let distance = 1.0 / (1.0 + (2.0 * inner.abs()).exp());
        let weight = h * slope * 2.0 * distance * (1.0 - distance);
        let width = end - start;
        let tau = if t < 0.0 {
            start + width * distance
        } else {
            end - width * distance
        };
        add(tau, weight * width);
    }
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    let differences = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    differences.fold(0.0, f64::max)
}

#[test]
fn forces_agree_with_another_rule() {
    let mut random = Random::seeded(1);
    let mut aft = SwitchedAft::default();
    let mut worst = 0.0_f64;
    for index in 0..600 {
        let alpha = match index % 6 {
            0 => 1.5,
            1 => 0.6,
            2 => random.between(0.99, 1.01),
            3 => 1.0 / 3.0,
            4 => 2.5,
            _ => random.between(0.3, 4.0),
        };
        let gap = random_gap(&mut random, 1 + index % 12);
        if nearest_miss(&gap) < 0.05 || slowest(&gap) < 0.1 {
            continue;
        }
        let case = Case::new(index % 2 == 0, alpha, gap);
        let force = case.force(&mut aft, &case.gap, &case.arguments);
        let error = largest_difference(&force, &by_another_rule(&case));
        worst = worst.max(error);
        assert!(error < 2e-12, "{index} {alpha} {error:e} {:?}", case.gap);
    }
    println!("largest difference {worst:e}");
}

/// The derivative of the force in a direction, by (2) and by differences.
fn slope_error(
    case: &Case,
    aft: &mut SwitchedAft,
    direction: &[f64],
    by_alpha: f64,
    step: f64,
) -> f64 {
    let rate = Case::rate(&case.gap);
    let length = case.gap.len();
    let (mut force, mut by_parameter) = (vec![0.0; length], vec![0.0; length]);
    let (mut by_gap, mut by_rate) = (vec![0.0; 2 * length - 1], vec![0.0; 2 * length - 1]);
    let input = ContactInput {
        law: case.law(),
        arguments: &case.arguments,
        gap: &case.gap,
        rate: &rate,
        base: BASE,
    };
    let change = Change {
        gap: direction,
        rate: &Case::rate(direction),
        arguments: &[0.0, by_alpha],
        base: 0.0,
    };
    let mut out = ContactDerivatives {
        by_gap: &mut by_gap,
        by_rate: &mut by_rate,
        by_parameter: &mut by_parameter,
    };
    aft.derivatives(input, Some(change), &mut force, &mut out);
    let best = difference(step, |h| {
        let pairs = case.gap.iter().zip(direction);
        let moved: Vec<f64> = pairs.map(|(x, d)| x + h * d).collect();
        let [zeta, alpha] = [case.arguments[0], case.arguments[1] + h * by_alpha];
        case.force(aft, &moved, &[zeta, alpha])
    });
    let size = best.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    largest_difference(&best, &by_parameter) / size
}

/// The derivative by `h` at zero: central differences of step `h`, `h / 2`, ..., extrapolated (Richardson 1911); the most consistent pair
/// counts.
fn difference(step: f64, mut at: impl FnMut(f64) -> Vec<f64>) -> Vec<f64> {
    let mut table: Vec<Vec<f64>> = Vec::new();
    let (mut best, mut change) = (Vec::new(), f64::INFINITY);
    for level in 0..8 {
        let h = step * 0.5_f64.powi(level);
        let (ahead, back) = (at(h), at(-h));
        let pairs = ahead.iter().zip(&back);
        let mut row: Vec<Vec<f64>> = vec![pairs.map(|(a, b)| (a - b) / (2.0 * h)).collect()];
        for (order, before) in table.iter().enumerate() {
            let factor = 4_f64.powi(order as i32 + 1);
            let finer = &row[order];
            row.push(
                finer
                    .iter()
                    .zip(before)
                    .map(|(f, c)| f + (f - c) / (factor - 1.0))
                    .collect(),
            );
        }
        for pair in row.windows(2) {
            let moved = largest_difference(&pair[0], &pair[1]);
            if moved < change {
                (best, change) = (pair[1].clone(), moved);
            }
        }
        table = row;
    }
    best
}

#[test]
fn slopes_agree_with_differences() {
    let mut random = Random::seeded(2);
    let mut aft = SwitchedAft::default();
    let (mut worst, mut tried) = (0.0_f64, 0);
    while tried < 10_000 {
        let alpha = [1.5, 0.6, 1.0, 2.5, random.between(0.4, 4.0)][tried % 5];
        let gap = random_gap(&mut random, 1 + tried % 10);
        // Differences need room: they must not step over a grazing contact.
        if nearest_miss(&gap) < 0.2 || slowest(&gap) < 0.1 {
            continue;
        }
        tried += 1;
        let case = Case::new(tried % 2 == 0, alpha, gap);
        let (direction, by_alpha, step) = if tried % 3 == 0 {
            (vec![0.0; case.gap.len()], 1.0, 0.1 * alpha)
        } else {
            (random_gap(&mut random, case.gap.len() / 2), 0.0, 2e-2)
        };
        let error = slope_error(&case, &mut aft, &direction, by_alpha, step);
        worst = worst.max(error);
        assert!(error < 1e-9, "{alpha} {by_alpha} {error:e} {:?}", case.gap);
    }
    println!("largest difference {worst:e}");
}

/// The series of the stiffness by the doubly exponential rule, with panels cut at crossings and at the phases given.
fn stiffness_by_another_rule(case: &Case, cuts: &[f64]) -> Vec<f64> {
    let mut found: Vec<Crossing> = Vec::new();
    crossings(&case.gap, 0.0, &mut found);
    let mut ends: Vec<f64> = found
        .iter()
        .map(|c| c.tau)
        .chain(cuts.iter().copied())
        .collect();
    ends.sort_by(f64::total_cmp);
    ends.push(ends[0] + TAU);
    let mut stiffness = vec![0.0; 2 * case.gap.len() - 1];
    for pair in ends.windows(2) {
        let piece = usize::from(series::value(&case.gap, 0.5 * (pair[0] + pair[1])) > 0.0);
        for part in 0..4 {
            let width = 0.25 * (pair[1] - pair[0]);
            let start = pair[0] + width * f64::from(part);
            doubly_exponential(start, start + width, |tau, weight| {
                let (mut force, mut by_gap, mut by_rate) = ([0.0], [0.0], [0.0]);
                let out = crate::law::Derivatives {
                    force: &mut force,
                    by_gap: &mut by_gap,
                    by_rate: &mut by_rate,
                };
                let gap = [series::value(&case.gap, tau)];
                case.law()
                    .derivatives(On::Piece(piece), &case.arguments, &gap, &[0.0], out);
                stiffness[0] += weight * by_gap[0] / TAU;
                for k in 1..=stiffness.len() / 2 {
                    let (sine, cosine) = (k as f64 * tau).sin_cos();
                    stiffness[2 * k - 1] += weight * by_gap[0] * cosine / PI;
                    stiffness[2 * k] += weight * by_gap[0] * sine / PI;
                }
            });
        }
    }
    stiffness
}

/// A gap with an extremum on either side of grazing, at a distance from 1e-2 to 1e-6, and the phases of all extrema.
fn nearly_grazing(random: &mut Random, index: usize) -> Option<(Vec<f64>, Vec<f64>)> {
    let mut gap = random_gap(random, 1 + index % 6);
    let mut slope = gap.clone();
    series::differentiate(&gap, &mut slope);
    let mut extrema = Vec::new();
    crossings(&slope, 0.0, &mut extrema);
    let extremum = extrema.get(index % extrema.len().max(1))?;
    let distance = 10_f64.powf(random.between(-6.0, -2.0));
    let sign = if random.between(0.0, 1.0) < 0.5 {
        -1.0
    } else {
        1.0
    };
    gap[0] += sign * distance - series::value(&gap, extremum.tau);
    Some((gap, extrema.iter().map(|c| c.tau).collect()))
}

#[test]
fn stiffness_near_grazing_agrees_with_another_rule() {
    let mut random = Random::seeded(3);
    let mut aft = SwitchedAft::default();
    let mut worst = [0.0_f64; 4];
    for index in 0..600 {
        let which = index % 4;
        let alpha = [0.6, 1.0, 1.5, 2.5][which];
        let Some((gap, cuts)) = nearly_grazing(&mut random, index) else {
            continue;
        };
        let case = Case::new(index % 8 < 4, alpha, gap);
        let rate = Case::rate(&case.gap);
        let length = case.gap.len();
        let (mut force, mut by_rate) = (vec![0.0; length], vec![0.0; 2 * length - 1]);
        let mut by_gap = vec![0.0; 2 * length - 1];
        let mut out = ContactDerivatives {
            by_gap: &mut by_gap,
            by_rate: &mut by_rate,
            by_parameter: &mut [0.0],
        };
        let input = ContactInput {
            law: case.law(),
            arguments: &case.arguments,
            gap: &case.gap,
            rate: &rate,
            base: BASE,
        };
        let mut without = vec![0.0; 2 * length - 1];
        aft.derivatives(input, None, &mut force, &mut out);
        without.copy_from_slice(out.by_gap);
        // The impulses of the damping's jump are exact; they are taken out again.
        aft.cut.apply(input);
        for switch in aft.cut.switches() {
            let speed = series::value_and_derivatives(&case.gap, switch.tau).1;
            if index % 8 < 4 {
                let jump = 2.0 * case.arguments[0] * BASE * speed;
                add_impulse(switch.tau, -jump / speed.abs(), &mut without);
            }
        }
        let expected = stiffness_by_another_rule(&case, &cuts);
        let size = expected.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
        let error = largest_difference(&without, &expected) / size;
        worst[which] = worst[which].max(error);
    }
    println!("largest differences {worst:?}");
    // With the exponent 0.6 the stiffness grows as the power -0.4 of a distance of 1e-6.
    assert!(worst[0] < 2e-7, "{:e}", worst[0]);
    assert!(worst[1..].iter().all(|error| *error < 1e-7), "{worst:?}");
}

/// An orbit that touches its level, wherever on the period, stays on the side of its mean.
#[test]
fn a_touch_is_no_switch_at_any_phase() {
    let mut aft = SwitchedAft::default();
    let mut means = Vec::new();
    for lag in [0.0, 1.0, PI] {
        let gap: Vec<f64> = vec![1.0, -f64::cos(lag), -f64::sin(lag)];
        let case = Case::new(true, 1.5, gap);
        means.push(case.force(&mut aft, &case.gap, &case.arguments)[0]);
    }
    // The mean of (1 - cos t)^1.5 is 2^1.5 times that of |sin|^3, which is 4 / (3 pi).
    let exact = 2.0_f64.powf(1.5) * 4.0 / (3.0 * PI);
    for mean in means {
        assert!((mean - exact).abs() < 1e-9, "{mean} {exact}");
    }
}

/// A contact as short as a thousandth of the period: `int (cos t - cos h)^1.5` is nearly that of a parabola.
#[test]
fn short_contacts_have_their_closed_form() {
    let mut aft = SwitchedAft::default();
    for half in [1e-2_f64, 5e-4, 1e-5] {
        let case = Case::new(true, 1.5, vec![-half.cos(), 1.0, 0.0]);
        // Without damping, whose mean vanishes but for rounding, and that would be more than the spring.
        let force = case.force(&mut aft, &case.gap, &[0.0, 1.5]);
        // With u = t / h the gap is h^2 (1 - u^2) / 2, to a relative h^2; int (1 - u^2)^1.5 over [-1, 1] is 3 pi / 8.
        let expected = half * (0.5 * half * half).powf(1.5) * 3.0 * PI / 8.0 / TAU;
        let allowed = half * half + 1e-13 / (half * half);
        let error = (force[0] / expected - 1.0).abs();
        assert!(error < allowed, "{half} {error:e}");
    }
}

/// An odd orbit of period one in a balance of period 35 has its harmonics at 35 and 105, and its cube at 35, 105, ..., 315: with 256
/// samples 175, 245 and 315 come down to 81, 11 and 59, and nothing is left at the upper end.
#[test]
fn samples_suffice_for_a_spectrum_with_holes() {
    let mut gap = vec![0.0; series::length(105)];
    (gap[69], gap[70], gap[209]) = (0.8, 0.3, 0.1);
    let mut simple = vec![0.0; series::length(3)];
    (simple[1], simple[2], simple[5]) = (0.8, 0.3, 0.1);
    let (long, short) = (Case::new(false, 3.0, gap), Case::new(false, 3.0, simple));
    let mut aft = SwitchedAft::default();
    // Away from the level there is one piece.
    let away = |case: &Case| {
        let mut gap = case.gap.clone();
        gap[0] = 3.0;
        gap
    };
    let force = long.force(&mut aft, &away(&long), &[0.0, 3.0]);
    let expected = short.force(&mut aft, &away(&short), &[0.0, 3.0]);
    for k in 1..=105 {
        let found = force[2 * k - 1].hypot(force[2 * k]);
        let wanted = if k.is_multiple_of(35) {
            expected[2 * (k / 35) - 1].hypot(expected[2 * (k / 35)])
        } else {
            0.0
        };
        assert!((found - wanted).abs() < 1e-11, "{k}: {found} {wanted}");
    }
}
