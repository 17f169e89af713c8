//! A token stops computations between two evaluations of a force, wherever they are.
//!
//! What happens after the token was cancelled is counted in evaluations, not in seconds: a law cancels the token when it is called for
//! the given time, and counts on.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use hertzian::backbone::{FreeOscillation, PhaseResonance};
use hertzian::error::ErrorKind;
use hertzian::law::{Derivatives, Law, LawFacts, On, Parts};
use hertzian::structure::{Contact, DMatrix, Structure, parameter};
use hertzian::{Cancel, FrequencyResponse, Progress, Shooting, Stop};

hertzian::law! {
    /// A hardening spring.
    Cubic(gap, k) { k*gap^3 }
}

/// Calls of a law, and the token that one of them cancels.
#[derive(Debug)]
struct Count {
    calls: AtomicUsize,
    cancels: usize,
    cancel: Cancel,
}

impl Count {
    fn call(&self) {
        if self.calls.fetch_add(1, Ordering::Relaxed) + 1 == self.cancels {
            self.cancel.cancel();
        }
    }

    fn calls(&self) -> usize {
        self.calls.load(Ordering::Relaxed)
    }
}

/// The spring, counted.
struct Counted(Arc<Count>);

impl Law for Counted {
    fn facts(&self) -> &LawFacts {
        Cubic.facts()
    }

    fn levels(&self, arguments: &[f64], levels: &mut [f64]) {
        Cubic.levels(arguments, levels);
    }

    fn levels_by(&self, arguments: &[f64], argument: usize, by_argument: &mut [f64]) {
        Cubic.levels_by(arguments, argument, by_argument);
    }

    fn force(&self, on: On, arguments: &[f64], gap: &[f64], rate: &[f64], force: &mut [f64]) {
        self.0.call();
        Cubic.force(on, arguments, gap, rate, force);
    }

    fn derivatives(
        &self,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
    ) {
        self.0.call();
        Cubic.derivatives(on, arguments, gap, rate, out);
    }

    fn derivatives_and_by(
        &self,
        argument: usize,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
        by_argument: &mut [f64],
    ) {
        self.0.call();
        Cubic.derivatives_and_by(argument, on, arguments, gap, rate, out, by_argument);
    }

    fn parts(&self) -> Option<Parts<'_>> {
        Cubic.parts()
    }
}

/// A chain of masses, each on a hardening spring, shaken at its end.
fn chain(masses: usize, cancels: usize) -> (Structure, Arc<Count>) {
    let count = Arc::new(Count {
        calls: AtomicUsize::new(0),
        cancels,
        cancel: Cancel::new(),
    });
    let stiffness = DMatrix::from_fn(masses, masses, |i, j| match i.abs_diff(j) {
        0 => 3.0,
        1 => -1.0,
        _ => 0.0,
    });
    let mass = DMatrix::identity(masses, masses);
    let mut chain = Structure::of(&mass, &(0.1 * &stiffness), &stiffness);
    for i in 0..masses {
        let direction = (0..masses).map(|j| if i == j { 1.0 } else { 0.0 });
        let spring = Contact::new(Counted(Arc::clone(&count)));
        let spring = spring.arguments([parameter("k", 1.0)]);
        chain = chain.contact(spring.direction(direction.collect::<Vec<f64>>()));
    }
    let chain = chain.cosine(masses - 1, 1, parameter("drive", 1.0));
    (chain.build().expect("a chain"), count)
}

/// Springs of the chain.
const MASSES: usize = 12;

#[test]
fn a_balance_is_stopped_in_the_search_for_its_first_orbit_and_on_its_branch() {
    let request = |chain: &Structure, count: &Count| {
        let request = FrequencyResponse::of(chain).from(0.8).to(1.4);
        request.harmonics(5).cancel(&count.cancel)
    };
    let (free, count) = chain(MASSES, usize::MAX);
    let whole = request(&free, &count).run().expect("a branch");
    let all = count.calls();
    assert!(whole.points.len() > 20);
    // Before the first evaluation is complete, and within the first iterations: each evaluation calls every spring.
    for cancels in [1, 3 * MASSES, 6 * MASSES] {
        let (chain, count) = chain(MASSES, cancels);
        let error = request(&chain, &count).run().expect_err("it is cancelled");
        assert_eq!(error.kind(), ErrorKind::Cancelled, "{error}");
        assert!(count.calls() - cancels <= 4 * MASSES, "{}", count.calls());
    }
    let (chain, count) = chain(MASSES, all / 2);
    let part = request(&chain, &count).run().expect("a branch");
    assert_eq!(part.stopped, Stop::Interrupted);
    assert!(part.points.len() > 2 && part.points.len() < whole.points.len());
    for (point, of_whole) in part.points.iter().zip(&whole.points) {
        assert_eq!(point.value, of_whole.value);
        assert_eq!(point.orbit, of_whole.orbit);
    }
    assert!(part.turns.is_empty() && count.calls() - all / 2 <= 100 * MASSES);
    // The branch answers although the token of its run is cancelled.
    let value = 0.5 * (part.points[0].value + part.points[1].value);
    assert_eq!(part.at(value).expect("an orbit").len(), 1);
}

/// Evaluations within one step of a motion: sweeps over its nodes until they agree, and the linear equations for the tangent.
const STEP: usize = 100 * MASSES;

#[test]
fn shooting_is_stopped_in_the_search_for_its_first_orbit_and_on_its_branch() {
    let request = |chain: &Structure, count: &Count| {
        let request = FrequencyResponse::of(chain)
            .by(Shooting::new().tolerance(1e-6))
            .from(0.8)
            .to(1.1);
        let request = request.near_state(&[0.0; 2 * MASSES]).stability(false);
        request.cancel(&count.cancel)
    };
    let (free, count) = chain(MASSES, usize::MAX);
    request(&free, &count).orbit(0.8).expect("an orbit");
    let to_first = count.calls();
    let whole = request(&free, &count).run().expect("a branch");
    let all = count.calls() - to_first;
    for cancels in [1, to_first / 4, to_first / 2] {
        let (chain, count) = chain(MASSES, cancels);
        let error = request(&chain, &count).run().expect_err("it is cancelled");
        assert_eq!(error.kind(), ErrorKind::Cancelled, "{error}");
        assert!(count.calls() - cancels <= STEP, "{}", count.calls());
    }
    let (chain, count) = chain(MASSES, all / 2);
    let part = request(&chain, &count).run().expect("a branch");
    assert_eq!(part.stopped, Stop::Interrupted);
    assert!(!part.points.is_empty() && part.points.len() < whole.points.len());
    assert_eq!(part.points[..], whole.points[..part.points.len()]);
    assert!(count.calls() - all / 2 <= STEP, "{}", count.calls());
}

hertzian::oscillator! {
    Hertz(x) {
        param zeta >= 0;
        param drive;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^1.5 = drive*cos(omega*t);
    }
}

#[test]
fn backbones_keep_what_they_had() {
    let free = FreeOscillation::of(&Hertz {
        zeta: 0.0,
        drive: 0.0,
    });
    let free = free.from(0.5).to(2.0);
    let driven = Hertz {
        zeta: 0.01,
        drive: 0.02,
    };
    let resonance = PhaseResonance::of(&driven)
        .vary("drive")
        .to(0.04)
        .between(0.45, 1.4);
    let cancel = Cancel::new();
    let stop_at_third = |progress: Progress<'_>| {
        if progress.done == 3 {
            cancel.cancel();
        }
        ControlFlow::Continue(())
    };
    let part = free
        .clone()
        .cancel(&cancel)
        .run_with(stop_at_third)
        .expect("three points");
    assert_eq!((part.stopped, part.points.len()), (Stop::Interrupted, 3));
    let nothing = free.cancel(&cancel).run().expect_err("it is cancelled");
    assert_eq!(nothing.kind(), ErrorKind::Cancelled);
    let nothing = resonance
        .clone()
        .cancel(&cancel)
        .run()
        .expect_err("it is cancelled");
    assert_eq!(nothing.kind(), ErrorKind::Cancelled);
    let cancel = Cancel::new();
    let stop_at_third = |progress: Progress<'_>| {
        if progress.done == 3 {
            cancel.cancel();
        }
        ControlFlow::Continue(())
    };
    let part = resonance
        .cancel(&cancel)
        .run_with(stop_at_third)
        .expect("three points");
    assert_eq!((part.stopped, part.points.len()), (Stop::Interrupted, 3));
}
