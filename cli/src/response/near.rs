//! `--near` and `--at-rest`: what is known of the first orbit.

use hertzian::{Branch, FrequencyResponse, Point, System};

use super::options::Options;
use super::run::Failure;
use crate::values;

/// What is swept may differ by this part from where the branch begins: its values are as near as the orbits of the file are.
const NEAR: f64 = 0.05;
/// Other values are the same up to rounding.
const SAME: f64 = 1e-12;

/// The request with the guess, if there is one, and what is to be said of it.
///
/// # Errors
/// If the file has no orbit of such an oscillator, or there is no such coordinate.
pub fn of(
    options: &Options,
    model: &dyn System,
    request: FrequencyResponse,
) -> Result<(FrequencyResponse, Option<String>), Failure> {
    let Some(path) = &options.near else {
        return Ok((at_rest(options, model, request)?, None));
    };
    let branches = Branch::read_all(path)?;
    let asked = Asked::of(options, model);
    let coordinates = model.facts().coordinates.len();
    let orbits = branches.iter().flat_map(|branch| {
        let points = branch.points.iter();
        points.map(|point| (point, asked.values_at(branch, point)))
    });
    let orbits: Vec<(&Point, Vec<f64>)> = orbits
        .filter(|(point, _)| point.orbit.coordinates() == coordinates)
        .collect();
    let nearest = asked.nearest(&orbits).ok_or_else(|| {
        Failure::Option(format!(
            "--near {}: there is no orbit of {coordinates} coordinates in it",
            path.display()
        ))
    })?;
    let (point, values) = nearest;
    // Its period is taken, unless another one is asked for, which is then refused.
    let request = match options.period {
        1 => request.period(point.orbit.period),
        _ => request,
    };
    let note = asked
        .differences(values)
        .map(|what| format!("--near {}: its nearest orbit has {what}", path.display()));
    Ok((request.near_orbit(&point.orbit), note))
}

/// What the first orbit is asked for at: frequency and parameters by their names.
struct Asked {
    /// Place of what is swept.
    swept: Option<usize>,
    names: Vec<String>,
    values: Vec<f64>,
}

impl Asked {
    fn of(options: &Options, model: &dyn System) -> Self {
        let facts = model.facts();
        let mut values = vec![0.0; facts.parameters.len()];
        model.values(&mut values);
        let parameters = facts.parameters.iter().map(|own| own.name.to_string());
        let names = parameters.chain(["omega".to_owned()]).collect::<Vec<_>>();
        values.push(options.model.frequency());
        let swept = names.iter().position(|name| name == options.varied());
        if let Some(place) = swept {
            values[place] = options.range.from;
        }
        Self {
            swept,
            names,
            values,
        }
    }

    /// The same of an orbit in a file; not a number where nothing is known of that.
    fn values_at(&self, branch: &Branch, point: &Point) -> Vec<f64> {
        let value = |name: &String| {
            let mut parameters = branch.model.parameters.iter();
            match parameters.position(|parameter| parameter.name == *name) {
                _ if name == "omega" => point.omega(),
                Some(place) => point.parameters.get(place).copied().unwrap_or(f64::NAN),
                None => f64::NAN,
            }
        };
        self.names.iter().map(value).collect()
    }

    /// The orbit that differs least, each difference as a part of the largest of all orbits.
    fn nearest<'o>(
        &self,
        orbits: &'o [(&'o Point, Vec<f64>)],
    ) -> Option<&'o (&'o Point, Vec<f64>)> {
        let apart = |values: &[f64], place: usize| (values[place] - self.values[place]).abs();
        let largest: Vec<f64> = (0..self.values.len())
            .map(|place| {
                let all = orbits.iter().map(|(_, values)| apart(values, place));
                all.fold(0.0, f64::max)
            })
            .collect();
        let far = |values: &[f64]| -> f64 {
            let parts = largest.iter().enumerate();
            let parts =
                parts.filter(|(place, largest)| **largest > 0.0 && !values[*place].is_nan());
            parts
                .map(|(place, largest)| apart(values, place) / largest)
                .sum()
        };
        orbits.iter().min_by(|a, b| far(&a.1).total_cmp(&far(&b.1)))
    }

    /// What an orbit has other than what is asked for.
    fn differences(&self, values: &[f64]) -> Option<String> {
        let all = self.names.iter().zip(&self.values).zip(values).enumerate();
        let other = all.filter(|(place, ((_, asked), known))| {
            let allowed = if self.swept == Some(*place) {
                NEAR
            } else {
                SAME
            };
            let size = asked.abs().max(known.abs());
            !known.is_nan() && (*known - *asked).abs() > allowed * size
        });
        let said: Vec<String> = other
            .map(|(_, ((name, asked), known))| {
                format!("{name} = {known}, and {asked} is asked for")
            })
            .collect();
        (!said.is_empty()).then(|| said.join("; "))
    }
}

/// The request with a state at rest, if there is one.
fn at_rest(
    options: &Options,
    model: &dyn System,
    request: FrequencyResponse,
) -> Result<FrequencyResponse, Failure> {
    if options.at_rest.is_empty() {
        return Ok(request);
    }
    values::once(
        "--at-rest",
        options.at_rest.iter().map(|(name, _)| name.as_str()),
    )
    .map_err(Failure::Option)?;
    let coordinates = &model.facts().coordinates;
    let mut state = vec![0.0; 2 * coordinates.len()];
    for (name, value) in &options.at_rest {
        values::finite(&format!("--at-rest {name}"), *value).map_err(Failure::Option)?;
        let place = coordinates.iter().position(|coordinate| coordinate == name);
        let place = place.ok_or_else(|| {
            let known: Vec<String> = coordinates.iter().map(ToString::to_string).collect();
            let known = known.join(", ");
            Failure::Option(format!("--at-rest {name}: the coordinates are {known}"))
        })?;
        state[place] = *value;
    }
    Ok(request.near_state(&state))
}
