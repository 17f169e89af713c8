//! What the correction changes of what is read off an orbit, whatever that is.
//!
//! The contributions of (2) in [`truncation`](super) are added one after the other, and what is read is compared each time: an extreme of a
//! force or of an acceleration is no linear function of the orbit, and may be at a switch.

use super::RefinedBalance;
use crate::balance::Balance;
use crate::numeric::fourier::series;

impl RefinedBalance<'_> {
    /// How much the peak-to-peak of what is read off the orbit changes by the last correction, by the sizes of its contributions, given
    /// what reads its extremes. What is beyond the tail is taken as if it were in its last harmonic, coordinate by coordinate. Its phase
    /// is not known, nor whether both extremes meet it alike: what a cosine changes of one and what a sine does are two parts of one wave,
    /// which changes it by the root of their squares at most, and both extremes may be changed apart.
    pub(crate) fn change_of(
        &mut self,
        u: &[f64],
        read: &mut dyn FnMut(&Balance<'_>, &[f64]) -> [f64; 2],
    ) -> f64 {
        let (fine, coarse) = (self.balance.length(), series::length(self.coarse.harmonics));
        let (few, many) = (
            series::harmonics(&u[..coarse]),
            series::harmonics(&self.orbit[..fine]),
        );
        let last = self.orbit.len() - 1;
        let corrected = self.orbit[last];
        let mut at = |balance: &mut Balance<'_>, orbit: &[f64], value: f64| {
            balance.set(value);
            read(balance, orbit)
        };
        let mut orbit = vec![0.0; last];
        for (to, from) in orbit.chunks_exact_mut(fine).zip(u.chunks_exact(coarse)) {
            to[..coarse].copy_from_slice(from);
        }
        let mut before = at(&mut self.balance, &orbit, u[u.len() - 1]);
        let mut change = 0.0;
        for harmonics in [few, few.midpoint(many), many] {
            let length = series::length(harmonics);
            let rows = self.orbit[..last].chunks_exact(fine);
            for (to, from) in orbit.chunks_exact_mut(fine).zip(rows) {
                to[..length].copy_from_slice(&from[..length]);
            }
            let now = at(&mut self.balance, &orbit, corrected);
            change += ((now[1] - now[0]) - (before[1] - before[0])).abs();
            before = now;
        }
        for (coordinate, &beyond) in self.beyond.iter().enumerate() {
            if beyond <= 0.0 {
                continue;
            }
            let cosine = coordinate * fine + 2 * many - 1;
            let [of_cosine, of_sine] = [cosine, cosine + 1].map(|entry| {
                let known = orbit[entry];
                orbit[entry] += beyond;
                let there = at(&mut self.balance, &orbit, corrected);
                orbit[entry] = known;
                [there[0] - before[0], there[1] - before[1]]
            });
            change += of_cosine[0].hypot(of_sine[0]) + of_cosine[1].hypot(of_sine[1]);
        }
        self.balance.set(corrected);
        change
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::balance::aft::Aft;
    use crate::balance::{Parity, Resolution};
    use crate::orbit::observe::Motion;
    use crate::system::Variable;
    use crate::testing::by_hand::PowerForm;

    /// Of `cos(tau - p) + b cos(k tau - q)`, of which the second wave is left out.
    #[test]
    fn what_is_beyond_counts_at_any_phase() {
        let system = PowerForm::new(true, 1.5, 0.05, 1.0, 0.1);
        let coarse = Resolution {
            harmonics: 3,
            core: 3,
            parity: Parity::All,
            stride: 1,
            samples: 64,
            aft: Aft::Switched,
            period: 1,
        };
        let mut finer = RefinedBalance::new(&system, &system.values, 0.9, Variable::Omega, coarse);
        let beyond = 1e-6;
        finer.beyond[0] = beyond;
        for step in 0..12 {
            let phase = f64::from(step) * 0.15;
            let wave = [phase.cos(), phase.sin()];
            finer.orbit.fill(0.0);
            finer.orbit[1..3].copy_from_slice(&wave);
            let u = [0.0, wave[0], wave[1], 0.0, 0.0, 0.0, 0.0, 0.0];
            let mut extremes = |_: &Balance<'_>, series: &[f64]| {
                let motion = Motion::of(series);
                [motion.minimum, motion.maximum]
            };
            let change = finer.change_of(&u, &mut extremes);
            assert!((change / (2.0 * beyond) - 1.0).abs() < 1e-4, "{change:e}");
            for (k, angle) in [(7, 0.0), (7, 1.5), (8, 0.7), (9, 2.9), (11, -1.6)] {
                let mut exact = vec![0.0; 2 * k + 1];
                exact[1..3].copy_from_slice(&wave);
                exact[2 * k - 1] = beyond * f64::cos(angle);
                exact[2 * k] = beyond * f64::sin(angle);
                let error = (Motion::of(&exact).peak_to_peak() - 2.0).abs();
                assert!(error <= change * (1.0 + 1e-4), "{k}: {error:e} {change:e}");
            }
        }
    }
}
