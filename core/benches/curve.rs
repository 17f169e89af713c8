//! The whole curve of Fig. 5a of Wang et al. (2021), without multipliers: `cargo bench -p hertzian --bench curve`.
//!
//! One-sided contact with a linear spring, damping ratio 0.032, load 1, drive 0.1, omega from 0.6 to 1.4. First the time
//! with exact switching at several numbers of harmonics; then the search for the cheapest sampled method, classical and with the
//! primitive of the damping, whose answer can be trusted: two turns, the upper one within 3e-4 of the exact 0.715119550, and
//! still so with twice the samples and with half the step.

use std::time::Instant;

use hertzian::{Aft, Branch, EventKind, FrequencyResponse, oscillator};

oscillator! {
    /// One-sided contact with a linear spring.
    OneSidedLinear(x) {
        param zeta in 0.0..;
        param load;
        param drive;

        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap,
            else    => 0,
        }

        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

const MODEL: OneSidedLinear = OneSidedLinear {
    zeta: 0.032,
    load: 1.0,
    drive: 0.1,
};
/// The fold of larger amplitude, from an independent computation to 15 digits.
const EXACT: f64 = 0.715_119_549_676_419;
const ALLOWED: f64 = 3e-4;
const TURNS: usize = 21;
/// A sampled curve that takes longer than this is not repeated for a median.
const LONG: f64 = 0.5;

fn request(harmonics: usize) -> FrequencyResponse {
    FrequencyResponse::of(&MODEL)
        .from(0.6)
        .to(1.4)
        .harmonics(harmonics)
        .stability(false)
}

/// Seconds of one run, and its branch.
fn timed(request: &FrequencyResponse) -> Option<(f64, Branch)> {
    let start = Instant::now();
    let branch = request.run().ok()?;
    Some((start.elapsed().as_secs_f64(), branch))
}

fn median(request: &FrequencyResponse) -> f64 {
    let mut times: Vec<f64> = (0..TURNS)
        .filter_map(|_| timed(request).map(|(time, _)| time))
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Where the branch turns at large amplitude, which is at the lower frequency, if it turns exactly twice. A turn counts whether or
/// not its test function could be driven to zero: sampled methods hardly ever can.
fn upper_fold(branch: &Branch) -> Option<f64> {
    let folds = branch.folds().map(|fold| fold.point.value);
    let turns = branch.turns.iter();
    let turns = turns.filter(|turn| turn.kind == EventKind::Fold);
    let turns = turns.map(|turn| turn.value);
    let mut all: Vec<f64> = folds.chain(turns).collect();
    all.sort_by(f64::total_cmp);
    (all.len() == 2).then(|| all[0])
}

fn is_right(branch: &Branch) -> bool {
    upper_fold(branch).is_some_and(|fold| (fold - EXACT).abs() <= ALLOWED)
}

fn main() {
    let only: Option<usize> = std::env::args().nth(1).and_then(|k| k.parse().ok());
    let mut switched = f64::NAN;
    let all = vec![5, 9, 10, 20, 40, 80];
    for harmonics in only.map_or(all, |only| vec![only]) {
        let request = request(harmonics);
        let time = median(&request);
        if let Some((_, branch)) = timed(&request) {
            let fold = upper_fold(&branch).unwrap_or(f64::NAN);
            println!(
                "switched  {harmonics:3} harmonics: {:8.3} ms, {} points, upper fold {fold:.9} (error {:.1e}); {}",
                1e3 * time,
                branch.points.len(),
                (fold - EXACT).abs(),
                branch.statistics
            );
            if is_right(&branch) && switched.is_nan() {
                switched = time;
            }
        }
    }
    if only.is_none() {
        for method in [Aft::Sampled, Aft::Primitive] {
            cheapest(method, switched);
        }
    }
}

/// Tries all numbers of samples and harmonics, and says which cheapest one can be trusted.
fn cheapest(method: Aft, switched: f64) {
    let (mut right, mut tried) = (0, 0);
    let mut best: Option<(f64, usize, usize)> = None;
    for harmonics in [5, 9, 10, 20, 40] {
        for power in 6..=14 {
            let samples = 1_usize << power;
            if samples < 4 * harmonics + 2 {
                continue;
            }
            tried += 1;
            let request = request(harmonics)
                .aft(method)
                .samples(samples)
                .max_points(3000);
            let Some((time, branch)) = timed(&request) else {
                continue;
            };
            if !is_right(&branch) {
                continue;
            }
            right += 1;
            let variants = [
                request.clone().samples(2 * samples),
                request.clone().largest_step(0.05),
            ];
            let survives = variants
                .iter()
                .all(|variant| timed(variant).is_some_and(|(_, branch)| is_right(&branch)));
            let time = if time < LONG { median(&request) } else { time };
            println!(
                "{method:9} {harmonics:3} harmonics, {samples:5} samples: {:8.3} ms, within {ALLOWED:.0e}{}",
                1e3 * time,
                if survives {
                    ", survives"
                } else {
                    ", does not survive"
                }
            );
            if survives && best.is_none_or(|(least, _, _)| time < least) {
                best = Some((time, harmonics, samples));
            }
        }
    }
    match best {
        Some((time, harmonics, samples)) => println!(
            "{method:9} cheapest that survives: {harmonics} harmonics, {samples} samples, {:.3} ms: {:.1} times the switched {:.3} ms",
            1e3 * time,
            time / switched,
            1e3 * switched
        ),
        None => {
            println!("{method:9} none of {tried} survives; {right} were within {ALLOWED:.0e} once");
        }
    }
}
