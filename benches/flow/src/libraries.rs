//! The same motion by general integrators, started again at every event.

use std::cell::Cell;
use std::error::Error;
use std::f64::consts::TAU;

use differential_equations::prelude::{
    ControlFlag, ExplicitRungeKutta, Interpolation, ODE, ODEProblem, Solout, Solution,
};
use diffsol::{NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};
use nalgebra::SVector;

use crate::{DRIVE, PERIODS};

pub const ZETA: f64 = 0.032;
pub const LOAD: f64 = 1.0;

/// Events nearer to the end than this are at the end.
const END: f64 = 1e-13;
/// Updates of Newton's method, or bisections, for an event.
const UPDATES: usize = 50;

/// The force in contact.
#[derive(Debug, Clone, Copy)]
pub enum Force {
    Linear,
    Hertz,
    Soft,
}

impl Force {
    /// The acceleration on a piece.
    fn acceleration(self, contact: bool, t: f64, x: f64, v: f64) -> f64 {
        let outside = DRIVE * t.cos() + LOAD;
        if !contact {
            return outside;
        }
        // The last stage of a step that passes the event.
        let gap = x.max(0.0);
        let spring = match self {
            Self::Linear => x,
            Self::Hertz => gap * gap.sqrt(),
            Self::Soft => gap.powf(0.6),
        };
        outside - 2.0 * ZETA * v - spring
    }
}

/// Tsitouras 5(4).
pub fn diffsol(force: Force, tolerance: f64, state: &mut [f64; 2]) -> Result<(), Box<dyn Error>> {
    let contact = Cell::new(state[0] > 0.0);
    let [x, v] = *state;
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(tolerance)
        .atol([tolerance])
        .rhs(|y, _p, t, dy| {
            dy[0] = y[1];
            dy[1] = force.acceleration(contact.get(), t, y[0], y[1]);
        })
        .init(
            move |_p, _t, y| {
                y[0] = x;
                y[1] = v;
            },
            2,
        )
        .root(|y, _p, _t, g| g[0] = y[0], 1)
        .build()?;
    let end = TAU * PERIODS as f64;
    let mut solver = problem.tsit45()?;
    solver.set_stop_time(end)?;
    loop {
        match solver.step()? {
            OdeSolverStopReason::InternalTimestep => {}
            OdeSolverStopReason::TstopReached => break,
            OdeSolverStopReason::RootFound(t, _) => {
                solver.state_mut_back(t)?;
                contact.set(!contact.get());
                let at = solver.state_mut();
                at.y[0] = 0.0;
                at.dy[0] = at.y[1];
                at.dy[1] = force.acceleration(contact.get(), t, 0.0, at.y[1]);
                solver.set_stop_time(end)?;
            }
        }
    }
    let at = solver.state();
    *state = [at.y[0], at.y[1]];
    Ok(())
}

/// One piece, for `differential-equations`.
struct Piece {
    force: Force,
    contact: bool,
}

impl ODE<f64, SVector<f64, 2>> for Piece {
    fn diff(&self, t: f64, y: &SVector<f64, 2>, dy: &mut SVector<f64, 2>) {
        dy[0] = y[1];
        dy[1] = self.force.acceleration(self.contact, t, y[0], y[1]);
    }
}

/// Looks at the steps: keeps the last state, and ends where the gap has left its piece.
struct Watch {
    contact: bool,
    before: (f64, SVector<f64, 2>),
    last: (f64, SVector<f64, 2>),
    left: bool,
}

impl Solout<f64, SVector<f64, 2>> for Watch {
    fn solout<I: Interpolation<f64, SVector<f64, 2>>>(
        &mut self,
        to: f64,
        from: f64,
        last: &SVector<f64, 2>,
        before: &SVector<f64, 2>,
        _interpolator: &mut I,
        _solution: &mut Solution<f64, SVector<f64, 2>>,
    ) -> ControlFlag<f64, SVector<f64, 2>> {
        (self.before, self.last) = ((from, *before), (to, *last));
        let off = if self.contact { -last[0] } else { last[0] };
        self.left = to > from && off > 0.0;
        if self.left {
            ControlFlag::Terminate
        } else {
            ControlFlag::Continue
        }
    }
}

/// Dormand and Prince 8(5,3). The event detection of the crate finds events by an interpolant that is less accurate than the
/// steps, with errors up to 1e-2 at any tolerance; so the last step is repeated here, to where Newton's method puts the event.
pub fn dop853(force: Force, tolerance: f64, state: &mut [f64; 2]) -> Result<(), Box<dyn Error>> {
    let end = TAU * PERIODS as f64;
    let mut at = (0.0, SVector::from(*state));
    let mut contact = state[0] > 0.0;
    while end - at.0 > END {
        let watch = integrate(force, contact, tolerance, at, end)?;
        at = watch.last;
        if !watch.left {
            continue;
        }
        let (mut low, mut high) = (watch.before.0, at.0);
        for _ in 0..UPDATES {
            let change = at.1[0] / at.1[1];
            if change.abs() <= END || high - low <= END {
                break;
            }
            let next = at.0 - change;
            let inside = next > low && next < high;
            let next = if inside { next } else { 0.5 * (low + high) };
            let again = integrate(force, contact, tolerance, watch.before, next)?;
            at = again.last;
            *(if again.left { &mut high } else { &mut low }) = at.0;
        }
        at.1[0] = 0.0;
        contact = !contact;
    }
    *state = [at.1[0], at.1[1]];
    Ok(())
}

/// From a state to the end, or to the first step that leaves the piece.
fn integrate(
    force: Force,
    contact: bool,
    tolerance: f64,
    at: (f64, SVector<f64, 2>),
    end: f64,
) -> Result<Watch, Box<dyn Error>> {
    let mut method = ExplicitRungeKutta::dop853().rtol(tolerance).atol(tolerance);
    let piece = Piece { force, contact };
    let mut watch = Watch {
        contact,
        before: at,
        last: at,
        left: false,
    };
    ODEProblem::new(&piece, at.0, end, at.1)
        .solout(&mut watch)
        .solve(&mut method)
        .map_err(|error| format!("{error:?}"))?;
    Ok(watch)
}
