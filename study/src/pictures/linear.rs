//! What linear propagation says of the place of an event: a normal distribution to draw over a histogram.
//!
//! The place `v` at the means of all that varies, and its derivatives there, give to first order
//!
//! ```text
//! mean = v(m_1, m_2, ..),    deviation^2 = sum over k of (dv/dp_k)^2 s_k^2                                       (1)
//! ```
//!
//! with the means `m_k` and the deviations `s_k` of parameters that vary independently. Where the derivatives change over a deviation, or the
//! event is lost, that is not what variants do: their histogram leans, or has another width.
//!
//! Source: JCGM 100:2008, Guide to the expression of uncertainty in measurement, 5.1.2.

use hertzian::Cancel;
use statrs::distribution::Normal;

use super::{better, is, number, place};
use crate::plan::Picture;
use crate::study::Prepared;
use crate::table::Value;

/// By (1), of the event that counts in a histogram.
///
/// # Errors
/// Why there is none.
pub(super) fn linear(
    study: &Prepared,
    picture: &Picture,
    kind: &str,
    cancel: &Cancel,
) -> Result<Normal, String> {
    let moments = study
        .designed
        .moments()
        .ok_or("nothing has a distribution")?;
    let middle = study.middle(moments.iter().map(|[mean, _]| *mean).collect());
    let found = middle.found(0, cancel);
    let rows = found.map_err(|_| "it was interrupted")?.rows;
    let column = |name: &str| place(&middle, name);
    let [row, kinds, value, without, ended] =
        ["row", "kind", "value", "without", "ended"].map(column);
    let written = |row: &Vec<Value>, place: usize| row.get(place).map(Value::written);
    let events = rows.iter().filter_map(|found| {
        let is_one = is(found, row, "event") && is(found, kinds, kind);
        Some((number(found, value).filter(|_| is_one)?, found))
    });
    let counts = events.reduce(|one, other| {
        if better(picture.which, Some(one.0), other.0) == one.0 {
            one
        } else {
            other
        }
    });
    let Some((mean, event)) = counts else {
        let said = rows.first().and_then(|found| written(found, ended));
        let said = said.unwrap_or_default();
        return Err(format!("at the means there is no {kind}: {said}"));
    };
    let slopes = middle
        .by
        .iter()
        .map(|name| number(event, column(&format!("by_{name}"))));
    let slopes: Option<Vec<f64>> = slopes.collect();
    let slopes = slopes.ok_or_else(|| written(event, without).unwrap_or_default())?;
    let both = slopes.iter().zip(&moments);
    let squares = both.map(|(slope, [_, deviation])| (slope * deviation).powi(2));
    let deviation = squares.sum::<f64>().sqrt();
    Normal::new(mean, deviation)
        .map_err(|_| format!("{mean} with the deviation {deviation} is no normal distribution"))
}
