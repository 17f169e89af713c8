//! Where contact is lost: the largest response of a loaded one-sided contact that never opens.

use std::ops::{ControlFlow, RangeInclusive};

use hertzian::{Branch, Cancel, FrequencyResponse};

use super::models::declared;
use crate::model::ModelOptions;

/// Frequencies at which the boundary is computed first.
const FREQUENCIES: usize = 61;
/// How often the space between two of them is halved at most.
const HALVINGS: usize = 3;
/// Where the middle lies within this part of the largest value beside the straight line, a line is what one sees.
const STRAIGHT: f64 = 0.002;
/// The orbit never leaves one piece of the law, so a few harmonics are as good as many.
const HARMONICS: usize = 6;
const SAMPLES: usize = 64;
/// More points than this at one frequency are not worth a reference line.
const POINTS: usize = 200;

/// Points `[omega, peak-to-peak]` on which the smallest displacement is zero; not a number where none was found, and
/// nothing at all for a contact that cannot open or is not loaded.
///
/// At each frequency the amplitude of the excitation is raised from nearly nothing until the orbit touches zero.
pub fn loss_of_contact(
    options: &ModelOptions,
    frequencies: RangeInclusive<f64>,
    cancel: &Cancel,
) -> Vec<[f64; 2]> {
    if !options.loses_contact() || options.load <= 0.0 {
        return Vec::new();
    }
    let (first, last) = frequencies.into_inner();
    let touch = |omega| {
        [
            omega,
            at_frequency(options, omega, cancel).unwrap_or(f64::NAN),
        ]
    };
    let mut points: Vec<_> = (0..FREQUENCIES)
        .map(|index| first + (last - first) * index as f64 / (FREQUENCIES - 1) as f64)
        .take_while(|_| !cancel.is_cancelled())
        .map(touch)
        .collect();
    for _ in 0..HALVINGS {
        points = halved(&points, |omega| {
            (!cancel.is_cancelled()).then(|| touch(omega))
        });
    }
    points
}

/// The points, with those in the middle between two of them where three in a row bend.
fn halved(points: &[[f64; 2]], touch: impl Fn(f64) -> Option<[f64; 2]>) -> Vec<[f64; 2]> {
    let largest = points.iter().fold(0.0, |largest: f64, p| largest.max(p[1]));
    let bends = |middle: usize| {
        let Some([[x, a], [y, b], [z, c]]) = middle
            .checked_sub(1)
            .and_then(|first| points.get(first..first + 3))
        else {
            return false;
        };
        let line = a + (c - a) * (y - x) / (z - x);
        (b - line).abs() > STRAIGHT * largest
    };
    let mut all = Vec::with_capacity(2 * points.len());
    for (index, &point) in points.iter().enumerate() {
        all.push(point);
        let next = points.get(index + 1);
        let wanted = next.filter(|_| bends(index) || bends(index + 1));
        all.extend(wanted.and_then(|next| touch(f64::midpoint(point[0], next[0]))));
    }
    all
}

/// Peak-to-peak of the orbit that touches zero at one frequency.
fn at_frequency(options: &ModelOptions, omega: f64, cancel: &Cancel) -> Option<f64> {
    let model = declared(options);
    let highest = highest_drive(options, omega);
    let branch = FrequencyResponse::of(&*model)
        .vary("drive")
        .omega(omega)
        .from(1e-3 * highest)
        .to(highest)
        .harmonics(HARMONICS)
        .samples(SAMPLES)
        .tolerance(1e-3)
        .max_points(POINTS)
        .cancel(cancel)
        .run_with(|progress| {
            if progress
                .point
                .is_some_and(|point| point.motion().minimum > 0.0)
            {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        })
        .ok()?;
    touching(&branch)
}

/// Peak-to-peak where the minimum vanishes, beyond the last orbits that stay in contact.
///
/// Those orbits depend smoothly on the amplitude, and for a linear spring in straight lines, while the first orbit that
/// leaves contact may already be far off. So peak-to-peak is taken as a polynomial of the minimum through the last three.
fn touching(branch: &Branch) -> Option<f64> {
    let (touched, inside) = branch.points.split_last()?;
    if touched.motion().minimum > 0.0 {
        return None;
    }
    let nodes: Vec<[f64; 2]> = inside
        .iter()
        .rev()
        .take(3)
        .map(|point| [point.motion().minimum, point.peak_to_peak()])
        .collect();
    let lagrange = nodes.iter().map(|[here, size]| {
        let others = nodes.iter().map(|[other, _]| other);
        let factors = others.filter(|&other| other != here);
        size * factors.map(|other| other / (other - here)).product::<f64>()
    });
    (!nodes.is_empty()).then(|| lagrange.sum())
}

/// More than it takes to open the contact: four times what a linear spring of the stiffness at rest would need.
///
/// At rest `x^alpha = W`, so `x_0 = W^(1/alpha)` and the stiffness is `alpha W / x_0`.
fn highest_drive(options: &ModelOptions, omega: f64) -> f64 {
    let rest = options.load.powf(1.0 / options.alpha);
    let stiffness = options.alpha * options.load / rest;
    let dynamic = (stiffness - omega * omega).hypot(2.0 * options.zeta * omega);
    4.0 * rest * (dynamic + stiffness)
}
