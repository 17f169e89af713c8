//! What data and free parameters must be.

use hertzian::observe::{Measure, Wanted};
use hertzian::{Model, System};

use crate::data::{DataSet, Deviations, Sweep};
use crate::error::FitError;
use crate::fit::{Fit, Free, Loss};
use crate::problem::Problem;

/// The highest frequency of a set is not so many times the lowest one.
const WIDEST: f64 = 1e4;
/// The standard deviation of a value of a set without any, as a part of the largest value.
const UNKNOWN: f64 = 0.01;
/// That of the frequency, as a part of the usual step between neighbours.
const OF_STEP: f64 = 0.01;

/// Smallest and largest value.
pub(crate) fn extremes(values: &[f64]) -> [f64; 2] {
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    let mut values = values.iter();
    values
        .try_fold(start, |[low, high], &value| {
            Some([low.min(value), high.max(value)])
        })
        .unwrap_or(start)
}

/// A part of the median step between neighbours.
pub(crate) fn usual_step(places: &[f64]) -> f64 {
    let mut steps: Vec<f64> = places
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .collect();
    steps.retain(|&step| step > 0.0);
    steps.sort_by(f64::total_cmp);
    let alone = 1e-3 * places.first().map_or(1.0, |place| place.abs());
    let step = steps.get(steps.len() / 2).copied().unwrap_or(alone);
    OF_STEP * if step > 0.0 { step } else { 1.0 }
}

/// Whether deviations of a set are known.
pub(crate) fn is_known(set: &DataSet) -> bool {
    set.deviations != Deviations::Unknown
}

/// The deviation of each value of a set.
pub(crate) fn deviations(set: &DataSet) -> Vec<f64> {
    match &set.deviations {
        Deviations::Each(deviations) => deviations.clone(),
        Deviations::All(deviation) => vec![*deviation; set.values.len()],
        Deviations::Unknown => {
            let [low, high] = extremes(&set.values);
            let deviation = UNKNOWN * low.abs().max(high.abs());
            let deviation = if deviation > 0.0 { deviation } else { UNKNOWN };
            vec![deviation; set.values.len()]
        }
    }
}

/// Whether data and parameters can be used.
pub(crate) fn fit(fit: &Fit, system: &dyn System, model: &Model) -> Result<(), FitError> {
    if fit.sets.is_empty() || fit.sets.iter().all(DataSet::is_empty) {
        let message = "there are no data";
        return Err(FitError::Nothing { message });
    }
    if fit.free.is_empty() {
        let message = "no parameter is free: name at least one";
        return Err(FitError::Nothing { message });
    }
    if let Loss::Huber(limit) = fit.loss
        && !(limit > 0.0 && limit.is_finite())
    {
        let message =
            format!("a loss that changes at {limit} standard deviations: give a positive number");
        return Err(FitError::data("all", message));
    }
    for parameter in &fit.free {
        free(parameter, fit, system)?;
    }
    for (index, set) in fit.sets.iter().enumerate() {
        let refused = |message: String| Err(FitError::data(&set.name, message));
        if fit.sets[..index].iter().any(|other| other.name == set.name) {
            return refused("another set has this name: give each its own".to_owned());
        }
        numbers(set).or_else(refused)?;
        names(set, system, model).or_else(refused)?;
    }
    Ok(())
}

/// The values that parameters have.
pub(crate) fn values_of(system: &dyn System) -> Vec<f64> {
    let mut values = vec![0.0; system.facts().parameters.len()];
    system.values(&mut values);
    values
}

/// What a free parameter must be.
fn free(free: &Free, fit: &Fit, system: &dyn System) -> Result<(), FitError> {
    let Free { name, range, .. } = free;
    let refused = |message: String| Err(FitError::free(name, message));
    let parameters = &system.facts().parameters;
    let Some(facts) = parameters.iter().find(|facts| facts.name == *name) else {
        let known: Vec<&str> = parameters.iter().map(|facts| facts.name.as_ref()).collect();
        return refused(format!(
            "the model has none of that name: there are {}",
            known.join(", ")
        ));
    };
    let values = values_of(system);
    let own = parameters
        .iter()
        .zip(values)
        .find(|(own, _)| own.name == *name);
    if let Some((facts, value)) = own
        && value.is_finite()
        && !facts.admits(value)
    {
        return refused(format!("its value {value} is not in its declared range"));
    }
    if let Some([low, high]) = range {
        if !(low.is_finite() && high.is_finite() && low < high) {
            return refused(format!("the range from {low} to {high} is empty"));
        }
        let inside = 0.5 * (low + high);
        if !facts.admits(inside) {
            return refused(format!(
                "{inside}, in the middle of its range, is not admitted by its declaration"
            ));
        }
    }
    for set in &fit.sets {
        if set.varied == *name {
            return refused(format!("it is what varies in data set {}", set.name));
        }
        if set.settings.iter().any(|(own, _)| own == name) {
            return refused(format!(
                "data set {} says what it is: leave that out, or do not free it",
                set.name
            ));
        }
    }
    Ok(())
}

/// Whether the numbers of a set can be used.
fn numbers(set: &DataSet) -> Result<(), String> {
    let (places, values) = (set.places.len(), set.values.len());
    if places != values {
        return Err(format!("{places} places and {values} values"));
    }
    if places == 0 {
        return Err("it is empty".to_owned());
    }
    let all = set.places.iter().chain(&set.values);
    if let Some(value) = all.clone().find(|value| !value.is_finite()) {
        return Err(format!("{value} is no number that can be fitted"));
    }
    let count = match &set.deviations {
        Deviations::Each(deviations) => deviations.len(),
        _ => values,
    };
    if count != values {
        return Err(format!("{values} values and {count} standard deviations"));
    }
    let positive = |value: f64| value > 0.0 && value.is_finite();
    let own = set.place_deviation.into_iter();
    let jumps = set.jumps.iter().map(|jump| jump.deviation);
    let mut all = deviations(set).into_iter().chain(own).chain(jumps);
    if let Some(value) = all.find(|&value| !positive(value)) {
        return Err(format!(
            "a standard deviation is {value}: it must be positive"
        ));
    }
    if !set.jumps.iter().all(|jump| jump.value.is_finite()) {
        return Err("the place of a jump is no number".to_owned());
    }
    if !set.jumps.is_empty() && !matches!(set.sweep, Sweep::Rising | Sweep::Falling) {
        return Err("it has a jump: say whether the sweep rose or fell".to_owned());
    }
    Ok(())
}

/// Whether the names of a set are those of something.
fn names(set: &DataSet, system: &dyn System, model: &Model) -> Result<(), String> {
    let wanted: Wanted = set
        .wanted
        .parse()
        .map_err(|error: hertzian::RequestError| error.to_string())?;
    model.check(&wanted).map_err(|error| error.to_string())?;
    if wanted.measure == Measure::Impacts {
        return Err("a number of impacts is whole: it has no derivative to fit by".to_owned());
    }
    let parameters = &system.facts().parameters;
    let known = |name: &str| parameters.iter().find(|facts| facts.name == name);
    if set.varied == "omega" {
        if let Some(omega) = set.places.iter().find(|omega| **omega <= 0.0) {
            return Err(format!("a frequency is {omega}: it must be positive"));
        }
        let [low, high] = extremes(&set.places);
        if high > WIDEST * low {
            return Err(format!(
                "frequencies from {low} to {high} are not of one curve: divide them into sets of which each is fitted for itself"
            ));
        }
    } else {
        let facts = known(&set.varied)
            .ok_or_else(|| format!("the model has no parameter {}", set.varied))?;
        if let Some(value) = set.places.iter().find(|value| !facts.admits(**value)) {
            return Err(format!(
                "{} = {value} is not in its declared range",
                set.varied
            ));
        }
        if !set
            .omega
            .is_some_and(|omega| omega > 0.0 && omega.is_finite())
        {
            return Err(format!(
                "{} varies: give the frequency, a positive number",
                set.varied
            ));
        }
    }
    for (index, (name, value)) in set.settings.iter().enumerate() {
        let facts = known(name).ok_or_else(|| format!("the model has no parameter {name}"))?;
        if !facts.admits(*value) {
            return Err(format!("{name} = {value} is not in its declared range"));
        }
        if *name == set.varied || set.settings[..index].iter().any(|(other, _)| other == name) {
            return Err(format!("{name} is given twice"));
        }
    }
    Ok(())
}

/// Whether every parameter has a value in every group.
pub(crate) fn values(problem: &Problem) -> Result<(), FitError> {
    let starts: Vec<f64> = problem
        .unknowns
        .iter()
        .map(|unknown| unknown.start)
        .collect();
    for set in &problem.sets {
        let values = problem.values_of(set.group, &starts);
        let parameters = &problem.system.facts().parameters;
        let mut both = parameters.iter().zip(values);
        if let Some((facts, value)) = both.find(|(facts, value)| !facts.admits(*value)) {
            let name = &facts.name;
            let message = if value.is_nan() {
                format!("parameter {name} has no value")
            } else {
                format!("{name} = {value} is not in its declared range")
            };
            return Err(FitError::data(&set.name, message));
        }
    }
    Ok(())
}
