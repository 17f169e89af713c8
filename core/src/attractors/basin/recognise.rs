//! One motion, followed until it is recognised.
//!
//! It is recognised when it enters a neighbourhood from which all motions are known to end on an orbit. Of orbits that are not
//! known yet it tells by returning: the state is compared with one some periods ago, which is renewed after 1, 2, 4, ...
//! periods (Brent 1980, BIT 20, 176). A near return is refined by Newton's method. If that leads to a stable orbit, its
//! neighbourhood is made, and the motion goes on until it is inside; if not, only a nearer return is tried next.

use super::Basin;
use super::attractor::{Attractor, Fate};
use super::catalogue::Catalogue;
use super::orbit::{Finder, Refined};
use crate::attractors::lyapunov::Lyapunov;
use crate::numeric::estimate::Estimate;
use crate::time::FlowError;
use crate::time::stroboscope::Stroboscope;

/// The first return that is tried, relative to the size of the motion.
const FIRST: f64 = 1e-2;
/// Nearer returns than this are not told from rounding.
const LAST: f64 = 1e-11;
/// Batches that tell chaos from a long period, and the periods of one, unless they leave it open.
const BATCHES: usize = 20;
const BATCH: usize = 100;

/// Follows motions, one after the other.
pub(super) struct Recogniser {
    pub(super) map: Stroboscope,
    finder: Finder,
    returns: Returns,
    state: Vec<f64>,
}

impl Recogniser {
    pub(super) fn new(map: Stroboscope) -> Self {
        let order = map.order();
        Self {
            finder: Finder::new(order),
            returns: Returns::new(order),
            state: vec![0.0; order],
            map,
        }
    }

    /// What becomes of a motion. Its orbit is one of `known`, or of `own`, which may grow, counted behind those.
    pub(super) fn fate(
        &mut self,
        basin: &Basin,
        start: &[f64],
        known: &Catalogue,
        own: &mut Catalogue,
    ) -> Fate {
        self.state.copy_from_slice(start);
        self.returns.start(start);
        for period in 0..basin.patience {
            if let Some(index) = known.find(&self.state) {
                return Fate::Periodic(index);
            }
            if let Some(index) = own.find(&self.state) {
                return Fate::Periodic(known.0.len() + index);
            }
            if let Some(returned) = self.returns.at(period, &self.state, basin.longest) {
                match self.refine(returned, [known, own]) {
                    Some(new) => {
                        own.add(new);
                    }
                    None => self.returns.be_stricter(),
                }
            }
            match self.map.map(&mut self.state) {
                Ok(()) => {}
                Err(FlowError::NotFinite { .. }) => return Fate::Escaped,
                Err(_) => return Fate::Failed,
            }
            if !self.state.iter().all(|x| x.abs() <= basin.request.escape) {
                return Fate::Escaped;
            }
        }
        self.judge(basin.patience / BATCHES)
    }

    /// Why the motion from a state cannot be followed; `None` if it can.
    pub(super) fn fault(&mut self, basin: &Basin, start: &[f64]) -> Option<FlowError> {
        self.state.copy_from_slice(start);
        let followed = (0..basin.patience).try_for_each(|_| self.map.map(&mut self.state));
        let long = BATCH.max(basin.patience / BATCHES);
        followed.err().or_else(|| self.exponent(long).err())
    }

    fn refine(&mut self, period: usize, known: [&Catalogue; 2]) -> Option<Attractor> {
        match self
            .finder
            .refine(&mut self.map, &self.state, period, known)
        {
            Refined::New(attractor) => Some(attractor),
            Refined::Known | Refined::Nothing => None,
        }
    }

    /// Tells chaos from a long period by the largest exponent. Where that is not told from zero, as in intermittency, it looks
    /// again with batches of the length `long`.
    fn judge(&mut self, long: usize) -> Fate {
        for length in [BATCH, long.max(BATCH)] {
            let Ok(largest) = self.exponent(length) else {
                return Fate::Failed;
            };
            let margin = 3.0 * largest.error;
            // Where neighbours part by less than a factor e in all that time, rounding alone may have done it.
            let parts = largest.value * (BATCHES * length) as f64 > 1.0;
            if parts && largest.value > margin {
                return Fate::Chaotic;
            }
            if largest.value < -margin {
                return Fate::Long;
            }
        }
        Fate::Long
    }

    /// The largest exponent of the motion from here.
    fn exponent(&mut self, length: usize) -> Result<Estimate, FlowError> {
        let mut lyapunov = Lyapunov::new(&mut self.map, &self.state);
        for _ in 0..BATCHES {
            lyapunov.batch(length)?;
        }
        let means = lyapunov.batches().iter().map(|batch| batch[0]);
        Ok(Estimate::of_batches(means))
    }
}

/// Compares a motion with its past.
struct Returns {
    reference: Vec<f64>,
    /// The period of the reference, and how long it lasts.
    since: usize,
    window: usize,
    /// Largest entries since then.
    size: Vec<f64>,
    tolerance: f64,
}

impl Returns {
    fn new(order: usize) -> Self {
        Self {
            reference: vec![0.0; order],
            since: 0,
            window: 1,
            size: vec![0.0; order],
            tolerance: FIRST,
        }
    }

    fn start(&mut self, state: &[f64]) {
        self.window = 1;
        self.tolerance = FIRST;
        self.renew(0, state);
    }

    fn renew(&mut self, period: usize, state: &[f64]) {
        self.since = period;
        self.reference.copy_from_slice(state);
        for (size, x) in self.size.iter_mut().zip(state) {
            *size = x.abs();
        }
    }

    /// The number of periods after which the motion has nearly returned, if it has.
    fn at(&mut self, period: usize, state: &[f64], longest: usize) -> Option<usize> {
        let passed = period - self.since;
        let mut near = passed > 0 && passed <= longest;
        for i in 0..state.len() {
            self.size[i] = self.size[i].max(state[i].abs());
            near &= (state[i] - self.reference[i]).abs() <= self.tolerance * self.size[i];
        }
        if passed == self.window {
            self.window = (2 * self.window).min(longest.saturating_mul(2));
            self.renew(period, state);
        }
        near.then_some(passed)
    }

    fn be_stricter(&mut self) {
        self.tolerance *= 0.1;
        if self.tolerance < LAST {
            self.tolerance = -1.0;
        }
    }
}
