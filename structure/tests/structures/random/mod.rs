//! Random structures with contacts: what is stated of their orbits, of few vectors instead of all modes, and of events, against motions of
//! all coordinates by an integrator that shares no code with the library.
//!
//!     HERTZIAN_STRUCTURES=300 cargo test -p hertzian-structure --test structures random -- --nocapture
//!
//! draws as many structures instead of [`STRUCTURES`]. A structure depends on its number only; `HERTZIAN_MODEL=17` runs that one and prints
//! it, and `HERTZIAN_FIRST=100` begins with that one.
//!
//! A false verdict, an orbit that is none, a panic and a structure that is refused fail the test, and so do stated errors that are exceeded
//! too often. Changes of verdicts without an event, and events that one method alone has, are counted and printed.

mod draw;
mod judge;
mod laws;
mod motion;
mod report;
mod truth;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use judge::Case;
use report::{Kind, Report};

/// Structures by default.
const STRUCTURES: u64 = 6;
/// So many times the stated errors, the share of them that may be exceeded so, and how many may be among few.
const EXCEEDED: [(f64, f64, usize); 2] = [(1.0, 0.05, 2), (3.0, 0.005, 1)];

fn environment(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{name}={text}")))
}

fn work(next: &AtomicU64, end: u64, sum: &Mutex<Report>) {
    loop {
        let index = next.fetch_add(1, Ordering::Relaxed);
        if index >= end {
            return;
        }
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
        if let Some((seconds, _)) = report.times.first().filter(|(seconds, _)| *seconds > 10.0) {
            eprintln!("HERTZIAN_MODEL={index}: {seconds:.0} s");
        }
        sum.lock().unwrap().add(report);
    }
}

#[test]
fn what_is_stated_of_structures_is_true() {
    let one = environment("HERTZIAN_MODEL");
    let start = one.or_else(|| environment("HERTZIAN_FIRST")).unwrap_or(0);
    let asked = || environment("HERTZIAN_STRUCTURES").unwrap_or(STRUCTURES);
    let count = one.map_or_else(asked, |_| 1);
    if one.is_some() {
        println!("{}", Case::of(start).text());
    }
    let next = AtomicU64::new(start);
    let sum = Mutex::new(Report::default());
    let workers = environment("HERTZIAN_WORKERS").unwrap_or(2);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| work(&next, start + count, &sum));
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
