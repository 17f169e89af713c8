//! What is asked for, checked and numbered.

use std::sync::Arc;

use hertzian::observe::{Measure, Wanted};
use hertzian::system::Bound;
use hertzian::{Cancel, Model, System};

use crate::checks;
use crate::data::{DataSet, Jump, Sweep};
use crate::error::FitError;
use crate::fit::{Fit, Free, Loss};
use crate::minimise::square;
use crate::search::spread;

/// Starts are looked for down to this part of a value, and up to its inverse, where no range is given.
const AROUND: f64 = 1.0 / 3.0;
/// So many times its value is as far as a parameter goes without a range: beyond, motions may be so stiff that they take long.
const FAR: f64 = 30.0;
/// Curves go beyond the data by this part of their range.
const MARGIN: f64 = 0.05;
/// A range that begins above zero and ends so many times higher is spread evenly by its logarithm.
const WIDE: f64 = 8.0;
/// Deviations that are found are not below this part of the largest value.
const ROUNDED: f64 = 1e-7;
/// They have settled where they change by less than this part.
const SETTLED: f64 = 0.03;
/// What is excluded is not come nearer to than this part of the scale.
const BESIDE: f64 = 1e-9;

/// A number that is looked for.
#[derive(Debug, Clone)]
pub(crate) struct Unknown {
    pub(crate) name: String,
    pub(crate) parameter: usize,
    /// The data set whose own it is.
    pub(crate) set: Option<usize>,
    pub(crate) start: f64,
    /// Where starts are looked for.
    pub(crate) search: Option<[f64; 2]>,
    pub(crate) limits: [f64; 2],
    /// What counts as one.
    pub(crate) scale: f64,
}

impl Unknown {
    /// The value at a part of the range, from zero to one.
    pub(crate) fn at(&self, part: f64) -> f64 {
        match self.search {
            None => self.start,
            Some([low, high]) if low > 0.0 && high >= WIDE * low => low * (high / low).powf(part),
            Some([low, high]) => low + part * (high - low),
        }
    }
}

/// A data set with what follows from it.
#[derive(Debug, Clone)]
pub(crate) struct Set {
    pub(crate) name: String,
    pub(crate) wanted: Wanted,
    pub(crate) group: usize,
    /// In the order in which they were measured.
    pub(crate) places: Vec<f64>,
    pub(crate) values: Vec<f64>,
    pub(crate) deviations: Vec<f64>,
    pub(crate) place_deviation: f64,
    /// Whether these were stated: those of values, and that of places.
    pub(crate) is_known: bool,
    place_is_known: bool,
    /// What counts as one along both axes, for distances along a curve.
    pub(crate) size: [f64; 2],
    pub(crate) sweep: Sweep,
    pub(crate) jumps: Vec<Jump>,
    /// The line of the given order in which each value stood.
    pub(crate) given: Vec<usize>,
}

impl Set {
    /// Whether it is an angle.
    pub(crate) fn wraps(&self) -> bool {
        matches!(self.wanted.measure, Measure::Phase(_))
    }

    /// Number of residuals.
    pub(crate) fn residuals(&self) -> usize {
        self.places.len() + self.jumps.len()
    }
}

/// Data sets that one curve serves.
#[derive(Debug, Clone)]
pub(crate) struct Group {
    pub(crate) varied: String,
    pub(crate) omega: Option<f64>,
    settings: Vec<(usize, f64)>,
    /// The set whose own parameters it has.
    own: Option<usize>,
    pub(crate) range: [f64; 2],
    /// What is read off its orbits.
    pub(crate) wanted: Vec<Wanted>,
}

/// What is asked for, checked.
#[derive(Debug)]
pub(crate) struct Problem {
    pub(crate) system: Arc<dyn System>,
    pub(crate) model: Model,
    pub(crate) values: Vec<f64>,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) sets: Vec<Set>,
    pub(crate) groups: Vec<Group>,
    pub(crate) starts: usize,
    pub(crate) loss: Loss,
    pub(crate) cancel: Cancel,
    /// Whether deviations are known of some sets: those of the others are found beside them.
    pub(crate) is_absolute: bool,
    /// What it was made of, to fit something like it.
    pub(crate) asked: Fit,
}

impl Problem {
    pub(crate) fn new(fit: &Fit) -> Result<Self, FitError> {
        let system = fit.system.shared();
        let model = Model::of(&system);
        let values = checks::values_of(&system);
        checks::fit(fit, &system, &model)?;
        let has_own = fit.free.iter().any(|free| free.own);
        let mut problem = Self {
            unknowns: Vec::new(),
            sets: Vec::new(),
            groups: Vec::new(),
            starts: fit.starts.max(1),
            loss: fit.loss,
            cancel: fit.cancel.clone(),
            is_absolute: fit.sets.iter().any(checks::is_known),
            asked: fit.clone(),
            system,
            model,
            values,
        };
        for (index, set) in fit.sets.iter().enumerate() {
            problem.take(set, has_own.then_some(index))?;
        }
        for free in &fit.free {
            problem.free(free)?;
        }
        for unknown in &mut problem.unknowns {
            let mut begins = fit.begins.iter();
            if let Some((_, value)) = begins.find(|(name, _)| *name == unknown.name) {
                unknown.start = value.clamp(unknown.limits[0], unknown.limits[1]);
            }
        }
        checks::values(&problem)?;
        let measured: usize = problem.sets.iter().map(Set::residuals).sum();
        let parameters = problem.unknowns.len();
        if measured < parameters {
            return Err(FitError::TooFew {
                measured,
                parameters,
            });
        }
        Ok(problem)
    }

    /// The place of a parameter.
    pub(crate) fn parameter(&self, name: &str) -> Option<usize> {
        let mut parameters = self.model.parameters.iter();
        parameters.position(|parameter| parameter.name == name)
    }

    /// Takes a data set in, with the group that its curve is of.
    fn take(&mut self, set: &DataSet, own: Option<usize>) -> Result<(), FitError> {
        let wanted: Wanted = (set.wanted.parse()).map_err(|error: hertzian::RequestError| {
            FitError::data(&set.name, error.to_string())
        })?;
        let settings = set.settings.iter().filter_map(|(name, value)| {
            let index = self.parameter(name)?;
            Some((index, *value))
        });
        let mut settings: Vec<(usize, f64)> = settings.collect();
        settings.sort_by_key(|(index, _)| *index);
        let [low, high] = checks::extremes(&set.places);
        // A branch that ends beyond the last value is followed to its end.
        let parameter = self.parameter(&set.varied);
        let is_admitted = |value: &f64| match parameter {
            None => *value > 0.0,
            Some(index) => self.system.facts().parameters[index].admits(*value),
        };
        let jumps = set.jumps.iter().map(|jump| jump.value);
        let jumps = jumps.filter(is_admitted);
        let [low, high] = jumps.fold([low, high], |[low, high], jump| {
            [low.min(jump), high.max(jump)]
        });
        let known = self.groups.iter_mut().position(|group| {
            (&group.varied, group.omega, &group.settings, group.own)
                == (&set.varied, set.omega, &settings, own)
        });
        let group = known.unwrap_or_else(|| {
            self.groups.push(Group {
                varied: set.varied.clone(),
                omega: set.omega,
                settings,
                own,
                range: [low, high],
                wanted: Vec::new(),
            });
            self.groups.len() - 1
        });
        let of = &mut self.groups[group];
        of.range = [of.range[0].min(low), of.range[1].max(high)];
        if !of.wanted.contains(&wanted) {
            of.wanted.push(wanted.clone());
        }
        self.sets.push(measured(set, wanted, group));
        Ok(())
    }

    /// Numbers a free parameter, or that of each set.
    fn free(&mut self, free: &Free) -> Result<(), FitError> {
        let Free { name, range, own } = free;
        let parameter = (self.parameter(name)).ok_or_else(|| FitError::free(name, "unknown"))?;
        let sets = if *own {
            (0..self.sets.len()).map(Some).collect()
        } else {
            vec![None]
        };
        for set in sets {
            let limits = self.limits(parameter, *range);
            let start = self.values[parameter];
            let middle = range.map_or(start, |[low, high]| 0.5 * (low + high));
            let start = if start.is_finite() { start } else { middle };
            let start = start.clamp(limits[0], limits[1]);
            if !start.is_finite() {
                let message = "it has no value to start from, and no range: give one of both";
                return Err(FitError::free(name, message));
            }
            let around = [AROUND * start, start / AROUND];
            let around = [around[0].min(around[1]), around[0].max(around[1])];
            let search = range.or((start != 0.0).then_some(around));
            let search = search.map(|ends| ends.map(|end: f64| end.clamp(limits[0], limits[1])));
            let width = search.map_or(0.0, |[low, high]| high - low);
            let scale = if start == 0.0 { width } else { start.abs() };
            let own = set.map(|set| &self.sets[set].name);
            self.unknowns.push(Unknown {
                name: own.map_or_else(|| name.clone(), |set| format!("{name} of {set}")),
                parameter,
                set,
                start,
                search,
                limits,
                scale: if scale > 0.0 { scale } else { 1.0 },
            });
        }
        Ok(())
    }

    /// The limits of a parameter, by its declaration and a range.
    fn limits(&self, parameter: usize, range: Option<[f64; 2]>) -> [f64; 2] {
        let facts = &self.system.facts().parameters[parameter];
        let scale = range.map_or(self.values[parameter].abs(), |[low, high]| high - low);
        let scale = if scale > 0.0 { scale } else { 1.0 };
        let value = self.values[parameter].abs();
        let far = if value > 0.0 {
            FAR * value
        } else {
            f64::INFINITY
        };
        let [low, high] = range.unwrap_or([-far, far]);
        let minimum = match facts.minimum {
            Bound::Unbounded => f64::NEG_INFINITY,
            Bound::Included(end) => end,
            Bound::Excluded(end) => end + BESIDE * scale,
        };
        let maximum = match facts.maximum {
            Bound::Unbounded => f64::INFINITY,
            Bound::Included(end) => end,
            Bound::Excluded(end) => end - BESIDE * scale,
        };
        [low.max(minimum), high.min(maximum)]
    }

    /// Makes deviations that were not stated those by which values scatter, beside sets of which they were: weights and estimates are found in
    /// turn, with the degrees of freedom shared as the values are. Whether any has changed.
    ///
    /// Source: Carroll and Ruppert (1988), Transformation and Weighting in Regression, section 3.2 (variances by groups).
    pub(crate) fn weigh(&mut self, first: &[usize], residuals: &[f64]) -> bool {
        let (count, unknowns) = (residuals.len(), self.unknowns.len());
        if !self.is_absolute || count <= unknowns {
            return false;
        }
        let left = (count - unknowns) as f64 / count as f64;
        let mut has_changed = false;
        let sets = self.sets.iter_mut().zip(first);
        for (set, &first) in sets.filter(|(set, _)| !set.is_known) {
            let own = &residuals[first..][..set.places.len()];
            let scatter = match self.loss {
                Loss::Squares => (square(own) / (own.len() as f64 * left)).sqrt(),
                Loss::Huber(_) => spread(own),
            };
            let [low, high] = checks::extremes(&set.values);
            let least = ROUNDED * low.abs().max(high.abs());
            let before = set.deviations[0];
            let deviation = (before * scatter).max(least).max(f64::MIN_POSITIVE);
            let times = deviation / before;
            has_changed |= times.ln().abs() > SETTLED;
            set.deviations.fill(deviation);
            if !set.place_is_known {
                set.place_deviation *= times;
            }
        }
        has_changed
    }

    /// The name of the parameter that an unknown is.
    pub(crate) fn name_of(&self, unknown: &Unknown) -> &str {
        &self.model.parameters[unknown.parameter].name
    }

    /// The unknowns that the curve of a group depends on.
    pub(crate) fn of_group(&self, group: usize) -> impl Iterator<Item = (usize, &Unknown)> {
        let own = self.groups[group].own;
        let unknowns = self.unknowns.iter().enumerate();
        unknowns.filter(move |(_, unknown)| unknown.set.is_none() || unknown.set == own)
    }

    /// The values of all parameters for the curve of a group.
    pub(crate) fn values_of(&self, group: usize, unknowns: &[f64]) -> Vec<f64> {
        let mut values = self.values.clone();
        for &(index, value) in &self.groups[group].settings {
            values[index] = value;
        }
        for (index, unknown) in self.of_group(group) {
            values[unknown.parameter] = unknowns[index];
        }
        // The range gives it its values; until then it needs one that can be used.
        let Group { varied, range, .. } = &self.groups[group];
        if let Some(index) = self.parameter(varied) {
            values[index] = range[0];
        }
        values
    }

    /// Where the curve of a group begins and ends: beyond the data, as far as there may be values.
    pub(crate) fn ends(&self, group: usize) -> [f64; 2] {
        let Group { varied, range, .. } = &self.groups[group];
        let [low, high] = *range;
        let margin = MARGIN * (high - low).max(1e-3 * high.abs());
        let [from, to] = [low - margin, high + margin];
        match self.parameter(varied) {
            None => [from.max(0.5 * low), to],
            Some(index) => {
                let facts = &self.system.facts().parameters[index];
                let admitted =
                    |value: f64, inside: f64| if facts.admits(value) { value } else { inside };
                [admitted(from, low), admitted(to, high)]
            }
        }
    }
}

/// A data set with what follows from it, in the order of its sweep.
fn measured(set: &DataSet, wanted: Wanted, group: usize) -> Set {
    let deviations = checks::deviations(set);
    let mut order: Vec<usize> = (0..set.places.len()).collect();
    order.sort_by(|&a, &b| set.places[a].total_cmp(&set.places[b]));
    if set.sweep == Sweep::Falling {
        order.reverse();
    }
    let sorted = |of: &[f64]| -> Vec<f64> { order.iter().map(|&index| of[index]).collect() };
    let (places, values) = (sorted(&set.places), sorted(&set.values));
    let [low, high] = checks::extremes(&values);
    let largest = low.abs().max(high.abs());
    let [first, last] = checks::extremes(&places);
    let span = |width: f64, of: f64| match width.max(1e-3 * of.abs()) {
        0.0 => 1.0,
        width => width,
    };
    Set {
        name: set.name.clone(),
        group,
        deviations: sorted(&deviations),
        is_known: checks::is_known(set),
        place_is_known: set.place_deviation.is_some(),
        place_deviation: set
            .place_deviation
            .unwrap_or_else(|| checks::usual_step(&places)),
        size: [span(last - first, last), span(high - low, largest)],
        sweep: set.sweep,
        jumps: set.jumps.clone(),
        given: order,
        places,
        values,
        wanted,
    }
}
