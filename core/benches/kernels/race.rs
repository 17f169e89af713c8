//! Turns, and the times they take.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::time::Instant;

use hertzian::power::{Accuracy, Instructions};

use super::contenders::{Contender, contenders};
use super::laws::{Call, SUBJECTS, Subject};
use super::samples::{COUNT, Samples};

/// Turns of each contender.
pub const TURNS: usize = 301;
/// Calls in a turn, so that a turn is long compared with the resolution of the clock.
const CALLS: usize = 16;

/// Nanoseconds per sample, by law, call, contender and instruction set.
#[derive(Default)]
pub struct Times(BTreeMap<(&'static str, &'static str, &'static str, Instructions), f64>);

impl Times {
    /// Nothing if nobody of this name ran.
    pub fn get(
        &self,
        subject: &Subject,
        call: Call,
        name: &'static str,
        instructions: Instructions,
    ) -> Option<f64> {
        let key = (subject.name, call.name(), name, instructions);
        self.0.get(&key).copied()
    }
}

/// Everything that is asked of every law.
pub fn run() -> Times {
    let mut samples = Samples::new();
    let mut medians = Times::default();
    for subject in &SUBJECTS {
        for call in subject.calls() {
            let contenders = contenders(subject, call);
            check(subject, &contenders, &mut samples);
            let mut times = vec![Vec::new(); contenders.len()];
            for _ in 0..TURNS {
                for (contender, times) in contenders.iter().zip(&mut times) {
                    times.push(turn(contender, &mut samples));
                }
            }
            for (contender, mut times) in contenders.iter().zip(times) {
                times.sort_by(f64::total_cmp);
                let Contender {
                    name, instructions, ..
                } = *contender;
                let key = (subject.name, call.name(), name, instructions);
                medians.0.insert(key, times[TURNS / 2]);
            }
        }
    }
    medians
}

/// One turn, after a call that finds caches and predictors as others left them.
fn turn(contender: &Contender, samples: &mut Samples) -> f64 {
    choose(contender);
    (contender.evaluate)(black_box(samples));
    let start = Instant::now();
    for _ in 0..CALLS {
        (contender.evaluate)(black_box(samples));
    }
    1e9 * start.elapsed().as_secs_f64() / (CALLS * COUNT) as f64
}

fn choose(contender: &Contender) {
    contender.instructions.pin();
    let accuracy = if contender.name == "fast" {
        Accuracy::Fast
    } else {
        Accuracy::Full
    };
    accuracy.choose();
}

/// All contenders compute the same.
fn check(subject: &Subject, contenders: &[Contender], samples: &mut Samples) {
    let mut results = contenders.iter().map(|contender| {
        choose(contender);
        samples.clear();
        (contender.evaluate)(samples);
        (contender.name, samples.outputs())
    });
    let (_, expected) = results.next().expect("at least the generated law");
    for (name, found) in results {
        for (found, expected) in found.iter().zip(&expected) {
            let close = (found - expected).abs() <= 1e-13 * expected.abs().max(1.0);
            assert!(close, "{}, {name}: {found} is not {expected}", subject.name);
        }
    }
}
