//! What is stated of errors: orbits at a coarse tolerance against the same orbits at a fine one.

use hertzian::flow::shooting::Cycle;
use hertzian::{Complex, Shooting, System, Verdict};

use crate::integrated::{continuous, one_sided};

/// Largest distance between multipliers, each matched with its nearest.
fn distance(a: &[Complex<f64>], b: &[Complex<f64>]) -> f64 {
    let mut free = b.to_vec();
    let mut largest = 0.0_f64;
    for x in a {
        let by_distance = |i: &usize, j: &usize| {
            let [p, q] = [i, j].map(|&k| (free[k] - x).norm());
            p.total_cmp(&q)
        };
        let nearest = (0..free.len()).min_by(by_distance).unwrap();
        largest = largest.max((free.swap_remove(nearest) - x).norm());
    }
    largest
}

/// Errors of states and multipliers are within what is stated, and no verdict is false.
pub fn assert_stated(cycle: &Cycle, finer: &Cycle) {
    let pairs = cycle.state().iter().zip(finer.state());
    let state = pairs.fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()));
    let omega = cycle.omega.max(1.0);
    assert!(state <= cycle.error * omega, "{state:.1e} {cycle:?}");
    let found = &cycle.stability;
    let error = distance(&found.multipliers, &finer.stability.multipliers);
    assert!(error <= found.error, "{error:.1e} {cycle:?}");
    if found.verdict != Verdict::Undecided {
        assert_eq!(found.verdict, finer.stability.verdict, "{cycle:?}");
    }
}

fn compare(system: &dyn System, (from, to): (f64, f64)) {
    let coarse = Shooting::of(system).tolerance(1e-7);
    let fine = Shooting::of(system).tolerance(1e-13);
    let branch = coarse.from(from).to(to).run().unwrap();
    let mut undecided = 0;
    for cycle in branch.cycles.iter().step_by(3) {
        let finer = fine.clone().near(cycle.state()).orbit(cycle.value).unwrap();
        assert_stated(cycle, &finer);
        undecided += usize::from(cycle.stability.verdict == Verdict::Undecided);
    }
    assert!(undecided <= branch.cycles.len() / 50, "{undecided}");
}

#[test]
fn errors_of_continuous_springs() {
    compare(&*continuous(1.5, 0.0), (0.6, 1.7));
    compare(&*continuous(0.6, 0.0), (0.66, 1.4));
}

#[test]
fn errors_of_contacts() {
    compare(&*one_sided(1.5), (0.6, 1.6));
    compare(&*one_sided(0.6), (0.5, 1.2));
}
