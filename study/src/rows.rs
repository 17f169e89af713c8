//! What is said of a variant, as rows of the table.

use hertzian::bifurcation::{Cell, CellVerdict};
use hertzian::error::chain;
use hertzian::observe::Wanted;
use hertzian::{Branch, Error, Event, Point};

use crate::evaluate::Of;
use crate::plan::What;
use crate::table::{About, Value, kind, moved};

impl Of<'_> {
    /// What there is to say of an event.
    pub(crate) fn event(&self, branch: &Branch, event: &Event) -> Result<Orbit, Error> {
        let orbit = self.orbit(branch, &event.point, kind(event))?;
        // At the very value where the branch turns, an orbit is not known at all: the error there is that of the value.
        let size_error = if event.kind.turns() {
            Value::Missing
        } else {
            orbit.size_error
        };
        Ok(Orbit {
            error: Value::Number(event.error),
            size_error,
            moves: self.moves(branch, event),
            ..orbit
        })
    }

    /// How the place of an event moves with everything else, where that is asked for: the derivative by each and its error, then why there are
    /// none.
    fn moves(&self, branch: &Branch, event: &Event) -> Vec<Value> {
        let by = &self.study.by;
        if by.is_empty() {
            return Vec::new();
        }
        match branch.event_sensitivities_of(event, &[]) {
            Ok(found) => {
                let both = |name: &String| {
                    let found = found.of_place(name);
                    [found.map(|of| of.value), found.map(|of| of.error)].map(Value::from)
                };
                by.iter().flat_map(both).collect()
            }
            Err(why) => {
                let mut moves = vec![Value::Missing; 2 * by.len()];
                moves.push(Value::text(chain(&why).to_string()));
                moves
            }
        }
    }

    pub(crate) fn orbit(
        &self,
        branch: &Branch,
        point: &Point,
        kind: String,
    ) -> Result<Orbit, Error> {
        let measured = |wanted: &Wanted| branch.measured(wanted, point).map(Value::from);
        let measured = self.study.signals.iter().map(measured);
        Ok(Orbit {
            kind,
            period: Value::count(point.orbit.period),
            value: Value::Number(point.value),
            error: Value::Missing,
            measured: measured.collect::<Result<_, _>>()?,
            size_error: point.error.into(),
            moves: Vec::new(),
            verdict: point.stability.verdict.to_string(),
            ended: branch.stopped.to_string(),
        })
    }

    /// A row of a branch.
    pub(crate) fn branch_row(&mut self, about: About, branch: usize, orbit: Orbit) {
        if self.study.plan.request.what == What::Solutions {
            return;
        }
        let mut row = self.begin.clone();
        row.push(Value::text(about.name()));
        row.push(Value::text(orbit.kind));
        row.push(if about == About::Failed {
            Value::Missing
        } else {
            Value::count(branch)
        });
        row.extend([orbit.period, orbit.value, orbit.error]);
        let mut measured = orbit.measured;
        measured.resize(self.study.signals.len(), Value::Missing);
        row.extend(measured);
        row.push(orbit.size_error);
        let mut moves = orbit.moves;
        moves.resize(moved(&self.study.by).count(), Value::Missing);
        row.extend(moves);
        row.push(Value::text(orbit.verdict));
        row.push(Value::text(orbit.ended));
        self.found.rows.push(row);
    }

    /// The row of a cell of a map.
    pub(crate) fn cell_row(&mut self, value: f64, cell: &Cell, signal: &str) {
        let failed = cell.reason.is_some();
        let mut row = self.begin.clone();
        row.push(Value::text(
            if failed { About::Failed } else { About::Cell }.name(),
        ));
        row.push(Value::Number(value));
        row.extend(cell.counts().map(|count| {
            if failed {
                Value::Missing
            } else {
                Value::count(count)
            }
        }));
        row.push(cell.largest.into());
        row.push(Value::text(if cell.largest.is_some() {
            signal
        } else {
            ""
        }));
        let periods: Vec<String> = cell.periods.iter().map(ToString::to_string).collect();
        row.push(Value::text(periods.join(" ")));
        let verdict = cell.verdict();
        let verdict = if verdict == CellVerdict::Failed {
            String::new()
        } else {
            verdict.to_string()
        };
        row.push(Value::text(verdict));
        row.push(Value::text(
            cell.reason
                .as_ref()
                .map(ToString::to_string)
                .unwrap_or_default(),
        ));
        self.found.failed |= failed;
        self.found.rows.push(row);
    }

    /// The row of a variant that could not be computed.
    pub(crate) fn fail(&mut self, why: &str) {
        self.found.failed = true;
        if self.study.plan.request.what == What::Solutions {
            let mut row = self.begin.clone();
            row.push(Value::text(About::Failed.name()));
            row.resize(self.study.columns.len() - 1, Value::Missing);
            row.push(Value::text(why));
            self.found.rows.push(row);
            return;
        }
        let orbit = Orbit {
            ended: why.to_owned(),
            ..Orbit::default()
        };
        self.branch_row(About::Failed, 0, orbit);
    }
}

/// What a row says of an orbit.
pub(crate) struct Orbit {
    pub(crate) kind: String,
    pub(crate) period: Value,
    pub(crate) value: Value,
    pub(crate) error: Value,
    pub(crate) measured: Vec<Value>,
    pub(crate) size_error: Value,
    /// How the place of an event moves: as [`moved`] says, or nothing.
    pub(crate) moves: Vec<Value>,
    pub(crate) verdict: String,
    pub(crate) ended: String,
}

impl Default for Orbit {
    fn default() -> Self {
        Self {
            kind: String::new(),
            period: Value::Missing,
            value: Value::Missing,
            error: Value::Missing,
            measured: Vec::new(),
            size_error: Value::Missing,
            moves: Vec::new(),
            verdict: String::new(),
            ended: String::new(),
        }
    }
}
