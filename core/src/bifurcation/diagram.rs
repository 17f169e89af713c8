//! All branches that are connected by bifurcations, one after the other.
//!
//! Breadth first: a queue holds the bifurcations that were found and not yet looked at. A branch of the longer period that has
//! ended at a bifurcation is the one that begins there, so it is not followed from the other end.

use std::collections::VecDeque;
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

use super::cover::Searched;
use super::matching;
use crate::branches::branch::Branch;
use crate::branches::checkpoint::Keep;
use crate::branches::point::Event;
use crate::branches::progress::{Progress, See};
use crate::continuation::follow::Stop;
use crate::error::{Error, ErrorKind, chain};
use crate::event::{EventKind, Side};
use crate::response::{FrequencyResponse, OrbitMethod};

/// Branches of periodic orbits and how they are connected.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Diagram {
    /// The branches, in the order in which they were found.
    pub branches: Vec<DiagramBranch>,
    /// Bifurcations whose further branch was not followed, and why.
    pub omitted: Vec<Omitted>,
    /// Orbits that were found and whose branch was not followed, and searches that failed: the value and why.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub missed: Vec<(f64, Reason)>,
    /// Where motions were followed until they settled, and what they settled to.
    pub searched: Vec<Searched>,
    /// Parts of the range that was asked for in which no branch has an orbit, in increasing order.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub uncovered: Vec<[f64; 2]>,
    /// Time of the computation.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub elapsed: Duration,
}

/// One branch of a diagram.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct DiagramBranch {
    /// Where it comes from.
    pub origin: Origin,
    /// Number of bifurcations between it and the first branch.
    pub depth: usize,
    /// Its orbits and events.
    pub branch: Branch,
    /// It is the mirror image of another branch.
    pub mirrored: bool,
}

/// Where a branch comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Origin {
    /// It is the branch that was asked for.
    First,
    /// It begins at an event of another branch.
    Event {
        /// Number of that branch in the diagram.
        branch: usize,
        /// Number of the event on it.
        event: usize,
        /// Side of the event.
        side: Side,
    },
    /// It begins at the other end of the range, where the first one ended before.
    OtherEnd,
    /// Nothing that was followed leads to it: motions were found to settle to one of its orbits.
    Attractor {
        /// Where, in what is varied.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        value: f64,
    },
    /// Nothing that was followed leads to it, and no motion was seen to settle to it: Newton's method led to one of its orbits.
    Solved {
        /// Where, in what is varied.
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        value: f64,
    },
}

/// A bifurcation of which a further branch was not followed; of two sides the other may have been.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Omitted {
    /// Number of the branch in the diagram.
    pub branch: usize,
    /// Number of the event on it.
    pub event: usize,
    /// Why.
    pub reason: Reason,
}

impl fmt::Display for Omitted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            branch,
            event,
            reason,
        } = self;
        write!(f, "event {event} of branch {branch}: {reason}")
    }
}

/// Why a branch was not followed.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Reason {
    /// It is deeper than asked for.
    Depth,
    /// Its orbits are of a longer period than was asked for.
    Period,
    /// There are as many branches or orbits as were allowed.
    Budget,
    /// It is the mirror image of a branch that is followed.
    Mirrored,
    /// A branch that was followed ends there.
    BranchEnds {
        /// Its number in the diagram.
        branch: usize,
    },
    /// The caller asked to stop before.
    Interrupted,
    /// Its first orbit was not found.
    Failed(Error),
}

impl Reason {
    /// Why no branch was followed, as the search for its first orbit says.
    pub(super) fn of(error: Error) -> Self {
        match error.kind() {
            ErrorKind::Cancelled => Self::Interrupted,
            _ => Self::Failed(error),
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Depth => f.write_str("deeper than asked for"),
            Self::Period => f.write_str("of a longer period than was asked for"),
            Self::Budget => f.write_str("no more branches or orbits are allowed"),
            Self::Mirrored => f.write_str("the mirror image of a branch that is followed"),
            Self::BranchEnds { branch } => write!(f, "branch {branch} ends there"),
            Self::Interrupted => f.write_str("interrupted"),
            Self::Failed(error) => chain(error).fmt(f),
        }
    }
}

impl DiagramBranch {
    /// Period of its orbits in periods of the declaration.
    pub fn period(&self) -> usize {
        self.branch.period()
    }
}

/// Branches by themselves, as they are read from a file: nothing is known of what connects them.
impl From<Vec<Branch>> for Diagram {
    fn from(branches: Vec<Branch>) -> Self {
        let alone = |branch: Branch| DiagramBranch {
            origin: Origin::First,
            depth: 0,
            branch,
            mirrored: false,
        };
        Self {
            branches: branches.into_iter().map(alone).collect(),
            ..Self::default()
        }
    }
}

impl Diagram {
    /// Where a branch begins on another one.
    pub(super) fn begin(&self, branch: &DiagramBranch) -> Option<&Event> {
        match branch.origin {
            Origin::Event { branch, event, .. } => {
                self.branches.get(branch)?.branch.events.get(event)
            }
            _ => None,
        }
    }

    /// All events of one kind, each with the number of its branch. A bifurcation is an event of the branch that goes on there
    /// with the same period, and of kind [`EventKind::BranchPoint`] on one that ends there.
    pub fn events(&self, kind: EventKind) -> impl Iterator<Item = (usize, &Event)> {
        let branches = self.branches.iter().enumerate();
        branches.flat_map(move |(number, branch)| {
            branch.branch.events(kind).map(move |event| (number, event))
        })
    }
}

/// Who looks at every orbit, and may ask to stop.
pub(super) struct Observer<'v> {
    visit: See<'v>,
    pub(super) interrupted: bool,
}

impl<'v> Observer<'v> {
    pub(super) fn new(visit: See<'v>) -> Self {
        Self {
            visit,
            interrupted: false,
        }
    }

    /// Shows an orbit.
    pub(super) fn see(&mut self, progress: Progress<'_>) -> ControlFlow<()> {
        let answer = (self.visit)(progress);
        self.interrupted |= answer.is_break();
        answer
    }
}

/// How far a search goes: bifurcations between a branch and the first one, the longest period, and numbers of branches and of orbits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub(super) depth: usize,
    pub(super) period: usize,
    /// Whether what begins on the mirror image of a branch is followed too.
    pub(super) mirrored: bool,
    pub(super) branches: usize,
    pub(super) points: usize,
}

/// The search, and what it has found.
pub(super) struct Search<'v, M> {
    pub(super) observer: Observer<'v>,
    pub(super) response: FrequencyResponse<M>,
    /// The range of the first branch.
    pub(super) asked: [f64; 2],
    /// Length of the range.
    pub(super) range: f64,
    depth: usize,
    longest: usize,
    mirrored: bool,
    most_branches: usize,
    pub(super) points_left: usize,
    /// States that were taken from boxes so far, see `starts.rs`.
    pub(super) drawn: usize,
    /// Branch and event.
    queue: VecDeque<(usize, usize)>,
    pub(super) diagram: Diagram,
}

impl<'v, M: OrbitMethod> Search<'v, M> {
    pub(super) fn new(
        response: FrequencyResponse<M>,
        asked: [f64; 2],
        limits: Limits,
        observer: Observer<'v>,
    ) -> Self {
        Self {
            asked,
            range: response.request.length(),
            response,
            depth: limits.depth,
            longest: limits.period,
            mirrored: limits.mirrored,
            most_branches: limits.branches,
            points_left: limits.points,
            drawn: 0,
            observer,
            queue: VecDeque::new(),
            diagram: Diagram::default(),
        }
    }

    /// Takes in a branch, and what begins at it.
    pub(super) fn add(&mut self, origin: Origin, depth: usize, branch: Branch) {
        self.points_left = self.points_left.saturating_sub(branch.points.len());
        let number = self.diagram.branches.len();
        self.enqueue(number, &branch, 0);
        let mirrored = self.is_mirrored(origin);
        self.diagram.branches.push(DiagramBranch {
            origin,
            depth,
            branch,
            mirrored,
        });
    }

    /// What begins at the events of a branch, from one of them on, is to be followed.
    fn enqueue(&mut self, number: usize, branch: &Branch, first: usize) {
        let begins =
            (first..branch.events.len()).filter(|&index| match branch.events[index].kind {
                EventKind::PeriodDoubling | EventKind::SymmetryBreaking => true,
                EventKind::BranchPoint => !is_joint(branch, index, self.range),
                _ => false,
            });
        self.queue.extend(begins.map(|index| (number, index)));
    }

    /// Goes on with the first branch where it met its limit of orbits, with so many of those that are left, and with what begins at it.
    pub(super) fn go_on(&mut self, keep: Option<Arc<dyn Keep>>, more: usize) {
        if self.observer.interrupted || more == 0 || !self.is_cut() {
            return;
        }
        let first = &self.diagram.branches[0].branch;
        let [points, events] = [first.points.len(), first.events.len()];
        let resume = first.resume().kept_by(keep);
        let resume = resume.cancel(&self.response.request.cancel);
        let resume = resume.max_points(points + more);
        let longer = match resume.run_with(|progress| self.observer.see(progress)) {
            Ok(longer) => longer,
            Err(error) => {
                let last = first.points.last().map_or(f64::NAN, |point| point.value);
                self.diagram.missed.push((last, Reason::of(error)));
                return;
            }
        };
        let more = longer.points.len().saturating_sub(points);
        self.points_left = self.points_left.saturating_sub(more);
        self.enqueue(0, &longer, events);
        self.diagram.branches[0].branch = longer;
        self.exhaust();
    }

    /// Whether the first branch met its limit of orbits, and none was met that goes on from there.
    fn is_cut(&self) -> bool {
        let [first, others @ ..] = &self.diagram.branches[..] else {
            return false;
        };
        let limited = matches!(first.branch.stopped, Stop::PointLimit { .. });
        let last = first.branch.points.last();
        let Some(last) = last.filter(|_| limited && first.origin == Origin::First) else {
            return false;
        };
        let states = matching::at_periods(&last.orbit);
        !others.iter().any(|other| {
            let begin = self.diagram.begin(other);
            matching::contains(&self.response, &other.branch, begin, last.value, &states)
        })
    }

    /// Whether a branch is the mirror image of another one: the other side of where a symmetry breaks, and what begins on it.
    fn is_mirrored(&self, origin: Origin) -> bool {
        let Origin::Event {
            branch,
            event,
            side,
        } = origin
        else {
            return false;
        };
        let parent = &self.diagram.branches[branch];
        let breaks = parent.branch.events[event].kind == EventKind::SymmetryBreaking;
        parent.mirrored || (breaks && side == Side::Other)
    }

    /// Follows what is in the queue until nothing is.
    pub(super) fn exhaust(&mut self) {
        while let Some((branch, event)) = self.queue.pop_front() {
            if let Err(reason) = self.follow(branch, event) {
                self.diagram.omitted.push(Omitted {
                    branch,
                    event,
                    reason,
                });
            }
        }
    }

    /// Whether a branch more may be followed, of two parts.
    ///
    /// # Errors
    /// Why not.
    pub(super) fn may_go_on(&self) -> Result<(), Reason> {
        if self.observer.interrupted {
            return Err(Reason::Interrupted);
        }
        if self.diagram.branches.len() >= self.most_branches || self.points_left < 4 {
            return Err(Reason::Budget);
        }
        Ok(())
    }

    /// The branch that the orbit with these states at the beginnings of its periods lies on.
    pub(super) fn branch_of(&self, value: f64, states: &[Vec<f64>]) -> Option<usize> {
        let contains = |branch: &DiagramBranch| {
            let begin = self.diagram.begin(branch);
            matching::contains(&self.response, &branch.branch, begin, value, states)
        };
        self.diagram.branches.iter().position(contains)
    }

    fn follow(&mut self, number: usize, index: usize) -> Result<(), Reason> {
        let branch = &self.diagram.branches[number];
        let (depth, mirrored) = (branch.depth + 1, branch.mirrored);
        let event = branch.branch.events[index].clone();
        let sides = match event.kind {
            EventKind::SymmetryBreaking | EventKind::BranchPoint => &[Side::One, Side::Other][..],
            _ => &[Side::One],
        };
        if let Some(branch) = self.crossing_at(number, &event) {
            return Err(Reason::BranchEnds { branch });
        }
        let known = self.ending_at(&event);
        if known.len() >= sides.len() {
            return Err(Reason::BranchEnds { branch: known[0] });
        }
        if depth > self.depth {
            return Err(Reason::Depth);
        }
        let found_by = branch.branch.method();
        let doubles = event.kind == EventKind::PeriodDoubling;
        if event.point.orbit.period * if doubles { 2 } else { 1 } > self.longest {
            return Err(Reason::Period);
        }
        if mirrored && !self.mirrored {
            return Err(Reason::Mirrored);
        }
        let mut failed = None;
        for &side in sides {
            if self.observer.interrupted {
                return Err(Reason::Interrupted);
            }
            if self.diagram.branches.len() >= self.most_branches || self.points_left < 2 {
                return Err(Reason::Budget);
            }
            let branch = match self.switched(&event, side, found_by) {
                Ok(branch) => branch,
                Err(error) => {
                    // The other side may begin all the same.
                    failed = Some(error);
                    continue;
                }
            };
            let origin = Origin::Event {
                branch: number,
                event: index,
                side,
            };
            let closed = branch.stopped == Stop::Closed;
            self.add(origin, depth, branch);
            if closed {
                // It came back on the other side.
                break;
            }
        }
        failed.map_or(Ok(()), |error| Err(Reason::of(error)))
    }

    /// Another branch that passes the same crossing.
    fn crossing_at(&self, number: usize, event: &Event) -> Option<usize> {
        let same = |other: &&Event| matching::is_same_place(other, event, self.range);
        let mut branches = self.diagram.branches.iter().enumerate();
        let crosses = |branch: &DiagramBranch| {
            let mut crossings = branch.branch.events(EventKind::BranchPoint);
            branch.period() == event.point.orbit.period && crossings.any(|other| same(&other))
        };
        let found = branches.find(|(index, branch)| *index != number && crosses(branch));
        let crossed = event.kind == EventKind::BranchPoint;
        found.filter(|_| crossed).map(|(index, _)| index)
    }

    /// The branches that end at an event of another one.
    fn ending_at(&self, event: &Event) -> Vec<usize> {
        let branches = self.diagram.branches.iter().enumerate();
        let is_joint = |end: Option<Stop>, joint: Option<&Event>| match end {
            Some(Stop::Joined { period, value, .. }) => {
                period == event.point.orbit.period
                    && joint
                        .filter(|joint| matching::is_same_value(value, joint, self.range))
                        .map_or_else(
                            || matching::is_same_value(value, event, self.range),
                            |joint| matching::is_same_place(joint, event, self.range),
                        )
            }
            _ => false,
        };
        let ends = branches.filter(|(_, branch)| {
            let joints = || branch.branch.events(EventKind::BranchPoint);
            is_joint(Some(branch.branch.stopped), joints().next_back())
                || is_joint(branch.branch.begin, joints().next())
        });
        ends.map(|(number, _)| number).collect()
    }
}

/// Whether a branch, in a range of some length, ends at one of its events on a branch of more regular orbits.
fn is_joint(branch: &Branch, index: usize, range: f64) -> bool {
    let event = &branch.events[index];
    let joined = |end: Option<Stop>| match end {
        Some(Stop::Joined { value, .. }) => matching::is_same_value(value, event, range),
        _ => false,
    };
    let points = || {
        let events = branch.events.iter().enumerate();
        let points = events.filter(|(_, event)| event.kind == EventKind::BranchPoint);
        points.map(|(index, _)| index)
    };
    let (first, last) = (points().next(), points().next_back());
    (joined(branch.begin) && first == Some(index))
        || (joined(Some(branch.stopped)) && last == Some(index))
}
