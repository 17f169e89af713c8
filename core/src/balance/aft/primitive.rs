//! Sampled alternating frequency/time in which rate terms are time derivatives.
//!
//! Where a law is linear in its rate, `phi = f(g) + h(g) dg/dt`, the second term is `dG(g)/dt` with `G' = h`. In the
//! frequency domain
//!
//! ```text
//! F = f(g) + Omega D G(g),      dF = f_g dg + Omega D (h dg)                                                 (1)
//! ```
//!
//! and `D (h dg) = (D h) dg + h (D dg)`: the series of the Jacobian are `f_g + Omega D h` and `h`. The samples of `G` are
//! continuous where those of `h dg/dt` jump.
//!
//! Source: integration by parts of Cameron and Griffin (1989), An alternating frequency/time domain method for calculating the
//! steady-state response of nonlinear dynamic systems.

use super::sampled::SampledAft;
use super::{Change, ContactDerivatives, ContactForces, ContactInput};
use crate::law::{Law, Parts};
use crate::numeric::fourier::series;

/// Samples of one contact, and series of its primitive.
#[derive(Debug)]
pub(crate) struct PrimitiveAft {
    sampled: SampledAft,
    primitive: Vec<f64>,
    slope: Vec<f64>,
    unused: Vec<f64>,
    by_parameter: Vec<f64>,
    derivative: Vec<f64>,
}

impl PrimitiveAft {
    pub(crate) fn new(samples: usize) -> Self {
        Self {
            sampled: SampledAft::new(samples),
            primitive: Vec::new(),
            slope: Vec::new(),
            unused: Vec::new(),
            by_parameter: Vec::new(),
            derivative: Vec::new(),
        }
    }
}

impl ContactForces for PrimitiveAft {
    fn operations(&self) -> u64 {
        self.sampled.operations()
    }

    fn force(&mut self, input: ContactInput<'_>, force: &mut [f64]) {
        let Some(Parts {
            spring, primitive, ..
        }) = input.law.parts()
        else {
            return self.sampled.force(input, force);
        };
        self.sampled.force(of(input, spring), force);
        self.primitive.resize(force.len(), 0.0);
        self.sampled
            .force(of(input, primitive), &mut self.primitive);
        add_derivative(&self.primitive, input.base, &mut self.derivative, force);
    }

    fn derivatives(
        &mut self,
        input: ContactInput<'_>,
        change: Option<Change<'_>>,
        force: &mut [f64],
        out: &mut ContactDerivatives<'_>,
    ) {
        let Some(Parts {
            spring, primitive, ..
        }) = input.law.parts()
        else {
            return self.sampled.derivatives(input, change, force, out);
        };
        self.sampled
            .derivatives(of(input, spring), change, force, out);
        self.primitive.resize(force.len(), 0.0);
        self.slope.resize(out.by_gap.len(), 0.0);
        self.unused.resize(out.by_rate.len(), 0.0);
        self.by_parameter.resize(out.by_parameter.len(), 0.0);
        let mut of_primitive = ContactDerivatives {
            by_gap: &mut self.slope,
            by_rate: &mut self.unused,
            by_parameter: &mut self.by_parameter,
        };
        self.sampled.derivatives(
            of(input, primitive),
            change,
            &mut self.primitive,
            &mut of_primitive,
        );
        let workspace = &mut self.derivative;
        add_derivative(&self.primitive, input.base, workspace, force);
        out.by_rate.copy_from_slice(&self.slope);
        add_derivative(&self.slope, input.base, workspace, out.by_gap);
        if let Some(change) = change {
            add_derivative(&self.by_parameter, input.base, workspace, out.by_parameter);
            add_derivative(&self.primitive, change.base, workspace, out.by_parameter);
        }
    }
}

/// The same gap under another law.
fn of<'a>(input: ContactInput<'a>, law: &'a dyn Law) -> ContactInput<'a> {
    ContactInput { law, ..input }
}

/// Adds `factor D series`.
fn add_derivative(of: &[f64], factor: f64, workspace: &mut Vec<f64>, to: &mut [f64]) {
    workspace.resize(of.len(), 0.0);
    series::differentiate(of, workspace);
    for (to, slope) in to.iter_mut().zip(workspace) {
        *to += factor * *slope;
    }
}
