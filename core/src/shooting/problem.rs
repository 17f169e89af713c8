//! What a computation by shooting works with: checked, and the same for all orbits of a branch.

use std::sync::Arc;

use nalgebra::Complex;

use crate::branches::checkpoint::Keep;
use crate::branches::recurrence::{CyclicSymmetry, SignedPermutation};
use crate::branches::stability::Stability;
use crate::cancel::Cancel;
use crate::continuation::follow::FollowOptions;
use crate::continuation::newton::NewtonOptions;
use crate::continuation::step_control::StepControl;
use crate::error::Error;
use crate::orbit::observe::Accuracy;
use crate::system::{System, Variable};
use crate::time::Flow;

type Make = dyn Fn(f64) -> Result<Box<dyn Flow>, Error>;

/// Where flows of one system come from.
pub(crate) struct Source {
    /// Makes a flow of this tolerance.
    pub(crate) make: Box<Make>,
    /// The flow is in closed form and has no tolerance.
    pub(crate) exact: bool,
    /// The tolerance asked for.
    pub(crate) tolerance: f64,
}

/// The system, what is varied, and how.
pub(crate) struct ShootingProblem {
    pub(crate) system: Arc<dyn System>,
    pub(crate) source: Source,
    /// Name of what is varied.
    pub(crate) varied: String,
    /// Parameters; what is varied has any value.
    pub(crate) parameters: Vec<f64>,
    /// Frequency, unless it is varied.
    pub(crate) omega: f64,
    pub(crate) variable: Variable,
    pub(crate) divisor: u32,
    /// Period of the orbits in periods of the system.
    pub(crate) period: usize,
    pub(crate) segments: usize,
    /// How many multipliers of the maps belong to a rigid motion, which is [taken out](crate::time::centred): they are zero there.
    pub(crate) rigid: usize,
    /// Symmetries that orbits may have: of one that has them, no more is followed than the time after which it comes back.
    pub(crate) symmetries: Vec<CyclicSymmetry>,
    /// Coordinates that may be in each other's place at every time.
    pub(crate) at_once: Vec<SignedPermutation>,
    pub(crate) stability: bool,
    /// What the error is of that is stated.
    pub(crate) accuracy: Accuracy,
    pub(crate) points: usize,
    pub(crate) steps: StepControl,
    pub(crate) cancel: Cancel,
    /// Keeps what was found.
    pub(crate) keep: Option<Arc<dyn Keep>>,
}

/// Updates of Newton's method at most.
const ITERATIONS: usize = 12;
/// The same from a guess, where they are halved as long as they do not help.
const ITERATIONS_AT_START: usize = 40;

impl ShootingProblem {
    /// A flow of this tolerance at the parameters of the problem.
    pub(crate) fn flow(&self, tolerance: f64) -> Result<Box<dyn Flow>, Error> {
        (self.source.make)(tolerance)
    }

    /// What the flow and rounding leave in a state, in units of the oscillation, of which the largest state is `ratio` times
    /// the size.
    fn noise(&self, tolerance: f64, ratio: f64) -> f64 {
        let flow = if self.source.exact { 0.0 } else { tolerance };
        (flow + f64::EPSILON) * ratio
    }

    /// Options of Newton's method on equations with a flow of this tolerance: an update as small as the noise means nothing.
    pub(crate) fn newton(&self, tolerance: f64, ratio: f64) -> NewtonOptions {
        NewtonOptions {
            tolerance: (100.0 * self.noise(tolerance, ratio)).clamp(1e-10, 1e-3),
            iterations: ITERATIONS,
            damped: false,
        }
    }

    /// The same from a guess, when nothing is known of the oscillation.
    pub(crate) fn newton_at_start(&self) -> NewtonOptions {
        NewtonOptions {
            iterations: ITERATIONS_AT_START,
            damped: true,
            ..self.newton(self.source.tolerance, 1.0)
        }
    }

    /// By what part of the size of an orbit two states differ that are one: half of an orbit, or one of its periods, is not integrated
    /// in the same steps as all of it.
    pub(crate) fn same(&self, ratio: f64) -> f64 {
        let noise = self.noise(self.source.tolerance, ratio);
        (1e3 * noise).clamp(1e-7, 1e-2)
    }

    /// How exactly a test function must vanish.
    pub(crate) fn vanishing(&self, ratio: f64) -> f64 {
        let noise = self.noise(self.source.tolerance, ratio);
        (1e3 * noise).clamp(1e-10, 1e-3)
    }

    /// Options to follow a branch. Updates are relative to the range too, and the noise to the value.
    pub(crate) fn follow(&self, from: f64, to: f64, ratio: f64) -> FollowOptions {
        let range = (to - from).abs();
        let narrow = if range > 0.0 {
            from.abs().max(to.abs()) / range
        } else {
            1.0
        };
        FollowOptions {
            from,
            to,
            points: self.points,
            steps: self.steps,
            newton: self.newton(self.source.tolerance, ratio.max(narrow)),
        }
    }

    /// The verdict that the multipliers of a map of so many states allow, largest first, where they are known to this error.
    pub(crate) fn stability(
        &self,
        mut multipliers: Vec<Complex<f64>>,
        states: usize,
        error: f64,
    ) -> Stability {
        // Those of rigid motions are zero there, and not among the larger ones where these are known alone.
        multipliers.truncate(states.saturating_sub(self.rigid));
        Stability {
            rigid: self.rigid,
            ..Stability::of(multipliers, error)
        }
    }

    /// The frequency where what is varied has a value.
    pub(crate) fn omega_at(&self, value: f64) -> f64 {
        match self.variable {
            Variable::Omega => value,
            Variable::Parameter(_) => self.omega,
        }
    }

    /// The parameters there.
    pub(crate) fn parameters_at(&self, value: f64) -> Vec<f64> {
        let mut parameters = self.parameters.clone();
        if let Variable::Parameter(index) = self.variable {
            parameters[index] = value;
        }
        parameters
    }

    /// How fast the phase moves there.
    pub(crate) fn rate_at(&self, value: f64) -> f64 {
        self.omega_at(value) / f64::from(self.divisor)
    }
}
