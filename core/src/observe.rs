//! What a user reads off an orbit.

use std::f64::consts::TAU;

use crate::balance::{Balance, gap_series, rate_series};
use crate::fourier::crossings::{Crossing, crossings, extremum};
use crate::fourier::series;
use crate::law::{Law, On, Variation};
use crate::layout::ContactLayout;

/// What is read off one orbit.
#[derive(Debug, Clone, PartialEq)]
pub struct Observed {
    /// One entry per coordinate.
    pub motions: Vec<Motion>,
    /// One entry per contact.
    pub contacts: Vec<ContactMotion>,
    /// Mean power of the load: `<f . q'>`.
    pub input_power: f64,
    /// Mean power that damping, stiffness and contacts take up. In the discrete balance it equals the input power
    /// exactly, for a symmetric mass matrix: the residual is orthogonal to the velocity.
    pub dissipated_power: f64,
}

/// What is read off the motion of one coordinate over a period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Largest value.
    pub maximum: f64,
    /// Smallest value.
    pub minimum: f64,
    /// Mean.
    pub mean: f64,
    /// Root of the mean square, mean included.
    pub rms: f64,
}

impl Motion {
    /// Largest less smallest value.
    pub fn peak_to_peak(&self) -> f64 {
        self.maximum - self.minimum
    }

    /// Reads the motion off a series.
    pub fn of(series: &[f64]) -> Self {
        let (minimum, maximum) = extremes(series);
        Self {
            maximum,
            minimum,
            mean: series[0],
            rms: series::mean_product(series, series).max(0.0).sqrt(),
        }
    }
}

/// What is read off one contact over a period of the orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactMotion {
    /// Largest force by size, one-sided limits at switches included.
    pub peak_force: f64,
    /// Fraction of the period spent on pieces whose force is not identically zero.
    pub fraction: f64,
    /// Number of separate intervals of contact: zero without contact, one for contact that is never lost.
    pub count: usize,
}

/// Amplitude of each harmonic, the mean (with its sign) first.
pub fn amplitudes(series: &[f64]) -> Vec<f64> {
    let oscillating = series[1..]
        .chunks_exact(2)
        .map(|pair| pair[0].hypot(pair[1]));
    std::iter::once(series[0]).chain(oscillating).collect()
}

/// Phase lag of each harmonic, in radians, the mean's zero first: harmonic `k` is `amplitude cos(k tau - phase)`.
pub fn phases(series: &[f64]) -> Vec<f64> {
    let oscillating = series[1..]
        .chunks_exact(2)
        .map(|pair| pair[1].atan2(pair[0]));
    std::iter::once(0.0).chain(oscillating).collect()
}

/// Smallest and largest value of a series.
fn extremes(of: &[f64]) -> (f64, f64) {
    let intervals = (8 * series::harmonics(of)).max(16);
    let h = TAU / intervals as f64;
    let mut extremes = (of[0], of[0]);
    let mut found = false;
    let first = series::value_and_derivatives(of, 0.0).1 > 0.0;
    let mut rising = first;
    for index in 1..=intervals {
        let (a, b) = (h * (index - 1) as f64, h * index as f64);
        // The period closes exactly, whatever the rounding of 2 pi.
        let last = index == intervals;
        let rises = if last {
            first
        } else {
            series::value_and_derivatives(of, b).1 > 0.0
        };
        if rises != rising {
            let x = series::value(of, extremum(of, a, b, rising));
            extremes = if found {
                (extremes.0.min(x), extremes.1.max(x))
            } else {
                (x, x)
            };
            found = true;
        }
        rising = rises;
    }
    extremes
}

/// Reads everything off an orbit, at the variable that the balance was set to last.
pub(crate) fn observe(balance: &mut Balance<'_>, u: &[f64]) -> Observed {
    let coordinates = balance.layout().coordinates;
    let length = balance.length();
    let unknowns = coordinates * length;
    let u = &u[..unknowns];
    let (input_power, dissipated_power) = powers(balance, u);
    let contacts = balance.layout().contacts.iter();
    Observed {
        motions: u.chunks_exact(length).map(Motion::of).collect(),
        contacts: contacts
            .map(|contact| contact_motion(balance, contact, u))
            .collect(),
        input_power,
        dissipated_power,
    }
}

/// `<f . q'>` and `<(C q' + K q + sum e phi) . q'>`.
fn powers(balance: &mut Balance<'_>, u: &[f64]) -> (f64, f64) {
    let length = balance.length();
    let mut load = vec![0.0; u.len()];
    let mut forces = vec![0.0; u.len()];
    balance.add_load(balance.coefficients(), 1.0, &mut load);
    balance.add_damping(balance.coefficients(), balance.base(), u, &mut forces);
    balance.add_stiffness(balance.coefficients(), u, &mut forces);
    let mut force = vec![0.0; series::length(balance.force_harmonics())];
    for contact in 0..balance.layout().contacts.len() {
        balance.contact_force(u, contact, &mut force);
        balance.add_in_direction(contact, &force, &mut forces);
    }
    let mut velocity = vec![0.0; length];
    let mut powers = (0.0, 0.0);
    for (row, coordinate) in u.chunks_exact(length).enumerate() {
        rate_series(coordinate, balance.base(), &mut velocity);
        powers.0 += series::mean_product(&load[row * length..][..length], &velocity);
        powers.1 += series::mean_product(&forces[row * length..][..length], &velocity);
    }
    powers
}

fn contact_motion(balance: &Balance<'_>, contact: &ContactLayout, u: &[f64]) -> ContactMotion {
    let law = balance.system().law(contact.law);
    let mut arguments = vec![0.0; contact.argument_count];
    contact.arguments(balance.coefficients(), &mut arguments);
    let mut gap = vec![0.0; series::length(balance.gap_harmonics())];
    let period = balance.resolution().period;
    gap_series(
        contact,
        balance.coefficients(),
        period,
        u,
        balance.length(),
        &mut gap,
    );
    let mut rate = gap.clone();
    rate_series(&gap, balance.base(), &mut rate);
    let panels = panels(law, &arguments, &gap);
    let touches = |piece: usize| law.facts().pieces[piece].force != Variation::Zero;
    let mut motion = ContactMotion {
        peak_force: 0.0,
        fraction: 0.0,
        count: 0,
    };
    let mut before = panels.last().is_some_and(|panel| touches(panel.piece));
    let always = panels.iter().all(|panel| touches(panel.piece));
    for panel in &panels {
        let now = touches(panel.piece);
        if now {
            motion.fraction += (panel.end - panel.start) / TAU;
            let peak = panel.peak_force(law, &arguments, &gap, &rate);
            motion.peak_force = motion.peak_force.max(peak);
        }
        motion.count += usize::from(now && !before);
        before = now;
    }
    if always {
        motion.count = 1;
    }
    motion
}

/// A part of the period on which the gap stays on one piece.
#[derive(Debug, Clone, Copy)]
struct Panel {
    start: f64,
    end: f64,
    piece: usize,
}

fn panels(law: &dyn Law, arguments: &[f64], gap: &[f64]) -> Vec<Panel> {
    let mut levels = vec![0.0; law.facts().levels.len()];
    law.levels(arguments, &mut levels);
    let mut found: Vec<Crossing> = Vec::new();
    for &level in &levels {
        crossings(gap, level, &mut found);
    }
    let mut cuts: Vec<f64> = found.iter().map(|crossing| crossing.tau).collect();
    cuts.extend([0.0, TAU]);
    cuts.sort_by(f64::total_cmp);
    let pairs = cuts.windows(2).filter(|pair| pair[1] > pair[0]);
    pairs
        .map(|pair| {
            let (start, end) = (pair[0], pair[1]);
            let middle = series::value(gap, 0.5 * (start + end));
            let piece = levels.iter().filter(|&&level| middle > level).count();
            Panel { start, end, piece }
        })
        .collect()
}

impl Panel {
    /// Largest force by size: on a grid with both ends, refined by golden section around the best.
    fn peak_force(&self, law: &dyn Law, arguments: &[f64], gap: &[f64], rate: &[f64]) -> f64 {
        let size = |tau: f64| {
            let mut force = [0.0];
            let (g, r) = ([series::value(gap, tau)], [series::value(rate, tau)]);
            law.force(On::Piece(self.piece), arguments, &g, &r, &mut force);
            force[0].abs()
        };
        let width = self.end - self.start;
        let intervals = (4.0 * series::harmonics(gap) as f64 * width / TAU)
            .ceil()
            .max(8.0);
        let h = width / intervals;
        let at = |index: usize| self.start + h * index as f64;
        let intervals = intervals as usize;
        let sizes: Vec<f64> = (0..=intervals).map(|index| size(at(index))).collect();
        let best = (0..=intervals)
            .max_by(|&i, &j| sizes[i].total_cmp(&sizes[j]))
            .unwrap_or(0);
        let refined = golden_maximum(
            size,
            at(best.saturating_sub(1)),
            at((best + 1).min(intervals)),
        );
        sizes[best].max(refined)
    }
}

/// Maximum of a function with one peak in `[a, b]`. Source: Kiefer (1953), Sequential minimax search for a maximum.
fn golden_maximum(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut c, mut d) = (b - ratio * (b - a), a + ratio * (b - a));
    let (mut fc, mut fd) = (f(c), f(d));
    for _ in 0..40 {
        if fc > fd {
            (b, d, fd) = (d, c, fc);
            c = b - ratio * (b - a);
            fc = f(c);
        } else {
            (a, c, fc) = (c, d, fd);
            d = a + ratio * (b - a);
            fd = f(d);
        }
    }
    fc.max(fd)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motion_of_two_harmonics_is_the_closed_form() {
        // x = 1 + cos tau + cos 2 tau = 2 c^2 + c: largest 3 at c = 1, smallest -1/8 at c = -1/4.
        let motion = Motion::of(&[1.0, 1.0, 0.0, 1.0, 0.0]);
        assert!((motion.maximum - 3.0).abs() < 1e-14);
        assert!((motion.minimum + 0.125).abs() < 1e-14);
        assert!((motion.peak_to_peak() - 3.125).abs() < 1e-14);
        assert_eq!(motion.mean, 1.0);
        assert!((motion.rms - 2.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn a_resting_coordinate_has_its_mean_for_extremes() {
        for series in [&[0.5][..], &[0.5, 0.0, 0.0]] {
            let motion = Motion::of(series);
            assert_eq!(
                (motion.minimum, motion.maximum, motion.rms),
                (0.5, 0.5, 0.5)
            );
        }
    }

    #[test]
    fn phase_is_the_lag() {
        let lag = 0.7_f64;
        let series = [0.2, 3.0 * lag.cos(), 3.0 * lag.sin()];
        assert!((phases(&series)[1] - lag).abs() < 1e-15);
        assert!((amplitudes(&series)[1] - 3.0).abs() < 1e-15);
        assert_eq!(amplitudes(&series)[0], 0.2);
    }
}
