//! What a user asks of a branch: the system, what is varied and how far, and the method.

mod backbone;
mod both_ways;
mod branch;
mod by_balance;
mod by_contact_equation;
mod by_shooting;
mod chosen;
mod following;
mod growing;
mod in_turn;
mod kind;
mod motion;
mod multipliers;
mod reading;
#[cfg(feature = "serde")]
mod request_in_file;
mod resume;
#[doc(hidden)]
pub mod stages;
mod steep;

pub(crate) use backbone::read_by_shooting;
pub use chosen::Chosen;
pub use kind::OrbitMethodKind;

use chosen::Choice;
pub use resume::Resume;

use std::ops::ControlFlow;

use self::motion::Motions;
use crate::balance::aft::Aft;
use crate::balance_branch::options::HarmonicBalance;
use crate::branches::branch::{Branch, Model};
use crate::branches::orbit::Orbit;
use crate::branches::point::{Event, Point};
use crate::branches::progress::{Progress, See};
use crate::branches::request::{Guess, Request};
use crate::cancel::Cancel;
use crate::contact_equation::ContactEquation;
use crate::error::Error;
use crate::event::Side;
use crate::model::request::RequestError;
use crate::orbit::observe::Accuracy;
use crate::orbit::stability::Method;
use crate::shooting::{BifurcationCurve, Shooting};
use crate::system::System;

mod sealed {
    use super::{Accuracy, Branch, Error, Event, Point, Request, See, Side};

    /// What a method of computing periodic orbits does for a request.
    pub trait Follow {
        /// The same method, looking for all that branches begin at.
        fn for_diagram(self) -> Self
        where
            Self: Sized,
        {
            self
        }

        /// The same method, with the accuracy of this.
        fn accurate_in(self, accuracy: Accuracy) -> Self
        where
            Self: Sized;

        /// Whether unknowns are harmonics.
        fn is_balance(&self, _request: &Request) -> bool {
            false
        }

        /// The one orbit at a value.
        fn orbit(&self, request: &Request, value: f64) -> Result<Point, Error>;

        /// The branch from one end of the range to the other.
        fn run(&self, request: &Request, visit: See<'_>) -> Result<Branch, Error>;

        /// The branch that begins at an event, on one side of it.
        fn switch(
            &self,
            request: &Request,
            event: &Event,
            side: Side,
            visit: See<'_>,
        ) -> Result<Branch, Error>;

        /// The branch through the orbit at a value, both ways.
        fn through(&self, request: &Request, value: f64, visit: See<'_>) -> Result<Branch, Error>;
    }
}

/// A method of computing periodic orbits: [`HarmonicBalance`], [`Shooting`], [`ContactEquation`], or the one of these that is
/// [`Chosen`].
pub trait OrbitMethod: sealed::Follow + Clone + Send + Sync + 'static {}

impl OrbitMethod for Chosen {}
impl OrbitMethod for HarmonicBalance {}
impl OrbitMethod for Shooting {}
impl OrbitMethod for ContactEquation {}

/// What to follow, set up step by step, then [run](FrequencyResponse::run).
///
/// Only the two ends of the range have to be given. By default the excitation frequency is varied, the orbit has the
/// period of the excitation, the method that fits the system is [`Chosen`], and everything else follows from the tolerance. Setters may be
/// called in any order; [`by`](Self::by) replaces the options of a method.
///
/// ```
/// hertzian::oscillator! {
///     Duffing(x) {
///         param drive;
///         ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
///     }
/// }
///
/// let model = Duffing { drive: 0.2 };
/// let request = hertzian::FrequencyResponse::of(&model).harmonics(5).samples(64);
/// let by_frequency = request.clone().from(0.5).to(1.5).run()?;
/// let by_drive = request.vary("drive").omega(1.2).from(0.01).to(0.2).run()?;
/// let (a, b) = (by_frequency.at(1.2)?, by_drive.at(0.2)?);
/// assert!((a[0].peak_to_peak() - b[0].peak_to_peak()).abs() < 1e-6);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct FrequencyResponse<M = Chosen> {
    pub(crate) request: Request,
    pub(crate) method: M,
    /// Name of what the accuracy is of.
    accuracy: Option<String>,
}

impl FrequencyResponse {
    /// Of this system, at the values that its parameters have now.
    pub fn of(system: &dyn System) -> Self {
        Self {
            request: Request::of(system),
            method: Chosen::new(),
            accuracy: None,
        }
    }

    hertzian_contract::setters! { self:
        /// By the balance, and as [`HarmonicBalance::harmonics`].
        harmonics(harmonics: usize) { self.method = self.method.balanced(|balance| balance.harmonics(harmonics)) }

        /// By the balance, and as [`HarmonicBalance::samples`].
        samples(samples: usize) { self.method = self.method.balanced(|balance| balance.samples(samples)) }

        /// By the balance, and as [`HarmonicBalance::aft`].
        aft(aft: Aft) { self.method = self.method.balanced(|balance| balance.aft(aft)) }

        /// By the balance, and as [`HarmonicBalance::multipliers`].
        multipliers(method: Method) { self.method = self.method.balanced(|balance| balance.multipliers(method)) }

        /// By the balance, and as [`HarmonicBalance::doublings`].
        doublings(wanted: bool) { self.method = self.method.balanced(|balance| balance.doublings(wanted)) }

        /// By the balance, and as [`HarmonicBalance::bifurcations`].
        bifurcations(wanted: bool) { self.method = self.method.balanced(|balance| balance.bifurcations(wanted)) }

        /// By the balance, and as [`HarmonicBalance::symmetric`].
        symmetric(wanted: bool) { self.method = self.method.balanced(|balance| balance.symmetric(wanted)) }
    }
}

impl FrequencyResponse {
    /// The method that fits by what laws say in the range that is asked for, as [`Branch::method`] has it; an option of the
    /// balance, or [accuracy of an output](Self::accuracy_of), asks for the balance whatever they say.
    ///
    /// ```
    /// use hertzian::{FrequencyResponse, OrbitMethodKind};
    ///
    /// hertzian::oscillator! {
    ///     Spring(x) {
    ///         param pulled = 1.0 > 0;
    ///         law spring(gap) { gap > 0 => gap, else => pulled*gap }
    ///         ddot(x) + 0.1*dot(x) + spring(x) = 0.3*cos(omega*t);
    ///     }
    /// }
    ///
    /// let spring = Spring::default();
    /// let request = FrequencyResponse::of(&spring).vary("pulled").omega(1.0);
    /// assert_eq!(request.choice(), OrbitMethodKind::HarmonicBalance);
    /// let request = request.from(1.0).to(4.0);
    /// assert_eq!(request.choice(), OrbitMethodKind::ContactEquation);
    /// assert_eq!(request.reason(), "law `spring` has a corner");
    /// ```
    pub fn choice(&self) -> OrbitMethodKind {
        Choice::within(&self.request).method()
    }

    /// Why that is the method that fits, in a few words.
    pub fn reason(&self) -> String {
        Choice::within(&self.request).reason()
    }
}

impl FrequencyResponse<HarmonicBalance> {
    hertzian_contract::setters! { self:
        /// As [`HarmonicBalance::harmonics`].
        harmonics(harmonics: usize) { self.method = self.method.harmonics(harmonics) }

        /// As [`HarmonicBalance::samples`].
        samples(samples: usize) { self.method = self.method.samples(samples) }

        /// As [`HarmonicBalance::aft`].
        aft(aft: Aft) { self.method = self.method.aft(aft) }

        /// As [`HarmonicBalance::multipliers`].
        multipliers(method: Method) { self.method = self.method.multipliers(method) }

        /// As [`HarmonicBalance::doublings`].
        doublings(wanted: bool) { self.method = self.method.doublings(wanted) }

        /// As [`HarmonicBalance::bifurcations`].
        bifurcations(wanted: bool) { self.method = self.method.bifurcations(wanted) }

        /// As [`HarmonicBalance::symmetric`].
        symmetric(wanted: bool) { self.method = self.method.symmetric(wanted) }
    }
}

impl<M: OrbitMethod> FrequencyResponse<M> {
    /// Computes orbits by another method, with its options.
    ///
    /// ```
    /// use hertzian::{FrequencyResponse, Shooting};
    ///
    /// hertzian::oscillator! {
    ///     Duffing(x) {
    ///         param drive;
    ///         ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let request = FrequencyResponse::of(&Duffing { drive: 0.2 }).from(0.5).to(2.0);
    /// let by_balance = request.clone().run()?;
    /// let by_shooting = request.by(Shooting::new().segments(2)).run()?;
    /// for (a, b) in by_balance.folds().zip(by_shooting.folds()) {
    ///     assert!((a.point.value - b.point.value).abs() < 1e-5);
    /// }
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    #[must_use]
    pub fn by<N: OrbitMethod>(self, method: N) -> FrequencyResponse<N> {
        FrequencyResponse {
            request: self.request,
            method,
            accuracy: self.accuracy,
        }
    }

    hertzian_contract::setters! { self:
        /// Where the branch starts.
        from(value: f64) { self.request.from = Some(value) }

        /// Where it ends.
        to(value: f64) { self.request.to = Some(value) }

        /// Varies a parameter instead of the excitation frequency, which is then [`omega`](Self::omega).
        vary(parameter: impl Into<String>) { self.request.vary = Some(parameter.into()) }

        /// The excitation frequency, in radians per unit of time, when a parameter is varied.
        omega(omega: f64) { self.request.omega = Some(omega) }

        /// Period of the orbit in periods of the declaration, `2 pi divisor / omega`: those of the excitation, unless the declaration
        /// has fractions of `omega`. Default: that of the orbit [given](Self::near_orbit), or 1.
        period(period: usize) { self.request.period = Some(period) }

        /// Relative accuracy asked of peak-to-peak. Default: 1e-6. The balance chooses harmonics at every point such that its estimated
        /// error is below the tolerance, at most 150 for each period of the excitation: the distance from the branch. [`Point::error`] adds
        /// what lies along it, which is of the same size and grows where the branch is steep. By shooting the
        /// [tolerance of the flow](Shooting::tolerance) follows from it, and a closed form has none; what came of it is in [`Point::error`].
        tolerance(tolerance: f64) { self.request.tolerance = tolerance }

        /// What the [tolerance](Self::tolerance) and the error that is stated of every orbit, [`Point::error`], are of: peak-to-peak of an
        /// output or a coordinate by its name, as a part of itself. Default: of all coordinates, of the first one as a part of its own, of
        /// the others as a part of the largest. An output that is a small difference of large coordinates, a rate or a force takes more
        /// harmonics, or nodes, than the coordinates do; by shooting the tolerance of the flow stays what it is, and the error is stated.
        /// What does not move has its largest value in place of peak-to-peak, or the largest coordinate where it is one; a force that is
        /// zero and stays so has no error. By the contact equation nothing depends on coordinates where it is of an output, so that all
        /// but the first of them are known from a few phases until they are asked for ([`Observed::sampled`](crate::observe::Observed::sampled)).
        ///
        /// ```
        /// use hertzian::FrequencyResponse;
        ///
        /// hertzian::oscillator! {
        ///     Stopped(x) {
        ///         law stop(gap) { gap > 0 => 10*gap, else => 0 }
        ///         ddot(x) + 0.1*dot(x) + x + stop(x - 1) = 0.3*cos(omega*t);
        ///         output pushes = force(stop);
        ///     }
        /// }
        ///
        /// let request = FrequencyResponse::of(&Stopped {}).from(1.0).to(1.3).tolerance(1e-4);
        /// let (plain, fine) = (request.orbit(1.1)?, request.accuracy_of("pushes").orbit(1.1)?);
        /// println!("{} and {} harmonics", plain.orbit.harmonics(), fine.orbit.harmonics());
        /// assert!(fine.orbit.harmonics() > plain.orbit.harmonics());
        /// assert!(fine.error < Some(1e-4));
        /// # Ok::<(), hertzian::Error>(())
        /// ```
        accuracy_of(name: impl Into<String>) { self.accuracy = Some(name.into()) }

        /// Whether Floquet multipliers are computed. Default: yes; without them every verdict is
        /// [`Verdict::Undecided`](crate::orbit::stability::Verdict::Undecided), a branch takes a fraction of the time, and shooting finds
        /// no events but folds.
        stability(wanted: bool) { self.request.stability = wanted }

        /// Largest step along the branch, where one is as much as the size of the orbit, or the whole range. Default: 0.1; the
        /// part of the range in one step is about 0.15 of it at most. Steps are shorter where the branch bends.
        largest_step(step: f64) { self.request.largest_step = step }

        /// The first orbit is near this one, found by whatever method, and has its period.
        near_orbit(orbit: &Orbit) { self.request.near = Some(Guess::Orbit(orbit.clone())) }

        /// The first orbit is near this state `(q, dq/dt)` at phase zero: all positions, then all velocities. It takes the place of an orbit
        /// given by [`near_orbit`](Self::near_orbit), and the other way round.
        near_state(state: &[f64]) { self.request.near = Some(Guess::State(state.to_vec())) }

        /// What is computed ends when this token is cancelled, the search for a first orbit too.
        cancel(cancel: &Cancel) { self.request.cancel = cancel.clone() }

        /// Stop after this many points. Default: 20000.
        max_points(points: usize) { self.request.max_points = points }
    }

    /// The one orbit at a value of what is varied; the ends of a range are not needed.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or no orbit is found; by shooting
    /// [`OrbitError::Beyond`](crate::OrbitError::Beyond) if the branch that comes near turns back before the value.
    pub fn orbit(&self, value: f64) -> Result<Point, Error> {
        let found = self.accurate()?.orbit(&self.request.unkept(), value);
        self.request.unless_cancelled(value, found)
    }

    /// Computes the branch, from one end of the range to the other.
    ///
    /// # Errors
    /// Before any work, if a parameter or an option is not usable; and if no first orbit is found. A branch that ends
    /// early is not an error: it comes back with what was computed and with [`Branch::stopped`].
    pub fn run(&self) -> Result<Branch, Error> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), and calls `visit` at every point as it is found: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with(
        &self,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Branch, Error> {
        let found = self.accurate()?.run(&self.request, &mut visit);
        let from = self.request.from.unwrap_or(f64::NAN);
        self.request.unless_lost(from, found)
    }

    /// The branch that begins at an event of another one, as [`run`](Self::run) would follow it: of orbits that come back after twice the
    /// time at a doubling ([`doublings`](Self::doublings)), of orbits without the symmetry where an odd symmetry breaks, and the other one where two cross
    /// ([`bifurcations`](Self::bifurcations)). Where a symmetry breaks the two sides are mirror images; at a doubling both are one
    /// branch.
    ///
    /// ```
    /// use hertzian::{EventKind, FrequencyResponse, Side};
    ///
    /// hertzian::oscillator! {
    ///     OneSided(x) {
    ///         param load;
    ///         param drive;
    ///         law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
    ///         ddot(x) + contact(x) = drive*cos(omega*t) + load;
    ///     }
    /// }
    ///
    /// let model = OneSided { load: 1.0, drive: 1.0 };
    /// let request = FrequencyResponse::of(&model).vary("drive").omega(1.0).from(1.0).to(1.4);
    /// let request = request.harmonics(20).doublings(true).stability(false);
    /// let branch = request.run()?;
    /// // A1 of Wang et al. (2021), figure 8, to what 20 harmonics give.
    /// let doubling = branch.events(EventKind::PeriodDoubling).next().unwrap();
    /// assert!((doubling.point.value - 1.2825842).abs() < 1e-4);
    /// let longer = request.doublings(false).switch(doubling, Side::One)?;
    /// assert!(longer.points.iter().all(|point| point.orbit.period == 2));
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// If a parameter or an option is not usable, no branch begins there, or its first orbit was not found.
    pub fn switch(&self, event: &Event, side: Side) -> Result<Branch, Error> {
        self.switch_with(event, side, |_| ControlFlow::Continue(()))
    }

    /// As [`switch`](Self::switch), and calls `visit` at every point as it is found: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`switch`](Self::switch).
    pub fn switch_with(
        &self,
        event: &Event,
        side: Side,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Branch, Error> {
        let found = (self.accurate()?).switch(&self.request, event, side, &mut visit);
        self.request.unless_lost(event.point.value, found)
    }

    /// The branch through the orbit at a value inside the range, both ways as far as it goes; [`Branch::stopped`] is that of the
    /// part to the side where the range ends, [`Branch::begin`] that of the other. A branch that closes upon itself (an isola) is
    /// followed once around.
    ///
    /// # Errors
    /// As [`orbit`](Self::orbit).
    pub fn through(&self, value: f64) -> Result<Branch, Error> {
        self.through_with(value, |_| ControlFlow::Continue(()))
    }

    /// As [`through`](Self::through), and calls `visit` at every orbit as it is found, first on the one side of the value, then on
    /// the other: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`orbit`](Self::orbit).
    pub fn through_with(
        &self,
        value: f64,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Branch, Error> {
        if self.request.keep.is_some() {
            return Err(RequestError::Option {
                name: "through",
                value,
                must: "a branch that is followed both ways is not kept in a file on the way: write it when it is there",
            }
            .into());
        }
        let found = (self.accurate()?).through(&self.request, value, &mut visit);
        self.request.unless_cancelled(value, found)
    }

    /// An orbit with its Fourier series and everything that is read off; see [`Branch::complete`].
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or the motion cannot be computed.
    pub fn complete(&self, point: &Point) -> Result<Point, Error> {
        if point.orbit.has_series() {
            return Ok(point.clone());
        }
        let found = self.motions()?.completed(point);
        self.request.unless_cancelled(point.value, found)
    }

    /// What the motions of its orbits are computed by.
    ///
    /// # Errors
    /// If neither an output nor a coordinate has the name that was given.
    fn motions(&self) -> Result<Motions<'_>, Error> {
        let method: &dyn std::any::Any = &self.method;
        let has_equation = method.is::<ContactEquation>() || method.is::<Chosen>();
        let equation = ContactEquation {
            accuracy: self.accuracy()?,
        };
        Ok(Motions {
            request: &self.request,
            shooting: self.shooting()?,
            equation: has_equation.then_some(equation),
        })
    }

    /// The method, which knows what the accuracy is of.
    ///
    /// # Errors
    /// If neither an output nor a coordinate has the name that was given.
    fn accurate(&self) -> Result<M, Error> {
        Ok(self.method.clone().accurate_in(self.accuracy()?))
    }

    /// What the accuracy is of.
    ///
    /// # Errors
    /// If neither an output nor a coordinate has the name that was given.
    fn accuracy(&self) -> Result<Accuracy, Error> {
        self.accuracy
            .as_ref()
            .map_or(Ok(Accuracy::Coordinates), |name| {
                Accuracy::of(&Model::of(self.request.system.as_ref()), name)
            })
    }

    /// The options of shooting, where that is the method, or those by default, with what the accuracy is of.
    ///
    /// # Errors
    /// If neither an output nor a coordinate has the name that was given.
    pub(crate) fn shooting(&self) -> Result<Shooting, Error> {
        let method: &dyn std::any::Any = &self.method;
        let shooting: Shooting = method.downcast_ref().copied().unwrap_or_default();
        Ok(sealed::Follow::accurate_in(shooting, self.accuracy()?))
    }

    /// The curve of bifurcations through an event of a branch, as a second parameter (or `"omega"`) varies between two values: of
    /// folds, period doublings, points where an odd symmetry breaks, or grazing. What is varied here stays in the range from
    /// [`from`](Self::from) to [`to`](Self::to). It is followed by shooting, whatever method found the event.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or there is no such curve.
    pub fn track(
        &self,
        event: &Event,
        second: &str,
        range: [f64; 2],
    ) -> Result<BifurcationCurve, Error> {
        self.track_with(event, second, range, |_| ControlFlow::Continue(()))
    }

    /// As [`track`](Self::track), and calls `visit` at every bifurcation as it is found: to show progress, or to stop. What was found
    /// until then comes back.
    ///
    /// # Errors
    /// As [`track`](Self::track).
    pub fn track_with(
        &self,
        event: &Event,
        second: &str,
        range: [f64; 2],
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<BifurcationCurve, Error> {
        let found = by_shooting::track(
            &self.request,
            self.shooting()?,
            event,
            by_shooting::Second {
                name: second,
                range,
            },
            &mut visit,
        );
        self.request.unless_cancelled(event.point.value, found)
    }
}
