//! What the correction changes of what is read off an orbit, whatever that is.
//!
//! The contributions of (2) in [`truncation`](super) are added one after the other, and what is read is compared each time: an extreme of a
//! force or of an acceleration is no linear function of the orbit, and may be at a switch.

use super::RefinedBalance;
use crate::balance::Balance;
use crate::numeric::fourier::series;

impl RefinedBalance<'_> {
    /// How much what is read off the orbit changes by the last correction, by the sizes of its contributions. What is beyond the tail is
    /// taken as if it were in its last harmonic, coordinate by coordinate.
    pub(crate) fn change_of(
        &mut self,
        u: &[f64],
        read: &mut dyn FnMut(&Balance<'_>, &[f64]) -> f64,
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
            change += (now - before).abs();
            before = now;
        }
        for (coordinate, beyond) in self.beyond.iter().enumerate() {
            let entry = coordinate * fine + 2 * many - 1;
            if *beyond > 0.0 {
                orbit[entry] += beyond;
                change += (at(&mut self.balance, &orbit, corrected) - before).abs();
                orbit[entry] -= beyond;
            }
        }
        self.balance.set(corrected);
        change
    }
}
