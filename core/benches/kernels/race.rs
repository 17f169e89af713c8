//! Turns, and the times they take.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::process::{Command, Stdio};
use std::time::Instant;

use hertzian::power::Instructions;

use super::contenders::{Contender, contenders};
use super::laws::{Call, SUBJECTS, Subject};
use super::processor;
use super::samples::{COUNT, Samples};

/// Turns of each contender.
pub const TURNS: usize = 301;
/// Calls in a turn, so that a turn is long compared with the resolution of the clock.
const CALLS: usize = 16;

/// The environment variable by which a process knows that it is one of those that run.
pub const CHILD: &str = "HERTZIAN_KERNELS";

/// Nanoseconds per sample, by law, call, contender and instruction set.
#[derive(Default)]
pub struct Times(BTreeMap<[String; 4], f64>);

impl Times {
    /// Nothing if nobody of this name ran.
    pub fn get(
        &self,
        subject: &Subject,
        call: Call,
        name: &'static str,
        instructions: Instructions,
    ) -> Option<f64> {
        let key = [subject.name, call.name(), name, instructions.name()];
        self.0.get(&key.map(str::to_owned)).copied()
    }
}

/// The times of all instruction sets, each by a process of its own.
pub fn run_all() -> Times {
    let program = std::env::current_exe().expect("this program");
    let mut medians = Times::default();
    for set in processor::instructions() {
        let run = Command::new(&program)
            .env(CHILD, "1")
            .env("HERTZIAN_INSTRUCTIONS", set.name())
            .stderr(Stdio::inherit())
            .output();
        let run = run.expect("this program can be run");
        assert!(run.status.success(), "no times on {}", set.name());
        for line in String::from_utf8_lossy(&run.stdout).lines() {
            let [subject, call, name, time] = line.split('\t').collect::<Vec<_>>()[..] else {
                panic!("this is no time: {line}");
            };
            let key = [subject, call, name, set.name()].map(str::to_owned);
            medians.0.insert(key, time.parse().expect("a time"));
        }
    }
    medians
}

/// Everything that is asked of every law, on the instruction set of this process: law, call, contender and time in lines.
pub fn run_and_write() {
    let mut samples = Samples::new();
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
                let [subject, call] = [subject.name, call.name()];
                println!(
                    "{subject}\t{call}\t{}\t{}",
                    contender.name,
                    times[TURNS / 2]
                );
            }
        }
    }
}

/// One turn, after a call that finds caches and predictors as others left them.
fn turn(contender: &Contender, samples: &mut Samples) -> f64 {
    (contender.evaluate)(black_box(samples));
    let start = Instant::now();
    for _ in 0..CALLS {
        (contender.evaluate)(black_box(samples));
    }
    1e9 * start.elapsed().as_secs_f64() / (CALLS * COUNT) as f64
}

/// All contenders compute the same.
fn check(subject: &Subject, contenders: &[Contender], samples: &mut Samples) {
    let mut results = contenders.iter().map(|contender| {
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
