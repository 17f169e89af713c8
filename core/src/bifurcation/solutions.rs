//! Which solutions exist at each value of what is varied, as far as they were looked for.

use std::fmt;
use std::ops::ControlFlow;

use super::cover::Settling;
use super::diagram::{Diagram, Reason};
use super::request::Bifurcations;
use crate::attractors::basin::Fate;
use crate::branches::point::Point;
use crate::branches::progress::Progress;
use crate::branches::stability::Verdict;
use crate::error::Error;
use crate::model::validate;
use crate::numeric::decimal::Decimal;
use crate::response::{FrequencyResponse, OrbitMethod};

/// Bifurcations that may lie between a branch and one from which it was found.
pub(super) const DEPTH: usize = 2;
/// Motions at each value: from the nearest orbit, from rest, and from four states in boxes of each size.
const STARTS: usize = 18;

/// The solutions at several values, and what was searched: see [`FrequencyResponse::solutions`].
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Solutions {
    /// Name of what is varied.
    pub varied: String,
    /// The values, as they were asked for, with what exists there.
    pub at: Vec<SolutionsAt>,
    /// The branches that they lie on, and what was searched.
    pub diagram: Diagram,
}

/// The solutions at one value.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct SolutionsAt {
    /// The value.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub value: f64,
    /// The periodic orbits, branch by branch.
    pub orbits: Vec<Solution>,
    /// Motions from states that settled to none of any period looked for: chaos, long periods, several frequencies.
    pub restless: usize,
}

/// A periodic orbit, and where it was found.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Solution {
    /// Number of its branch in the diagram.
    pub branch: usize,
    /// The orbit.
    pub point: Point,
}

impl SolutionsAt {
    /// How many orbits have this verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        let alike = |solution: &&Solution| solution.point.stability.verdict == verdict;
        self.orbits.iter().filter(alike).count()
    }

    /// The largest peak-to-peak of the first coordinate among the stable ones.
    pub fn largest(&self) -> Option<f64> {
        let stable = self.orbits.iter().map(|solution| &solution.point);
        let stable = stable.filter(|point| point.stability.verdict == Verdict::Stable);
        let sizes = stable.map(Point::peak_to_peak);
        sizes.filter(|size| !size.is_nan()).max_by(f64::total_cmp)
    }
}

impl<M: OrbitMethod> FrequencyResponse<M> {
    /// All periodic solutions at these values of what is varied, as far as they are found: of the branch that [`run`](Self::run) gives; of
    /// that from the other end of the range; of what begins on them at bifurcations; of what motions settle to at the values themselves;
    /// and of what Newton's method leads to around them. An orbit of a branch that cannot be computed at a value is in
    /// [`Diagram::missed`]. [`Solutions`] says at each value how many there are, which are stable, and what was searched: no search finds all for
    /// sure.
    ///
    /// ```
    /// use hertzian::{FrequencyResponse, Verdict};
    ///
    /// hertzian::oscillator! {
    ///     Duffing(x) {
    ///         param drive;
    ///         ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let request = FrequencyResponse::of(&Duffing { drive: 0.2 }).from(0.9).to(1.6);
    /// let solutions = request.solutions(&[1.0, 1.3])?;
    /// assert_eq!(solutions.at[0].orbits.len(), 1);
    /// assert_eq!(solutions.at[1].orbits.len(), 3);
    /// assert_eq!(solutions.at[1].count(Verdict::Stable), 2);
    /// println!("{solutions}");
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`cover`](Self::cover), and if a value is outside of the range.
    pub fn solutions(&self, values: &[f64]) -> Result<Solutions, Error> {
        let mut diagram = self.searched("solutions", values, Settling::new(), |_| {
            ControlFlow::Continue(())
        })?;
        let mut at = Vec::new();
        for &value in values {
            let (solutions, lost) = diagram.found_at(value);
            at.push(solutions);
            let lost = lost.into_iter().map(|error| (value, Reason::of(error)));
            diagram.missed.extend(lost);
        }
        Ok(Solutions {
            varied: self.request.varied(),
            at,
            diagram,
        })
    }

    /// The branches of the range, with what begins on them and what motions settle to at these values, for a request of this name.
    ///
    /// # Errors
    /// As [`cover`](Self::cover), and if a value is outside of the range.
    pub(super) fn searched(
        &self,
        name: &'static str,
        values: &[f64],
        settling: Settling,
        visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Diagram, Error> {
        let [from, to] = self.request.range()?;
        for &value in values {
            let range = from.min(to)..=from.max(to);
            validate::option(name, value, range, "must be between from and to")?;
        }
        let request = Bifurcations::starting_with(self.clone()).by(self.method.clone());
        let request = request.depth(DEPTH).margin(0.0);
        let request = request
            .cover(settling.starts(STARTS).wide())
            .settled_at(values);
        request.run_with(visit)
    }
}

impl Diagram {
    /// What its branches have at a value; mirror images of branches that were followed are among them where they were.
    ///
    /// # Errors
    /// If an orbit between two points of a branch cannot be computed.
    pub fn solutions_at(&self, value: f64) -> Result<SolutionsAt, Error> {
        let (at, lost) = self.found_at(value);
        lost.into_iter().next().map_or(Ok(at), Err)
    }

    /// The same, as far as its orbits can be computed, and why others cannot.
    fn found_at(&self, value: f64) -> (SolutionsAt, Vec<Error>) {
        let (mut orbits, mut lost) = (Vec::new(), Vec::new());
        for (branch, found) in self.branches.iter().enumerate() {
            match found.branch.at(value) {
                Ok(points) => {
                    let points = points.into_iter();
                    orbits.extend(points.map(|point| Solution { branch, point }));
                }
                Err(error) => lost.push(error),
            }
        }
        let searched = self
            .searched
            .iter()
            .filter(|searched| searched.value == value);
        let fates = searched.flat_map(|searched| &searched.fates);
        let restless = fates.filter(|fate| matches!(fate, Fate::Chaotic | Fate::Long));
        let at = SolutionsAt {
            value,
            orbits,
            restless: restless.count(),
        };
        (at, lost)
    }

    /// How many branches were not followed that are none of those that were, or their mirror images.
    pub(super) fn lost(&self) -> usize {
        let not = self.omitted.iter().map(|omitted| &omitted.reason);
        let not = not.chain(self.missed.iter().map(|(_, reason)| reason));
        let known =
            |reason: &Reason| matches!(reason, Reason::BranchEnds { .. } | Reason::Mirrored);
        not.filter(|reason| !known(reason)).count()
    }
}

impl fmt::Display for Solutions {
    /// A line for each value, and what was searched.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let varied = &self.varied;
        for at in &self.at {
            write!(
                f,
                "{varied} = {}: {} orbits, {} stable, {} unstable",
                Decimal::plain(at.value),
                at.orbits.len(),
                at.count(Verdict::Stable),
                at.count(Verdict::Unstable)
            )?;
            match at.count(Verdict::Undecided) {
                0 => {}
                undecided => write!(f, ", {undecided} undecided")?,
            }
            match at.restless {
                0 => writeln!(f)?,
                restless => writeln!(f, "; {restless} motions settle to no orbit")?,
            }
        }
        let Diagram {
            branches, searched, ..
        } = &self.diagram;
        let motions: usize = searched.iter().map(|searched| searched.fates.len()).sum();
        writeln!(
            f,
            "searched: {} branches, with what begins on them to depth {DEPTH}; {motions} motions at {} values of {varied}, and orbits around them",
            branches.len(),
            searched.len()
        )?;
        match self.diagram.lost() {
            0 => Ok(()),
            lost => writeln!(f, "not followed: {lost} branches, see `diagram`"),
        }
    }
}
