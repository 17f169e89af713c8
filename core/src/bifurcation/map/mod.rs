//! Which solutions exist over two parameters, as far as they were looked for.

mod cell;
mod summary;

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

pub use cell::{Cell, CellVerdict};

use super::cover::Settling;
use super::diagram::{Diagram, Reason};
use super::solutions::Solution;
use crate::branches::branch::{Branch, Model};
use crate::branches::progress::{Progress, Stage};
use crate::error::{Error, ErrorKind};
use crate::model::request::RequestError;
use crate::model::{validate, valued::with_values};
use crate::orbit::observe::Wanted;
use crate::response::{FrequencyResponse, OrbitMethod};
use crate::system::Variable;

/// The solutions over two parameters: see [`FrequencyResponse::map`].
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Map {
    /// The system.
    pub model: Model,
    /// Names of what varies along a row, and from row to row.
    pub names: [String; 2],
    /// Their values, as they were asked for: one for each cell of a row, and one for each row.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub values: [Vec<f64>; 2],
    /// Values of all parameters; of those that vary they mean nothing.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub parameters: Vec<f64>,
    /// The excitation frequency where it does not vary.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub omega: Option<f64>,
    /// Of what [`Cell::largest`] is the peak-to-peak: what [leads](Branch::leading) on the first branch of the first row that has one.
    pub signal: String,
    /// The cells, row by row.
    pub cells: Vec<Cell>,
    /// How many branches were followed for each row, with what begins on them; none for a row that was not looked at.
    pub branches: Vec<usize>,
    /// How many branches begin on these and were not followed, or were not followed from where motions settle, for each row.
    pub lost: Vec<usize>,
    /// Time of the computation.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub elapsed: Duration,
}

impl Map {
    /// The cells of every row.
    pub fn rows(&self) -> impl Iterator<Item = &[Cell]> {
        self.cells.chunks(self.values[0].len().max(1))
    }

    /// The values of both parameters at a cell, by its place in the list.
    pub fn at(&self, cell: usize) -> Option<[f64; 2]> {
        let columns = self.values[0].len().max(1);
        let [along, across] = &self.values;
        let other = across.get(cell / columns)?;
        along.get(cell % columns).map(|value| [*value, *other])
    }
}

impl<M: OrbitMethod> FrequencyResponse<M> {
    /// All periodic solutions over two parameters, as far as they are found: what [`solutions`](Self::solutions) finds at `values` of what is
    /// varied, for each of the values `others` of another parameter, or of `"omega"` where a parameter is varied. [`Map`] says of each pair
    /// how many orbits there are, how many of them are stable, how large these are, and what was searched. By
    /// [`Shooting`](crate::Shooting) a map with many bifurcations takes a small part of the time.
    ///
    /// ```
    /// use hertzian::{FrequencyResponse, Shooting};
    ///
    /// hertzian::oscillator! {
    ///     OneSided(x) {
    ///         param drive;
    ///         law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
    ///         ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    ///     }
    /// }
    ///
    /// let request = FrequencyResponse::of(&OneSided { drive: 0.1 }).by(Shooting::new()).from(0.65).to(1.05);
    /// let map = request.map(&[0.7, 0.9], "drive", &[0.02, 0.1])?;
    /// let stable: Vec<usize> = map.cells.iter().map(|cell| cell.stable).collect();
    /// // The contact is never lost at the smaller drive; at the larger one the response bends, with folds at 0.7151 and 0.9602.
    /// assert_eq!(stable, [1, 1, 1, 2]);
    /// println!("{map}");
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// Before any work, if a name, a value or an option is not usable; later what a row has no solutions for is in its [cells](Cell::reason).
    pub fn map(&self, values: &[f64], parameter: &str, others: &[f64]) -> Result<Map, Error> {
        self.map_with(values, parameter, others, |_| ControlFlow::Continue(()))
    }

    /// As [`map`](Self::map), and calls `visit` at every orbit, at every motion that has settled, and after every row: to show progress, or to
    /// stop. The rows until then come back; cells of the others have [`Reason::Interrupted`].
    ///
    /// # Errors
    /// As [`map`](Self::map).
    pub fn map_with(
        &self,
        values: &[f64],
        parameter: &str,
        others: &[f64],
        mut visit: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Map, Error> {
        let started = Instant::now();
        let second = self.second(values, parameter, others)?;
        let mut map = Map {
            model: Model::of(&self.request.system),
            names: [self.request.varied(), parameter.to_owned()],
            values: [values.to_vec(), others.to_vec()],
            parameters: self.request.parameters(),
            omega: self.request.omega.filter(|_| second != Variable::Omega),
            signal: String::new(),
            cells: Vec::new(),
            branches: Vec::new(),
            lost: Vec::new(),
            elapsed: Duration::default(),
        };
        let mut signal = None;
        for (row, &other) in others.iter().enumerate() {
            let request = self.with(second, other);
            let mut stopped = false;
            let found =
                request.searched("map", values, Settling::new().motions_alone(), |progress| {
                    let answer = visit(progress);
                    stopped |= answer.is_break();
                    answer
                });
            // A row that was searched in part says too little.
            if stopped || self.request.cancel.is_cancelled() {
                break;
            }
            match found {
                Ok(diagram) => {
                    let first = diagram.branches.first();
                    let leading = || first.map(|first| first.branch.leading());
                    signal = signal.or_else(leading);
                    map.take(&request, &diagram, signal.as_ref());
                }
                Err(error) if error.kind() == ErrorKind::Request && row == 0 => return Err(error),
                Err(error) => map.leave_out(&Reason::of(error)),
            }
            let progress = Progress {
                total: Some(others.len()),
                ..Progress::at(Stage::Map, row + 1, other)
            };
            if visit(progress).is_break() {
                break;
            }
        }
        while map.branches.len() < others.len() {
            map.leave_out(&Reason::Interrupted);
        }
        map.signal = signal.map_or_else(String::new, |signal| signal.name);
        map.elapsed = started.elapsed();
        Ok(map)
    }

    /// The second parameter, if all that is asked for can be.
    ///
    /// # Errors
    /// If something cannot.
    fn second(&self, values: &[f64], parameter: &str, others: &[f64]) -> Result<Variable, Error> {
        let facts = self.request.system.facts();
        let second = validate::variable(facts, Some(parameter))?;
        if second == self.request.variable()? {
            let name = parameter.to_owned();
            let must = "must be another one than what is varied";
            return Err(RequestError::Varied { name, must }.into());
        }
        for (name, list) in [("values", values), ("others", others)] {
            let count = list.len() as f64;
            validate::option(name, count, 1.0..=1e6, "there must be at least one")?;
            let again = |&place: &usize| list[..place].contains(&list[place]);
            if let Some(place) = (0..list.len()).find(again) {
                let (value, must) = (list[place], "must not be there twice");
                return Err(RequestError::Option { name, value, must }.into());
            }
        }
        if self.request.keep.is_some() {
            let (name, value) = ("map", others[0]);
            let must = "its branches are not kept in a file: leave out `keep`";
            return Err(RequestError::Option { name, value, must }.into());
        }
        for &other in others {
            validate::value(facts, second, other)?;
        }
        Ok(second)
    }

    /// The same request at another value of something.
    fn with(&self, second: Variable, value: f64) -> Self {
        let mut request = self.clone();
        match second {
            Variable::Omega => request.request.omega = Some(value),
            Variable::Parameter(index) => {
                let mut values = request.request.parameters();
                values[index] = value;
                request.request.system = with_values(&self.request.system, values);
            }
        }
        request
    }

    /// Peak-to-peak of a signal at an orbit of a branch, where it is known.
    fn size(&self, signal: &Wanted, branch: &Branch, solution: &Solution) -> Option<f64> {
        let point = &solution.point;
        if let Ok(Some(size)) = branch.measured(signal, point) {
            return Some(size);
        }
        let complete = self.complete(point).ok()?;
        branch.measured(signal, &complete).ok().flatten()
    }
}

impl Map {
    /// Takes in a row.
    fn take<M: OrbitMethod>(
        &mut self,
        request: &FrequencyResponse<M>,
        diagram: &Diagram,
        signal: Option<&Wanted>,
    ) {
        let values = self.values[0].iter();
        let size = |solution: &Solution| {
            let branch = &diagram.branches[solution.branch].branch;
            request.size(signal?, branch, solution)
        };
        let cells = values.map(|&value| {
            diagram
                .cell(value, size)
                .unwrap_or_else(|error| Cell::without(Reason::of(error)))
        });
        self.cells.extend(cells);
        self.branches.push(diagram.branches.len());
        self.lost.push(diagram.lost());
    }

    /// Takes in a row of which nothing is known.
    fn leave_out(&mut self, reason: &Reason) {
        let cells = self.values[0].iter();
        self.cells
            .extend(cells.map(|_| Cell::without(reason.clone())));
        self.branches.push(0);
        self.lost.push(0);
    }
}
