//! Exact bifurcations and states, what a log gives back, what is refused.

use std::ops::ControlFlow;

use super::*;
use crate::testing::one_sided::{OneSided, one_sided};

const MODEL: OneSided = one_sided(1.0);

fn sweep(from: f64, to: f64, start: [f64; 2]) -> Sweep {
    let sweep = Sweep::of(&MODEL).vary("drive").omega(1.0);
    let sweep = sweep.from(from).to(to).values(26).start(&start);
    sweep.transient(400).periods(4)
}

/// States that differ.
fn distinct(row: &Row) -> usize {
    let mut seen: Vec<f64> = Vec::new();
    for x in row.points.chunks(2).map(|state| state[0]) {
        if seen.iter().all(|y| (x - y).abs() > 1e-3) {
            seen.push(x);
        }
    }
    seen.len()
}

/// Period one doubles at A = 1.282584168, and a period two ends in a fold at A = 0.294528806 (exact values, computed
/// independently of this project); between them both are stable.
#[test]
fn up_and_down_show_the_hysteresis() {
    let run = |sweep: Sweep| sweep.run().expect("rows").rows;
    let up = run(sweep(0.2, 1.45, [0.5, 0.0]));
    let down = run(sweep(1.0, 0.2, [-5.632, 3.5266]));
    // Beside a bifurcation the transient is long.
    for row in up.iter().filter(|row| (row.value - 1.282_584).abs() > 0.02) {
        let doubled = row.value > 1.282_584;
        assert_eq!(distinct(row), 1 + usize::from(doubled), "{}", row.value);
    }
    for row in down
        .iter()
        .filter(|row| (row.value - 0.294_529).abs() > 0.02)
    {
        let before = row.value > 0.294_529;
        assert_eq!(distinct(row), 1 + usize::from(before), "{}", row.value);
    }
    assert!(up.iter().chain(&down).all(|row| row.ended.is_none()));
    // At A = 1: the exact states of both.
    let at_one = up.iter().find(|row| (row.value - 1.0).abs() < 1e-9);
    let first = at_one.expect("a row").points[0];
    assert!((first + 1.999_776_122_757_642_7).abs() < 1e-9, "{first}");
    let second = down[0].points[0].max(down[0].points[2]);
    assert!((second + 5.632_060_192_753_841).abs() < 1e-9, "{second}");
}

#[test]
fn a_run_that_was_ended_goes_on_with_the_same_rows() {
    let sweep = sweep(1.0, 1.5, [0.5, 0.0]);
    let all = sweep.run().expect("rows");
    assert!(all.complete && all.rows.len() == 26);
    let folder = std::env::temp_dir().join(format!("hertzian-sweep-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("sweep");
    let _ = std::fs::remove_file(&path);
    let mut computed = 0;
    let swept = loop {
        let before = computed;
        let mut see = |progress: Progress<'_>| {
            computed += 1;
            assert_eq!((progress.done, progress.total), (computed, Some(26)));
            if computed - before < 10 {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        let swept = sweep.resume(&path, "sweep", &mut see).expect("rows");
        if swept.complete {
            break swept;
        }
    };
    assert_eq!(swept, all);
    assert_eq!(computed, all.rows.len());
    let _ = std::fs::remove_dir_all(&folder);
}

/// A damping below zero is refused, value by value, and by the run that goes on in the same words.
#[test]
fn values_that_failed_are_the_same_when_a_run_goes_on() {
    let sweep = Sweep::of(&MODEL).vary("zeta").omega(1.0).start(&[0.5, 0.0]);
    let sweep = sweep.from(0.05).to(-0.03).values(5).back(true);
    let sweep = sweep.transient(20).periods(2);
    let all = sweep.run().expect("rows");
    let failed = |row: &&Row| matches!(row.ended, Some(FlowError::Value { .. }));
    assert_eq!(all.rows.iter().filter(failed).count(), 4);
    let folder = std::env::temp_dir().join(format!("hertzian-failed-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("sweep");
    let kept = || {
        let log = Log::open(&path, &format!("sweep, {sweep:?}"));
        log.expect("a log").records().len()
    };
    let visit = |progress: Progress<'_>| match progress.done {
        6 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let part = sweep.resume(&path, "sweep", visit).expect("rows");
    assert_eq!(part.rows[..], all.rows[..6]);
    assert_eq!(kept(), 6);
    let visit = |_: Progress<'_>| ControlFlow::Continue(());
    assert_eq!(sweep.resume(&path, "sweep", visit), Ok(all));
    assert_eq!(kept(), 10);
    let _ = std::fs::remove_dir_all(&folder);
}

/// A sweep that is cancelled at a value has those before it, and no row for the motion that was cut short.
#[test]
fn a_cancelled_sweep_keeps_its_rows() {
    let cancel = Cancel::new();
    let sweep = sweep(1.0, 1.5, [0.5, 0.0]).cancel(&cancel);
    let part = sweep.run_with(|progress| {
        if progress.done == 3 {
            cancel.cancel();
        }
        ControlFlow::Continue(())
    });
    let part = part.expect("rows");
    let again = sweep.cancel(&Cancel::new()).values(26);
    let whole = again.run().expect("rows");
    assert!(!part.complete && whole.complete);
    assert_eq!(part.rows[..], whole.rows[..3]);
}

#[test]
fn what_cannot_be_swept_is_refused() {
    for count in [MOST_VALUES + 1, usize::MAX] {
        let refused = sweep(0.0, 1.0, [0.0; 2]).values(count).run();
        let refused = refused.expect_err("too many");
        assert!(matches!(
            refused.downcast_ref(),
            Some(RequestError::Option { name: "values", .. })
        ));
    }
    let refused = Sweep::of(&MODEL).from(0.5).run().expect_err("no end");
    assert_eq!(refused.downcast_ref(), Some(&RequestError::no_end("to")));
    let refused = sweep(0.0, 1.0, [0.0; 2]).start(&[0.0]).run();
    assert!(matches!(
        refused.expect_err("half a state").downcast_ref(),
        Some(RequestError::State {
            entries: 1,
            expected: 2
        })
    ));
    let back = sweep(0.0, 1.0, [0.0; 2]).values(3).back(true);
    assert_eq!(back.spread(0.0, 1.0), [0.0, 0.5, 1.0, 1.0, 0.5, 0.0]);
}

#[test]
fn a_section_gives_its_crossings() {
    let section = Section::entry(0, 0.0);
    let sweep = sweep(1.0, 1.0, [-2.0, 0.18]).values(1).section(section);
    let rows = sweep.run().expect("rows").rows;
    // Period one meets the contact once in each period, at one speed.
    assert_eq!(rows[0].points.len(), 8);
    for state in rows[0].points.chunks(2) {
        assert!(state[0].abs() < 1e-13 && (state[1] - rows[0].points[1]).abs() < 1e-9);
    }
}

/// Without damping and at its own frequency an oscillator grows without bound.
#[test]
fn what_escapes_starts_again() {
    crate::oscillator! {
        Resonance(x) {
            param drive;
            ddot(x) + x = drive*cos(omega*t);
        }
    }
    let model = Resonance { drive: 1.0 };
    let sweep = Sweep::of(&model).vary("drive").omega(1.0);
    let sweep = sweep.from(1.0).to(0.0).values(2).start(&[1.0, 0.0]);
    let sweep = sweep.transient(10).periods(2).escape(10.0);
    let rows = sweep.run().expect("rows").rows;
    assert_eq!(rows[0].ended, Some(FlowError::Escaped));
    assert!(rows[0].points.is_empty());
    assert!(rows[1].ended.is_none() && (rows[1].points[0] - 1.0).abs() < 1e-12);
}
