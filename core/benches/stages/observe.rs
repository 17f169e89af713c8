//! A law that passes every call on, and writes down when it was made and with what.

use std::sync::{Arc, Mutex};
use std::time::Instant;

use hertzian::generic::LawData;
use hertzian::law::{Derivatives, Law, LawFacts, On, Parts};
use hertzian::system::System;

/// The first law of a system, observed.
pub struct Observed {
    system: Arc<dyn System>,
    calls: Mutex<Vec<Call>>,
}

/// A call with the derivatives by gap and rate, or for the force alone.
pub struct Call {
    on: On,
    arguments: Vec<f64>,
    gap: Vec<f64>,
    rate: Vec<f64>,
    out: [Vec<f64>; 3],
    slopes: bool,
    pub start: Instant,
}

impl Observed {
    pub fn new(system: &dyn System) -> Self {
        Self {
            system: system.shared(),
            calls: Mutex::default(),
        }
    }

    fn law(&self) -> &dyn Law {
        self.system.law(0)
    }

    /// The calls since this was asked last.
    pub fn take(&self) -> Vec<Call> {
        std::mem::take(&mut self.calls.lock().expect("one thread"))
    }

    fn note(
        &self,
        slopes: bool,
        on: On,
        arguments: &[f64],
        [gap, rate]: [&[f64]; 2],
        start: Instant,
    ) {
        self.calls.lock().expect("one thread").push(Call {
            on,
            arguments: arguments.to_vec(),
            gap: gap.to_vec(),
            rate: rate.to_vec(),
            out: std::array::from_fn(|_| vec![0.0; gap.len()]),
            slopes,
            start,
        });
    }
}

impl Call {
    /// Samples in it.
    pub fn samples(&self) -> usize {
        self.gap.len()
    }

    /// Makes it again.
    pub fn repeat(&mut self, law: &dyn Law) {
        let [force, by_gap, by_rate] = &mut self.out;
        if self.slopes {
            let out = Derivatives {
                force,
                by_gap,
                by_rate,
            };
            law.derivatives(self.on, &self.arguments, &self.gap, &self.rate, out);
        } else {
            law.force(self.on, &self.arguments, &self.gap, &self.rate, force);
        }
    }
}

impl Law for Observed {
    fn facts(&self) -> &LawFacts {
        self.law().facts()
    }

    fn data(&self) -> Option<&LawData> {
        self.law().data()
    }

    fn levels(&self, arguments: &[f64], levels: &mut [f64]) {
        self.law().levels(arguments, levels);
    }

    fn levels_by(&self, arguments: &[f64], argument: usize, by_argument: &mut [f64]) {
        self.law().levels_by(arguments, argument, by_argument);
    }

    fn force(&self, on: On, arguments: &[f64], gap: &[f64], rate: &[f64], force: &mut [f64]) {
        let law = self.law();
        let start = Instant::now();
        law.force(on, arguments, gap, rate, force);
        self.note(false, on, arguments, [gap, rate], start);
    }

    fn derivatives(
        &self,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
    ) {
        let law = self.law();
        let start = Instant::now();
        law.derivatives(on, arguments, gap, rate, out);
        self.note(true, on, arguments, [gap, rate], start);
    }

    fn derivatives_and_by(
        &self,
        argument: usize,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
        by_argument: &mut [f64],
    ) {
        // Not asked for where omega varies.
        self.law()
            .derivatives_and_by(argument, on, arguments, gap, rate, out, by_argument);
    }

    fn parts(&self) -> Option<Parts<'_>> {
        self.law().parts()
    }
}
