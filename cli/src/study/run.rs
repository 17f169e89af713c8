//! Runs a study, a part of it, or a merge, and sums up.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Duration;

use hertzian::Cancel;
use hertzian::error::chain;
use hertzian_study::{Folder, Merged, Part, Plan, Prepared, Ran, Runner, StudyError};

use super::options::Options;
use super::read;
use crate::program::{Ended, Failed};
use crate::response::progress::Progress;

/// Computes what is asked for, writes the table, and sums up. Cancelling ends it after what is kept.
///
/// # Errors
/// If the study file cannot be used, or a file cannot be written.
pub fn run(options: &Options, cancel: &Cancel, progress: &mut Progress) -> Result<Ended, Failed> {
    let file = options.file.display();
    let (study, plan) = read::study(&options.file).map_err(|message| {
        // A fault of the study file says where it is.
        let known = message.starts_with(&file.to_string());
        Failed::new(if known {
            message
        } else {
            format!("{file}: {message}")
        })
    })?;
    let prepared = study.prepare();
    let study = prepared.map_err(|error| Failed::new(format!("{file}: {}", chain(&error))))?;
    let place = folder(options, &plan);
    if let Some(folders) = &options.merge {
        let first = [place];
        let folders = if folders.is_empty() {
            &first[..]
        } else {
            folders
        };
        let folders = folders
            .iter()
            .map(|folder| Folder::existing(folder, &study));
        let folders = folders.collect::<Result<Vec<_>, _>>()?;
        return table(&study, &folders, None, cancel, progress);
    }
    #[cfg(feature = "mpi")]
    if let Some(ranks) = super::ranks::ranks(options) {
        return super::ranks::run(&ranks, &study, &place, cancel, progress);
    }
    let folder = Folder::open(&place, &study)?;
    let ran = compute(options, &study, &folder, cancel, progress)?;
    if options.part.is_some() || ran.interrupted {
        return Ok(kept(&ran, options.part.is_some()));
    }
    table(&study, &[folder], Some(&ran), cancel, progress)
}

/// Writes one table of all, and its pictures.
pub(super) fn table(
    study: &Prepared,
    folders: &[Folder],
    ran: Option<&Ran>,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<Ended, Failed> {
    progress.update(|| "one table of all".to_owned());
    let mut merged = study.merge(folders)?;
    progress.update(|| "pictures".to_owned());
    let drawn = study.draw(folders, cancel);
    let fault = drawn.map(|files| merged.files.extend(files)).err();
    let mut ended = ended(&merged, ran);
    // The table is there: what cannot be drawn is said with it.
    if let Some(error) = fault {
        let said = format!("pictures: {}", chain(&error));
        ended.complaints.push(said);
        ended.complete = false;
    }
    Ok(ended)
}

/// The folder of the results.
fn folder(options: &Options, plan: &Plan) -> PathBuf {
    let named = options.out.clone();
    let named = named.or_else(|| {
        plan.results
            .as_ref()
            .map(|path| read::beside(&options.file, path))
    });
    named.unwrap_or_else(|| {
        let stem = options
            .file
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy();
        options.file.with_file_name(format!("{stem}-results"))
    })
}

fn compute(
    options: &Options,
    study: &Prepared,
    folder: &Folder,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<Ran, StudyError> {
    let runner = Runner::new(study, folder)
        .part(options.part.unwrap_or(Part::WHOLE))
        .threads(options.threads.unwrap_or(0).into())
        .cancel(cancel);
    runner.run(&mut shown(progress))
}

/// Shows how many variants are done, and the time left.
pub(super) fn shown(
    progress: &mut Progress,
) -> impl FnMut(hertzian::Progress<'_>) -> ControlFlow<()> + Send + '_ {
    let started = std::time::Instant::now();
    let mut before = None;
    move |done| {
        let total = done.total.unwrap_or(done.done);
        let before = *before.get_or_insert(done.done.saturating_sub(1));
        // Two threads may tell what they have counted in the other order.
        let each = started.elapsed() / done.done.saturating_sub(before).max(1) as u32;
        let left = each * total.saturating_sub(done.done) as u32;
        progress.update(|| format!("{} of {total} variants, {} left", done.done, clock(left)));
        ControlFlow::Continue(())
    }
}

/// A time in hours, minutes and seconds.
fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    match hours {
        0 => format!("{minutes}:{seconds:02}"),
        _ => format!("{hours}:{minutes:02}:{seconds:02}"),
    }
}

/// What is said of a run without a table.
pub(super) fn kept(ran: &Ran, is_part: bool) -> Ended {
    let mut complaints = ran.damaged.clone();
    if ran.interrupted {
        complaints.push("interrupted: the same command goes on with what is missing".to_owned());
    }
    Ended {
        summary: said(ran, is_part),
        complaints,
        complete: !ran.interrupted,
    }
}

fn said(ran: &Ran, is_part: bool) -> String {
    let of = if is_part { " of this part" } else { "" };
    let (now, seconds) = (ran.computed, ran.elapsed.as_secs_f64());
    // Rank 0 of several does not know how long the others worked.
    let busy = if ran.worked.is_zero() {
        String::new()
    } else {
        let busy = ran.worked.as_secs_f64() / seconds.max(1e-9);
        format!(", {busy:.2} threads busy")
    };
    let kept = ran.before + now;
    format!(
        "computed   {now} variants in {seconds:.1} s{busy}; {kept} of {} are kept{of}\n",
        ran.asked
    )
}

/// What is said of a table.
fn ended(merged: &Merged, ran: Option<&Ran>) -> Ended {
    let mut complaints: Vec<String> = ran
        .into_iter()
        .flat_map(|ran| ran.damaged.clone())
        .collect();
    complaints.extend(merged.damaged.iter().cloned());
    if !merged.missing.is_empty() {
        let ranges = merged
            .missing
            .iter()
            .take(RANGES)
            .map(|[from, to]| format!("{from} to {to}"));
        let ranges = ranges.collect::<Vec<_>>().join(", ");
        let more = if merged.missing.len() > RANGES {
            ", .."
        } else {
            ""
        };
        complaints.push(format!(
            "{} variants are not there, and not in the table: {ranges}{more}",
            merged.lost()
        ));
    }
    if merged.failed > 0 {
        complaints.push(format!(
            "{} of {} variants could not be computed: rows `failed` say why",
            merged.failed, merged.variants
        ));
    }
    let computed = ran.map(|ran| said(ran, false)).unwrap_or_default();
    Ended {
        summary: format!("{computed}{merged}"),
        complete: merged.missing.is_empty() && merged.failed == 0,
        complaints,
    }
}

/// Ranges of missing variants that are said.
const RANGES: usize = 8;
