//! What a study file asks for and cannot have, or would do nothing.

use std::sync::Arc;

use hertzian::observe::Wanted;
use hertzian::{EventKind, System};

use crate::error::StudyError;
use crate::plan::{Format, Keep, Method, Plan, Request, What};

/// More values than this are not looked at of one variant.
const MOST_VALUES: usize = 1_000_000;

/// What would do nothing, and what cannot be.
pub(crate) fn check_request(plan: &Plan) -> Result<(), StudyError> {
    let Plan {
        request,
        keep,
        formats,
        ..
    } = plan;
    if cfg!(not(feature = "parquet")) && formats.contains(&Format::Parquet) {
        let message = "this program was built without `parquet`: build it with --features parquet";
        return Err(StudyError::value("formats", message));
    }
    let Request { from, to, what, .. } = *request;
    if !(from.is_finite() && to.is_finite() && from != to) {
        let message = format!("from = {from} and to = {to} are no range");
        return Err(StudyError::value("request", message));
    }
    let nothing = |given: bool, key: &str, message: &str| {
        if given {
            Err(StudyError::value(key, message))
        } else {
            Ok(())
        }
    };
    let branches = what == What::Bifurcations;
    let belongs = "it belongs to what = \"bifurcations\", and would do nothing here";
    nothing(
        request.depth.is_some() && !branches,
        "request.depth",
        belongs,
    )?;
    nothing(
        request.max_period.is_some() && !branches,
        "request.max-period",
        belongs,
    )?;
    nothing(request.cover && !branches, "request.cover", belongs)?;
    let other = matches!(
        request.method,
        Some(Method::Shooting | Method::ContactEquation)
    );
    let message = "it is for the balance: the other methods look for all bifurcations";
    nothing(
        request.bifurcations && other,
        "request.bifurcations",
        message,
    )?;
    let solutions = what == What::Solutions;
    let message = "it belongs to what = \"solutions\"; keep.at has the values of other requests";
    nothing(request.at.is_some() && !solutions, "request.at", message)?;
    let message = "it would do nothing where what = \"solutions\": every value has a row";
    nothing(keep.at.is_some() && solutions, "keep.at", message)?;
    nothing(keep.events.is_some() && solutions, "keep.events", message)?;
    nothing(
        !keep.largest.is_empty() && solutions,
        "keep.largest",
        message,
    )?;
    nothing(keep.signals.is_some() && solutions, "keep.signals", message)?;
    nothing(
        keep.sensitivities && solutions,
        "keep.sensitivities",
        message,
    )?;
    nothing(keep.branches && solutions, "keep.branches", message)
}

/// Where values of what varies stand.
pub(crate) fn at_key(what: What) -> &'static str {
    match what {
        What::Solutions => "request.at",
        _ => "keep.at",
    }
}

/// Whether values of what varies are in its range.
pub(crate) fn within(at: Vec<f64>, plan: &Plan) -> Result<Vec<f64>, StudyError> {
    let Request { from, to, what, .. } = plan.request;
    let key = at_key(what);
    if what == What::Solutions && at.is_empty() {
        let message = "solutions are looked for at values: give some";
        return Err(StudyError::value(key, message));
    }
    if at.len() > MOST_VALUES {
        let message = format!("{} values are more than {MOST_VALUES}", at.len());
        return Err(StudyError::value(key, message));
    }
    let range = from.min(to)..=from.max(to);
    match at.iter().find(|value| !range.contains(value)) {
        Some(value) => {
            let message = format!("{value} is not between from = {from} and to = {to}");
            Err(StudyError::value(key, message))
        }
        None => Ok(at),
    }
}

/// The signals of all rows, and those whose largest value has a row.
pub(crate) fn signals(
    system: &Arc<dyn System>,
    plan: &Plan,
) -> Result<[Vec<Wanted>; 2], StudyError> {
    let facts = system.facts();
    let leading = facts.outputs.first().map(|output| output.name.as_ref());
    let leading = leading.or(facts.coordinates.first().map(AsRef::as_ref));
    let default = || {
        leading
            .map(|name| format!("{name}:p2p"))
            .into_iter()
            .collect()
    };
    let model = hertzian::Model::of(&**system);
    let read = |key: &'static str, texts: Vec<String>| {
        let wanted = texts.into_iter().map(|text| {
            let failed = |message: String| StudyError::value(key, format!("`{text}`: {message}"));
            let wanted: Wanted = text
                .parse()
                .map_err(|error: hertzian::RequestError| failed(error.to_string()))?;
            model
                .check(&wanted)
                .map_err(|error| failed(error.to_string()))?;
            Ok(wanted)
        });
        wanted.collect::<Result<Vec<_>, StudyError>>()
    };
    let shown = plan.keep.signals.clone().unwrap_or_else(default);
    let shown = read("keep.signals", shown)?;
    for (place, signal) in shown.iter().enumerate() {
        if shown[..place].contains(signal) {
            return Err(StudyError::value(
                "keep.signals",
                format!("`{signal}` is there twice"),
            ));
        }
    }
    Ok([shown, read("keep.largest", plan.keep.largest.clone())?])
}

/// The kinds of events that have rows.
pub(crate) fn kinds(keep: &Keep) -> Result<Option<Vec<EventKind>>, StudyError> {
    let Some(names) = &keep.events else {
        return Ok(None);
    };
    let kind = |name: &String| {
        name.parse().map_err(|_| {
            let known: Vec<String> = EventKind::ALL.iter().map(ToString::to_string).collect();
            let message = format!("no event `{name}`: there are {}", known.join(", "));
            StudyError::value("keep.events", message)
        })
    };
    names.iter().map(kind).collect::<Result<_, _>>().map(Some)
}
