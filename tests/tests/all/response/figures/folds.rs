//! Folds of the curves: at the defaults of the library, at given harmonics, and how fast they converge.

use hertzian::{Event, EventKind, FrequencyResponse, OrbitMethodKind, Side, Stop};

use super::exact::{FIGURE_2B_UNLISTED, FIGURE_5A_GALERKIN};
use super::models::{
    FIGURE_2A, FIGURE_2B, FIGURE_2B_BELOW, FIGURE_4A_LOAD_1, FIGURE_4A_LOAD_5, FIGURE_5A,
    FIGURE_5B, FIGURE_5C, Figure,
};

/// Error of the exact values.
const KNOWN: f64 = 1e-12;

/// Every fold found once, none invented: omega within the error stated, omega and peak-to-peak near the exact ones.
fn assert_folds(figure: &Figure, request: &FrequencyResponse) {
    assert_folds_besides(figure, request, &[]);
}

/// The same, where these folds are not among the exact ones.
fn assert_folds_besides(figure: &Figure, request: &FrequencyResponse, unlisted: &[f64]) {
    let branch = request.run().unwrap();
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    assert!(branch.turns.is_empty(), "{:?}", branch.turns);
    let is_unlisted = |fold: &&Event| {
        let near = |value: &f64| (fold.point.value - value).abs() < 1e-6;
        unlisted.iter().any(near)
    };
    let (besides, mut found): (Vec<_>, Vec<_>) = branch.folds().partition(is_unlisted);
    assert_eq!(besides.len(), unlisted.len());
    found.sort_by(|a, b| a.point.value.total_cmp(&b.point.value));
    assert_eq!(found.len(), figure.folds.len(), "{found:?}");
    for (fold, exact) in found.iter().zip(figure.folds) {
        let error = (fold.point.omega() - exact.omega).abs();
        assert!(error <= fold.error + KNOWN, "{fold} {exact:?}");
        assert!(error < 1e-5, "{fold} {exact:?}");
        let size = fold.point.peak_to_peak();
        assert!((size - exact.peak_to_peak).abs() < 1e-4, "{fold} {exact:?}");
        assert!(fold.test.abs() < 1e-10);
    }
}

#[test]
fn at_the_defaults_every_fold_is_found_once() {
    let figures = [
        FIGURE_2A,
        FIGURE_4A_LOAD_1,
        FIGURE_4A_LOAD_5,
        FIGURE_5A,
        FIGURE_5B,
        FIGURE_5C,
    ];
    for figure in &figures {
        let model = figure.model();
        assert_folds(figure, &figure.request(&*model));
    }
}

/// Of Fig. 2b too, from both ends.
#[test]
fn at_the_defaults_figure_2b_has_its_folds() {
    let unlisted: [&[f64]; 2] = [&[], &FIGURE_2B_UNLISTED];
    for (figure, unlisted) in [FIGURE_2B, FIGURE_2B_BELOW].iter().zip(unlisted) {
        let model = figure.model();
        let request = figure.request(&*model);
        assert_folds_besides(figure, &request.clone(), unlisted);
        let back = request.from(figure.to).to(figure.from);
        assert_folds_besides(figure, &back, unlisted);
    }
}

/// Beside touches the branch without symmetry bends sharply: what happens between is located all the same, by steps of any length.
#[test]
fn what_begins_without_symmetry_in_figure_2b_is_whole() {
    let model = FIGURE_2B.model();
    let doublings = [0.896_507_260_971_036, 0.904_833_344_193_996];
    for [from, to] in [[1.6, 0.38], [1.0, 0.85]] {
        let request = FIGURE_2B.request(&*model).from(from).to(to);
        let branch = request.run().unwrap();
        let breaks = |event: &&Event| event.kind == EventKind::SymmetryBreaking;
        let above = branch.events.iter().filter(breaks);
        let event = above.max_by(|a, b| a.point.value.total_cmp(&b.point.value));
        // Of the request where that is quick.
        let broken = if from == 1.0 {
            request.switch(event.unwrap(), Side::One)
        } else {
            branch.switch(event.unwrap(), Side::One)
        };
        let broken = broken.unwrap();
        assert_eq!(broken.method(), Some(OrbitMethodKind::Shooting));
        assert!(broken.turns.is_empty(), "{:?}", broken.turns);
        let doubled = broken.events.iter();
        let doubled = doubled.filter(|event| event.kind == EventKind::PeriodDoubling);
        let mut doubled: Vec<&Event> = doubled.collect();
        doubled.sort_by(|a, b| a.point.value.total_cmp(&b.point.value));
        assert_eq!(doubled.len(), doublings.len(), "{doubled:?}");
        for (found, exact) in doubled.iter().zip(doublings) {
            let apart = (found.point.value - exact).abs();
            assert!(apart <= found.error + KNOWN, "{found} {exact}");
        }
    }
}

#[test]
fn figure_2a_backwards_has_the_same_folds() {
    let model = FIGURE_2A.model();
    let request = FIGURE_2A.request(&*model);
    assert_folds(&FIGURE_2A, &request.from(FIGURE_2A.to).to(FIGURE_2A.from));
}

/// Below its main resonance Fig. 2b has eight folds, two of them 0.0007 apart on a curve that bends there. Wherever a sweep
/// starts, and in either direction, it passes over none.
#[test]
fn no_sweep_steps_over_a_pair_of_folds() {
    let model = FIGURE_2B_BELOW.model();
    for index in 0..16 {
        let from = 0.37 + 0.001 * f64::from(index);
        let to = 0.71 - 0.002 * f64::from(index);
        let ends = if index % 2 == 0 {
            (from, to)
        } else {
            (to, from)
        };
        let request = FIGURE_2B_BELOW.request(&*model).harmonics(10);
        let request = request.from(ends.0).to(ends.1).stability(false);
        let branch = request.run().unwrap();
        let folds: Vec<f64> = branch.folds().map(|fold| fold.point.value).collect();
        assert_eq!(folds.len(), 8, "{ends:?} {folds:?} {}", branch.stopped);
        assert!(branch.turns.is_empty());
    }
}

fn largest(folds: &[Event]) -> &Event {
    let by_size =
        |a: &&Event, b: &&Event| a.point.peak_to_peak().total_cmp(&b.point.peak_to_peak());
    folds.iter().max_by(by_size).unwrap()
}

/// A truncated balance has one answer, whatever computes it.
#[test]
fn figure_5a_solves_the_equations_of_galerkin() {
    for (harmonics, omega) in FIGURE_5A_GALERKIN {
        let folds = FIGURE_5A.folds_with(Some(harmonics));
        assert_eq!(folds.len(), 2, "{folds:?}");
        let fold = largest(&folds);
        assert!((fold.point.value - omega).abs() < 1e-8, "{fold} {omega}");
    }
}

#[test]
fn figures_5b_and_5c_at_20_harmonics() {
    for (figure, count) in [(FIGURE_5B, 2), (FIGURE_5C, 4)] {
        let errors = figure.errors(Some(20));
        assert_eq!(errors.len(), count);
        for (error, _) in errors {
            assert!(error < 1e-4, "{} {error:e}", figure.name);
        }
    }
}

#[test]
fn figure_2a_at_given_harmonics() {
    for (harmonics, bound) in [(5, 2e-6), (10, 1e-7), (20, 2e-9), (40, 5e-11)] {
        // The larger fold is the one of higher frequency.
        let (error, _) = FIGURE_2A.errors(Some(harmonics))[1];
        assert!(error < bound, "{harmonics} harmonics: {error:e}");
    }
}

#[test]
fn figure_2b_at_given_harmonics() {
    for harmonics in [Some(10), Some(20), Some(40), None] {
        for (error, _) in FIGURE_2B.errors(harmonics) {
            assert!(error < 1e-5, "{harmonics:?} {error:e}");
        }
    }
}

/// The order at which the error of one fold falls from few to many harmonics.
fn order(figure: &Figure, fold: usize, few: usize, many: usize) -> f64 {
    let error = |harmonics| figure.errors(Some(harmonics))[fold].0;
    (error(few) / error(many)).ln() / (many as f64 / few as f64).ln()
}

/// Coefficients of a force with a jump in the derivative of order `p` fall as `k^-(p+1)`. In Fig. 5a damping jumps where
/// contact begins: third order. In Fig. 2a the force is as `|t|^1.5`, its coefficients as `k^-2.5`, those of the fold's
/// left null vector, which weighs them, as `k^-3.5`: sixth order. It shows only from ten harmonics on.
#[test]
fn folds_converge_in_their_order() {
    let contact = order(&FIGURE_5A, 0, 10, 80);
    assert!((contact - 3.0).abs() < 0.5, "{contact}");
    let few = order(&FIGURE_2A, 1, 5, 10);
    assert!((few - 4.3).abs() < 0.5, "{few}");
    let many = order(&FIGURE_2A, 1, 10, 40);
    assert!((many - 6.0).abs() < 0.5, "{many}");
    println!("orders: 5a {contact:.2}, 2a {few:.2} from 5 to 10 and {many:.2} from 10 to 40");
}
