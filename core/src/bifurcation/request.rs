//! A request for all branches that are connected with one, set up step by step.

use std::ops::ControlFlow;
use std::time::Instant;

use super::cover::Settling;
use super::diagram::{Diagram, Limits, Observer, Origin, Reason, Search};
use crate::attractors::basin::{Basin, Basins, Moving, Visit};
use crate::bifurcation::error::BifurcationError;
use crate::branches::branch::Branch;
use crate::branches::progress::Progress;
use crate::cancel::Cancel;
use crate::continuation::step_control;
use crate::error::{Error, ErrorKind};
use crate::model::request::RequestError;
use crate::model::validate;
use crate::response::{FrequencyResponse, OrbitMethod};
use crate::shooting::Shooting;
use crate::system::{System, Variable};
use crate::time;

/// Branches beyond this many are not followed.
const BRANCHES: usize = 64;
/// From so many orbits on, the first branch has half of them at first.
const MANY: usize = 2000;
/// Orbits of all branches together.
const POINTS: usize = 50_000;
/// Tolerance of the flow by which motions settle, where it is not in closed form.
const SETTLED: f64 = 1e-9;
/// By this part of the range further branches may go beyond its ends.
const MARGIN: f64 = 0.1;

/// All branches of periodic orbits that are connected with a first one by bifurcations, to a depth: set up step by step, then
/// [run](Bifurcations::run).
///
/// The first branch is followed along the range, by [`Shooting`] unless another method is [asked for](Bifurcations::by). At every period doubling, where an odd symmetry breaks, and where
/// branches cross, the branch that begins there is followed too, and so on. A bifurcation where a known branch ends is not followed
/// again. What begins at these and was not followed is in [`Diagram::omitted`], with the reason.
///
/// ```
/// use hertzian::EventKind;
/// use hertzian::bifurcation::Bifurcations;
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
/// let request = Bifurcations::of(&model).vary("drive").omega(1.0).from(1.0).to(1.6);
/// let diagram = request.depth(1).run()?;
/// let of_period_2 = &diagram.branches[1].branch;
/// // A4 and A6 of Wang et al. (2021), figure 8, where period 4 begins.
/// let doublings: Vec<f64> =
///     of_period_2.events(EventKind::PeriodDoubling).map(|event| event.point.value).collect();
/// assert!((doublings[0] - 1.531044135499983).abs() < 1e-11);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Bifurcations<M = Shooting> {
    response: FrequencyResponse<M>,
    depth: usize,
    longest: usize,
    branches: usize,
    points: usize,
    margin: f64,
    searched: Vec<(f64, Basin)>,
    settling: Option<Settling>,
    settled_at: Vec<f64>,
}

impl Bifurcations {
    /// Of this system, at the values that its parameters have now.
    pub fn of(system: &dyn System) -> Self {
        Self {
            points: POINTS,
            ..Self::starting_with(FrequencyResponse::of(system).by(Shooting::new()))
        }
    }
}

impl<M: OrbitMethod> Bifurcations<M> {
    /// The first branch is that of a request, with its range, method and options; what its method looks for on a branch, further
    /// branches begin at. [Its limit](FrequencyResponse::max_points) is that of all branches together.
    pub fn starting_with(response: FrequencyResponse<M>) -> Self {
        Self {
            depth: 3,
            longest: usize::MAX,
            branches: BRANCHES,
            points: response.request.max_points,
            margin: MARGIN,
            searched: Vec::new(),
            settling: None,
            settled_at: Vec::new(),
            response,
        }
    }

    /// Computes orbits by another method, with its options. The balance looks for all
    /// bifurcations here, whatever its options say.
    #[must_use]
    pub fn by<N: OrbitMethod>(self, method: N) -> Bifurcations<N> {
        Bifurcations {
            response: self.response.by(method.for_diagram()),
            depth: self.depth,
            longest: self.longest,
            branches: self.branches,
            points: self.points,
            margin: self.margin,
            searched: self.searched,
            settling: self.settling,
            settled_at: self.settled_at,
        }
    }

    hertzian_contract::setters! { self:
        /// Where the first branch starts.
        from(value: f64) { self.response = self.response.from(value) }

        /// Where it ends.
        to(value: f64) { self.response = self.response.to(value) }

        /// Varies a parameter instead of the excitation frequency, which is then [`omega`](Self::omega).
        vary(parameter: impl Into<String>) { self.response = self.response.vary(parameter) }

        /// The excitation frequency, in radians per unit of time, when a parameter is varied.
        omega(omega: f64) { self.response = self.response.omega(omega) }

        /// Period of the orbits of the first branch, in periods of the declaration; see [`FrequencyResponse::period`]. Default: 1.
        period(period: usize) { self.response = self.response.period(period) }

        /// So many bifurcations may lie between a branch and the first one. Default: 3.
        depth(depth: usize) { self.depth = depth }

        /// What begins at a doubling is followed up to this period, in periods of the declaration. Default: without end.
        max_period(period: usize) { self.longest = period }

        /// No more branches than this. Default: 64.
        max_branches(branches: usize) { self.branches = branches }

        /// No more orbits than this on all branches together. Default: 50000. Of 2000 or more the first branch has half at first, and goes on with
        /// what all others leave.
        max_points(points: usize) { self.points = points }

        /// Branches other than the first may go beyond the ends of the range by this part of it, as far as the equations
        /// make sense there. Default: 0.1.
        margin(part: f64) { self.margin = part }

        /// Also looks for branches that nothing leads to: at a value of what is varied, motions from a grid of initial states are
        /// followed until they have settled, and the branch of every periodic orbit that they settle to, of whatever period, is
        /// followed unless it is known. The basin is of the same system, with its grid, the longest period, the patience, the bound and the
        /// threads; frequency and parameters are those of this request at the value.
        search(value: f64, basin: Basin) { self.searched.push((value, basin)) }

        /// Covers the range by what exists there. Where the first branch turns back or ends before the other end, the branch from there is
        /// followed too. Then motions are followed until they have settled, for any number of coordinates: at the values that `settling`
        /// says, and at others where no stable orbit is known; and the branch of every orbit that they settle to is followed both ways. Around
        /// the values that were asked for orbits of all periods up to [the longest](Settling::longest) are solved for by Newton's method too, since few motions
        /// settle to an orbit with a small basin, and none to one that is stable between these values alone.
        /// [`Diagram::searched`] says what was searched and found, [`Diagram::uncovered`] where there is no orbit. What begins on the mirror
        /// image of a branch is followed like any other.
        ///
        /// Where the balance is asked for, orbits of several periods with many harmonics are followed by shooting, and so is what begins on their branches:
        /// [`Branch::method`](crate::Branch::method) says by what.
        ///
        /// What exists and is not met by any of these is not found: more [values](Settling::values) and
        /// [initial states](Settling::starts) find more.
        ///
        /// ```
        /// use hertzian::FrequencyResponse;
        /// use hertzian::bifurcation::{Bifurcations, Settling};
        ///
        /// hertzian::oscillator! {
        ///     Duffing(x) {
        ///         param drive;
        ///         ddot(x) + 0.05*dot(x) + x + x^3 = drive*cos(omega*t);
        ///     }
        /// }
        ///
        /// let model = Duffing { drive: 0.3 };
        /// let request = Bifurcations::of(&model).from(1.2).to(2.4).depth(1);
        /// let diagram = request.cover(Settling::new().values(3).starts(8)).run()?;
        /// assert!(diagram.uncovered.is_empty());
        /// assert!(diagram.searched.iter().all(|searched| searched.fates.len() == 8));
        /// # Ok::<(), hertzian::Error>(())
        /// ```
        cover(settling: Settling) { self.settling = Some(settling) }

        /// Where the range is [covered](Self::cover), motions are followed at these values too.
        settled_at(values: &[f64]) { self.settled_at = values.to_vec() }

        /// Accuracy of the output; see [`FrequencyResponse::tolerance`].
        tolerance(tolerance: f64) { self.response = self.response.tolerance(tolerance) }

        /// Largest step along a branch; see [`FrequencyResponse::largest_step`].
        largest_step(step: f64) { self.response = self.response.largest_step(step) }

        /// What is computed ends when this token is cancelled, the search for a first orbit too.
        cancel(cancel: &Cancel) { self.response = self.response.cancel(cancel) }
    }

    /// Follows the first branch and all that are connected with it.
    ///
    /// # Errors
    /// If a parameter or an option is not usable, or no first orbit is found.
    pub fn run(&self) -> Result<Diagram, Error> {
        self.run_with(|_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), and calls `visit` at every orbit as it is found: to show progress, or to stop. What was found until
    /// then comes back, and what was not followed has [`Reason::Interrupted`].
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with(
        &self,
        visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Diagram, Error> {
        self.run_watched(visit, |_| ControlFlow::Continue(()))
    }

    /// As [`run_with`](Self::run_with), and tells `watch` how far each [`search`](Self::search) is, which takes long before it has
    /// an orbit to show: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_watched(
        &self,
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
        mut watch: impl FnMut(Progress<'_>) -> ControlFlow<()> + Send,
    ) -> Result<Diagram, Error> {
        let started = Instant::now();
        let [from, to] = self.response.request.range()?;
        self.check()?;
        self.check_searched([from, to])?;
        let mut seen = Observer::new(&mut visit);
        let (branch, none) = match self.first(&mut seen) {
            Ok(branch) => (Some(branch), None),
            // Without a first branch the range may be covered by others.
            Err(error) if self.may_do_without(&error) => (None, Some(error)),
            Err(error) => return Err(error),
        };
        let [low, high] = self.wider(from, to)?;
        // The first branch alone is kept on the way.
        let mut others = self.response.clone().from(low).to(high);
        others.request.keep = None;
        let mut search = Search::new(
            others,
            [from, to],
            Limits {
                depth: self.depth,
                period: self.longest,
                // Motions settle to them as well.
                mirrored: self.settling.is_some(),
                branches: self.branches,
                points: self.points,
            },
            seen,
        );
        if let Some(branch) = branch {
            search.add(Origin::First, 0, branch);
            search.exhaust();
        }
        self.search_range(&mut search, &mut watch);
        let mut diagram = search.diagram;
        if let Some(error) = none {
            if diagram.branches.is_empty() {
                return Err(error);
            }
            diagram.missed.insert(0, (from, Reason::of(error)));
        }
        diagram.uncovered = diagram.without_orbits([from, to]);
        diagram.elapsed = started.elapsed();
        Ok(diagram)
    }

    /// The first branch. One that creeps leaves some orbits for all others.
    fn first(&self, seen: &mut Observer<'_>) -> Result<Branch, Error> {
        let points = if self.points >= MANY {
            self.points / 2
        } else {
            self.points.max(2)
        };
        let first = self.response.clone().max_points(points);
        first.run_with(|progress| seen.see(progress))
    }

    /// Whether the range may be covered without a first branch.
    fn may_do_without(&self, error: &Error) -> bool {
        self.settling.is_some() && matches!(error.kind(), ErrorKind::NoOrbit | ErrorKind::Limit)
    }

    /// What motions settle to, and what is left of the first branch.
    fn search_range(&self, search: &mut Search<'_, M>, visit: Visit<'_>) {
        let keep = &self.response.request.keep;
        // What motions settle to has half of what is left.
        if self.settling.is_some() || !self.searched.is_empty() {
            search.go_on(keep.clone(), search.points_left / 2);
        }
        if let Some(settling) = &self.settling {
            search.cover(settling, &self.settled_at);
        }
        for &(value, ref basin) in &self.searched {
            if let Err(reason) = self.add_attractors(search, value, basin, &mut *visit) {
                search.diagram.missed.push((value, reason));
            }
        }
        if let Some(settling) = self.settling.as_ref().filter(|settling| settling.solving) {
            search.scatter(settling, &self.settled_at);
        }
        search.go_on(keep.clone(), search.points_left);
    }

    /// Where motions are followed from a grid is in the range, and can be.
    fn check_searched(&self, [from, to]: [f64; 2]) -> Result<(), Error> {
        for &(value, ref basin) in &self.searched {
            if !(from.min(to)..=from.max(to)).contains(&value) {
                let must = "must be in the range of the first branch";
                let name = "search";
                return Err(RequestError::Option { name, value, must }.into());
            }
            basin
                .check()
                .and_then(|_| basin.is_of(&*self.response.request.system))
                .map_err(|reason| BifurcationError::Search { value, reason })?;
        }
        Ok(())
    }

    /// Takes in the branches of what motions settle to at a value, and what begins at them.
    ///
    /// # Errors
    /// Why it is not known what they settle to.
    fn add_attractors(
        &self,
        search: &mut Search<'_, M>,
        value: f64,
        basin: &Basin,
        visit: Visit<'_>,
    ) -> Result<(), Reason> {
        if search.observer.interrupted {
            return Err(Reason::Interrupted);
        }
        let found = self.basins(value, basin, visit).map_err(Reason::of)?;
        if !found.complete {
            search.observer.interrupted = true;
            return Err(Reason::Interrupted);
        }
        for attractor in found.attractors {
            let origin = Origin::Attractor { value };
            if let Err(reason) = search.add_orbit(origin, value, &attractor.points) {
                search.diagram.missed.push((value, reason));
            }
            search.exhaust();
        }
        Ok(())
    }

    /// What motions settle to at a value.
    fn basins(&self, value: f64, basin: &Basin, visit: Visit<'_>) -> Result<Basins, Error> {
        let request = &self.response.request;
        let variable = request.variable()?;
        let mut parameters = request.parameters();
        let omega = request.held_omega(variable)?.unwrap_or(value);
        if let Variable::Parameter(index) = variable {
            parameters[index] = value;
        }
        let basin = basin.clone().cancel(&request.cancel);
        let flows = (0..basin.threads_wanted())
            .map(|_| time::at(&request.system, &parameters, omega, SETTLED));
        let mut flows = flows.collect::<Result<Vec<_>, Error>>()?;
        for flow in &mut flows {
            flow.until(&request.cancel);
        }
        let moving = Moving {
            flows,
            parameters,
            omega,
        };
        let found = basin.compute(moving, None, visit);
        found.map_err(|reason| BifurcationError::Search { value, reason }.into())
    }

    fn check(&self) -> Result<(), Error> {
        validate::option("margin", self.margin, 0.0..=10.0, "must be from 0 to 10")?;
        let branches = self.branches as f64;
        if let Some(settling) = &self.settling {
            settling.check()?;
        }
        validate::option("max_branches", branches, 1.0..=1e6, "must be 1 or more")?;
        step_control::max_points(self.points).map(|_| ())
    }

    /// The range with what lies beyond its ends, as far as that is admissible.
    fn wider(&self, from: f64, to: f64) -> Result<[f64; 2], Error> {
        let request = &self.response.request;
        let (facts, system) = (request.system.facts(), request.system.as_ref());
        let variable = request.variable()?;
        let parameters = request.parameters();
        let makes_sense = |value: f64| {
            let (mut parameters, mut omega) = (parameters.clone(), request.omega.unwrap_or(value));
            match variable {
                Variable::Omega => omega = value,
                Variable::Parameter(index) => parameters[index] = value,
            }
            validate::omega(omega).is_ok()
                && validate::parameters(facts, &parameters).is_ok()
                && validate::levels(system, &parameters, omega).is_ok()
                && validate::mass(system, &parameters, omega).is_ok()
        };
        let margin = self.margin * (to - from);
        // As much of it as makes sense.
        let widened = |end: f64, by: f64| {
            let parts = [1.0, 0.5, 0.25, 0.125, 0.0625];
            let ends = parts.into_iter().map(|part| end + part * by);
            ends.into_iter()
                .find(|&end| makes_sense(end))
                .unwrap_or(end)
        };
        Ok([widened(from, -margin), widened(to, margin)])
    }
}
