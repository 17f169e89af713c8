//! How often an event lies where: a histogram with quantiles.
//!
//! Bins are as wide as Freedman and Diaconis (1981) say: twice the distance of the quartiles over the cube root of the number. A distribution is
//! drawn over them by its density times the width of a bin and the number of values.

use std::io;

use hertzian::Cancel;
use hertzian::chart::{Chart, Series};

use statrs::distribution::{Continuous, ContinuousCDF, Normal};

use super::linear::linear;
use super::{along, better, is, number, percent, place, quantile, quantiles};
use crate::merge::Source;
use crate::plan::Picture;
use crate::table::Value;

/// Bins, at least and at most.
const BINS: [f64; 2] = [5.0, 60.0];
/// Parts of a density that is drawn.
const POINTS: usize = 100;

/// The chart.
pub(super) fn chart(source: &Source<'_>, picture: &Picture, cancel: &Cancel) -> io::Result<Chart> {
    let study = source.study;
    let kind = picture.kind.as_deref().unwrap_or("fold");
    let mut places = places(source, picture, kind)?;
    places.sort_by(f64::total_cmp);
    let title = format!(
        "{} {kind} of {} variants of {}",
        picture.which,
        places.len(),
        hertzian::Model::of(&*study.system).name
    );
    let mut chart = Chart::new(title).x(along(study)).y("number of variants");
    let (Some(&low), Some(&high)) = (places.first(), places.last()) else {
        return Ok(chart.remark(format!("no variant has an event of kind {kind}")));
    };
    let Bars { outline, most, bin } = bars(&places, low, high);
    let bars = Series::new("variants", outline);
    chart = chart.trace(bars.clone()).area(bars);
    let parts = quantiles(picture);
    for (number, part) in parts.iter().enumerate() {
        let value = quantile(&places, *part);
        let label = if number == 0 { "quantiles" } else { "" };
        let line = [[value, 0.0], [value, most]];
        chart = chart.reference(Series::new(label, line));
    }
    let said = |value: &dyn Fn(f64) -> f64| {
        let parts = parts.iter();
        let said = parts.map(|part| format!("{} {:.6}", percent(*part), value(*part)));
        said.collect::<Vec<_>>().join(", ")
    };
    chart = chart.remark(format!(
        "quantiles: {}",
        said(&|part| quantile(&places, part))
    ));
    if !picture.linear {
        return Ok(chart);
    }
    Ok(match linear(study, picture, kind, cancel) {
        Ok(normal) => chart
            .trace(density(normal, bin * places.len() as f64))
            .remark(format!(
                "linear propagation: {}",
                said(&|part| normal.inverse_cdf(part))
            )),
        Err(why) => chart.remark(format!("no linear propagation: {why}")),
    })
}

/// The density of a normal distribution times a number, but for a ten-thousandth at each end.
fn density(normal: Normal, times: f64) -> Series {
    let ends = [1e-4, 1.0 - 1e-4].map(|part| normal.inverse_cdf(part));
    let points = (0..=POINTS).map(|point| {
        let part = point as f64 / POINTS as f64;
        let value = ends[0] + part * (ends[1] - ends[0]);
        [value, times * normal.pdf(value)]
    });
    Series::new("linear propagation", points.collect::<Vec<_>>())
}

/// The place of the event of every variant that has it.
fn places(source: &Source<'_>, picture: &Picture, kind: &str) -> io::Result<Vec<f64>> {
    let columns = ["row", "kind", "value"].map(|name| place(source.study, name));
    let mut places = Vec::new();
    // Rows of a variant follow one after the other.
    let mut last: Option<(Value, f64)> = None;
    source.each(|row| {
        let Some(value) = number(&row, columns[2]) else {
            return Ok(());
        };
        if !is(&row, columns[0], "event") || !is(&row, columns[1], kind) {
            return Ok(());
        }
        last = match last.take() {
            Some((variant, known)) if variant == row[0] => {
                Some((variant, better(picture.which, Some(known), value)))
            }
            before => {
                places.extend(before.map(|(_, known)| known));
                Some((row[0].clone(), value))
            }
        };
        Ok(())
    })?;
    places.extend(last.map(|(_, known)| known));
    Ok(places)
}

/// How many values are where.
struct Bars {
    outline: Vec<[f64; 2]>,
    /// The highest.
    most: f64,
    /// Width of each.
    bin: f64,
}

fn bars(places: &[f64], low: f64, high: f64) -> Bars {
    let count = places.len() as f64;
    let width = 2.0 * (quantile(places, 0.75) - quantile(places, 0.25)) / count.cbrt();
    let range = if high > low {
        high - low
    } else {
        low.abs().max(1.0) * 1e-3
    };
    let bins = (range / width).clamp(BINS[0], BINS[1]).ceil();
    let bins = if bins.is_nan() { BINS[0] } else { bins };
    let mut counts = vec![0.0; bins as usize];
    for value in places {
        let bin = ((value - low) / range * bins) as usize;
        counts[bin.min(bins as usize - 1)] += 1.0;
    }
    let at = |edge: usize| low + range * edge as f64 / bins;
    let mut points = vec![[low, 0.0]];
    for (bin, &count) in counts.iter().enumerate() {
        points.extend([[at(bin), count], [at(bin + 1), count]]);
    }
    points.push([at(counts.len()), 0.0]);
    Bars {
        outline: points,
        most: counts.into_iter().fold(0.0, f64::max),
        bin: range / bins,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_hold_every_value_once() {
        let places: Vec<f64> = (0..1000).map(|index| f64::from(index) / 999.0).collect();
        let Bars { outline, most, bin } = bars(&places, 0.0, 1.0);
        // Twice half of the range over ten: ten bins.
        assert_eq!((outline.len(), bin), (22, 0.1));
        let sum: f64 = outline[1..21].iter().step_by(2).map(|point| point[1]).sum();
        assert_eq!((sum, most), (1000.0, 100.0));
        // All in one place.
        let Bars { outline, most, .. } = bars(&[2.0, 2.0], 2.0, 2.0);
        assert_eq!((outline[1], most), ([2.0, 2.0], 2.0));
    }
}
