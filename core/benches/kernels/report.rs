//! The times as tables in Markdown.

use hertzian::power::Instructions;

use super::laws::{SUBJECTS, Subject};
use super::processor;
use super::race::{TURNS, Times};
use super::samples::COUNT;

pub fn print(times: &Times) {
    println!("Nanoseconds per sample, medians of {TURNS} turns, {COUNT} samples.");
    println!("{}.\n", processor::description());
    three_halves(times);
    exponents(times);
    calls(times);
}

/// Heads of columns, and a line below them; the first two hold text.
fn head(columns: &str) {
    println!("| {columns} |");
    let right = columns.split(" | ").count() - 2;
    println!("|{}{}", "---|".repeat(2), "---:|".repeat(right));
}

/// The laws that others were written for, with one argument or two, on every instruction set.
fn rows(arguments: usize) -> impl Iterator<Item = (&'static Subject, Instructions)> {
    let subjects = SUBJECTS.iter();
    let compared = subjects.filter(move |s| s.sides.is_some() && s.arguments.len() == arguments);
    compared.flat_map(|subject| processor::instructions().map(move |set| (subject, set)))
}

/// Exponent 3/2, against loops written by hand.
fn three_halves(times: &Times) {
    let columns = "law | instructions | generated | by hand | with Newton | num-dual | interpreted | \
                   generated / by hand | generated / best";
    head(columns);
    for (subject, set) in rows(1) {
        let time = |name| times.get(subject, subject.compared, name, set);
        let ratio = |other: f64| time("generated").unwrap_or(f64::NAN) / other;
        let hand = time("by hand").unwrap_or(f64::NAN);
        let best = time("Newton").map_or(hand, |newton| newton.min(hand));
        let names = ["generated", "by hand", "Newton", "num-dual", "interpreted"];
        println!(
            "{} {} | {:.2} | {:.2} |",
            start(subject, set),
            names.map(|name| number(time(name))).join(" | "),
            ratio(hand),
            ratio(best),
        );
    }
    println!();
}

/// An exponent that is an argument, against what evaluates sample by sample or node by node.
fn exponents(times: &Times) {
    let columns = "law | instructions | generated | powf | num-dual | interpreted | powf / generated | \
                   num-dual / generated | interpreted / generated";
    head(columns);
    for (subject, set) in rows(2) {
        let time = |name| times.get(subject, subject.compared, name, set);
        let ratio = |name| {
            time(name)
                .zip(time("generated"))
                .map_or(f64::NAN, |(a, b)| a / b)
        };
        let ratios = ["powf", "num-dual", "interpreted"].map(ratio);
        let names = ["generated", "powf", "num-dual", "interpreted"];
        println!(
            "{} {} | {} |",
            start(subject, set),
            names.map(|name| number(time(name))).join(" | "),
            ratios.map(|ratio| number(Some(ratio))).join(" | "),
        );
    }
    println!();
}

/// What the outputs cost: every law, call by call.
fn calls(times: &Times) {
    let sets: Vec<Instructions> = processor::instructions().collect();
    let names: Vec<&str> = sets.iter().map(|set| set.name()).collect();
    let columns = names.join(" | ");
    head(&format!(
        "law | call | {columns} | interpreted | interpreted / generated"
    ));
    for subject in &SUBJECTS {
        for call in subject.calls() {
            let time = |name, set: &Instructions| times.get(subject, call, name, *set);
            let generated: Vec<String> = sets
                .iter()
                .map(|set| number(time("generated", set)))
                .collect();
            let last = |name| sets.last().and_then(|set| time(name, set));
            let ratio = last("interpreted")
                .zip(last("generated"))
                .map(|(i, g)| i / g);
            println!(
                "| {} | {} | {} | {} | {} |",
                subject.name,
                call.name(),
                generated.join(" | "),
                number(last("interpreted")),
                number(ratio),
            );
        }
    }
}

fn start(subject: &Subject, set: Instructions) -> String {
    format!("| {} | {} |", subject.name, set.name())
}

fn number(time: Option<f64>) -> String {
    time.map_or(String::new(), |time| format!("{time:.2}"))
}
