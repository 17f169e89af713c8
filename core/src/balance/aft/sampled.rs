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

use super::{Change, ContactDerivatives, ContactInput, PER_SAMPLE};
use crate::law::{Derivatives, On, Variation};
use crate::numeric::fourier::sampled::SampledTransform;

/// Samples of one contact, reused for all.
#[derive(Debug)]
pub(crate) struct SampledAft {
    transform: SampledTransform,
    gap: Vec<f64>,
    rate: Vec<f64>,
    force: Vec<f64>,
    by_gap: Vec<f64>,
    by_rate: Vec<f64>,
    by_argument: Vec<f64>,
    by_parameter: Vec<f64>,
    change: Vec<f64>,
    evaluated: u64,
}

impl SampledAft {
    pub(crate) fn new(samples: usize) -> Self {
        let zeros = || vec![0.0; samples];
        Self {
            transform: SampledTransform::new(samples),
            gap: zeros(),
            rate: zeros(),
            force: zeros(),
            by_gap: zeros(),
            by_rate: zeros(),
            by_argument: zeros(),
            by_parameter: zeros(),
            change: zeros(),
            evaluated: 0,
        }
    }

    /// About how many multiplications all evaluations so far have taken.
    pub(crate) fn operations(&self) -> u64 {
        PER_SAMPLE * self.evaluated
    }

    /// Writes the series of the force.
    pub(crate) fn force(&mut self, input: ContactInput<'_>, force: &mut [f64]) {
        self.sample_input(input);
        input.law.force(
            On::AllPieces,
            input.arguments,
            &self.gap,
            &self.rate,
            &mut self.force,
        );
        self.transform.analyse(&self.force, force);
    }

    /// Writes the series of the force and of its derivatives.
    pub(crate) fn derivatives(
        &mut self,
        input: ContactInput<'_>,
        change: Option<Change<'_>>,
        force: &mut [f64],
        out: &mut ContactDerivatives<'_>,
    ) {
        self.sample_input(input);
        let mut varied = change.iter().flat_map(|change| nonzero(change.arguments));
        let first = varied.next();
        self.evaluate(input, first.map(|(argument, _)| argument));
        self.transform.analyse(&self.force, force);
        let vanishes = |of: fn(&crate::law::PieceFacts) -> Variation| {
            input
                .law
                .facts()
                .pieces
                .iter()
                .all(|piece| of(piece) == Variation::Zero)
        };
        self.analyse_unless(vanishes(|piece| piece.by_gap), Which::ByGap, out.by_gap);
        self.analyse_unless(vanishes(|piece| piece.by_rate), Which::ByRate, out.by_rate);
        if let Some(change) = change {
            self.by_motion(change);
            self.add_argument(first.map_or(0.0, |(_, by)| by));
            for (argument, by) in varied {
                self.evaluate(input, Some(argument));
                self.add_argument(by);
            }
            self.transform.analyse(&self.by_parameter, out.by_parameter);
        }
    }

    /// The law at every sample, with the derivative by one argument where it is asked for.
    fn evaluate(&mut self, input: ContactInput<'_>, argument: Option<usize>) {
        let out = Derivatives {
            force: &mut self.force,
            by_gap: &mut self.by_gap,
            by_rate: &mut self.by_rate,
        };
        let (on, gap, rate) = (On::AllPieces, &self.gap, &self.rate);
        match argument {
            None => input.law.derivatives(on, input.arguments, gap, rate, out),
            Some(argument) => {
                let by_argument = &mut self.by_argument;
                input.law.derivatives_and_by(
                    argument,
                    on,
                    input.arguments,
                    gap,
                    rate,
                    out,
                    by_argument,
                );
            }
        }
    }

    fn sample_input(&mut self, input: ContactInput<'_>) {
        self.transform.sample(input.gap, &mut self.gap);
        self.transform.sample(input.rate, &mut self.rate);
        self.evaluated += self.gap.len() as u64;
    }

    fn analyse_unless(&mut self, zero: bool, which: Which, series: &mut [f64]) {
        if zero {
            series.fill(0.0);
        } else {
            let samples = match which {
                Which::ByGap => &self.by_gap,
                Which::ByRate => &self.by_rate,
            };
            self.transform.analyse(samples, series);
        }
    }

    /// `phi_g g_lambda + phi_r r_lambda` at every sample: what the parameter does by way of gap and rate.
    fn by_motion(&mut self, change: Change<'_>) {
        self.transform.sample(change.gap, &mut self.change);
        for ((to, slope), dg) in self
            .by_parameter
            .iter_mut()
            .zip(&self.by_gap)
            .zip(&self.change)
        {
            *to = slope * dg;
        }
        self.transform.sample(change.rate, &mut self.change);
        for ((to, slope), dr) in self
            .by_parameter
            .iter_mut()
            .zip(&self.by_rate)
            .zip(&self.change)
        {
            *to += slope * dr;
        }
    }

    /// Adds `phi_a a_lambda` for the argument evaluated last.
    fn add_argument(&mut self, by: f64) {
        if by != 0.0 {
            for (to, slope) in self.by_parameter.iter_mut().zip(&self.by_argument) {
                *to += slope * by;
            }
        }
    }
}

/// The entries of a list that are not zero, with their positions.
fn nonzero(list: &[f64]) -> impl Iterator<Item = (usize, f64)> {
    list.iter().copied().enumerate().filter(|&(_, x)| x != 0.0)
}

/// A derivative that may be known to vanish.
#[derive(Clone, Copy)]
enum Which {
    ByGap,
    ByRate,
}
