//! A range covered by what exists there: the branch from its other end, and those of what motions settle to.
//!
//! A first branch may turn back or end early, and be unstable where motions go on to something else. Then the branch from the other end
//! is followed, and at values where there is no stable orbit yet, or where the request says, motions from several initial states are
//! followed until they have settled. Every orbit that they settle to lies on a branch that is known, or is where another one is begun.
//!
//! Initial states are the state of the nearest orbit that is known, as where a response jumps; rest at the origin; and then states from boxes
//! around the orbits that are known, see `starts.rs`. Last come the images, under the symmetries of the system, of the orbits that were found.
//! Where values were asked for, orbits that no motion was seen to settle to are looked for in the end, see `scatter.rs`.

use std::ops::ControlFlow;

use super::diagram::{Diagram, Origin, Reason, Search};
use super::settle::{Images, Motions, Patience};
use super::starts::{self, Reach, Starts};
use super::stretches::{Lacking, without};
use crate::attractors::basin::Fate;
use crate::branches::point::Point;
use crate::branches::progress::{Progress, Stage};
use crate::branches::recurrence::CyclicSymmetry;
use crate::error::Error;
use crate::model::layout::Layout;
use crate::model::validate;
use crate::response::{FrequencyResponse, OrbitMethod};
use crate::shooting::{Asked, Shooting};
use crate::system::Variable;
use crate::time::centred::{centre, centred};
use crate::time::stroboscope::Stroboscope;
use crate::time::{self, FlowError};

/// Values that are chosen where something is lacking, at most.
const CHOSEN: usize = 8;
/// Of stretches that lack orbits, and stable orbits, those longer than this part of the range are searched.
const SEARCHED: [f64; 2] = [1e-4, 1e-2];
/// Stretches without an orbit that are longer than this part of the range are said.
const SAID: f64 = 1e-6;
/// Tolerance of motions, which only lead to a guess.
const TOLERANCE: f64 = 1e-8;
/// Multiplications that one motion may take, and those of the force of a contact at one instant.
const MULTIPLICATIONS: usize = 400_000_000;
const PER_CONTACT: usize = 64;
/// Periods from rest that tell a size where no orbit is known.
const FIRST_PERIODS: usize = 50;

/// How a range is searched for what motions settle to; see [`Bifurcations::cover`](super::Bifurcations::cover).
///
/// By default 4 motions are followed at each value, for 500 periods, and values are only chosen where a search finds no stable orbit.
/// Around values that are asked for orbits are also solved for, stable or not, from as many states at each: what lies on no known branch begins one,
/// of [`Origin::Solved`]. That goes on two to eight times, until the next state leads to a new branch with a probability of less than 1/200.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settling {
    pub(super) values: usize,
    pub(super) starts: usize,
    pub(super) longest: usize,
    pub(super) patience: usize,
    /// Whether initial states are of all sizes.
    pub(super) wide: bool,
    /// Whether orbits are solved for.
    pub(super) solving: bool,
}

impl Default for Settling {
    fn default() -> Self {
        Self {
            values: 0,
            starts: 4,
            longest: 4,
            patience: 500,
            wide: false,
            solving: true,
        }
    }
}

impl Settling {
    /// The default.
    pub fn new() -> Self {
        Self::default()
    }

    hertzian_contract::setters! { self:
        /// So many values, in the middles of as many equal parts of the range, besides those where there is no stable orbit. Default: 0.
        values(count: usize) { self.values = count }

        /// Motions from so many initial states at each value. Default: 4.
        starts(count: usize) { self.starts = count }

        /// The longest period that is looked for, in periods of the declaration. Default: 4.
        longest(period: usize) { self.longest = period }

        /// Periods for which a motion is followed before it is counted as one that does not settle. Default: 500.
        patience(periods: usize) { self.patience = periods }
    }

    /// With initial states in boxes of four sizes, which reach orbits that are several times as large as those that are known.
    pub(super) fn wide(self) -> Self {
        Self { wide: true, ..self }
    }

    /// Without orbits that no motion settles to.
    pub(super) fn motions_alone(self) -> Self {
        Self {
            solving: false,
            ..self
        }
    }

    /// # Errors
    /// If an option cannot be used.
    pub(super) fn check(&self) -> Result<(), Error> {
        let Self {
            values,
            starts,
            longest,
            patience,
            wide: _,
            solving: _,
        } = *self;
        validate::option("values", values as f64, 0.0..=1e5, "must be 100000 or less")?;
        for (name, count, most) in [
            ("starts", starts, 1e6),
            ("longest", longest, 64.0),
            ("patience", patience, 1e9),
        ] {
            validate::option(
                name,
                count as f64,
                1.0..=most,
                "must be 1 or more, and not so many",
            )?;
        }
        Ok(())
    }
}

/// What was searched at one value, and what was found.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Searched {
    /// The value of what is varied.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub value: f64,
    /// The longest period that was looked for.
    pub longest: usize,
    /// Periods for which motions were followed at most.
    pub patience: usize,
    /// What became of the motion from each initial state, and from each image of an orbit under a symmetry of the system that no motion
    /// had settled to before; [`Fate::Periodic`] counts [`orbits`](Self::orbits).
    pub fates: Vec<Fate>,
    /// The orbits that motions settled to.
    pub orbits: Vec<SettledTo>,
}

/// An orbit that motions settled to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct SettledTo {
    /// Its shortest period, in periods of the declaration.
    pub period: usize,
    /// Number in the diagram of the branch that it lies on; `None` where that was not followed, see [`Diagram::missed`].
    pub branch: Option<usize>,
}

impl Searched {
    /// How many motions had a fate.
    pub fn count(&self, fate: Fate) -> usize {
        self.fates.iter().filter(|&&other| other == fate).count()
    }
}

impl Diagram {
    /// The parts of a range in which there is no orbit.
    pub(super) fn without_orbits(&self, range: [f64; 2]) -> Vec<[f64; 2]> {
        without(Lacking::Orbits, &self.branches, range, SAID)
    }
}

impl<M: OrbitMethod> Search<'_, M> {
    /// Follows what exists in the range besides what is known.
    pub(super) fn cover(&mut self, settling: &Settling, at: &[f64]) {
        if !self.diagram.without_orbits(self.asked).is_empty()
            && let Err(reason) = self.other_end()
        {
            self.diagram.missed.push((self.asked[1], reason));
        }
        self.exhaust();
        let [from, to] = self.asked;
        for index in 0..settling.values {
            let part = (index as f64 + 0.5) / settling.values as f64;
            self.settle((1.0 - part) * from + part * to, settling);
        }
        for &value in at {
            self.settle(value, settling);
        }
        for _ in 0..CHOSEN {
            let Some(value) = self.lacking() else {
                return;
            };
            self.settle(value, settling);
        }
    }

    /// Takes in the branch from the other end, unless it is known.
    ///
    /// # Errors
    /// Why it was not followed.
    fn other_end(&mut self) -> Result<(), Reason> {
        let [from, to] = self.asked;
        self.may_go_on()?;
        let mut request = self.response.clone().from(to).to(from);
        request.request.period = Some(request.request.period());
        request.request.near = None;
        let orbit = request.orbit(to).map_err(Reason::of)?;
        if self.branch_of(to, &[orbit.orbit.state()]).is_some() {
            return Ok(());
        }
        let request = request
            .near_orbit(&orbit.orbit)
            .max_points(self.points_left / 2);
        let branch = request.run_with(|progress| self.observer.see(progress));
        self.add(Origin::OtherEnd, 0, branch.map_err(Reason::of)?);
        Ok(())
    }

    /// The middle of the longest stretch that lacks something and where motions were not followed yet.
    fn lacking(&self) -> Option<f64> {
        let stretches = |lacking, longer| {
            let stretches = without(lacking, &self.diagram.branches, self.asked, longer);
            let new = stretches.into_iter().filter(|[low, high]| {
                let mut searched = self.diagram.searched.iter();
                !searched.any(|searched| (*low..=*high).contains(&searched.value))
            });
            new.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))
        };
        let [of_orbits, of_stable] = SEARCHED;
        let found = stretches(Lacking::Orbits, of_orbits)
            .or_else(|| stretches(Lacking::StableOrbits, of_stable));
        found.map(|[low, high]| 0.5 * (low + high))
    }

    /// Follows motions at a value, and takes in the branches of what they settle to.
    fn settle(&mut self, value: f64, settling: &Settling) {
        if self.observer.interrupted || self.drifts(value) {
            return;
        }
        let Settled {
            fates,
            orbits: found,
        } = match self.settled(value, settling) {
            Ok(settled) => settled,
            Err(error) => {
                self.diagram.missed.push((value, Reason::of(error)));
                return;
            }
        };
        let mut orbits = Vec::new();
        for orbit in &found {
            let branch = match self.add_orbit(Origin::Attractor { value }, value, orbit) {
                Ok(number) => Some(number),
                Err(reason) => {
                    self.diagram.missed.push((value, reason));
                    None
                }
            };
            let period = orbit.len();
            orbits.push(SettledTo { period, branch });
            self.exhaust();
        }
        self.diagram.searched.push(Searched {
            value,
            longest: settling.longest,
            patience: settling.patience,
            fates,
            orbits,
        });
    }

    /// What becomes of motions at a value, and the states of every orbit that they settle to.
    ///
    /// # Errors
    /// If no motion can be computed there.
    fn settled(&mut self, value: f64, settling: &Settling) -> Result<Settled, Error> {
        let (starts, map) = self.starts(value, settling.wide)?;
        let forces = self.most_forces();
        let patience = Patience {
            longest: settling.longest,
            periods: settling.patience,
            forces,
        };
        let first = self.first_states(value);
        let others = self.drawn..;
        let others = others.map(|index| starts.draw(index).state);
        let states: Vec<_> = first.chain(others).take(settling.starts).collect();
        self.drawn += settling.starts;
        let mut motions = Motions::new(map, starts.units, patience);
        let symmetries = self.symmetries(value);
        let total = states.len();
        let mut starts = states.into_iter();
        let mut images = Images::default();
        let mut fates = Vec::new();
        while let Some(start) = starts
            .next()
            .or_else(|| motions.image(&symmetries, &mut images))
        {
            fates.push(motions.follow(&start));
            let progress = Progress {
                total: Some(total.max(fates.len())),
                ..Progress::at(Stage::Settling, fates.len(), value)
            };
            let cancelled = self.response.request.cancel.is_cancelled();
            if cancelled || self.observer.see(progress) == ControlFlow::Break(()) {
                self.observer.interrupted = true;
                break;
            }
        }
        fates.resize(fates.len().max(total), Fate::Unknown);
        // Numbered anew without those that no motion has settled to.
        let mut numbers = vec![0; motions.orbits.len()];
        let mut orbits = Vec::new();
        for (number, orbit) in motions.orbits.into_iter().enumerate() {
            numbers[number] = orbits.len();
            if orbit.motions > 0 {
                orbits.push(orbit.states);
            }
        }
        for fate in &mut fates {
            if let Fate::Periodic(number) = fate {
                *number = numbers[*number];
            }
        }
        Ok(Settled { fates, orbits })
    }

    /// Evaluations of forces that one motion may take.
    pub(super) fn most_forces(&self) -> usize {
        let facts = self.response.request.system.facts();
        let order = 2 * facts.coordinates.len();
        MULTIPLICATIONS / (PER_CONTACT * facts.contacts.len() + order * order)
    }

    /// The symmetries that take motions into motions at a value.
    fn symmetries(&self, value: f64) -> Vec<CyclicSymmetry> {
        let asked = Asked::of(&self.response.request, &Shooting::new()).problem(value, value);
        let Ok(problem) = asked else {
            return Vec::new();
        };
        let at_once = problem.at_once.into_iter();
        let at_once = at_once.map(|image| CyclicSymmetry { parts: 1, image });
        let mut symmetries: Vec<CyclicSymmetry> = at_once.chain(problem.symmetries).collect();
        // A shift in time alone gives the same branch.
        symmetries.retain(|symmetry| !symmetry.image.is_identity());
        symmetries
    }

    /// Whether an orbit that is shifted along what does not hold it is another one that a motion may settle to.
    pub(super) fn drifts(&self, value: f64) -> bool {
        let system = &self.response.request.system;
        let centred = || {
            let (parameters, omega) = self.place(value).ok()?;
            centre(
                system.as_ref(),
                &Layout::of(system.as_ref()),
                &parameters,
                omega,
            )
        };
        let free = |point: &Point| point.stability.rigid > 0;
        let mut branches = self.diagram.branches.iter();
        branches.any(|branch| branch.branch.points.iter().any(free)) && centred().is_none()
    }

    /// The parameters and the frequency at a value.
    ///
    /// # Errors
    /// If what is varied is not usable.
    fn place(&self, value: f64) -> Result<(Vec<f64>, f64), Error> {
        let request = &self.response.request;
        let variable = request.variable()?;
        let mut parameters = request.parameters();
        let omega = request.held_omega(variable)?.unwrap_or(value);
        if let Variable::Parameter(index) = variable {
            parameters[index] = value;
        }
        Ok((parameters, omega))
    }

    /// The stroboscopic map at a value.
    ///
    /// # Errors
    /// If there is none.
    fn map(&self, value: f64) -> Result<Stroboscope, Error> {
        let request = &self.response.request;
        let (parameters, omega) = self.place(value)?;
        let mut flow = time::at(&request.system, &parameters, omega, TOLERANCE)?;
        flow.until(&request.cancel);
        let flow = centred(flow, &request.system, &parameters, omega);
        Ok(Stroboscope::new(flow))
    }

    /// Where orbits are looked for at a value, and the map there.
    ///
    /// # Errors
    /// If no motion can be computed there.
    pub(super) fn starts(&self, value: f64, wide: bool) -> Result<(Starts, Stroboscope), Error> {
        let request = &self.response.request;
        let mut map = self.map(value)?;
        let coordinates = request.system.facts().coordinates.len();
        let omega = request.held_omega(request.variable()?)?.unwrap_or(value);
        let branches = &self.diagram.branches;
        let reach = match starts::reach(branches, coordinates) {
            Some(reach) => reach,
            None => {
                from_rest(&mut map, omega).map_err(|reason| time::MotionError { value, reason })?
            }
        };
        Ok((Starts::at(value, omega, &self.diagram, &reach, wide), map))
    }

    /// The state of the nearest orbit that is known, and rest.
    pub(super) fn first_states(&self, value: f64) -> impl Iterator<Item = Vec<f64>> {
        let near = |point: &&Point| (point.value - value).abs();
        let branches = self.diagram.branches.iter();
        let points = branches.flat_map(|branch| &branch.branch.points);
        let nearest = points.min_by(|a, b| near(a).total_cmp(&near(b)));
        let coordinates = self.response.request.system.facts().coordinates.len();
        let nearest = nearest.map(|point| point.orbit.state());
        nearest.into_iter().chain([vec![0.0; 2 * coordinates]])
    }
}

/// How far a motion from rest goes.
///
/// # Errors
/// If it cannot be computed.
fn from_rest(map: &mut Stroboscope, omega: f64) -> Result<Reach, FlowError> {
    let coordinates = map.order() / 2;
    let mut reach = Reach::new(coordinates);
    let mut state = vec![0.0; 2 * coordinates];
    for _ in 0..FIRST_PERIODS {
        map.map(&mut state)?;
        for i in 0..coordinates {
            let speed = state[coordinates + i] / omega;
            let far = state[i].hypot(speed);
            reach.include(i, -far, far);
        }
    }
    Ok(reach)
}

/// States of an orbit at the beginnings of its periods.
type States = Vec<Vec<f64>>;

/// What became of motions, and the orbits that they settled to.
struct Settled {
    fates: Vec<Fate>,
    orbits: Vec<States>,
}

impl<M: OrbitMethod> FrequencyResponse<M> {
    /// All that exists in the range, as far as it is found at little cost: the branch that [`run`](Self::run) gives; where that turns
    /// back or ends before the other end of the range, the branch from there; and where there is no stable orbit yet, the branch of
    /// every orbit that motions settle to. [`Diagram::searched`] says what was searched, and [`Diagram::uncovered`] where there is
    /// none. [`Bifurcations::cover`](super::Bifurcations::cover) searches more.
    ///
    /// # Errors
    /// As [`run`](Self::run), where nothing else is found either.
    pub fn cover(&self) -> Result<Diagram, Error> {
        self.cover_with(|_| ControlFlow::Continue(()))
    }

    /// As [`cover`](Self::cover), and calls `visit` at every point and every motion that has settled: to show progress, or to stop.
    ///
    /// # Errors
    /// As [`cover`](Self::cover).
    pub fn cover_with(
        &self,
        visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Diagram, Error> {
        let request = super::Bifurcations::starting_with(self.clone());
        let request = request.depth(0).margin(0.0).cover(Settling::new());
        request.run_with(visit)
    }
}
