//! How long a point of a branch takes on structures with contacts, by the contact equation: one branch, one line of a table.
//!
//! ```sh
//! hertzian-structure-times bar 20 with 60       # 20 modes, with verdicts, ends after the first point beyond 60 s
//! hertzian-structure-times bar-reduced 2000 without 60    # the bar of so many modes, by the vectors that a reduction keeps by itself
//! hertzian-structure-times file plate.toml:700:1400 without 60
//! ```
//!
//! Time is that of the process on all of its threads. What is done until the first point is there is counted by itself: in it are the modes of
//! the structure, and the search for a first orbit.

mod models;

use std::error::Error;
use std::ops::ControlFlow;

use cpu_time::ProcessTime;

use hertzian::system::System;
use hertzian::{ContactEquation, FrequencyResponse, HarmonicBalance, Orbit, Verdict};
use hertzian_structure::{Reduction, SparseStructure, file};

use models::{Elastic, Hertz, Modes, Rotor, chain, shaft};

/// Frequencies of the cage over which rotors are followed.
const ROTOR: [f64; 2] = [0.36, 0.2];

/// What is followed, and what was done before.
struct Case {
    system: Box<dyn System>,
    range: [f64; 2],
    /// An orbit that the first one is near.
    near: Option<Orbit>,
    coordinates: usize,
    /// Seconds of the reduction.
    reduction: f64,
}

impl Case {
    fn of(kind: &str, size: &str) -> Result<Self, Box<dyn Error>> {
        if kind == "file" {
            return Self::of_file(size);
        }
        let count: usize = size.parse()?;
        let bar = [1.4, 1.8];
        let cantilever = [3.3, 3.73];
        let (system, range): (Box<dyn System>, _) = match kind {
            "bar" => (Box::new(Modes::bar(count).stopped(Elastic, 10.0)?), bar),
            "bar-hertz" => (Box::new(Modes::bar(count).stopped(Hertz, 10.0)?), bar),
            "cantilever" => {
                let modes = Modes::cantilever(count);
                (Box::new(modes.stopped(Elastic, 50.0)?), cantilever)
            }
            "cantilever-hertz" => {
                let modes = Modes::cantilever(count);
                (Box::new(modes.stopped(Hertz, 500.0)?), cantilever)
            }
            "chain" => (Box::new(chain(count, count)?), [0.2, 0.3]),
            "chain-one" => (Box::new(chain(count, 1)?), [0.275, 0.298]),
            "rotor" => (Box::new(Rotor::default()), ROTOR),
            "bar-reduced" => {
                return Self::reduced(&Modes::bar(count).sparse(Elastic, 10.0)?, bar, None);
            }
            "bar-hertz-reduced" => {
                return Self::reduced(&Modes::bar(count).sparse(Hertz, 10.0)?, bar, None);
            }
            "cantilever-reduced" => {
                let modes = Modes::cantilever(count);
                return Self::reduced(&modes.sparse(Elastic, 50.0)?, cantilever, None);
            }
            "cantilever-hertz-reduced" => {
                let modes = Modes::cantilever(count);
                return Self::reduced(&modes.sparse(Hertz, 500.0)?, cantilever, None);
            }
            "rotor-modes" => return Self::of_modes(&shaft(count)?),
            _ => return Err(format!("no case {kind}").into()),
        };
        let near = (kind == "rotor")
            .then(|| near_rest(&*system, range[0]))
            .transpose()?;
        Ok(Self {
            near,
            coordinates: system.facts().coordinates.len(),
            system,
            range,
            reduction: 0.0,
        })
    }

    /// By the vectors of a reduction with so many modes, or with those that it keeps where nothing is asked of it.
    fn reduced(
        structure: &SparseStructure,
        range: [f64; 2],
        modes: Option<usize>,
    ) -> Result<Self, Box<dyn Error>> {
        let begin = ProcessTime::now();
        let mut reduction = Reduction::to(range[1]);
        if let Some(modes) = modes {
            reduction = reduction.modes(modes);
        }
        let reduced = reduction.run(structure)?;
        Ok(Self {
            reduction: begin.elapsed().as_secs_f64(),
            coordinates: reduced.vectors(),
            system: Box::new(reduced.structure(structure)?),
            range,
            near: None,
        })
    }

    /// A rotor by all of its modes.
    fn of_modes(structure: &SparseStructure) -> Result<Self, Box<dyn Error>> {
        let begin = ProcessTime::now();
        let reduction = Reduction::to(ROTOR[0]).modes(structure.coordinates());
        let reduced = reduction.steps(0).run(structure)?;
        let system: Box<dyn System> = Box::new(reduced.structure(structure)?);
        let reduction = begin.elapsed().as_secs_f64();
        Ok(Self {
            near: None,
            coordinates: reduced.vectors(),
            system,
            range: ROTOR,
            reduction,
        })
    }

    /// `FILE:FROM:TO` or `FILE:FROM:TO:MODES`
    fn of_file(described: &str) -> Result<Self, Box<dyn Error>> {
        let mut parts = described.split(':');
        let mut part = || parts.next().ok_or("FILE:FROM:TO");
        let path = part()?;
        let (from, to) = (part()?.parse()?, part()?.parse()?);
        let modes: Option<usize> = part().ok().map(str::parse).transpose()?;
        let structure = file::read(path)?;
        Self::reduced(&structure, [from, to], modes)
    }
}

/// An orbit by few harmonics: shooting, which is asked for a first one by default, takes minutes for the motions of many coordinates that are not
/// known in closed form.
fn near_rest(system: &dyn System, omega: f64) -> Result<Orbit, Box<dyn Error>> {
    let request = FrequencyResponse::of(system).stability(false);
    let balance = HarmonicBalance::new().harmonics(48);
    Ok(request.by(balance).orbit(omega)?.orbit)
}

/// Times of a branch and what it states.
fn line(case: &Case, verdicts: bool, seconds: f64) -> Result<String, Box<dyn Error>> {
    let begin = ProcessTime::now();
    let mut times = Vec::new();
    let request = FrequencyResponse::of(&*case.system).by(ContactEquation::new());
    let [from, to] = case.range;
    let mut request = request.from(from).to(to).stability(verdicts);
    let mut said = 0.0;
    // As the program asks for by default.
    if let Some(output) = case.system.facts().outputs.first() {
        request = request.accuracy_of(output.name.to_string());
    }
    if let Some(orbit) = &case.near {
        request = request.near_orbit(orbit);
    }
    let branch = request.run_with(|progress| {
        let time = begin.elapsed().as_secs_f64();
        times.push(time);
        // Lines at every point would be a part of what is timed.
        if time > said + 1.0 {
            let at = progress.value.unwrap_or(f64::NAN);
            eprintln!("{} points to {at:.6} after {time:.1} s", progress.done);
            said = time;
        }
        if time > seconds {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    })?;
    let whole = begin.elapsed().as_secs_f64();
    let first = times.first().copied().unwrap_or(whole);
    let points = branch.points.len();
    let point = (whole - first) / (points - 1).max(1) as f64;
    let mut errors: Vec<f64> = branch
        .points
        .iter()
        .filter_map(|point| point.error)
        .collect();
    errors.sort_by(f64::total_cmp);
    let middle = errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN);
    let largest = errors.last().copied().unwrap_or(f64::NAN);
    let decided = branch.points.iter();
    let decided = decided.filter(|point| point.stability.verdict != Verdict::Undecided);
    let each = |count: usize| count as f64 / points as f64;
    let statistics = branch.statistics;
    Ok(format!(
        "{}\t{points}\t{}\t{}\t{:.1}\t{:.4}\t{:.4}\t{:.3}\t{middle:.0e}\t{largest:.0e}\t{:.1}\t{:.1}\t{:.0}\t{:?}",
        case.coordinates,
        branch.events.len(),
        decided.count(),
        1e6 * point,
        first,
        whole,
        case.reduction,
        each(statistics.jacobians),
        each(statistics.residuals),
        peak_memory(),
        branch.stopped,
    ))
}

/// The most memory that the process has had, in MB; not a number where the system does not say.
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok());
    kilobytes.map_or(f64::NAN, |kilobytes: f64| kilobytes / 1024.0)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [kind, size, verdicts, seconds] = &arguments[..] else {
        return Err("hertzian-structure-times CASE SIZE with|without SECONDS".into());
    };
    let case = Case::of(kind, size)?;
    let shown = if kind == "file" { "solid" } else { kind };
    println!(
        "{shown}\t{verdicts}\t{}",
        line(&case, verdicts == "with", seconds.parse()?)?
    );
    Ok(())
}
