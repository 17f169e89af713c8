//! A branch as lines and marks of a chart, each orbit where the chart has it.

use hertzian_chart::{Bend, Chart, Line, Run, Scale, Series, smoothed};

use crate::branches::branch::Branch;
use crate::branches::point::Point;
use crate::error::Error;
use crate::event::EventKind;
use crate::orbit::observe::{Measure, Wanted, amplitudes};
use crate::orbit::stability::Verdict;
use crate::report::error::ViewError;
use crate::report::picture::{event_markers, harmonic};
use crate::report::view::{Seen, View};

/// What is smaller than this part of the largest value is not told from zero.
const ROUNDING: f64 = 1e-15;

/// A branch with everything that a chart shows of it.
#[derive(Debug, Clone)]
pub(crate) struct Drawn<'b> {
    pub(crate) seen: Seen<'b>,
    /// One line for each size: of one, or of each harmonic.
    lines: Vec<Places>,
    /// Where test functions change their sign without an event.
    turns: Vec<(EventKind, [f64; 2])>,
}

/// Where its orbits and its events are.
#[derive(Debug, Clone, Default)]
struct Places {
    points: Vec<[f64; 2]>,
    events: Vec<[f64; 2]>,
}

impl Places {
    /// The branch that they are of as runs of one stability each, bent as it is.
    fn runs(&self, branch: &Branch, scale: Scale) -> Vec<Run> {
        let verdicts = branch.points.iter().map(|point| point.stability.verdict);
        let after = branch.events.iter().map(|event| event.after);
        let events: Vec<(usize, [f64; 2])> = after.zip(self.events.iter().copied()).collect();
        let leaps: Vec<usize> = branch.leaps.iter().map(|leap| leap.after).collect();
        let places = self.points.iter().copied().zip(verdicts);
        let runs = runs(places, &events, &leaps);
        smoothed(runs, &self.bends(branch), scale)
    }

    fn bends(&self, branch: &Branch) -> Vec<([f64; 2], Bend)> {
        let bent = branch.events.iter().zip(&self.events);
        let bent = bent.filter_map(|(event, place)| match event.kind {
            EventKind::Fold => Some((*place, Bend::Upright)),
            EventKind::Grazing { .. } => Some((*place, Bend::Corner)),
            _ => None,
        });
        let turns = branch.turns.iter().map(|turn| turn.after);
        let beside = turns.chain(branch.leaps.iter().map(|leap| leap.after));
        let beside = beside.flat_map(|after| [after.checked_sub(1), Some(after)]);
        let beside = beside.filter_map(|index| self.points.get(index?));
        bent.chain(beside.map(|place| (*place, Bend::Corner)))
            .collect()
    }
}

impl<'b> Drawn<'b> {
    pub(crate) fn of(seen: Seen<'b>) -> Self {
        let branch = seen.branch;
        let mut lines = vec![Places::default(); seen.lines()];
        let points = branch.points.iter().map(|point| (point, false));
        let events = branch.events.iter().map(|event| (&event.point, true));
        for (point, is_event) in points.chain(events) {
            let x = seen.varied(point.value);
            for (line, y) in lines.iter_mut().zip(seen.sizes(point)) {
                let places = if is_event {
                    &mut line.events
                } else {
                    &mut line.points
                };
                places.push([x, y]);
            }
        }
        let points = &lines[0].points;
        let turns = branch.turns.iter().filter_map(|turn| {
            let [before, behind] = [turn.after.checked_sub(1)?, turn.after];
            let [_, low] = points.get(before)?;
            let [_, high] = points.get(behind)?;
            Some((turn.kind, [seen.varied(turn.value), 0.5 * (low + high)]))
        });
        let turns = turns.collect();
        Self { seen, lines, turns }
    }

    /// A line as runs of one stability each, bent as the branch is.
    pub(crate) fn runs(&self, line: usize, scale: Scale) -> Vec<Run> {
        self.lines[line].runs(self.seen.branch, scale)
    }

    /// Its orbits along a line.
    pub(crate) fn points(&self, line: usize) -> &[[f64; 2]] {
        &self.lines[line].points
    }

    /// The place on the first line that is farthest from events and from its ends, in parts of what the line takes of both axes.
    pub(crate) fn clear_place(&self) -> Option<[f64; 2]> {
        let Places { points, events } = self.lines.first()?;
        let is_known = |place: &&[f64; 2]| place.iter().all(|u| u.is_finite());
        let known: Vec<[f64; 2]> = points.iter().filter(is_known).copied().collect();
        let extent = |k: usize| {
            let values = known.iter().map(|place| place[k]);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| {
                (low.min(u), high.max(u))
            });
            (high - low).max(f64::MIN_POSITIVE)
        };
        let extents = [extent(0), extent(1)];
        let apart = |a: &[f64; 2], b: &[f64; 2]| {
            let [x, y] = [0, 1].map(|k| (a[k] - b[k]) / extents[k]);
            x.hypot(y)
        };
        let distance = |place: &[f64; 2]| {
            let others = events.iter().chain(known.first()).chain(known.last());
            let distances = others.map(|other| apart(place, other));
            distances.fold(f64::INFINITY, f64::min)
        };
        let farthest = known
            .iter()
            .max_by(|a, b| distance(a).total_cmp(&distance(b)));
        farthest.copied()
    }

    /// All lines with other values, as higher ones.
    pub(crate) fn raised(mut self, by: impl Fn(f64) -> f64) -> Self {
        let places = self.lines.iter_mut();
        let places = places.flat_map(|line| line.points.iter_mut().chain(&mut line.events));
        let turns = self.turns.iter_mut().map(|(_, place)| place);
        places
            .chain(turns)
            .for_each(|place| place[1] = by(place[1]));
        self
    }

    fn marked(&self) -> impl Iterator<Item = (EventKind, [f64; 2])> {
        let events = self.seen.branch.events.iter();
        let places = self.lines[0].events.iter();
        events
            .zip(places)
            .map(|(event, place)| (event.kind, *place))
    }
}

impl View {
    /// Whether every value has a place on the axis. One at zero has none on a logarithmic axis, and is left out unless all are; what is not
    /// told from zero by rounding is zero there.
    ///
    /// # Errors
    /// If one is negative, or none is positive, on a logarithmic axis, or phases are asked for.
    pub(crate) fn check(&self, drawn: &mut [Drawn<'_>]) -> Result<(), Error> {
        if self.scale == Scale::Linear {
            return Ok(());
        }
        let sizes = drawn.iter().flat_map(|drawn| &drawn.lines);
        let sizes = sizes.flat_map(|line| &line.points);
        let largest = sizes.fold(0.0, |m: f64, [_, y]| m.max(y.abs()));
        for line in drawn.iter_mut().flat_map(|drawn| &mut drawn.lines) {
            for [_, y] in line.points.iter_mut().chain(&mut line.events) {
                if y.abs() < ROUNDING * largest {
                    *y = 0.0;
                }
            }
        }
        let Some(first) = drawn.first() else {
            return Ok(());
        };
        let Wanted { name, measure } = &first.seen.wanted;
        if let Measure::Phase(harmonic) = *measure {
            let name = name.clone();
            return Err(ViewError::Angle { name, harmonic }.into());
        }
        let all = || {
            let known = |drawn: &'_ Drawn<'_>| {
                let lines = drawn.lines.iter();
                lines
                    .flat_map(|line| line.points.clone())
                    .collect::<Vec<_>>()
            };
            drawn.iter().flat_map(known)
        };
        let positive = all().any(|[_, y]| y > 0.0);
        let wrong = all().find(|&[_, y]| y < 0.0 || (y == 0.0 && !positive));
        match wrong {
            None => Ok(()),
            Some([at, value]) => Err(ViewError::NotPositive {
                name: format!("{} of {name}", measure.in_words()),
                value,
                varied: first.seen.branch.varied.clone(),
                at,
            }
            .into()),
        }
    }

    /// Marks of the events that are shown, and what is left out in words.
    pub(crate) fn marked(&self, chart: Chart, drawn: &[Drawn<'_>]) -> Chart {
        let shown = |kind: EventKind| {
            let chosen = self.events.as_ref();
            chosen.is_none_or(|kinds| kinds.iter().any(|own| own.is_like(kind)))
        };
        let all: Vec<_> = drawn.iter().flat_map(Drawn::marked).collect();
        let turns = || drawn.iter().flat_map(|drawn| &drawn.turns);
        let places = turns().filter(|(kind, _)| shown(*kind));
        let unlocated = Series {
            label: "unlocated".to_owned(),
            points: places.map(|(_, place)| *place).collect(),
        };
        let marks = all.iter().copied().filter(|(kind, _)| shown(*kind));
        let chart = event_markers(marks)
            .chain([unlocated])
            .fold(chart, Chart::marks);
        let hidden = EventKind::ALL.into_iter().filter(|kind| !shown(*kind));
        let mut counts: Vec<String> = hidden
            .filter_map(|kind| {
                let count = all.iter().filter(|(own, _)| own.is_like(kind)).count();
                (count > 0).then(|| counted(kind, count))
            })
            .collect();
        let turns = turns().filter(|(kind, _)| !shown(*kind)).count();
        counts.extend((turns > 0).then(|| format!("{turns} unlocated")));
        let mut chart = chart;
        if !counts.is_empty() {
            chart = chart.remark(format!("not marked: {}", counts.join(", ")));
        }
        for remark in self.missing(drawn) {
            chart = chart.remark(remark);
        }
        chart
    }

    /// Orbits without a place, in words.
    fn missing(&self, drawn: &[Drawn<'_>]) -> Vec<String> {
        let mut remarks = Vec::new();
        let count = drawn.first().map_or(0, |first| first.lines.len());
        for line in 0..count {
            let all = || drawn.iter().flat_map(|drawn| drawn.points(line));
            let total = all().count();
            let unknown = all().filter(|[_, y]| y.is_nan()).count();
            let of = if count > 1 {
                format!("{}: ", harmonic(line))
            } else {
                String::new()
            };
            if unknown > 0 {
                remarks.push(format!("{of}not known at {unknown} of {total} orbits"));
            }
            let zero = all().filter(|[_, y]| *y == 0.0).count();
            if zero > 0 && self.scale != Scale::Linear {
                remarks.push(format!(
                    "{of}zero, to rounding, at {zero} of {total} orbits: it has no place on this axis"
                ));
            }
        }
        remarks
    }
}

impl Seen<'_> {
    /// How many lines there are of a branch.
    fn lines(&self) -> usize {
        self.harmonics.max(1)
    }

    /// What is measured of an orbit, one number for each line; not a number where it is not known.
    pub(crate) fn sizes(&self, point: &Point) -> Vec<f64> {
        let Seen {
            branch,
            wanted,
            harmonics,
            ..
        } = self;
        if *harmonics == 0 {
            let measured = branch.measured(wanted, point).ok().flatten();
            return vec![measured.unwrap_or(f64::NAN)];
        }
        let reading = branch.reading(&wanted.name, point);
        let known = reading.map_or_else(|_| Vec::new(), |read| amplitudes(&read.series));
        // In multiples of the excitation frequency, whatever the period of the orbit.
        let each = (point.orbit.omega / point.orbit.base).round() as usize;
        let amplitude = |harmonic: usize| known.get(harmonic * each).copied();
        let sizes = 1..=*harmonics;
        sizes
            .map(|harmonic| amplitude(harmonic).unwrap_or(f64::NAN))
            .collect()
    }
}

impl Branch {
    /// The branch as runs of one stability each, by peak-to-peak of the first coordinate; neighbours share the point where they meet, which is
    /// the event if there is one between them, but at [places](Branch::leaps) where nothing leads from one to the other. Between orbits there are places where the line bends, as [`plot`](Self::plot) draws it with
    /// linear axes: these are interpolated.
    pub fn runs(&self) -> Vec<Run> {
        self.runs_of(place)
    }

    /// The same with every orbit at a place of one's own, over what the branch varies: upright at folds.
    pub fn runs_of(&self, place: impl Fn(&Point) -> [f64; 2]) -> Vec<Run> {
        let places = Places {
            points: self.points.iter().map(&place).collect(),
            events: self
                .events
                .iter()
                .map(|event| place(&event.point))
                .collect(),
        };
        places.runs(self, Scale::Linear)
    }
}

/// Points with their verdicts as runs of one stability each, with events, each behind so many points. Neighbours share the point
/// where they meet, but where nothing leads from one to the other.
fn runs(
    points: impl Iterator<Item = ([f64; 2], Verdict)>,
    events: &[(usize, [f64; 2])],
    leaps: &[usize],
) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut count = 0;
    for (index, (here, verdict)) in points.enumerate() {
        count = index + 1;
        let line = line_of(verdict);
        let between = events.iter().filter(|(after, _)| *after == index);
        let joints: Vec<_> = between.map(|(_, place)| *place).collect();
        match runs.last_mut() {
            Some(_) if leaps.contains(&index) => runs.push(Run {
                line,
                points: vec![here],
            }),
            Some(run) if run.line == line => {
                run.points.extend(&joints);
                run.points.push(here);
            }
            Some(run) => {
                let joint = joints.first().copied().unwrap_or(here);
                run.points.push(joint);
                let points = joints.into_iter().chain([here]).collect();
                runs.push(Run { line, points });
            }
            None => runs.push(Run {
                line,
                points: joints.into_iter().chain([here]).collect(),
            }),
        }
    }
    let behind = events.iter().filter(|(after, _)| *after >= count);
    if let Some(run) = runs.last_mut() {
        run.points.extend(behind.map(|(_, place)| place));
    }
    runs
}

pub(crate) fn place(point: &Point) -> [f64; 2] {
    [point.value, point.peak_to_peak()]
}

fn line_of(verdict: Verdict) -> Line {
    match verdict {
        Verdict::Stable => Line::Stable,
        Verdict::Unstable => Line::Unstable,
        Verdict::Undecided => Line::Undecided,
    }
}

/// So many events of a kind, in words.
fn counted(kind: EventKind, count: usize) -> String {
    let one = match kind {
        EventKind::Fold => "fold",
        EventKind::SymmetryBreaking => "symmetry breaking",
        EventKind::PeriodDoubling => "period doubling",
        EventKind::BranchPoint => "branch point",
        EventKind::NeimarkSacker => "Neimark-Sacker bifurcation",
        EventKind::Grazing { .. } => "grazing",
    };
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {one}{plural}")
}
