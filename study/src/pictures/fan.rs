//! A fan: at every value of what varies along the branches, quantiles over the variants.

use std::collections::BTreeMap;
use std::io;

use hertzian::chart::{Chart, Series};

use super::{along, better, is, number, percent, place, quantile, quantiles};
use crate::merge::Source;
use crate::plan::Picture;
use crate::table::Value;

/// The chart. Of several orbits at a value the highest or the lowest counts, of those that are not unstable.
pub(super) fn chart(source: &Source<'_>, picture: &Picture) -> io::Result<Chart> {
    let study = source.study;
    let signal = picture
        .of
        .clone()
        .or_else(|| study.signals.first().map(ToString::to_string));
    let signal = signal.unwrap_or_default();
    let columns = ["row", "value", signal.as_str(), "verdict"].map(|name| place(study, name));
    let mut sizes: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    let mut of_variant: BTreeMap<usize, f64> = BTreeMap::new();
    let mut variant = Value::Missing;
    let mut variants = 0_usize;
    source.each(|row| {
        if row[0] != variant {
            variants += 1;
            variant = row[0].clone();
            for (at, size) in std::mem::take(&mut of_variant) {
                sizes.entry(at).or_default().push(size);
            }
        }
        let [value, size] = [number(&row, columns[1]), number(&row, columns[2])];
        if let (Some(value), Some(size)) = (value, size)
            && is(&row, columns[0], "at")
            && !is(&row, columns[3], "unstable")
            && let Some(at) = study.at.iter().position(|at| *at == value)
        {
            let known = of_variant.get(&at).copied();
            of_variant.insert(at, better(picture.which, known, size));
        }
        Ok(())
    })?;
    for (at, size) in of_variant {
        sizes.entry(at).or_default().push(size);
    }
    for sizes in sizes.values_mut() {
        sizes.sort_by(f64::total_cmp);
    }
    let title = format!(
        "{} {signal} of {variants} variants of {}",
        picture.which,
        hertzian::Model::of(&*study.system).name
    );
    let mut chart = Chart::new(title)
        .x(along(study))
        .y(labelled(source, &signal));
    for part in quantiles(picture) {
        let points = (0..study.at.len()).map(|at| {
            let size = sizes
                .get(&at)
                .map_or(f64::NAN, |sizes| quantile(sizes, part));
            [study.at[at], size]
        });
        chart = chart.trace(Series {
            label: percent(part),
            points: points.collect(),
        });
    }
    Ok(chart)
}

/// The label of the vertical axis.
fn labelled(source: &Source<'_>, signal: &str) -> String {
    let study = source.study;
    let wanted = study
        .signals
        .iter()
        .find(|known| known.to_string() == signal);
    let Some(wanted) = wanted else {
        return signal.to_owned();
    };
    let model = hertzian::Model::of(&*study.system);
    let words = format!("{} of {}", wanted.measure.in_words(), wanted.name);
    match wanted.measure.unit(model.unit_of(&wanted.name)) {
        unit if unit.is_empty() => words,
        unit => format!("{words} [{unit}]"),
    }
}
