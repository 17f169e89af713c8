//! Curves of Figs. 2a, 4a and 5 of Wang et al. (2021) by three methods, with multipliers and folds: `cargo bench -p hertzian --bench methods`.
//!
//! All methods run in turns, so that what else the machine does falls on all alike; the time is that of the processor, the median of the
//! turns. With arguments, `methods 5b contact 1e-6`, one of them runs once, for a program that counts.

use std::time::Duration;

use cpu_time::ThreadTime;
use hertzian::{
    Branch, ContactEquation, Error, FrequencyResponse, HarmonicBalance, Shooting, System,
    oscillator,
};

oscillator! {
    /// One-sided contact with a linear spring.
    Linear(x) {
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
    }
}

oscillator! {
    /// One-sided contact of two spheres.
    Hertz(x) {
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
    }
}

oscillator! {
    /// One-sided contact, softer the further it is pressed.
    Soft(x) {
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap^0.6, else => 0 }
        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
    }
}

oscillator! {
    /// A contact that cannot open.
    Continuous(x) {
        param load;
        law spring(gap) { gap > 0 => gap^1.5, else => -(-gap)^1.5 }
        ddot(x) + 0.02*dot(x) + spring(x) = 0.1*cos(omega*t) + load;
    }
}

/// A curve, and the folds in its range. They were computed apart from this project: those of exponent one by closed forms between
/// switches in 80 bits, the others by event-located integration of order eight in 80 bits, with errors below 1e-12.
struct Figure {
    name: &'static str,
    system: Box<dyn System>,
    range: [f64; 2],
    folds: &'static [f64],
}

fn figures() -> [Figure; 5] {
    [
        Figure {
            name: "2a",
            system: Box::new(Continuous { load: 0.0 }),
            range: [0.6, 1.7],
            folds: &[0.909_513_715_044_238, 1.332_696_002_393_464],
        },
        Figure {
            name: "4a",
            system: Box::new(Continuous { load: 1.0 }),
            range: [0.7, 1.7],
            folds: &[
                1.095_028_606_745_39,
                1.136_461_722_203_842,
                1.158_212_487_926_707,
                1.337_227_934_760_159,
            ],
        },
        Figure {
            name: "5a",
            system: Box::new(Linear {}),
            range: [0.6, 1.4],
            folds: &[0.715_119_549_676_419, 0.960_163_671_878_57],
        },
        Figure {
            name: "5b",
            system: Box::new(Hertz {}),
            range: [0.6, 1.6],
            folds: &[0.685_842_253_572_486, 1.144_516_913_788_162],
        },
        Figure {
            name: "5c",
            system: Box::new(Soft {}),
            range: [0.5, 1.2],
            folds: &[
                0.631_308_249_440_869,
                0.765_568_492_941_199,
                0.845_526_217_725_541,
                0.849_176_252_131_873,
            ],
        },
    ]
}

const METHODS: [&str; 3] = ["balance", "shooting", "contact"];
const TOLERANCES: [f64; 2] = [1e-6, 1e-9];
const TURNS: usize = 7;

fn run(figure: &Figure, method: &str, tolerance: f64) -> Result<Branch, Error> {
    let [from, to] = figure.range;
    let request = FrequencyResponse::of(&*figure.system).from(from).to(to);
    let request = request.tolerance(tolerance);
    match method {
        "shooting" => request.by(Shooting::new()).run(),
        "contact" => request.by(ContactEquation::new()).run(),
        _ => request.by(HarmonicBalance::new()).run(),
    }
}

/// The largest distance of a fold from a known one; none where there are others than these.
fn error(branch: &Branch, exact: &[f64]) -> Option<f64> {
    let mut folds: Vec<f64> = branch.folds().map(|fold| fold.point.value).collect();
    folds.sort_by(f64::total_cmp);
    let pairs = folds.iter().zip(exact);
    let largest = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    (folds.len() == exact.len()).then_some(largest)
}

fn median(times: &mut [Duration]) -> f64 {
    times.sort();
    times[times.len() / 2].as_secs_f64()
}

/// All methods at one tolerance, in turns.
fn compare(figure: &Figure, tolerance: f64) -> Result<(), Error> {
    let mut times = METHODS.map(|_| Vec::new());
    for _ in 0..TURNS {
        for (method, times) in METHODS.iter().zip(&mut times) {
            let started = ThreadTime::now();
            run(figure, method, tolerance)?;
            times.push(started.elapsed());
        }
    }
    for (method, times) in METHODS.iter().zip(&mut times) {
        let branch = run(figure, method, tolerance)?;
        let (seconds, points) = (median(times), branch.points.len());
        let fold = error(&branch, figure.folds);
        let fold = fold.map_or_else(|| "others".to_owned(), |error| format!("{error:.0e}"));
        println!(
            "{} | {tolerance:.0e} | {method} | {points} | {:.2} | {:.1} | {fold} | {}",
            figure.name,
            1e3 * seconds,
            1e6 * seconds / points as f64,
            branch.stopped
        );
    }
    Ok(())
}

fn main() -> Result<(), Error> {
    let figures = figures();
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [name, method, tolerance] = &arguments[..] {
        for figure in figures.iter().filter(|figure| figure.name == name) {
            let branch = run(figure, method, tolerance.parse().unwrap_or(1e-6))?;
            println!("{} points, {}", branch.points.len(), branch.statistics);
        }
        return Ok(());
    }
    println!("figure | tolerance | method | points | ms | us a point | error of folds | ended");
    for figure in &figures {
        for tolerance in TOLERANCES {
            compare(figure, tolerance)?;
        }
    }
    Ok(())
}
