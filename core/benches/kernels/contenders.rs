//! Who runs, in turns, within one process and therefore on one instruction set.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::time::Instant;

use hertzian::generic::InterpretedLaw;
use hertzian::law::{Derivatives, Law, On};

use super::laws::{Call, SUBJECTS, Subject};
use super::processor::Instructions;
use super::samples::{COUNT, Samples};
use super::{by_hand, scalar};

/// Turns of each contender in a process.
const TURNS: usize = 61;
/// Calls in a turn, so that a turn is long compared with the resolution of the clock.
const CALLS: usize = 16;

/// A name, and what it computes.
type Contender = (&'static str, Box<dyn Fn(&mut Samples)>);

/// One comparison.
struct Race {
    subject: &'static Subject,
    call: Call,
    contenders: Vec<Contender>,
}

/// Runs everything on this process's instruction set, and prints the times.
pub fn run(instructions: Instructions) {
    let mut samples = Samples::new();
    for race in races(instructions) {
        check(&race, &mut samples);
        let mut times = vec![Vec::new(); race.contenders.len()];
        for _ in 0..TURNS {
            for ((_, evaluate), times) in race.contenders.iter().zip(&mut times) {
                // One call finds caches and predictors as others left them.
                evaluate(black_box(&mut samples));
                let start = Instant::now();
                for _ in 0..CALLS {
                    evaluate(black_box(&mut samples));
                }
                times.push(1e9 * start.elapsed().as_secs_f64() / (CALLS * COUNT) as f64);
            }
        }
        for ((name, _), times) in race.contenders.iter().zip(times) {
            let key = [race.subject.name, race.call.name(), name].join("\t");
            println!(
                "{key}\t{}",
                times
                    .iter()
                    .map(f64::to_string)
                    .collect::<Vec<_>>()
                    .join("\t")
            );
        }
    }
}

/// Times by law, call and contender.
#[derive(Default)]
pub struct Times(BTreeMap<[String; 3], Vec<f64>>);

impl Times {
    /// Adds what a process printed.
    pub fn read(&mut self, lines: &str) {
        for line in lines.lines() {
            let mut fields = line.split('\t');
            let key = std::array::from_fn(|_| fields.next().expect("three names").to_owned());
            let times = self.0.entry(key).or_default();
            times.extend(fields.map(|time| time.parse::<f64>().expect("a number")));
        }
    }

    /// Nanoseconds per sample, or nothing if nobody of this name ran.
    pub fn median(&self, law: &str, call: Call, contender: &str) -> Option<f64> {
        let mut times = self
            .0
            .get(&[law, call.name(), contender].map(str::to_owned))?
            .clone();
        times.sort_by(f64::total_cmp);
        Some(times[times.len() / 2])
    }
}

/// Everything that is asked of every law, and whom else the question of its aim is put to.
fn races(instructions: Instructions) -> Vec<Race> {
    let mut races = Vec::new();
    for subject in &SUBJECTS {
        for call in [
            Call::Force,
            Call::Derivatives,
            Call::ByArgument(subject.argument),
        ] {
            let mut contenders = laws(subject, call);
            if call == subject.aim {
                contenders.extend(others(subject, instructions));
            }
            races.push(Race {
                subject,
                call,
                contenders,
            });
        }
    }
    races
}

fn laws(subject: &'static Subject, call: Call) -> Vec<Contender> {
    let arguments = subject.arguments;
    let generated = move |s: &mut Samples| evaluate(subject.law, call, arguments, s);
    let law = InterpretedLaw::of(subject.law);
    let interpreted = move |s: &mut Samples| evaluate(&law, call, arguments, s);
    vec![
        ("generated", Box::new(generated)),
        ("interpreted", Box::new(interpreted)),
    ]
}

fn others(subject: &'static Subject, instructions: Instructions) -> Vec<Contender> {
    let mut contenders: Vec<Contender> = Vec::new();
    let Some(sides) = subject.sides else {
        return contenders;
    };
    if let [zeta] = *subject.arguments {
        contenders.push((
            "by hand",
            Box::new(move |s| by_hand::run(sides, instructions, zeta, s)),
        ));
        #[cfg(target_arch = "x86_64")]
        if instructions == Instructions::Avx512 {
            contenders.push((
                "Newton",
                Box::new(move |s| super::newton::run(sides, zeta, s)),
            ));
        }
        let duals = move |s: &mut Samples| scalar::duals_three_halves(sides, zeta, s);
        contenders.push(("num-dual", Box::new(duals)));
    }
    if let [zeta, alpha] = *subject.arguments {
        let powf = move |s: &mut Samples| scalar::powf(sides, [zeta, alpha], s);
        let duals = move |s: &mut Samples| scalar::duals(sides, [zeta, alpha], s);
        contenders.push(("powf", Box::new(powf)));
        contenders.push(("num-dual", Box::new(duals)));
    }
    contenders
}

fn evaluate(law: &dyn Law, call: Call, arguments: &[f64], samples: &mut Samples) {
    let Samples {
        gap,
        rate,
        force,
        by_gap,
        by_rate,
        by_argument,
    } = samples;
    let on = On::AllPieces;
    if let Call::Force = call {
        law.force(on, arguments, gap, rate, force);
        return;
    }
    let out = Derivatives {
        force,
        by_gap,
        by_rate,
    };
    match call {
        Call::ByArgument(index) => {
            law.derivatives_and_by(index, on, arguments, gap, rate, out, by_argument);
        }
        _ => law.derivatives(on, arguments, gap, rate, out),
    }
}

/// All contenders of a race compute the same.
fn check(race: &Race, samples: &mut Samples) {
    let mut results = race.contenders.iter().map(|(name, evaluate)| {
        samples.clear();
        evaluate(samples);
        (name, samples.outputs())
    });
    let (_, expected) = results.next().expect("at least the generated law");
    for (name, found) in results {
        for (found, expected) in found.iter().zip(&expected) {
            let close = (found - expected).abs() <= 1e-13 * expected.abs().max(1.0);
            assert!(
                close,
                "{}, {name}: {found} is not {expected}",
                race.subject.name
            );
        }
    }
}
