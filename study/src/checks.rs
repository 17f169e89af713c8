//! What a study file asks for and cannot have, or would do nothing.

use crate::error::StudyError;
use crate::plan::{Format, Method, Plan, Request, What};

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
    nothing(keep.branches && solutions, "keep.branches", message)
}
