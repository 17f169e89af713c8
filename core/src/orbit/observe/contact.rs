//! What is read off the gap of one contact.

use std::f64::consts::TAU;

use super::ContactMotion;
use super::peak::Batch;
use super::sampler::{Sampler, largest};
use crate::balance::{Balance, rate_series};
use crate::law::{Law, RateDependence, Variation};
use crate::model::layout::ContactLayout;
use crate::numeric::fourier::crossings::levels::{Cuts, Segment};

/// Whether the force of a contact is identically zero.
pub(super) fn is_idle(balance: &Balance<'_>, contact: usize) -> bool {
    let law = balance.system().law(balance.layout().contacts[contact].law);
    let pieces = law.facts().pieces.iter();
    pieces.into_iter().all(|p| p.force == Variation::Zero)
}

/// Workspace for one contact after the other.
#[derive(Debug, Default)]
pub(super) struct ContactObserver {
    arguments: Vec<f64>,
    levels: Vec<f64>,
    cuts: Cuts,
    rate: Vec<f64>,
    rates: Vec<f64>,
    batch: Batch,
}

impl ContactObserver {
    pub(super) fn take_arguments(&mut self, contact: &ContactLayout, coefficients: &[f64]) {
        self.arguments.resize(contact.argument_count, 0.0);
        contact.arguments(coefficients, &mut self.arguments);
    }

    /// Reads the gap that has been loaded; the arguments have been taken. Adds the part of the period on each piece.
    pub(super) fn read(
        &mut self,
        law: &dyn Law,
        sampler: &mut Sampler,
        base: f64,
        on_pieces: &mut [f64],
    ) -> ContactMotion {
        self.cut(law, sampler);
        let pieces = &law.facts().pieces;
        let touches = |segment: &Segment| pieces[segment.piece].force != Variation::Zero;
        let mut motion = ContactMotion::NONE;
        let always = self.cuts.segments().iter().all(touches);
        let mut before = self.cuts.segments().last().is_some_and(touches);
        if before && always {
            motion.count = 1;
        }
        if self.cuts.segments().iter().any(touches) {
            self.sample_rate(law, sampler, base);
        }
        let mut extremes = [f64::INFINITY, f64::NEG_INFINITY];
        for segment in self.cuts.segments() {
            let now = touches(segment);
            let part = (segment.end - segment.start) / TAU;
            on_pieces[segment.piece] += part;
            let mut here = [0.0; 2];
            if now {
                motion.fraction += part;
                let (gaps, rates) = (sampler.samples(), &self.rates[..]);
                let gap = sampler.series();
                let levels = &self.levels;
                self.batch.take(segment, levels, [gaps, rates], gap, base);
                let piece = segment.piece;
                here = self.batch.extremes(law, piece, &self.arguments, gap, base);
            }
            extremes = [
                -largest(-extremes[0], -here[0]),
                largest(extremes[1], here[1]),
            ];
            motion.count += usize::from(now && !before);
            before = now;
        }
        // The segments of contact that is never lost add up to the period but for rounding.
        if before && always {
            motion.fraction = 1.0;
        }
        motion.fraction = motion.fraction.min(1.0);
        for part in on_pieces {
            *part = part.min(1.0);
        }
        // A gap that is not a number is on no segment.
        if extremes[0] <= extremes[1] {
            [motion.minimum_force, motion.maximum_force] = extremes;
            // The sign of a zero is none of a size.
            motion.peak_force = largest(extremes[0].abs(), extremes[1].abs());
        }
        motion
    }

    fn sample_rate(&mut self, law: &dyn Law, sampler: &mut Sampler, base: f64) {
        if law.facts().rate == RateDependence::None {
            self.rates.clear();
            self.rates.resize(sampler.samples().len(), 0.0);
            return;
        }
        self.rate.resize(sampler.series().len(), 0.0);
        rate_series(sampler.series(), base, &mut self.rate);
        sampler.sample(&self.rate, &mut self.rates);
    }

    /// Cuts the period at the levels.
    fn cut(&mut self, law: &dyn Law, sampler: &Sampler) {
        self.levels.resize(law.facts().levels.len(), 0.0);
        law.levels(&self.arguments, &mut self.levels);
        self.cuts
            .apply(sampler.finder(), sampler.series(), &self.levels);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::On;
    use crate::numeric::fourier::crossings::crossings;
    use crate::numeric::fourier::series;
    use crate::system::System;
    use crate::testing::by_hand::PowerForm;
    use crate::testing::random::Random;

    const BASE: f64 = 0.9;

    fn read(law: &dyn Law, arguments: &[f64], gap: &[f64]) -> ContactMotion {
        let (mut contact, mut sampler) = (ContactObserver::default(), Sampler::default());
        contact.arguments = arguments.to_vec();
        sampler.load(gap);
        let mut on_pieces = vec![0.0; law.facts().pieces.len()];
        let motion = contact.read(law, &mut sampler, BASE, &mut on_pieces);
        assert!((on_pieces.iter().sum::<f64>() - 1.0).abs() < 1e-13);
        let size = motion.maximum_force.abs().max(motion.minimum_force.abs());
        assert_eq!(motion.peak_force, size);
        motion
    }

    /// Parts of the period on each piece.
    fn on_pieces(law: &dyn Law, arguments: &[f64], gap: &[f64]) -> Vec<f64> {
        let (mut contact, mut sampler) = (ContactObserver::default(), Sampler::default());
        contact.arguments = arguments.to_vec();
        sampler.load(gap);
        let mut on_pieces = vec![0.0; law.facts().pieces.len()];
        contact.read(law, &mut sampler, BASE, &mut on_pieces);
        on_pieces
    }

    crate::law! {
        /// An attraction that a gap from the surface has, and a spring below: as under a tip.
        Tip(gap, reach > 0) {
            gap > reach => 3*(gap - reach) - 1,
            gap < 0     => -1 + gap/2,
            else        => -1,
        }
    }

    /// `gap = 1/2 + 2 cos tau`: above one while `cos tau > 1/4`, above zero while `cos tau > -1/4`.
    #[test]
    fn times_and_signed_extremes_are_the_closed_form() {
        let gap = [0.5, 2.0, 0.0];
        let motion = read(&Tip, &[1.0], &gap);
        // No piece is without a force, so contact is never lost by that measure.
        assert_eq!((motion.fraction, motion.count), (1.0, 1));
        assert!((motion.maximum_force - 3.5).abs() < 1e-14);
        assert!((motion.minimum_force + 1.75).abs() < 1e-14);
        assert!((motion.peak_force - 3.5).abs() < 1e-14);
        let angle = |cosine: f64| cosine.acos() / std::f64::consts::PI;
        let above = angle(0.25);
        let middle = angle(-0.25) - above;
        let found = on_pieces(&Tip, &[1.0], &gap);
        for (found, expected) in found
            .iter()
            .zip([above, middle, 1.0 - above - middle].iter().rev())
        {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
        // Without a crossing all of the time is on one piece.
        assert_eq!(on_pieces(&Tip, &[1.0], &[-3.0, 1.0, 0.0]), [1.0, 0.0, 0.0]);
        let below = read(&Tip, &[1.0], &[-3.0, 1.0, 0.0]);
        assert!((below.minimum_force + 3.0).abs() < 1e-14);
        assert!((below.maximum_force + 2.0).abs() < 1e-14);
    }

    /// A linear spring on one side with damping: `phi = g + 2 zeta r`, on `g = m + a cos tau` while `g > 0`. As it is left the force
    /// pulls with the damping alone.
    #[test]
    fn the_smallest_force_is_the_limit_where_contact_is_lost() {
        let (zeta, mean, size) = (0.3, 0.25, 1.0);
        let system = PowerForm::new(true, 1.0, zeta, 1.0, 1.0);
        let motion = read(system.law(0), &[zeta, 1.0], &[mean, size, 0.0]);
        let angle = f64::acos(-mean / size);
        let leaving = -2.0 * zeta * BASE * size * angle.sin();
        let largest = mean + size.hypot(2.0 * zeta * BASE * size);
        assert!((motion.minimum_force - leaving).abs() < 1e-13);
        assert!((motion.maximum_force - largest).abs() < 1e-13);
        assert!((motion.fraction - 2.0 * angle / TAU).abs() < 1e-13);
    }

    fn random_gap(random: &mut Random, harmonics: usize) -> Vec<f64> {
        let mut gap = vec![random.between(-0.8, 0.8)];
        for k in 1..=harmonics {
            let size = (k as f64).powf(-1.5);
            gap.push(random.between(-size, size));
            gap.push(random.between(-size, size));
        }
        gap
    }

    /// By a scan of each segment between crossings of zero, ends included, and golden sections about its best sample.
    /// Source: Kiefer (1953), Sequential minimax search for a maximum.
    fn scanned(law: &dyn Law, arguments: &[f64], gap: &[f64]) -> (f64, f64) {
        let size = |tau: f64| {
            let (g, slope, _) = series::value_and_derivatives(gap, tau);
            let mut force = [0.0];
            law.force(On::AllPieces, arguments, &[g], &[BASE * slope], &mut force);
            (force[0].abs(), g)
        };
        let mut found = Vec::new();
        crossings(gap, 0.0, &mut found);
        let mut cuts: Vec<f64> = found.iter().map(|crossing| crossing.tau).collect();
        cuts.push(cuts.first().map_or(TAU, |first| first + TAU));
        if cuts.len() == 1 {
            cuts.insert(0, 0.0);
        }
        let (mut peak, mut inside) = (0.0_f64, 0.0);
        for ends in cuts.windows(2) {
            let (a, b) = (ends[0], ends[1]);
            let middle = size(0.5 * (a + b)).1;
            let count = 4000;
            let at = |index: usize| a + (b - a) * index as f64 / f64::from(4000);
            if !found.is_empty() {
                // At a switch itself, from the side of this segment.
                let rate = |tau| BASE * series::value_and_derivatives(gap, tau).1;
                let (gaps, mut force) = ([0.0; 2], [0.0; 2]);
                let on = On::Piece(usize::from(middle > 0.0));
                law.force(on, arguments, &gaps, &[rate(a), rate(b)], &mut force);
                peak = peak.max(force[0].abs()).max(force[1].abs());
            }
            let best = (0..=count)
                .max_by(|&i, &j| size(at(i)).0.total_cmp(&size(at(j)).0))
                .unwrap();
            let (mut low, mut high) = (at(best.saturating_sub(1)), at((best + 1).min(count)));
            let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
            for _ in 0..60 {
                let (c, d) = (high - ratio * (high - low), low + ratio * (high - low));
                if size(c).0 > size(d).0 {
                    high = d;
                } else {
                    low = c;
                }
            }
            peak = peak.max(size(at(best)).0).max(size(0.5 * (low + high)).0);
            if middle > 0.0 {
                inside += (ends[1] - ends[0]) / TAU;
            }
        }
        (peak, inside)
    }

    #[test]
    fn peak_force_is_that_of_a_dense_scan() {
        let mut random = Random::seeded(7);
        let mut compared = 0;
        for one_sided in [true, false] {
            for alpha in [0.6, 1.0, 1.5, 3.0] {
                for harmonics in [1, 2, 3, 5, 10, 20] {
                    for zeta in [0.0, 0.03, 0.5, 3.0] {
                        let system = PowerForm::new(one_sided, alpha, zeta, 1.0, 1.0);
                        let law = system.law(0);
                        let gap = random_gap(&mut random, harmonics);
                        let motion = read(law, &[zeta, alpha], &gap);
                        let (peak, inside) = scanned(law, &[zeta, alpha], &gap);
                        let error = (motion.peak_force - peak).abs();
                        assert!(
                            error <= 1e-10 * peak,
                            "{one_sided} {alpha} {harmonics} {zeta}: {} {peak}",
                            motion.peak_force
                        );
                        if one_sided {
                            assert!((motion.fraction - inside).abs() < 1e-12);
                            compared += usize::from(inside > 0.0 && inside < 1.0);
                        }
                    }
                }
            }
        }
        assert!(compared > 50, "{compared}");
    }

    #[test]
    fn a_short_contact_is_sampled_by_itself() {
        // Just above the level for an eightieth of the period: the force of cos tau - cos(pi / 80), exponent 1, no damping.
        let half: f64 = TAU / 160.0;
        let system = PowerForm::new(true, 1.0, 0.0, 1.0, 1.0);
        for lag in [0.0, 0.013, 3.0, 6.2] {
            let gap = [-half.cos(), f64::cos(lag), f64::sin(lag)];
            let motion = read(system.law(0), &[0.0, 1.0], &gap);
            let peak = 1.0 - half.cos();
            assert!((motion.peak_force - peak).abs() < 1e-15);
            assert!((motion.fraction - 2.0 * half / TAU).abs() < 1e-13);
            assert_eq!(motion.count, 1);
        }
    }

    #[test]
    fn contact_that_never_ends_or_never_begins_is_counted() {
        let system = PowerForm::new(true, 1.5, 0.0, 1.0, 1.0);
        let arguments = [0.0, 1.5];
        let rest = read(system.law(0), &arguments, &[4.0]);
        assert_eq!((rest.fraction, rest.count), (1.0, 1));
        assert!((rest.peak_force - 8.0).abs() < 1e-14);
        let above = read(system.law(0), &arguments, &[2.0, 0.6, -0.8]);
        assert_eq!((above.fraction, above.count), (1.0, 1));
        assert!((above.peak_force - 3.0_f64.powf(1.5)).abs() < 1e-13);
        let below = read(system.law(0), &arguments, &[-2.0, 0.6, -0.8]);
        assert_eq!(below, ContactMotion::NONE);
        assert!(below.peak_force.is_sign_positive());
        let twice = read(system.law(0), &arguments, &[0.0, 0.0, 0.0, 1.0, 0.0]);
        assert_eq!(twice.count, 2);
        assert!((twice.fraction - 0.5).abs() < 1e-14);
    }
}
