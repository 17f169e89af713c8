//! A rotor on eight balls that move with the cage, in the manner of Sunnersjo (1978).
//!
//! The balls are alike, so the orbits come back after the passage of one, a sixteenth of the period of the declaration. All methods
//! know of the balls that they are alike: the balance has the harmonics of a passage only, the others follow a passage only. What
//! begins where the time of a passage doubles has an eighth of the declared period, and multipliers of one over all of it.

use hertzian::EventKind::{Fold, PeriodDoubling};
use hertzian::{Branch, ContactEquation, EventKind, FrequencyResponse, Shooting, Side, Verdict};

use super::{all_found, of_shooting};

hertzian::oscillator! {
    /// Balls at angles that are two fifths of those of the rotor, with a clearance.
    Bearing(x, y) {
        param load;
        let cage = 2/5*omega*t;
        law ball(gap) { gap > 0 => gap^1.5, else => 0 }
        ddot(x) + 0.05*dot(x) + for j in 0..8 {
            let angle = cage + 2*pi*j/8;
            cos(angle)*ball(x*cos(angle) + y*sin(angle) - 0.1)
        } = load;
        ddot(y) + 0.05*dot(y) + for j in 0..8 {
            let angle = cage + 2*pi*j/8;
            sin(angle)*ball(x*cos(angle) + y*sin(angle) - 0.1)
        } = 0;
    }
}

/// DOP853 in extended precision, confirmed by harmonic balance to 13 digits.
const FOLDS: [(EventKind, f64); 2] = [(Fold, 0.352_318_220_738_17), (Fold, 0.358_054_523_901_42)];
/// The same, confirmed by Hill's determinant to 11 digits.
const UPPER: [(EventKind, f64); 1] = [(PeriodDoubling, 0.734_596_381_464_95)];
const LOWER: [(EventKind, f64); 1] = [(PeriodDoubling, 0.664_785_786_802_24)];

/// Every event of the range, one for each that is known, and none besides.
fn all_and_no_more(branch: &Branch, known: &[(EventKind, f64)], digits: f64) {
    all_found(&of_shooting(branch), known, digits);
    let besides = branch.events.iter().filter(|event| {
        let kinds = [Fold, PeriodDoubling, EventKind::BranchPoint];
        kinds.contains(&event.kind)
    });
    assert_eq!(besides.count(), known.len(), "{:?}", branch.events);
    assert!(branch.turns.is_empty(), "{:?}", branch.turns);
    for point in &branch.points {
        assert_eq!((point.orbit.period, point.orbit.parts), (1, 16));
    }
}

#[test]
fn both_folds_are_found() {
    by_shooting([0.35, 0.36], &FOLDS, 1e-13);
    by_shooting([0.36, 0.35], &FOLDS, 1e-13);
}

#[test]
fn the_upper_doubling_of_a_passage_is_found() {
    by_shooting([0.7344, 0.7348], &UPPER, 1e-11);
    by_shooting([0.7348, 0.7344], &UPPER, 1e-11);
}

#[test]
fn the_lower_doubling_of_a_passage_is_found() {
    by_shooting([0.6646, 0.665], &LOWER, 1e-11);
    by_shooting([0.665, 0.6646], &LOWER, 1e-11);
}

#[test]
fn the_contact_equation_finds_all() {
    for ([from, to], known, digits) in [
        ([0.35, 0.36], &FOLDS[..], 1e-13),
        ([0.7344, 0.7348], &UPPER[..], 1e-11),
        ([0.6646, 0.665], &LOWER[..], 1e-11),
    ] {
        by_contact_equation([from, to], known, digits);
        by_contact_equation([to, from], known, digits);
    }
}

#[test]
fn the_balance_finds_the_folds() {
    let ends = [0.352, 0.3585];
    either_way(ends, |ends| by_balance(ends, &FOLDS, 1e-13, false));
}

#[test]
fn the_balance_finds_the_doublings_of_a_passage() {
    either_way([0.7348, 0.7344], |ends| {
        by_balance(ends, &UPPER, 1e-11, true);
    });
    either_way([0.6646, 0.665], |ends| {
        by_balance(ends, &LOWER, 1e-11, true);
    });
}

/// From one end of a range to the other, which takes half a minute of a core; and back, where the variable `HERTZIAN_BOTH_WAYS` is set.
fn either_way([from, to]: [f64; 2], follow: impl Fn([f64; 2])) {
    follow([from, to]);
    if std::env::var_os("HERTZIAN_BOTH_WAYS").is_some() {
        follow([to, from]);
    }
}

fn by_balance(range: [f64; 2], known: &[(EventKind, f64)], digits: f64, bifurcations: bool) {
    let model = Bearing { load: 1.0 };
    let request = FrequencyResponse::of(&model).from(range[0]).to(range[1]);
    let request = request.stability(false).bifurcations(bifurcations);
    all_and_no_more(&request.run().unwrap(), known, digits);
}

fn by_contact_equation([from, to]: [f64; 2], known: &[(EventKind, f64)], digits: f64) {
    let model = Bearing { load: 1.0 };
    let request = FrequencyResponse::of(&model).by(ContactEquation::new());
    let branch = request.from(from).to(to).run().unwrap();
    all_and_no_more(&branch, known, digits);
}

fn by_shooting([from, to]: [f64; 2], known: &[(EventKind, f64)], digits: f64) {
    let model = Bearing { load: 1.0 };
    let request = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .from(from)
        .to(to)
        .max_points(120);
    all_and_no_more(&request.run().unwrap(), known, digits);
}

/// The orbits that begin at the upper doubling come back after two passages, an eighth of the declared period, by both methods: the same
/// orbits, that end where the passage doubles again.
#[test]
fn what_begins_there_has_twice_the_passage() {
    let model = Bearing { load: 1.0 };
    let request = FrequencyResponse::of(&model).from(0.7352).to(0.7340);
    let of_balance = request.clone().stability(false).bifurcations(true);
    let branch = of_balance.run().unwrap();
    let event = branch.events(PeriodDoubling).next().unwrap();
    let of_balance = branch.switch(event, Side::One).unwrap();
    let branch = request.by(Shooting::new()).run().unwrap();
    let event = branch.events(PeriodDoubling).next().unwrap();
    let of_shooting = branch.switch(event, Side::One).unwrap();
    for branch in [&of_balance, &of_shooting] {
        assert_eq!(branch.period(), 1);
        assert!(branch.points.iter().all(|point| point.orbit.parts == 8));
    }
    let value = 0.73445;
    let [a, b] = [&of_balance, &of_shooting].map(|branch| branch.at(value).unwrap());
    let [a, b] = [&a[0], &b[0]];
    assert_eq!(b.stability.verdict, Verdict::Stable);
    for (a, b) in a.observed.motions.iter().zip(&b.observed.motions) {
        let error = (a.peak_to_peak() - b.peak_to_peak()).abs() / b.peak_to_peak();
        assert!(error < 1e-6, "{error:e}");
    }
}
