//! One contact on equally spaced samples of a period.

use super::{Change, ContactInput};
use crate::law::{Derivatives, On};
use crate::numeric::fourier::sampled::SampledTransform;

/// Gap, rate, and what the law says of them at every sample.
#[derive(Debug)]
pub(super) struct Samples {
    pub(super) transform: SampledTransform,
    pub(super) gap: Vec<f64>,
    pub(super) rate: Vec<f64>,
    pub(super) force: Vec<f64>,
    pub(super) by_gap: Vec<f64>,
    pub(super) by_rate: Vec<f64>,
    pub(super) by_parameter: Vec<f64>,
    by_argument: Vec<f64>,
    change: Vec<f64>,
}

impl Samples {
    pub(super) fn new(samples: usize) -> Self {
        let zeros = || vec![0.0; samples];
        Self {
            transform: SampledTransform::new(samples),
            gap: zeros(),
            rate: zeros(),
            force: zeros(),
            by_gap: zeros(),
            by_rate: zeros(),
            by_parameter: zeros(),
            by_argument: zeros(),
            change: zeros(),
        }
    }

    /// Samples gap and rate.
    pub(super) fn take(&mut self, input: ContactInput<'_>) {
        self.transform.sample(input.gap, &mut self.gap);
        self.transform.sample(input.rate, &mut self.rate);
    }

    /// The force where gap and rate have been taken.
    pub(super) fn evaluate(&mut self, input: ContactInput<'_>, on: On) {
        let (gap, rate, force) = (&self.gap, &self.rate, &mut self.force);
        input.law.force(on, input.arguments, gap, rate, force);
    }

    /// The same with its derivatives by gap and rate, and `phi_g dg + phi_r dr + phi_a da` where there is a change.
    pub(super) fn evaluate_slopes(
        &mut self,
        input: ContactInput<'_>,
        on: On,
        change: Option<Change<'_>>,
    ) {
        let Some(change) = change else {
            return self.slopes(input, on, None);
        };
        let arguments = change.arguments.iter().copied().enumerate();
        let mut varied = arguments.filter(|&(_, by)| by != 0.0);
        let first = varied.next();
        self.slopes(input, on, first.map(|(argument, _)| argument));
        self.by_parameter.fill(0.0);
        for (series, slopes) in [(change.gap, &self.by_gap), (change.rate, &self.by_rate)] {
            if series.iter().any(|x| *x != 0.0) {
                self.transform.sample(series, &mut self.change);
                let products = slopes.iter().zip(&self.change);
                for (sum, (slope, by)) in self.by_parameter.iter_mut().zip(products) {
                    *sum += slope * by;
                }
            }
        }
        let mut next = first;
        while let Some((_, by)) = next {
            for (sum, slope) in self.by_parameter.iter_mut().zip(&self.by_argument) {
                *sum += by * slope;
            }
            next = varied.next();
            if let Some((argument, _)) = next {
                self.slopes(input, on, Some(argument));
            }
        }
    }

    /// The law and its derivatives by gap, rate and an argument.
    fn slopes(&mut self, input: ContactInput<'_>, on: On, argument: Option<usize>) {
        let out = Derivatives {
            force: &mut self.force,
            by_gap: &mut self.by_gap,
            by_rate: &mut self.by_rate,
        };
        let (law, gap, rate) = (input.law, &self.gap, &self.rate);
        let Some(argument) = argument else {
            return law.derivatives(on, input.arguments, gap, rate, out);
        };
        let by = &mut self.by_argument;
        law.derivatives_and_by(argument, on, input.arguments, gap, rate, out, by);
    }
}
