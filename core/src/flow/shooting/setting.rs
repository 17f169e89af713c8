//! What a computation by shooting works with: checked, and the same for all orbits of a branch.

use crate::continuation::follow::FollowOptions;
use crate::continuation::step::StepControl;
use crate::error::Error;
use crate::flow::Flow;
use crate::newton::NewtonOptions;
use crate::system::Variable;

type Make<'a> = dyn Fn(f64) -> Result<Box<dyn Flow + 'a>, Error> + 'a;

/// Where flows of one system come from.
pub(super) struct Source<'a> {
    /// Makes a flow of this tolerance.
    pub(super) make: Box<Make<'a>>,
    /// The flow is in closed form and has no tolerance.
    pub(super) exact: bool,
    /// The tolerance asked for.
    pub(super) tolerance: f64,
}

/// The system, what is varied, and how.
pub(super) struct Setting<'a> {
    pub(super) source: Source<'a>,
    /// Name of what is varied.
    pub(super) varied: String,
    /// Parameters; what is varied has any value.
    pub(super) parameters: Vec<f64>,
    /// Frequency, unless it is varied.
    pub(super) omega: f64,
    pub(super) variable: Variable,
    pub(super) divisor: u32,
    /// Period of the orbits in periods of the system.
    pub(super) period: usize,
    pub(super) segments: usize,
    /// Where the orbit has odd symmetry, half of it is followed.
    pub(super) odd: bool,
    pub(super) stability: bool,
    pub(super) points: usize,
    pub(super) steps: StepControl,
}

/// Updates of Newton's method at most.
const ITERATIONS: usize = 12;
/// The same from a guess, where they are halved as long as they do not help.
const ITERATIONS_AT_START: usize = 40;

impl<'a> Setting<'a> {
    /// A flow of this tolerance at the parameters of the setting.
    pub(super) fn flow(&self, tolerance: f64) -> Result<Box<dyn Flow + 'a>, Error> {
        (self.source.make)(tolerance)
    }

    /// Options of Newton's method on equations with a flow of this tolerance: an update as small as the error of the flow
    /// means nothing.
    pub(super) fn newton(&self, tolerance: f64) -> NewtonOptions {
        let by_flow = if self.source.exact {
            0.0
        } else {
            100.0 * tolerance
        };
        NewtonOptions {
            tolerance: by_flow.clamp(1e-10, 1e-3),
            iterations: ITERATIONS,
            damped: false,
        }
    }

    /// The same from a guess.
    pub(super) fn newton_at_start(&self) -> NewtonOptions {
        NewtonOptions {
            iterations: ITERATIONS_AT_START,
            damped: true,
            ..self.newton(self.source.tolerance)
        }
    }

    /// How exactly a test function must vanish.
    pub(super) fn vanishing(&self) -> f64 {
        let by_flow = if self.source.exact {
            0.0
        } else {
            1e3 * self.source.tolerance
        };
        by_flow.max(1e-10)
    }

    /// Options to follow a branch. Updates are relative to the range, and what rounding and the flow leave to the value.
    pub(super) fn follow(&self, from: f64, to: f64) -> FollowOptions {
        let newton = self.newton(self.source.tolerance);
        let range = (to - from).abs();
        let narrow = if range > 0.0 {
            from.abs().max(to.abs()) / range
        } else {
            1.0
        };
        let by_range = narrow
            * if self.source.exact {
                1e-12
            } else {
                newton.tolerance
            };
        FollowOptions {
            from,
            to,
            points: self.points,
            steps: self.steps,
            newton: NewtonOptions {
                tolerance: newton.tolerance.max(by_range).min(1e-3),
                ..newton
            },
        }
    }

    /// The frequency where what is varied has a value.
    pub(super) fn omega_at(&self, value: f64) -> f64 {
        match self.variable {
            Variable::Omega => value,
            Variable::Parameter(_) => self.omega,
        }
    }

    /// The parameters there.
    pub(super) fn parameters_at(&self, value: f64) -> Vec<f64> {
        let mut parameters = self.parameters.clone();
        if let Variable::Parameter(index) = self.variable {
            parameters[index] = value;
        }
        parameters
    }

    /// How fast the phase moves there.
    pub(super) fn rate_at(&self, value: f64) -> f64 {
        self.omega_at(value) / f64::from(self.divisor)
    }
}
