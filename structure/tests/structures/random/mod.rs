//! Random structures with contacts: what is stated of their orbits, of few vectors instead of all modes, and of events, against motions of
//! all coordinates by an integrator that shares no code with the library.
//!
//!     HERTZIAN_STRUCTURES=300 cargo test -p hertzian-structure --test structures random -- --nocapture
//!
//! draws as many structures instead of [`STRUCTURES`]. A structure depends on its number only; `HERTZIAN_MODEL=17` runs that one and prints
//! it, and `HERTZIAN_FIRST=100` begins with that one.
//!
//! A false verdict, by all modes or by few, an orbit that is none, a panic, what is no number and a structure that is refused fail the test,
//! and so do stated errors that are exceeded too often. Changes of verdicts without an event, and events that one method alone has, are counted and printed.

mod borders;
mod draw;
mod few;
mod judge;
mod laws;
mod matrices;
mod motion;
mod report;
mod truth;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;

use judge::Case;
use report::{Kind, Report};

/// Structures by default, and how many coordinates they have at most.
const STRUCTURES: usize = 5;
const FEW: usize = 4;
/// Of so few coordinates all are kept. By default there is one of more besides, few vectors of which stand for eight coordinates.
const REDUCED: u64 = 413;
/// So many times the stated errors, the share of them that may be exceeded so, and how many may be among few.
const EXCEEDED: [(f64, f64, usize); 2] = [(1.0, 0.05, 3), (3.0, 0.005, 1)];

fn environment(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{name}={text}")))
}

/// Judges structures until there are none left.
fn work(next: &Mutex<impl Iterator<Item = u64>>, sum: &Mutex<Report>) {
    loop {
        let Some(index) = next.lock().unwrap().next() else {
            return;
        };
        let judged = catch_unwind(AssertUnwindSafe(|| Case::of(index).judged()));
        let report = judged.unwrap_or_else(|_| {
            let mut report = Report::default();
            report.count("structures");
            report.find(Kind::Panic, index, "see above".to_owned());
            report
        });
        for finding in &report.findings {
            eprintln!("{finding}");
        }
        sum.lock().unwrap().add(report);
    }
}

/// Numbers of the structures: those that were asked for, or the first few with few coordinates, and one of more.
fn numbers() -> Box<dyn Iterator<Item = u64> + Send> {
    if let Some(one) = environment("HERTZIAN_MODEL") {
        println!("{}", Case::of(one).text());
        return Box::new(one..=one);
    }
    let first = environment("HERTZIAN_FIRST").unwrap_or(0);
    if let Some(count) = environment("HERTZIAN_STRUCTURES") {
        return Box::new(first..first + count);
    }
    let are_few = |index: &u64| draw::structure(*index).size() <= FEW;
    let few = (first..).filter(are_few).take(STRUCTURES);
    Box::new(few.chain([REDUCED]))
}

/// Whether the structures are those by default.
fn by_default() -> bool {
    let asked = ["HERTZIAN_MODEL", "HERTZIAN_STRUCTURES"];
    asked.iter().all(|name| environment(name).is_none())
}

#[test]
fn what_is_stated_of_structures_is_true() {
    let next = Mutex::new(numbers());
    let sum = Mutex::new(Report::default());
    let workers = std::thread::available_parallelism().map_or(1, |count| count.get().min(8));
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| work(&next, &sum));
        }
    });
    let mut sum = sum.into_inner().unwrap();
    sum.print();
    let failed: Vec<_> = sum.findings.iter().filter(|f| f.kind.fails()).collect();
    assert!(
        failed.is_empty(),
        "{} failures: {:?}",
        failed.len(),
        failed[0]
    );
    if by_default() {
        let compared = sum.ratios.get("reduced orbits").map_or(0, Vec::len);
        assert!(compared > 0, "no reduced orbit is compared");
    }
    for (of, ratios) in &sum.ratios {
        for (factor, share, few) in EXCEEDED {
            let beyond = ratios.iter().filter(|ratio| **ratio > factor).count();
            let most = (share * ratios.len() as f64).max(few as f64);
            assert!(
                beyond as f64 <= most,
                "{of}: {beyond} of {} beyond {factor} times",
                ratios.len()
            );
        }
    }
}
