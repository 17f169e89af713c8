//! `--lyapunov`: Lyapunov exponents.

use std::fmt::Write;

use hertzian::Estimate;
use hertzian::attractors::lyapunov::Lyapunov;
use hertzian::chart::{Chart, Page, Series};

use super::output::{Results, Table};
use super::run::{Failure, Task};

/// Computes the exponents at each amplitude.
///
/// # Errors
/// If an option cannot be used, or a motion cannot be computed.
pub fn run(task: &Task<'_>) -> Result<Results, Failure> {
    let options = task.options;
    let order = 2 * task.system.facts().coordinates.len();
    let batches = options.batches;
    let length = options.periods.unwrap_or(400_000).div_ceil(batches).max(1);
    let parts = (1..=order).flat_map(|i| [format!("exponent_{i}"), format!("standard_error_{i}")]);
    let names = ["drive", "periods"].map(str::to_owned).into_iter();
    let names = names
        .chain(parts)
        .chain(["sum", "divergence"].map(str::to_owned));
    let mut table = Table::new(names.collect());
    let mut page = Page::new(1);
    let mut summary = String::new();
    let mut complete = true;
    for drive in task.drives() {
        let values = task.values(drive)?;
        let mut map = task.map(drive)?;
        let start = task.start()?;
        let omega = options.model.frequency();
        let lyapunov = Lyapunov::new(&mut map, &start);
        let mut lyapunov = lyapunov.with_divergence(task.system, &values, omega)?;
        for _ in 0..options.transient.unwrap_or(5000) {
            if !task.goes_on() {
                break;
            }
            lyapunov.settle(1)?;
        }
        for batch in 0..batches {
            if !task.goes_on() {
                complete = false;
                break;
            }
            lyapunov.batch(length)?;
            task.say(|| format!("batch {} of {batches}", batch + 1));
        }
        if lyapunov.batches().is_empty() {
            break;
        }
        let found = lyapunov.exponents();
        let divergence = lyapunov.divergence().unwrap_or_default();
        let periods = (lyapunov.batches().len() * length) as f64;
        let mut row = vec![task.amplitude(drive)?, periods];
        row.extend(found.iter().flat_map(|e| [e.value, e.error]));
        row.extend([lyapunov.sum().value, divergence.value]);
        table.row(&row);
        describe(&mut summary, &task.title(drive, "")?, &lyapunov);
        let largest: Vec<f64> = lyapunov.batches().iter().map(|b| b[0]).collect();
        page = page.chart(chart(&task.title(drive, "")?, &largest, length, found[0]));
    }
    Ok(table.with(page.to_svg(), summary, complete)?)
}

fn describe(text: &mut String, title: &str, motion: &Lyapunov<'_>) {
    // Writing to a string does not fail.
    let _ = writeln!(text, "{title}");
    for (index, exponent) in motion.exponents().iter().enumerate() {
        let _ = writeln!(text, "exponent   {}: {exponent} per period", index + 1);
    }
    let divergence = motion.divergence().unwrap_or_default();
    let _ = writeln!(
        text,
        "sum        {:.12}; the divergence over the same motion gives {:.12} +- {:.0e}",
        motion.sum().value,
        divergence.value,
        divergence.error
    );
}

/// How the mean of the largest exponent settles.
fn chart(title: &str, batches: &[f64], length: usize, largest: Estimate) -> Chart {
    let at = |index: usize| ((index + 1) * length) as f64;
    let mut sum = 0.0;
    let means = batches.iter().enumerate().map(|(index, batch)| {
        sum += batch;
        [at(index), sum / (index + 1) as f64]
    });
    let means: Vec<[f64; 2]> = means.collect();
    let ends = [at(0), at(batches.len() - 1)];
    let level = |by: f64| {
        let value = largest.value + by * largest.error;
        ends.map(|x| [x, value]).to_vec()
    };
    let mut chart = Chart::new(title)
        .x("periods")
        .y("largest Lyapunov exponent per period")
        .trace(Series {
            label: "mean so far".to_owned(),
            points: means,
        })
        .cloud(Series {
            label: "means of batches".to_owned(),
            points: batches
                .iter()
                .enumerate()
                .map(|(i, &b)| [at(i), b])
                .collect(),
        });
    if largest.error.is_finite() {
        for (by, label) in [(-1.0, "one standard error"), (1.0, "")] {
            chart = chart.trace(Series {
                label: label.to_owned(),
                points: level(by),
            });
        }
    }
    chart
}
