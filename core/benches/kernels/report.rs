//! The times as tables in Markdown.

use std::collections::BTreeMap;

use super::contenders::Times;
use super::laws::{Call, SUBJECTS, Subject};
use super::processor::{self, Instructions};
use super::samples::COUNT;

type All = BTreeMap<Instructions, Times>;

pub fn print(times: &All) {
    println!(
        "Nanoseconds per sample, medians, {COUNT} samples. {}.\n",
        processor::description()
    );
    three_halves(times);
    exponents(times);
    calls(times);
}

/// Exponent 3/2, against loops written by hand.
fn three_halves(times: &All) {
    println!(
        "| law | instructions | generated | by hand | with Newton | num-dual | interpreted | generated / best | at most 1.10 |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|---:|---|");
    for subject in SUBJECTS
        .iter()
        .filter(|s| s.sides.is_some() && s.arguments.len() == 1)
    {
        for (instructions, times) in times {
            let time = |name| times.median(subject.name, subject.aim, name);
            let generated = time("generated").unwrap_or(f64::NAN);
            let by_hand = [time("by hand"), time("Newton")];
            let best = by_hand.into_iter().flatten().fold(f64::INFINITY, f64::min);
            let ratio = generated / best;
            println!(
                "{} {} | {} | {} | {} | {} | {ratio:.2} | {} |",
                start(subject, *instructions),
                number(Some(generated)),
                number(by_hand[0]),
                number(by_hand[1]),
                number(time("num-dual")),
                number(time("interpreted")),
                verdict(ratio <= 1.10),
            );
        }
    }
    println!();
}

/// An exponent that is an argument, against what evaluates sample by sample or node by node.
fn exponents(times: &All) {
    println!(
        "| law | instructions | generated | powf | num-dual | interpreted | powf / generated | num-dual / generated | interpreted / generated | at least 6, 6, 4 |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|---:|---:|---|");
    for subject in SUBJECTS
        .iter()
        .filter(|s| s.sides.is_some() && s.arguments.len() == 2)
    {
        for (instructions, times) in times {
            let time = |name| {
                times
                    .median(subject.name, subject.aim, name)
                    .unwrap_or(f64::NAN)
            };
            let others = ["powf", "num-dual", "interpreted"].map(time);
            let ratios = others.map(|other| other / time("generated"));
            let holds = [6.0, 6.0, 4.0]
                .iter()
                .zip(&ratios)
                .all(|(aim, ratio)| ratio >= aim);
            let numbers = |of: [f64; 3]| of.map(|x| number(Some(x))).join(" | ");
            println!(
                "{} {} | {} | {} | {} |",
                start(subject, *instructions),
                number(Some(time("generated"))),
                numbers(others),
                numbers(ratios),
                verdict(holds),
            );
        }
    }
    println!();
}

/// What the outputs cost: every law, call by call.
fn calls(times: &All) {
    let sets: Vec<&str> = times.keys().map(|set| set.name()).collect();
    println!(
        "| law | call | {} | interpreted | interpreted / generated |",
        sets.join(" | ")
    );
    println!("|---|---|{}---:|---:|", "---:|".repeat(sets.len()));
    for subject in &SUBJECTS {
        for call in [
            Call::Force,
            Call::Derivatives,
            Call::ByArgument(subject.argument),
        ] {
            let time = |times: &Times, name| times.median(subject.name, call, name);
            let generated = times.values().map(|times| number(time(times, "generated")));
            let generated = generated.collect::<Vec<_>>().join(" | ");
            let last = |name| {
                times
                    .values()
                    .next_back()
                    .and_then(|times| time(times, name))
            };
            let interpreted = last("interpreted");
            let ratio = interpreted.zip(last("generated")).map(|(i, g)| i / g);
            println!(
                "| {} | {} | {generated} | {} | {} |",
                subject.name,
                call.name(),
                number(interpreted),
                number(ratio),
            );
        }
    }
}

fn start(subject: &Subject, instructions: Instructions) -> String {
    format!("| {} | {} |", subject.name, instructions.name())
}

fn number(time: Option<f64>) -> String {
    time.map_or(String::new(), |time| format!("{time:.2}"))
}

fn verdict(holds: bool) -> &'static str {
    if holds { "holds" } else { "does not" }
}
