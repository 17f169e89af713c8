//! A system without what gives or takes energy.
//!
//! Of the equations of a system are left
//!
//! ```text
//! M q'' + K q + sum_c e_c phi_c(g_c, 0; a_c) = mean loads                                                     (1)
//! ```
//!
//! without damping, without loads that change with time, and with forces at gaps that are at rest: what a law does by the rate of its gap is
//! left out, so that a damped contact keeps its spring.
//!
//! Source: Kerschen, Peeters, Golinval and Vakakis (2009), Nonlinear normal modes, part I, Mech. Syst. Signal Process. 23, section 2 (the
//! underlying conservative system).

use std::fmt;
use std::sync::Arc;

use crate::law::{Derivatives, Law, LawFacts, On, Quantity, RateDependence, Variation};
use crate::system::{Place, System, SystemFacts, Variable};

/// Samples of which the rates are zero at a time.
const BATCH: usize = 64;
const AT_REST: [f64; BATCH] = [0.0; BATCH];

/// The system (1) of another one.
pub(crate) fn conservative(system: &dyn System) -> Arc<dyn System> {
    let system = system.shared();
    let places = system.facts().places.iter();
    let is_left_out = places.map(|place| match place {
        Place::Damping { .. } => true,
        Place::Load { wave, .. } => wave.harmonic > 0,
        _ => false,
    });
    let laws = (0..system.facts().laws).map(|index| Static::of(&system, index));
    Arc::new(Conservative {
        left_out: is_left_out.collect(),
        laws: laws.collect(),
        system,
    })
}

/// All but what gives or takes energy is the system's own.
#[derive(Clone)]
struct Conservative {
    system: Arc<dyn System>,
    /// Of each coefficient whether it is zero here.
    left_out: Arc<[bool]>,
    /// Laws of rates, at rest.
    laws: Arc<[Option<Static>]>,
}

impl fmt::Debug for Conservative {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Conservative")
            .field("system", &self.system)
            .finish_non_exhaustive()
    }
}

impl Conservative {
    fn leave_out(&self, coefficients: &mut [f64]) {
        for (coefficient, left_out) in coefficients.iter_mut().zip(self.left_out.iter()) {
            if *left_out {
                *coefficient = 0.0;
            }
        }
    }
}

impl System for Conservative {
    fn facts(&self) -> &SystemFacts {
        self.system.facts()
    }

    fn values(&self, values: &mut [f64]) {
        self.system.values(values);
    }

    fn coefficients(&self, parameters: &[f64], omega: f64, coefficients: &mut [f64]) {
        self.system.coefficients(parameters, omega, coefficients);
        self.leave_out(coefficients);
    }

    fn coefficients_by(
        &self,
        variable: Variable,
        parameters: &[f64],
        omega: f64,
        derivatives: &mut [f64],
    ) {
        self.system
            .coefficients_by(variable, parameters, omega, derivatives);
        self.leave_out(derivatives);
    }

    fn law(&self, index: usize) -> &dyn Law {
        match &self.laws[index] {
            Some(law) => law,
            None => self.system.law(index),
        }
    }

    fn shared(&self) -> Arc<dyn System> {
        Arc::new(self.clone())
    }
}

/// A law of a system at gaps that are at rest.
#[derive(Clone)]
struct Static {
    system: Arc<dyn System>,
    index: usize,
    facts: LawFacts,
}

impl Static {
    /// None where the law does not depend on rates.
    fn of(system: &Arc<dyn System>, index: usize) -> Option<Self> {
        let law = system.law(index);
        if law.facts().rate == RateDependence::None {
            return None;
        }
        let mut facts = spring(law).facts().clone();
        facts.name.clone_from(&law.facts().name);
        facts.rate = RateDependence::None;
        for level in facts.levels.to_mut() {
            level.by_rate_jumps = false;
        }
        for piece in facts.pieces.to_mut() {
            piece.by_rate = Variation::Zero;
            let terms = piece.terms.to_mut();
            terms.retain(|term| term.of != Quantity::ByRate);
        }
        let system = Arc::clone(system);
        Some(Self {
            system,
            index,
            facts,
        })
    }

    fn law(&self) -> &dyn Law {
        spring(self.system.law(self.index))
    }
}

/// The law of the gap alone where one is known, else the law itself.
fn spring(law: &dyn Law) -> &dyn Law {
    law.parts().map_or(law, |parts| parts.spring)
}

impl Law for Static {
    fn facts(&self) -> &LawFacts {
        &self.facts
    }

    fn levels(&self, arguments: &[f64], levels: &mut [f64]) {
        self.law().levels(arguments, levels);
    }

    fn levels_by(&self, arguments: &[f64], argument: usize, by_argument: &mut [f64]) {
        self.law().levels_by(arguments, argument, by_argument);
    }

    fn force(&self, on: On, arguments: &[f64], gap: &[f64], _: &[f64], force: &mut [f64]) {
        let law = self.law();
        for (gap, force) in gap.chunks(BATCH).zip(force.chunks_mut(BATCH)) {
            law.force(on, arguments, gap, &AT_REST[..gap.len()], force);
        }
    }

    fn derivatives(&self, on: On, arguments: &[f64], gap: &[f64], _: &[f64], out: Derivatives<'_>) {
        let law = self.law();
        for (samples, gap) in batches(gap.len()).zip(gap.chunks(BATCH)) {
            let out = Derivatives {
                force: &mut out.force[samples.clone()],
                by_gap: &mut out.by_gap[samples.clone()],
                by_rate: &mut out.by_rate[samples],
            };
            law.derivatives(on, arguments, gap, &AT_REST[..gap.len()], out);
        }
        out.by_rate.fill(0.0);
    }

    fn derivatives_and_by(
        &self,
        argument: usize,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        _: &[f64],
        out: Derivatives<'_>,
        by_argument: &mut [f64],
    ) {
        let law = self.law();
        for (samples, gap) in batches(gap.len()).zip(gap.chunks(BATCH)) {
            let rate = &AT_REST[..gap.len()];
            let own = &mut by_argument[samples.clone()];
            let out = Derivatives {
                force: &mut out.force[samples.clone()],
                by_gap: &mut out.by_gap[samples.clone()],
                by_rate: &mut out.by_rate[samples],
            };
            law.derivatives_and_by(argument, on, arguments, gap, rate, out, own);
        }
        out.by_rate.fill(0.0);
    }

    fn parts(&self) -> Option<crate::law::Parts<'_>> {
        None
    }
}

/// Ranges of so many samples at a time.
fn batches(samples: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
    let begin = (0..samples).step_by(BATCH);
    begin.map(move |begin| begin..samples.min(begin + BATCH))
}
