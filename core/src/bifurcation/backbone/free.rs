//! Free oscillation of a conservative system.
//!
//! Without damping and excitation, a motion that starts at rest and is at rest again half a period later goes back the way it came
//! (the equations do not change when time is turned round). So an orbit is a position `q_0` and a frequency `omega` with
//!
//! ```text
//! v(pi / omega; q_0, 0) = 0                                                                                  (1)
//! ```
//!
//! Rest at the beginning is the phase condition. One coordinate of `q_0` is what is varied, so that a frequency that does not
//! depend on the amplitude, or turns back, is followed as any other.
//!
//! The first oscillation of several coordinates is given, or one of the [modes](super::modes) beside rest is.
//!
//! Source: Kerschen, Peeters, Golinval and Vakakis (2009), Nonlinear normal modes, part I, Mech. Syst. Signal Process. 23, section
//! 3.2 (shooting with a phase condition); Lamb and Roberts (1998), Time-reversal symmetry in dynamical systems, Physica D 112
//! (orbits that return on their way).

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use super::modes::Linearised;
use super::oscillation::Equations;
use super::walk::{Found, OneWay, Walk};
use crate::bifurcation::error::BifurcationError;
use crate::branches::branch::{Branch, Model};
use crate::branches::error::OrbitError;
use crate::branches::point::Point;
use crate::branches::progress::Progress;
use crate::cancel::Cancel;
use crate::continuation::follow::{FollowOptions, Outcome, Stop};
use crate::continuation::newton::{Newton, NewtonError, NewtonOptions};
use crate::continuation::step_control::{self, StepControl};
use crate::error::Error;
use crate::model::conservative::conservative;
use crate::model::error::ModelError;
use crate::model::layout::{self, Layout};
use crate::model::request::RequestError;
use crate::model::{self, validate};
use crate::response::read_by_shooting;
use crate::system::System;
use crate::time::{self, MotionError};

const POINTS: usize = 5000;
/// Where nothing else was asked for, an oscillation in a mode begins with this part of the displacement that it ends with.
const SMALLEST: f64 = 0.02;
/// A damping matrix that differs from symmetry by this part of its largest entry has gyroscopic forces in it.
const SYMMETRIC: f64 = 1e-9;

/// The frequency of free oscillation over its amplitude: set up step by step, then [run](FreeOscillation::run).
///
/// It gives a [`Branch`] over the frequency, whose orbits are known by two states, at rest where they begin and half a period later:
/// [`Orbit::states`](crate::Orbit::states). What is not read off them [`Branch::complete`] has. Nothing is known of their stability: what is
/// conserved neither grows nor decays.
///
/// ```
/// use hertzian::backbone::FreeOscillation;
///
/// hertzian::oscillator! {
///     Hertz(x) {
///         ddot(x) + sgn(x)*|x|^1.5 = 0;
///     }
/// }
///
/// let curve = FreeOscillation::of(&Hertz {}).from(0.5).to(2.0).run()?;
/// // omega = 0.95469357 a^(1/4), by a quadrature of the period.
/// let last = curve.points.last().unwrap();
/// assert!((last.omega() - 0.95469356972851 * 2_f64.powf(0.25)).abs() < 1e-9);
/// assert!((last.peak_to_peak() - 4.0).abs() < 1e-9);
/// assert_eq!(curve.to_csv().lines().count(), 1 + curve.points.len());
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct FreeOscillation {
    system: Arc<dyn System>,
    from: Option<f64>,
    to: Option<f64>,
    /// Largest and smallest positions of all coordinates.
    up_to: Vec<[f64; 2]>,
    along: Option<String>,
    near: Option<Near>,
    gyroscopic: Option<f64>,
    tolerance: f64,
    max_points: usize,
    largest_step: f64,
    cancel: Cancel,
}

/// What the first oscillation is near.
#[derive(Debug, Clone)]
enum Near {
    /// Positions at rest, and the frequency.
    Rest(Vec<f64>, f64),
    /// The mode of this number.
    Mode(usize),
}

/// Where a curve begins.
struct Begin {
    /// The coordinate that is varied, and its first position.
    varied: usize,
    from: f64,
    /// Its last one.
    to: f64,
    /// Positions at rest and the frequency, where they are known.
    near: Option<(Vec<f64>, f64)>,
    /// The mode whose curve it is, where one was asked for.
    one_way: Option<OneWay>,
}

impl FreeOscillation {
    /// Of this system, whose damping and excitation must be zero at the parameters it has, or are [left out](Self::conservative).
    pub fn of(system: &dyn System) -> Self {
        Self {
            system: system.shared(),
            from: None,
            to: None,
            up_to: Vec::new(),
            along: None,
            near: None,
            gyroscopic: None,
            tolerance: 1e-12,
            max_points: POINTS,
            largest_step: StepControl::default().largest,
            cancel: Cancel::new(),
        }
    }

    hertzian_contract::setters! { self:
        /// Position of the coordinate that is varied, at rest, where the curve begins. By default a [mode](Self::mode) begins with a fiftieth of
        /// the displacement that it ends with.
        from(position: f64) { self.from = Some(position) }

        /// The same where it ends.
        to(position: f64) { self.to = Some(position) }

        /// A [mode](Self::mode) ends where it moves as far as the orbits of this branch of the same coordinates do.
        up_to(branch: &Branch) {
            let coordinates = self.system.facts().coordinates.len();
            self.up_to = vec![[f64::NEG_INFINITY, f64::INFINITY]; coordinates];
            for point in &branch.points {
                for (most, motion) in self.up_to.iter_mut().zip(&point.observed.motions) {
                    *most = [most[0].max(motion.maximum), most[1].min(motion.minimum)];
                }
            }
        }

        /// The coordinate whose position is varied, by its name. Default: the first one; of a [mode](Self::mode) that which moves most.
        along(coordinate: impl Into<String>) { self.along = Some(coordinate.into()) }

        /// The first oscillation is near these positions at rest and this frequency: needed where there are several coordinates and no
        /// [mode](Self::mode) is asked for.
        near_rest(positions: &[f64], omega: f64) { self.near = Some(Near::Rest(positions.to_vec(), omega)) }

        /// The oscillation that begins with this mode, counted from one in the order of the [frequencies](Self::modes) that small oscillations
        /// about the state at rest have. Where it is in resonance with another mode and turns back, the curve is taken up again at larger
        /// positions: parts of it are missing there, and [`Branch::leaps`] says where. Where it is not found
        /// again it ends with [`Stop::TurnedBack`].
        ///
        /// ```
        /// use hertzian::backbone::FreeOscillation;
        ///
        /// hertzian::oscillator! {
        ///     /// Two masses in a row, of which the second has a cubic spring to the ground.
        ///     Pair(x, y) {
        ///         ddot(x) + 2*x - y = 0;
        ///         ddot(y) + 2*y - x + 0.5*y^3 = 0;
        ///     }
        /// }
        ///
        /// let request = FreeOscillation::of(&Pair {});
        /// let modes = request.modes()?;
        /// assert!((modes[0] - 1.0).abs() < 1e-12 && (modes[1] - 3_f64.sqrt()).abs() < 1e-12);
        /// let curve = request.mode(1).along("y").to(1.0).run()?;
        /// assert!(curve.points[0].omega() < 1.001);
        /// assert!(curve.points.last().unwrap().omega() > 1.05);
        /// # Ok::<(), hertzian::Error>(())
        /// ```
        mode(number: usize) { self.near = Some(Near::Mode(number)) }

        /// Leaves out what gives or takes energy: damping, loads that change with time, and what forces do by the rates of their gaps.
        ///
        /// ```
        /// use hertzian::backbone::FreeOscillation;
        ///
        /// hertzian::oscillator! {
        ///     Damped(x) {
        ///         param zeta = 0.05;
        ///         law stop(gap) { gap > 0 => 3*gap + zeta*dot(gap), else => 0 }
        ///         ddot(x) + 2*zeta*dot(x) + x + stop(x) = cos(omega*t);
        ///     }
        /// }
        ///
        /// let curve = FreeOscillation::of(&Damped::default()).conservative().from(1.0).to(2.0).run()?;
        /// // Half a period at the frequency one, and half at the frequency two.
        /// assert!((curve.points[0].omega() - 4.0 / 3.0).abs() < 1e-9);
        /// # Ok::<(), hertzian::Error>(())
        /// ```
        conservative() {
            self.gyroscopic = Some(gyroscopic(&self.system));
            self.system = conservative(&self.system);
        }

        /// Tolerance of the flow, where it is not in closed form. Default: 1e-12.
        tolerance(tolerance: f64) { self.tolerance = tolerance }

        /// Largest step along the curve, as [`FrequencyResponse::largest_step`](crate::response::FrequencyResponse::largest_step) measures
        /// it. Default: 0.1.
        largest_step(step: f64) { self.largest_step = step }

        /// What is computed ends when this token is cancelled, the search for the first oscillation too.
        cancel(cancel: &Cancel) { self.cancel = cancel.clone() }

        /// Stop after this many points. Default: 5000.
        max_points(points: usize) { self.max_points = points }
    }

    /// Follows the curve from one position to the other.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, nothing oscillates at the first position, or a motion does not come back because
    /// the system has damping or an excitation. A curve that ends early is not an error: it comes back with what was computed and
    /// with [`Branch::stopped`].
    pub fn run(&self) -> Result<Branch, Error> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), and calls `visit` at every point as it is found: to show progress, or to stop. Its value is the position at
    /// rest.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with(
        &self,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Branch, Error> {
        let started = Instant::now();
        let begin = self.begin()?;
        let options = self.options(begin.from, begin.to)?;
        let mut equations = self.equations(begin.varied)?;
        let first = begin.first(&mut equations)?;
        equations.measure(&first);
        let mut newton = Newton::new(&equations);
        let mut walk = Walk {
            equations: &mut equations,
            newton: &mut newton,
            visit: &mut visit,
            one_way: begin.one_way,
        };
        let (found, outcome) = walk.all(first, options, &self.cancel)?;
        let stopped = self.stopped(&found, outcome)?;
        let Found { points, leaps, .. } = found;
        let omega = points.first().map_or(1.0, Point::omega);
        Ok(Branch {
            model: Model::of(&self.system),
            varied: "omega".to_owned(),
            points,
            events: Vec::new(),
            turns: Vec::new(),
            leaps,
            begin: None,
            stopped,
            statistics: newton.statistics,
            work: equations.flow.work(),
            elapsed: started.elapsed(),
            further: read_by_shooting(&self.system, self.tolerance, omega),
        })
    }

    /// Why it ended.
    ///
    /// # Errors
    /// If nothing was found, or a motion is not free.
    fn stopped(&self, found: &Found, outcome: Result<Outcome, NewtonError>) -> Result<Stop, Error> {
        let cancelled = self.cancel.is_cancelled();
        let (nothing, value) = (found.points.is_empty(), found.position);
        let own = found.stop(&outcome);
        Ok(match (&found.failure, outcome) {
            _ if cancelled && !nothing => Stop::Interrupted,
            _ if cancelled => return Err(OrbitError::Cancelled { value }.into()),
            (Some(Ok(apart)), _) => {
                let apart = *apart;
                return Err(BifurcationError::NotFree { apart }.into());
            }
            (Some(Err(reason)), _) if nothing => {
                let reason = *reason;
                return Err(MotionError { value, reason }.into());
            }
            (Some(Err(reason)), _) => Stop::Motion {
                value,
                reason: *reason,
            },
            (None, Err(reason)) => return Err(OrbitError::NoStart { value, reason }.into()),
            // A walk along free oscillations is never resized.
            (None, Ok(_)) => own.unwrap_or(Stop::Interrupted),
        })
    }

    /// Angular frequencies of small oscillations about the state at rest, the lowest first; of motions that nothing holds they are zero.
    ///
    /// # Errors
    /// If no state at rest is found, or forces there have no potential.
    pub fn modes(&self) -> Result<Vec<f64>, Error> {
        let modes = Linearised::of(&self.system, &self.cancel)?.small()?;
        Ok(modes.iter().map(|mode| mode.omega).collect())
    }

    /// Energies of the oscillations of a curve above that of the state at rest: what it takes to move the system from there to where each
    /// oscillation begins.
    ///
    /// ```
    /// use hertzian::backbone::FreeOscillation;
    ///
    /// hertzian::oscillator! {
    ///     Hertz(x) { ddot(x) + sgn(x)*|x|^1.5 = 0; }
    /// }
    ///
    /// let request = FreeOscillation::of(&Hertz {}).from(0.5).to(2.0);
    /// let energies = request.energies(&request.run()?)?;
    /// // The work of x^1.5 from 0 to 2.
    /// assert!((energies.last().unwrap() - 0.4 * 2_f64.powf(2.5)).abs() < 1e-12);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// If no state at rest is found, forces have no potential, or the curve is none of free oscillations of this system.
    pub fn energies(&self, curve: &Branch) -> Result<Vec<f64>, Error> {
        let linearised = Linearised::of(&self.system, &self.cancel)?;
        let coordinates = linearised.rest.len();
        let of = |point: &Point| {
            let entries = point.orbit.states().next().map_or(0, <[f64]>::len);
            let state = point.orbit.states().next();
            let positions = state.filter(|state| state.len() == 2 * coordinates);
            let positions = positions.ok_or(RequestError::State {
                entries,
                expected: 2 * coordinates,
            })?;
            linearised.energy(&positions[..coordinates])
        };
        curve.points.iter().map(of).collect()
    }

    /// What is varied, and where the curve begins.
    fn begin(&self) -> Result<Begin, Error> {
        if let Some(largest) = self.gyroscopic.filter(|largest| *largest > 0.0) {
            return Err(BifurcationError::Gyroscopic { largest }.into());
        }
        let named = match &self.along {
            Some(name) => Some(self.coordinate(name)?),
            None => None,
        };
        let near = match &self.near {
            Some(Near::Mode(number)) => return self.at_mode(*number, named),
            Some(Near::Rest(positions, omega)) => Some((positions.clone(), *omega)),
            None => None,
        };
        Ok(Begin {
            varied: named.unwrap_or(0),
            from: self.from.ok_or(RequestError::no_end("from"))?,
            to: self.to.ok_or(RequestError::no_end("to"))?,
            near,
            one_way: None,
        })
    }

    /// Where a curve ends that varies a coordinate, which has this position at rest.
    fn end(&self, varied: usize, rest: f64) -> Result<f64, Error> {
        let farther = |[most, least]: [f64; 2]| {
            if most - rest >= rest - least {
                most
            } else {
                least
            }
        };
        let known = self.up_to.get(varied).copied().map(farther);
        let to = self.to.or(known.filter(|to| to.is_finite()));
        Ok(to.ok_or(RequestError::no_end("to"))?)
    }

    /// The coordinate of a name.
    fn coordinate(&self, name: &str) -> Result<usize, Error> {
        let coordinates = &self.system.facts().coordinates;
        let found = coordinates.iter().position(|known| known == name);
        let unknown = || RequestError::UnknownCoordinate {
            name: name.to_owned(),
            known: coordinates.iter().map(ToString::to_string).collect(),
        };
        Ok(found.ok_or_else(unknown)?)
    }

    /// Where the oscillation in a mode begins.
    fn at_mode(&self, number: usize, along: Option<usize>) -> Result<Begin, Error> {
        let linearised = Linearised::of(&self.system, &self.cancel)?;
        let modes = linearised.small()?;
        let mode = number.checked_sub(1).and_then(|index| modes.get(index));
        let varied = along.or_else(|| Some(linearised.leading(mode?)));
        let varied = varied.unwrap_or(0);
        let rest = linearised.rest[varied];
        let to = self.end(varied, rest)?;
        let from = self.from.unwrap_or(rest + SMALLEST * (to - rest));
        let none = || {
            let name = self.system.facts().coordinates.get(varied);
            let held = modes.iter().filter(|mode| mode.moves(varied));
            BifurcationError::NoMode {
                mode: number,
                modes: held.count(),
                coordinate: name.map_or_else(String::new, ToString::to_string),
            }
        };
        let mode = mode.cloned().ok_or_else(none)?;
        if linearised.at(&mode, varied, from - rest)?.is_none() {
            return Err(none().into());
        }
        Ok(Begin {
            varied,
            from,
            to,
            near: None,
            one_way: Some(OneWay {
                linearised,
                mode,
                varied,
            }),
        })
    }

    /// Range and accuracy, checked.
    fn options(&self, from: f64, to: f64) -> Result<FollowOptions, Error> {
        for (name, value) in [("from", from), ("to", to)] {
            validate::option(name, value, -1e300..=1e300, "must be finite")?;
        }
        if from == to {
            return Err(RequestError::EmptyRange { value: from }.into());
        }
        Ok(FollowOptions {
            from,
            to,
            points: step_control::max_points(self.max_points)?,
            steps: step_control::largest_step(self.largest_step)?,
            newton: NewtonOptions {
                tolerance: (100.0 * self.tolerance).clamp(1e-11, 1e-6),
                iterations: 12,
                damped: false,
            },
        })
    }

    /// The equations of the system, checked.
    fn equations(&self, varied: usize) -> Result<Equations, Error> {
        let facts = self.system.facts();
        if facts.coordinates.is_empty() {
            return Err(ModelError::NoCoordinates.into());
        }
        let cancel = self.cancel.clone();
        let mut flow = time::of(&self.system, 1.0, self.tolerance)?;
        flow.until(&cancel);
        let parameters = model::values(&self.system);
        Ok(Equations::new(
            flow,
            varied,
            parameters,
            facts.divisor,
            cancel,
        ))
    }
}

impl Begin {
    /// The unknowns of the first oscillation, and its position.
    fn first(&self, equations: &mut Equations) -> Result<Vec<f64>, Error> {
        let n = equations.flow.coordinates();
        let of_mode = self.one_way.as_ref().map(|one_way| one_way.near(self.from));
        if let Some(first) = of_mode.transpose()?.flatten() {
            return Ok(first);
        }
        let Some((positions, omega)) = &self.near else {
            let time = equations.half_period(self.from)?;
            let others = (1..n).map(|_| 0.0);
            return Ok(others.chain([PI / time, self.from]).collect());
        };
        if positions.len() != n {
            return Err(RequestError::State {
                entries: positions.len(),
                expected: n,
            }
            .into());
        }
        let omega = validate::omega(*omega)?;
        let positions = positions.iter().enumerate();
        let others = positions.filter(|(index, _)| *index != self.varied);
        let others = others.map(|(_, position)| *position);
        Ok(others.chain([omega, self.from]).collect())
    }
}

/// The largest entry of the part of the damping matrix that is skew-symmetric; zero where that is rounding.
fn gyroscopic(system: &dyn System) -> f64 {
    let layout = Layout::of(system);
    let mut coefficients = vec![0.0; layout.coefficients];
    system.coefficients(&model::values(system), 1.0, &mut coefficients);
    let damping = layout::constant(&layout.damping, &coefficients, layout.coordinates);
    let skew = 0.5 * (&damping - damping.transpose()).amax();
    if skew > SYMMETRIC * damping.amax() {
        skew
    } else {
        0.0
    }
}
