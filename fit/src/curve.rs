//! The curve of a group of data sets at values of the parameters: followed by shooting, read, and with its derivatives.

use std::collections::HashMap;

use hertzian::{Branch, EventKind, FrequencyResponse, Point, Shooting, Stop, with_values};

use crate::path::{Node, Sheet};
use crate::problem::Problem;

/// Accuracy asked of motions: by shooting their errors are far below, and do not grow with harmonics that are left out.
const TOLERANCE: f64 = 1e-4;
/// The longest steps along a curve.
const STEP: f64 = 0.3;
/// A curve that takes more points is no resonance curve that data could be compared with.
const POINTS: usize = 600;

/// A curve.
#[derive(Debug)]
pub(crate) struct Curve {
    branches: Vec<Branch>,
    /// Whether each was followed from the lowest place on.
    from_lowest: Vec<bool>,
    /// For each branch, points and turns in their order, with a reading for each thing that is wanted.
    chains: Vec<Vec<(Node, Vec<f64>)>>,
    group: usize,
    orbits: HashMap<(usize, u64), Vec<Point>>,
    slopes: HashMap<(usize, usize), Slopes>,
    slopes_at: HashMap<(usize, u64, usize), Slopes>,
    folds: HashMap<(usize, usize), Vec<f64>>,
}

/// What is read off an orbit, and its derivatives.
#[derive(Debug, Clone)]
pub(crate) struct Slopes {
    /// Of each thing that is wanted: by the place, then by each unknown of the problem.
    pub(crate) of: Vec<Option<(f64, f64, Vec<f64>)>>,
}

impl Curve {
    /// Follows the curve of a group.
    ///
    /// # Errors
    /// Why it cannot be compared with data, in a sentence.
    pub(crate) fn follow(
        problem: &Problem,
        group: usize,
        unknowns: &[f64],
    ) -> Result<Self, String> {
        let of = &problem.groups[group];
        let values = problem.values_of(group, unknowns);
        let system = with_values(&problem.system, values);
        let [low, high] = problem.ends(group);
        let mut request = FrequencyResponse::of(&system)
            .by(Shooting::new())
            .tolerance(TOLERANCE)
            .largest_step(STEP)
            .stability(false)
            .max_points(POINTS)
            .cancel(&problem.cancel);
        if let Some(omega) = of.omega {
            request = request.vary(&of.varied).omega(omega);
        }
        let described = |error: hertzian::Error| hertzian::error::chain(&error).to_string();
        let forth = request.clone().from(low).to(high).run();
        let whole = matches!(&forth, Ok(branch) if branch.stopped == Stop::ReachedEnd);
        let mut branches = Vec::new();
        let mut failed = None;
        match forth {
            Ok(branch) => branches.push((branch, true)),
            Err(error) => failed = Some(described(error)),
        }
        if !whole && !problem.cancel.is_cancelled() {
            match request.from(high).to(low).run() {
                Ok(branch) => branches.push((branch, false)),
                Err(error) => failed = failed.or_else(|| Some(described(error))),
            }
        }
        if problem.cancel.is_cancelled() {
            return Err("cancelled".to_owned());
        }
        branches.retain(|(branch, _)| branch.points.len() > 2);
        if branches.is_empty() {
            return Err(failed.unwrap_or_else(|| "the curve ended where it began".to_owned()));
        }
        let (branches, from_lowest): (Vec<Branch>, Vec<bool>) = branches.into_iter().unzip();
        let chains = branches.iter().map(|branch| chain(branch, &of.wanted));
        let chains = chains.collect::<Result<_, _>>().map_err(described)?;
        Ok(Self {
            branches,
            from_lowest,
            chains,
            group,
            orbits: HashMap::new(),
            slopes: HashMap::new(),
            slopes_at: HashMap::new(),
            folds: HashMap::new(),
        })
    }

    /// The nodes of each branch with what a set measured, an angle without leaps.
    pub(crate) fn nodes(&self, wanted: usize, wraps: bool) -> Vec<Vec<Node>> {
        let chains = self.chains.iter();
        let nodes = chains.map(|chain| {
            let mut before: Option<f64> = None;
            let nodes = chain.iter().map(|(node, readings)| {
                let mut y = readings[wanted];
                if let (true, Some(before)) = (wraps, before) {
                    y = crate::turn::near(y, before);
                }
                if y.is_finite() {
                    before = Some(y);
                }
                Node { y, ..*node }
            });
            nodes.filter(|node| node.y.is_finite()).collect()
        });
        nodes.collect()
    }

    /// The place of a sheet along the curve from its lowest end on: a branch that was followed from the highest end comes last, and backwards.
    pub(crate) fn rank(&self, branch: usize, sheet: &Sheet) -> isize {
        let along = sheet.nodes[0] as isize;
        if self.from_lowest[branch] {
            along
        } else {
            isize::MAX / 4 - along
        }
    }

    /// The readings of all orbits of a branch at a place.
    ///
    /// # Errors
    /// Why they are not known.
    pub(crate) fn readings(
        &mut self,
        problem: &Problem,
        branch: usize,
        place: f64,
        wanted: usize,
    ) -> Result<Vec<f64>, String> {
        self.find(branch, place)?;
        let of = &problem.groups[self.group].wanted[wanted];
        let readings = self.orbits[&(branch, place.to_bits())].iter().map(|point| {
            let reading = self.branches[branch].measured(of, point);
            reading.map(|reading| reading.unwrap_or(f64::NAN))
        });
        readings
            .collect::<Result<_, _>>()
            .map_err(|error| error.to_string())
    }

    fn find(&mut self, branch: usize, place: f64) -> Result<(), String> {
        let key = (branch, place.to_bits());
        if !self.orbits.contains_key(&key) {
            let found = self.branches[branch]
                .at(place)
                .map_err(|error| error.to_string())?;
            self.orbits.insert(key, found);
        }
        Ok(())
    }

    /// Derivatives at an orbit at a place, by its number among those there.
    ///
    /// # Errors
    /// Why there are none.
    pub(crate) fn slopes_at(
        &mut self,
        problem: &Problem,
        branch: usize,
        place: f64,
        number: usize,
    ) -> Result<&Slopes, String> {
        self.find(branch, place)?;
        let key = (branch, place.to_bits(), number);
        if !self.slopes_at.contains_key(&key) {
            let orbits = &self.orbits[&(branch, place.to_bits())];
            let point = orbits.get(number).ok_or("no orbit there")?;
            let found = slopes(problem, self.group, &self.branches[branch], point)?;
            self.slopes_at.insert(key, found);
        }
        Ok(&self.slopes_at[&key])
    }

    /// Derivatives at a point of a branch.
    ///
    /// # Errors
    /// Why there are none.
    pub(crate) fn slopes_of(
        &mut self,
        problem: &Problem,
        branch: usize,
        point: usize,
    ) -> Result<&Slopes, String> {
        if !self.slopes.contains_key(&(branch, point)) {
            let of = &self.branches[branch];
            let found = slopes(problem, self.group, of, &of.points[point])?;
            self.slopes.insert((branch, point), found);
        }
        Ok(&self.slopes[&(branch, point)])
    }

    /// How the place of a turn moves with every unknown; zero for those that it does not depend on.
    ///
    /// # Errors
    /// Why that is not known.
    pub(crate) fn fold_slopes(
        &mut self,
        problem: &Problem,
        branch: usize,
        event: usize,
    ) -> Result<Vec<f64>, String> {
        if let Some(known) = self.folds.get(&(branch, event)) {
            return Ok(known.clone());
        }
        let key = (branch, event);
        let branch = &self.branches[branch];
        let found = branch
            .event_sensitivities_of(&branch.events[event], &[])
            .map_err(|error| error.to_string())?;
        let mut slopes = vec![0.0; problem.unknowns.len()];
        for (index, unknown) in problem.of_group(self.group) {
            let name = problem.name_of(unknown);
            slopes[index] = found.of_place(name).map_or(0.0, |slope| slope.value);
        }
        self.folds.insert(key, slopes.clone());
        Ok(slopes)
    }
}

/// Points and turns of a branch in their order, with readings.
fn chain(
    branch: &Branch,
    wanted: &[hertzian::observe::Wanted],
) -> Result<Vec<(Node, Vec<f64>)>, hertzian::Error> {
    let read = |point: &Point| -> Result<Vec<f64>, hertzian::Error> {
        let readings = wanted.iter().map(|wanted| branch.measured(wanted, point));
        readings
            .map(|reading| Ok(reading?.unwrap_or(f64::NAN)))
            .collect()
    };
    let mut chain = Vec::with_capacity(branch.points.len() + branch.events.len());
    for (index, point) in branch.points.iter().enumerate() {
        let turns = branch.events.iter().enumerate();
        for (number, event) in turns.filter(|(_, event)| event.after == index && event.kind.turns())
        {
            let node = Node {
                x: event.point.value,
                y: 0.0,
                turns: event.kind == EventKind::Fold,
                point: None,
                event: Some(number),
            };
            chain.push((node, read(&event.point)?));
        }
        let node = Node {
            x: point.value,
            y: 0.0,
            turns: false,
            point: Some(index),
            event: None,
        };
        chain.push((node, read(point)?));
    }
    Ok(chain)
}

/// Derivatives of what a group wants at an orbit.
fn slopes(
    problem: &Problem,
    group: usize,
    branch: &Branch,
    point: &Point,
) -> Result<Slopes, String> {
    let of = &problem.groups[group];
    let unknowns: Vec<(usize, &str)> = problem
        .of_group(group)
        .map(|(index, unknown)| (index, problem.name_of(unknown)))
        .collect();
    let own = unknowns.iter().map(|(_, name)| *name);
    let variables: Vec<&str> = std::iter::once(of.varied.as_str()).chain(own).collect();
    let found = branch
        .quick_sensitivities_of(point, &of.wanted, &variables)
        .map_err(|error| hertzian::error::chain(&error).to_string())?;
    let slopes = of.wanted.iter().map(|wanted| {
        let name = wanted.to_string();
        let mut measured = found.measured.iter();
        let measured = measured.find(|measured| measured.name == name)?;
        // One that is another one to each side is no number.
        measured
            .by
            .iter()
            .all(|slope| slope.value.is_finite())
            .then_some(())?;
        let mut by = measured.by.iter().map(|slope| slope.value);
        let place = by.next()?;
        let mut slopes = vec![0.0; problem.unknowns.len()];
        for ((index, _), slope) in unknowns.iter().zip(by) {
            slopes[*index] = slope;
        }
        Some((measured.value, place, slopes))
    });
    Ok(Slopes {
        of: slopes.collect(),
    })
}
