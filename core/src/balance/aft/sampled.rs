//! Classical alternating frequency/time: the law on a grid of samples.
//!
//! Source: Cameron and Griffin (1989), An alternating frequency/time domain method for calculating the steady-state
//! response of nonlinear dynamic systems. Gap and rate are sampled at `tau_j = 2 pi j / N`,
//!
//! ```text
//! F_k = (2 / N) sum_j phi(g_j, r_j) e^(i k tau_j)                                                            (1)
//! ```
//!
//! which is the Fourier coefficient of the force plus those of all harmonics `k + m N` folded onto it. A force or a
//! derivative that jumps between two samples is not seen to move: on one-sided contact the residual is then
//! discontinuous in the unknowns, and its Jacobian misses the jump.

use super::samples::Samples;
use super::{Change, ContactDerivatives, ContactForces, ContactInput, PER_SAMPLE};
use crate::law::{On, PieceFacts, Variation};

/// Samples of one contact, reused for all.
#[derive(Debug)]
pub(crate) struct SampledAft {
    samples: Samples,
    evaluated: u64,
}

impl SampledAft {
    pub(crate) fn new(samples: usize) -> Self {
        Self {
            samples: Samples::new(samples),
            evaluated: 0,
        }
    }

    fn take(&mut self, input: ContactInput<'_>) {
        self.samples.take(input);
        self.evaluated += self.samples.gap.len() as u64;
    }
}

impl ContactForces for SampledAft {
    fn operations(&self) -> u64 {
        PER_SAMPLE * self.evaluated
    }

    fn force(&mut self, input: ContactInput<'_>, force: &mut [f64]) {
        self.take(input);
        self.samples.evaluate(input, On::AllPieces);
        self.samples.transform.analyse(&self.samples.force, force);
    }

    fn derivatives(
        &mut self,
        input: ContactInput<'_>,
        change: Option<Change<'_>>,
        force: &mut [f64],
        out: &mut ContactDerivatives<'_>,
    ) {
        self.take(input);
        let s = &mut self.samples;
        s.evaluate_slopes(input, On::AllPieces, change);
        s.transform.analyse(&s.force, force);
        let pieces = &input.law.facts().pieces;
        let vanishes = |of: fn(&PieceFacts) -> Variation| {
            let mut pieces = pieces.iter();
            pieces.all(|piece| of(piece) == Variation::Zero)
        };
        for (zero, slopes, series) in [
            (vanishes(|piece| piece.by_gap), &s.by_gap, &mut *out.by_gap),
            (
                vanishes(|piece| piece.by_rate),
                &s.by_rate,
                &mut *out.by_rate,
            ),
        ] {
            if zero {
                series.fill(0.0);
            } else {
                s.transform.analyse(slopes, series);
            }
        }
        if change.is_some() {
            s.transform.analyse(&s.by_parameter, out.by_parameter);
        }
    }
}
