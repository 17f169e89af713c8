//! What a user reads off an orbit.

mod accuracy;
mod contact;
mod instant;
mod measure;
mod peak;
mod reading;
mod sampler;
mod sum;
mod waveform;

use std::f64::consts::TAU;

use crate::balance::{Balance, gap_series, rate_series};
pub use crate::branches::observed::{ContactMotion, Motion, Observed};
use crate::numeric::fourier::series;
pub(crate) use accuracy::Accuracy;
use contact::ContactObserver;
pub use instant::outputs_at;
pub use measure::{Measure, Wanted};
pub use reading::{Reading, SpectrumLine};
pub(crate) use reading::{of_coordinate, of_series, over_period, series_over_period, stored};
use sampler::Sampler;
use sum::Motions;
use waveform::Waveform;

impl Motion {
    /// Reads the motion off a series; rest off an empty one.
    pub fn of(series: &[f64]) -> Self {
        let series = if series.is_empty() { &[0.0] } else { series };
        Self::read(&mut Sampler::default(), series)
    }

    /// Largest value by size over the root of the mean square; `None` at rest in zero, and where only the extremes were read off.
    pub fn crest_factor(&self) -> Option<f64> {
        let largest = self.maximum.abs().max(self.minimum.abs());
        let rms = self.rms.filter(|&rms| rms > 0.0)?;
        Some(largest / rms)
    }

    fn read(sampler: &mut Sampler, series: &[f64]) -> Self {
        let (minimum, maximum) = sampler.extremes(series);
        Self {
            maximum,
            minimum,
            mean: Some(series[0]),
            rms: Some(series::mean_product(series, series).max(0.0).sqrt()),
        }
    }
}

/// Amplitude of each harmonic, the mean (with its sign) first; none of an empty series.
pub fn amplitudes(series: &[f64]) -> Vec<f64> {
    let Some((&mean, oscillating)) = series.split_first() else {
        return Vec::new();
    };
    let oscillating = oscillating.chunks_exact(2);
    let oscillating = oscillating.map(|pair| pair[0].hypot(pair[1]));
    std::iter::once(mean).chain(oscillating).collect()
}

/// Phase lag of each harmonic, in radians, the mean's zero first: harmonic `k` is `amplitude cos(k tau - phase)`. None of an empty
/// series.
pub fn phases(series: &[f64]) -> Vec<f64> {
    let Some((_, oscillating)) = series.split_first() else {
        return Vec::new();
    };
    let oscillating = oscillating.chunks_exact(2);
    let oscillating = oscillating.map(|pair| pair[1].atan2(pair[0]));
    std::iter::once(0.0).chain(oscillating).collect()
}

/// Reads orbits, one after the other. Beyond what it returns, it allocates for the first orbit only.
#[derive(Debug, Default)]
pub(crate) struct Observer {
    sampler: Sampler,
    contact: ContactObserver,
    gap: Vec<f64>,
    load: Vec<f64>,
    forces: Vec<f64>,
    force: Vec<f64>,
    velocity: Vec<f64>,
    impulses: Vec<f64>,
    phases: Vec<[f64; 2]>,
}

impl Observer {
    /// The phases of the smallest and the largest value of each coordinate of the last orbit.
    pub(crate) fn phases(&self) -> &[[f64; 2]] {
        &self.phases
    }

    /// Reads everything off an orbit, at the variable that the balance was set to last.
    pub(crate) fn observe(&mut self, balance: &mut Balance<'_>, u: &[f64]) -> Observed {
        let length = balance.length();
        let u = &u[..balance.layout().coordinates * length];
        self.impulses.clear();
        let (input_power, dissipated_power) = self.powers(balance, u);
        // Contacts first: a coordinate that moves as a gap does is not searched again.
        let count = balance.layout().contacts.len();
        let mut on_pieces: Vec<Vec<f64>> = (0..count)
            .map(|contact| {
                let law = balance.layout().contacts[contact].law;
                vec![0.0; balance.system().law(law).facts().pieces.len()]
            })
            .collect();
        let contacts = on_pieces
            .iter_mut()
            .enumerate()
            .map(|(contact, on_pieces)| {
                let motion = self.contact_motion(balance, contact, u, on_pieces);
                let impulse = self.impulses.get(contact).copied();
                ContactMotion { impulse, ..motion }
            })
            .collect();
        self.phases.clear();
        let motions = u
            .chunks_exact(length)
            .map(|series| {
                let motion = Motion::read(&mut self.sampler, series);
                self.phases.push(self.sampler.phases());
                motion
            })
            .collect();
        let outputs = self.outputs(balance, u);
        Observed {
            sampled: false,
            motions,
            outputs,
            contacts,
            on_pieces,
            input_power: Some(input_power),
            dissipated_power: Some(dissipated_power),
            switches: None,
        }
    }

    /// What is read off the outputs of the system.
    fn outputs(&mut self, balance: &Balance<'_>, u: &[f64]) -> Vec<Motion> {
        let count = balance.system().facts().outputs.len();
        if count == 0 {
            return Vec::new();
        }
        let motions = Motions::of_balance(balance, u);
        (0..count)
            .map(|output| {
                let waveform = Waveform::new(&motions, motions.output(output));
                waveform.motion(&mut self.sampler)
            })
            .collect()
    }

    /// What is read off one output.
    pub(crate) fn output(&mut self, balance: &Balance<'_>, u: &[f64], output: usize) -> Motion {
        let motions = Motions::of_balance(balance, u);
        let waveform = Waveform::new(&motions, motions.output(output));
        waveform.motion(&mut self.sampler)
    }

    /// `<f . q'>` and `<(C q' + K q + sum e phi) . q'>`; the impulses of the contacts besides.
    fn powers(&mut self, balance: &mut Balance<'_>, u: &[f64]) -> (f64, f64) {
        let length = balance.length();
        for sum in [&mut self.load, &mut self.forces] {
            sum.clear();
            sum.resize(u.len(), 0.0);
        }
        balance.add_load(balance.coefficients(), 1.0, &mut self.load);
        balance.add_damping(balance.coefficients(), balance.base(), u, &mut self.forces);
        balance.add_stiffness(balance.coefficients(), u, &mut self.forces);
        let workspace = series::length(balance.force_harmonics());
        self.force.resize(workspace, 0.0);
        for contact in 0..balance.layout().contacts.len() {
            if contact::is_idle(balance, contact) {
                self.impulses.push(0.0);
                continue;
            }
            balance.contact_force(u, contact, &mut self.force);
            self.impulses.push(self.force[0] * TAU / balance.base());
            balance.add_in_direction(contact, 1.0, &self.force, &mut self.forces);
        }
        self.velocity.resize(length, 0.0);
        let mut powers = (0.0, 0.0);
        let rows = self.load.chunks_exact(length);
        let rows = rows.zip(self.forces.chunks_exact(length));
        for (coordinate, (load, forces)) in u.chunks_exact(length).zip(rows) {
            rate_series(coordinate, balance.base(), &mut self.velocity);
            powers.0 += series::mean_product(load, &self.velocity);
            powers.1 += series::mean_product(forces, &self.velocity);
        }
        powers
    }

    fn contact_motion(
        &mut self,
        balance: &Balance<'_>,
        contact: usize,
        u: &[f64],
        on_pieces: &mut [f64],
    ) -> ContactMotion {
        let layout = &balance.layout().contacts[contact];
        let coefficients = balance.coefficients();
        self.gap
            .resize(series::length(balance.gap_harmonics()), 0.0);
        gap_series(
            layout,
            coefficients,
            balance.resolution().period,
            u,
            balance.length(),
            &mut self.gap,
        );
        self.sampler.load(&self.gap);
        let law = balance.system().law(layout.law);
        self.contact.take_arguments(layout, coefficients);
        let base = balance.base();
        self.contact.read(law, &mut self.sampler, base, on_pieces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::balance::Resolution;
    use crate::balance::aft::Aft;
    use crate::numeric::fourier::crossings::crossings;
    use crate::system::Variable;
    use crate::testing::allocations::count;
    use crate::testing::by_hand::PowerForm;
    use crate::testing::random::Random;

    #[test]
    fn motion_of_two_harmonics_is_the_closed_form() {
        // x = 1 + cos tau + cos 2 tau = 2 c^2 + c: largest 3 at c = 1, smallest -1/8 at c = -1/4.
        let motion = Motion::of(&[1.0, 1.0, 0.0, 1.0, 0.0]);
        assert!((motion.maximum - 3.0).abs() < 1e-14);
        assert!((motion.minimum + 0.125).abs() < 1e-14);
        assert!((motion.peak_to_peak() - 3.125).abs() < 1e-14);
        assert_eq!(motion.mean, Some(1.0));
        assert!((motion.rms.unwrap() - 2.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn extremes_are_those_of_a_dense_scan() {
        let mut random = Random::seeded(3);
        let mut sampler = Sampler::default();
        for harmonics in [1, 2, 3, 7, 12, 30] {
            for _ in 0..20 {
                let coefficients =
                    (0..series::length(harmonics)).map(|_| random.between(-1.0, 1.0));
                let series: Vec<f64> = coefficients.collect();
                let motion = Motion::read(&mut sampler, &series);
                let count = 100 * harmonics;
                let values = (0..count)
                    .map(|j| series::value(&series, TAU * f64::from(j as u32) / count as f64));
                let scan = values.fold((f64::INFINITY, -f64::INFINITY), |(a, b), x| {
                    (a.min(x), b.max(x))
                });
                // No sample is beyond, and the nearest is as near as the largest curvature allows.
                let curvature: f64 = (1..=harmonics)
                    .map(|k| (k * k) as f64 * series[2 * k - 1].hypot(series[2 * k]))
                    .sum();
                let step = TAU / count as f64;
                let least = curvature * step * step / 8.0;
                for beyond in [motion.maximum - scan.1, scan.0 - motion.minimum] {
                    assert!(beyond > -1e-13 && beyond <= least, "{beyond} {least}");
                }
                // The slope vanishes where they are taken, so they agree with roots of the slope.
                let mut slope = series.clone();
                series::differentiate(&series, &mut slope);
                let mut found = Vec::new();
                crossings(&slope, 0.0, &mut found);
                let values = found.iter().map(|c| series::value(&series, c.tau));
                let (low, high) = values.fold((f64::INFINITY, -f64::INFINITY), |(a, b), x| {
                    (a.min(x), b.max(x))
                });
                let error = (low - motion.minimum)
                    .abs()
                    .max((high - motion.maximum).abs());
                let size: f64 = series.iter().map(|x| x.abs()).sum();
                assert!(error < 1e-14 * size, "{harmonics}: {error:e}");
            }
        }
    }

    #[test]
    fn a_series_that_hardly_varies_is_read() {
        for size in [1e-300, 1e-30, 1e-17, 1e-16, 1e-12] {
            let motion = Motion::of(&[1.0, size, -size, 0.0, 0.5 * size]);
            assert!(motion.minimum <= motion.maximum);
            assert!((motion.maximum - 1.0).abs() <= 3.0 * size + 1e-15);
            assert!((motion.minimum - 1.0).abs() <= 3.0 * size + 1e-15);
        }
        let motion = Motion::of(&[0.0, 1e-300, 0.0]);
        assert!((motion.maximum - 1e-300).abs() < 1e-314);
        let motion = Motion::of(&[0.0, f64::NAN, 0.0]);
        assert_eq!((motion.minimum, motion.maximum), (0.0, 0.0));
    }

    /// The unknowns of a balance of the one-sided oscillator, at a value of its frequency.
    fn some_orbit(balance: &Balance<'_>) -> Vec<f64> {
        let mut u = vec![0.0; balance.length()];
        u[..5].copy_from_slice(&[0.3, 0.8, -0.2, 0.1, 0.15]);
        u[20] = 1e-3;
        u
    }

    #[test]
    fn only_the_answer_is_allocated() {
        let system = PowerForm::new(true, 1.5, 0.05, 1.0, 0.1);
        let resolution = Resolution {
            harmonics: 10,
            core: 10,
            parity: crate::balance::Parity::All,
            stride: 1,
            samples: 64,
            aft: Aft::Switched,
            period: 1,
        };
        let mut balance = Balance::new(&system, &system.values, 0.9, Variable::Omega, resolution);
        let u = some_orbit(&balance);
        let mut observer = Observer::default();
        let first = observer.observe(&mut balance, &u);
        let mut second = None;
        let allocations = count(|| second = Some(observer.observe(&mut balance, &u)));
        // Motions, contacts, and the time of the one contact on its pieces.
        assert_eq!(allocations, 4);
        assert_eq!(second, Some(first));
    }

    #[test]
    fn a_resting_coordinate_has_its_mean_for_extremes() {
        for series in [&[0.5][..], &[0.5, 0.0, 0.0]] {
            let motion = Motion::of(series);
            assert_eq!(
                (motion.minimum, motion.maximum, motion.rms),
                (0.5, 0.5, Some(0.5))
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
