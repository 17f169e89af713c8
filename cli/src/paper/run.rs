//! From options to a folder with pictures, data and a page.

use hertzian::Cancel;
use std::io;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use hertzian::export;

use super::figure::{Drawing, Figure, Table, Task};
use super::figures::FIGURES;
use super::options::Options;
use super::page;
use crate::response::files;
use crate::response::places;
use crate::response::progress::Progress;

/// A figure, what came of it, and the time it took.
pub struct Drawn {
    /// The figure.
    pub figure: &'static Figure,
    /// What came of it, or why nothing did.
    pub drawing: Result<Drawing, String>,
    /// How long it took.
    pub elapsed: Duration,
}

/// A file that could not be written, and why.
#[derive(Debug)]
pub struct Failure(pub PathBuf, pub io::Error);

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "cannot write {}: {}", self.0.display(), self.1)
    }
}

impl std::error::Error for Failure {}

/// Draws the figures and writes the page. Cancelling ends it; what is done by then is written.
///
/// # Errors
/// If a file cannot be written.
pub fn run(
    options: &Options,
    cancel: &Cancel,
    progress: &mut Progress,
) -> Result<Vec<Drawn>, Failure> {
    let folder = &options.out;
    places::make_folder(folder).map_err(|error| Failure(folder.clone(), error))?;
    let asked: Vec<&'static Figure> = FIGURES
        .iter()
        .filter(|figure| options.only.is_empty() || options.only.iter().any(|id| id == figure.id))
        .collect();
    // The chaotic ones take longest: with them first, no thread waits for another in the end.
    let mut order: Vec<usize> = (0..asked.len()).collect();
    order.sort_by_key(|&index| !asked[index].long);
    let threads = options
        .threads
        .or_else(|| thread::available_parallelism().ok())
        .map_or(1, NonZeroUsize::get)
        .min(asked.len());
    let started = Instant::now();
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, Drawn)>> = Mutex::new(Vec::new());
    let failed: Mutex<Option<Failure>> = Mutex::new(None);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while !cancel.is_cancelled() {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(&index) = order.get(index) else {
                        break;
                    };
                    let drawn = draw(asked[index], cancel);
                    if let Err(failure) = write(&drawn, folder) {
                        *lock(&failed) = Some(failure);
                        break;
                    }
                    lock(&done).push((index, drawn));
                }
            });
        }
        while lock(&done).len() < asked.len() && !cancel.is_cancelled() && lock(&failed).is_none() {
            progress.update(|| bar(lock(&done).len(), asked.len(), started.elapsed()));
            thread::sleep(Duration::from_millis(20));
        }
    });
    if let Some(failure) = lock(&failed).take() {
        return Err(failure);
    }
    let mut done = std::mem::take(&mut *lock(&done));
    done.sort_by_key(|(index, _)| *index);
    let done: Vec<Drawn> = done.into_iter().map(|(_, drawn)| drawn).collect();
    let path = folder.join("index.html");
    let html = page::html(&done, started.elapsed(), threads);
    export::write(&path, html).map_err(|error| Failure(path, error))?;
    Ok(done)
}

/// A lock whose holder panicked is as good as any here: a list of what is done.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn draw(figure: &'static Figure, cancel: &Cancel) -> Drawn {
    let started = Instant::now();
    let drawing = (figure.draw)(&Task { figure, cancel });
    Drawn {
        figure,
        drawing,
        elapsed: started.elapsed(),
    }
}

fn write(drawn: &Drawn, folder: &Path) -> Result<(), Failure> {
    let Ok(drawing) = &drawn.drawing else {
        return Ok(());
    };
    let svg = folder.join(drawn.figure.id).with_extension("svg");
    export::write(&svg, &drawing.svg).map_err(|error| Failure(svg, error))?;
    let csv = folder.join(drawn.figure.id).with_extension("csv");
    write_csv(&csv, &drawing.data).map_err(|error| Failure(csv, error))
}

fn write_csv(path: &Path, table: &Table) -> io::Result<()> {
    files::write_csv(path, |writer| {
        writer.write_record(&table.names)?;
        table
            .rows
            .iter()
            .try_for_each(|row| writer.write_record(row))
    })
}

/// How much is done.
fn bar(done: usize, all: usize, elapsed: Duration) -> String {
    const WIDTH: usize = 30;
    let full = WIDTH * done / all.max(1);
    let (full, rest) = ("#".repeat(full), ".".repeat(WIDTH - full));
    format!(
        "[{full}{rest}] {done} of {all} figures, {:.0} s",
        elapsed.as_secs_f64()
    )
}
