//! What is asked of a branch, by any method.

use std::sync::Arc;

use hertzian::{
    Chosen, ContactEquation, FrequencyResponse, HarmonicBalance, OrbitMethod, Shooting, System,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::arrays::numbers;
use crate::given::Given;
use crate::methods::{PyContactEquation, PyHarmonicBalance, PyShooting};
use crate::orbit::PyOrbit;
use crate::point::PyPoint;

/// A request by one of the methods.
#[derive(Clone)]
pub enum Request {
    Chosen(FrequencyResponse),
    Balance(FrequencyResponse<HarmonicBalance>),
    Shooting(FrequencyResponse<Shooting>),
    ContactEquation(FrequencyResponse<ContactEquation>),
}

/// Does the same with a request, whatever its method.
macro_rules! by_any {
    ($request:expr, $name:ident => $does:expr) => {
        match $request {
            $crate::request::Request::Chosen($name) => $does,
            $crate::request::Request::Balance($name) => $does,
            $crate::request::Request::Shooting($name) => $does,
            $crate::request::Request::ContactEquation($name) => $does,
        }
    };
}
pub(crate) use by_any;

/// A method with its options.
#[derive(Clone, Copy)]
pub enum Method {
    Chosen,
    Balance(HarmonicBalance),
    Shooting(Shooting),
    ContactEquation(ContactEquation),
}

impl Method {
    /// What `by` says, or else the default: where that is chosen, and options of the balance are given, the balance with these.
    pub fn of(given: &Given<'_>, default: Self) -> PyResult<Self> {
        let by = given.any("by")?;
        let options = BalanceOptions::of(given)?;
        let Some(by) = by else {
            return match default {
                Self::Chosen if options.any().is_some() => {
                    Ok(Self::Balance(options.applied(HarmonicBalance::new())))
                }
                default => options.refused_by("default here").map(|()| default),
            };
        };
        let method = if let Ok(balance) = by.extract::<PyHarmonicBalance>() {
            Self::Balance(balance.0)
        } else if let Ok(shooting) = by.extract::<PyShooting>() {
            Self::Shooting(shooting.0)
        } else if let Ok(equation) = by.extract::<PyContactEquation>() {
            Self::ContactEquation(equation.0)
        } else {
            return Err(PyTypeError::new_err(
                "by is a method: HarmonicBalance(), Shooting() or ContactEquation()",
            ));
        };
        options.refused_by("given by `by`").map(|()| method)
    }
}

/// Options of the balance, which requests take too where that is the method.
struct BalanceOptions {
    harmonics: Option<usize>,
    doublings: Option<bool>,
    bifurcations: Option<bool>,
    symmetric: Option<bool>,
}

impl BalanceOptions {
    fn of(given: &Given<'_>) -> PyResult<Self> {
        Ok(Self {
            harmonics: given.take("harmonics")?,
            doublings: given.take("doublings")?,
            bifurcations: given.take("bifurcations")?,
            symmetric: given.take("symmetric")?,
        })
    }

    fn applied(&self, mut balance: HarmonicBalance) -> HarmonicBalance {
        if let Some(harmonics) = self.harmonics {
            balance = balance.harmonics(harmonics);
        }
        if let Some(wanted) = self.doublings {
            balance = balance.doublings(wanted);
        }
        if let Some(wanted) = self.bifurcations {
            balance = balance.bifurcations(wanted);
        }
        if let Some(wanted) = self.symmetric {
            balance = balance.symmetric(wanted);
        }
        balance
    }

    /// The first one that is given.
    fn any(&self) -> Option<&'static str> {
        let given = [
            ("harmonics", self.harmonics.is_some()),
            ("doublings", self.doublings.is_some()),
            ("bifurcations", self.bifurcations.is_some()),
            ("symmetric", self.symmetric.is_some()),
        ];
        let mut given = given.into_iter().filter(|(_, given)| *given);
        given.next().map(|(name, _)| name)
    }

    /// None is given where they would be lost.
    fn refused_by(&self, which: &str) -> PyResult<()> {
        match self.any() {
            None => Ok(()),
            Some(name) => Err(PyTypeError::new_err(format!(
                "{name} is an option of the harmonic balance, and the method is the one {which}: by=HarmonicBalance({name}=..)"
            ))),
        }
    }
}

impl Request {
    /// Of a system, with the options that were given.
    pub fn of(system: &Arc<dyn System>, given: &Given<'_>, default: Method) -> PyResult<Self> {
        let request = FrequencyResponse::of(system);
        Ok(match Method::of(given, default)? {
            Method::Chosen => Self::Chosen(with(request.by(Chosen::new()), given)?),
            Method::Balance(method) => Self::Balance(with(request.by(method), given)?),
            Method::Shooting(method) => Self::Shooting(with(request.by(method), given)?),
            Method::ContactEquation(method) => {
                Self::ContactEquation(with(request.by(method), given)?)
            }
        })
    }

    /// The same in a range.
    pub fn between(self, from: f64, to: f64) -> Self {
        match self {
            Self::Chosen(request) => Self::Chosen(request.from(from).to(to)),
            Self::Balance(request) => Self::Balance(request.from(from).to(to)),
            Self::Shooting(request) => Self::Shooting(request.from(from).to(to)),
            Self::ContactEquation(request) => Self::ContactEquation(request.from(from).to(to)),
        }
    }
}

/// The request with what every method takes.
fn with<M: OrbitMethod>(
    mut request: FrequencyResponse<M>,
    given: &Given<'_>,
) -> PyResult<FrequencyResponse<M>> {
    if let Some(name) = given.take::<String>("vary")? {
        request = request.vary(name);
    }
    if let Some(omega) = given.take("omega")? {
        request = request.omega(omega);
    }
    if let Some(period) = given.take("period")? {
        request = request.period(period);
    }
    if let Some(tolerance) = given.take("tolerance")? {
        request = request.tolerance(tolerance);
    }
    if let Some(name) = given.take::<String>("accuracy_of")? {
        request = request.accuracy_of(name);
    }
    if let Some(wanted) = given.take("stability")? {
        request = request.stability(wanted);
    }
    if let Some(step) = given.take("largest_step")? {
        request = request.largest_step(step);
    }
    if let Some(points) = given.take("max_points")? {
        request = request.max_points(points);
    }
    if let Some(state) = given.any("near_state")? {
        request = request.near_state(&numbers(&state)?);
    }
    if let Some(orbit) = given.any("near_orbit")? {
        request = if let Ok(orbit) = orbit.cast::<PyOrbit>() {
            request.near_orbit(&orbit.get().orbit)
        } else if let Ok(point) = orbit.cast::<PyPoint>() {
            request.near_orbit(&point.get().0.orbit)
        } else {
            return Err(PyTypeError::new_err("near_orbit is an Orbit or a Point"));
        };
    }
    if let Some(path) = given.take::<std::path::PathBuf>("keep")? {
        request = request.keep(path);
    }
    Ok(request)
}
