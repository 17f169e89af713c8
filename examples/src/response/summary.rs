//! What a person reads: what was traced, how it ended, and what is on the branch.

use std::fmt::{self, Write};
use std::path::Path;

use hertzian::{Branch, Point, Verdict};

use super::options::{Options, Sweep};

/// Turns listed one by one; more of them are counted.
const TURNS_LISTED: usize = 4;

/// Title of the picture.
pub fn title(options: &Options) -> String {
    let kind = if options.loses_contact() {
        "One-sided"
    } else {
        "Continuous"
    };
    let Options {
        alpha, zeta, load, ..
    } = options;
    let fixed = match options.sweep {
        Sweep::Omega => format!("A = {}", options.drive),
        Sweep::Drive => format!("ω = {}", options.omega),
    };
    let period = match options.period {
        1 => String::new(),
        n => format!(", period {n}"),
    };
    format!("{kind}, α = {alpha}, ζ = {zeta}, W = {load}, {fixed}{period}")
}

/// The summary of a run.
pub fn of(options: &Options, branch: &Branch<'_>, at: &[Point], written: &[&Path]) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write_all(&mut text, options, branch, at, written);
    text
}

fn write_all(
    text: &mut String,
    options: &Options,
    branch: &Branch<'_>,
    at: &[Point],
    written: &[&Path],
) -> fmt::Result {
    equation(text, options)?;
    range(text, branch)?;
    folds(text, branch)?;
    turns(text, branch)?;
    stability(text, branch)?;
    for point in at {
        writeln!(
            text,
            "at         {} = {}: peak-to-peak {:.6}, {}",
            branch.varied,
            point.value,
            point.peak_to_peak(),
            point.stability.verdict
        )?;
    }
    let milliseconds = 1e3 * branch.elapsed.as_secs_f64();
    writeln!(
        text,
        "time       {milliseconds:.0} ms; {}",
        branch.statistics
    )?;
    let paths = written.iter().map(|path| path.display().to_string());
    writeln!(text, "written    {}", paths.collect::<Vec<_>>().join(", "))
}

fn equation(text: &mut String, options: &Options) -> fmt::Result {
    let Options {
        alpha, zeta, load, ..
    } = options;
    let (force, remark) = if options.loses_contact() {
        (
            "2 zeta H(x) x' + H(x) x^alpha",
            "  one-sided: H(x) = 1 for x > 0, else 0",
        )
    } else {
        ("2 zeta x' + sgn(x) |x|^alpha", "  continuous")
    };
    writeln!(text, "x'' + {force} = drive cos(omega t) + load{remark}")?;
    write!(text, "alpha = {alpha}, zeta = {zeta}, load = {load}")?;
    match options.sweep {
        Sweep::Omega => writeln!(text, ", drive = {}", options.drive)?,
        Sweep::Drive => writeln!(text, ", omega = {}", options.omega)?,
    }
    writeln!(text)
}

fn range(text: &mut String, branch: &Branch<'_>) -> fmt::Result {
    let ends = branch.points.first().zip(branch.points.last());
    if let Some((first, last)) = ends {
        writeln!(
            text,
            "points     {}, {} from {:.6} to {:.6}, {} harmonics",
            branch.points.len(),
            branch.varied,
            first.value,
            last.value,
            first.orbit.harmonics(),
        )?;
    }
    writeln!(text, "ended      {}", branch.stopped)
}

fn folds(text: &mut String, branch: &Branch<'_>) -> fmt::Result {
    if branch.folds().next().is_none() {
        return writeln!(text, "folds      none");
    }
    for fold in branch.folds() {
        writeln!(
            text,
            "fold       {} {:.9}, peak-to-peak {:.6}, error {:.0e}",
            branch.varied,
            fold.point.value,
            fold.point.peak_to_peak(),
            fold.error
        )?;
    }
    Ok(())
}

fn turns(text: &mut String, branch: &Branch<'_>) -> fmt::Result {
    for turn in branch.turns.iter().take(TURNS_LISTED) {
        writeln!(
            text,
            "turn       {} {:.9}, no fold: the slope of the branch jumps there",
            branch.varied, turn.value
        )?;
    }
    let more = branch.turns.len().saturating_sub(TURNS_LISTED);
    if more > 0 {
        writeln!(text, "           and {more} more turns that are no folds")?;
    }
    Ok(())
}

/// Says of a one-sided contact what the method does to it.
fn stability(text: &mut String, branch: &Branch<'_>) -> fmt::Result {
    let mut last: Option<&Point> = None;
    let mut changes = 0;
    for point in &branch.points {
        let verdict = point.stability.verdict;
        if verdict == Verdict::Undecided {
            continue;
        }
        if let Some(before) = last.filter(|before| before.stability.verdict != verdict) {
            changes += 1;
            writeln!(
                text,
                "stability  {} until {} {:.6}, {verdict} from {:.6}",
                before.stability.verdict, branch.varied, before.value, point.value
            )?;
        }
        last = Some(point);
    }
    match last {
        Some(point) if changes == 0 => {
            writeln!(text, "stability  {} throughout", point.stability.verdict)?;
        }
        _ => {}
    }
    let undecided = branch
        .points
        .iter()
        .filter(|point| point.stability.verdict == Verdict::Undecided)
        .count();
    if undecided > 0 {
        writeln!(
            text,
            "           undecided at {undecided} points: within the error of the multipliers"
        )?;
    }
    Ok(())
}
