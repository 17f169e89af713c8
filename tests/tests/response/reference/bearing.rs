//! A rotor on eight balls that move with the cage, in the manner of Sunnersjo (1978).
//!
//! The balls are alike, so the orbits come back after the passage of one, a sixteenth of the period of the declaration. There a
//! doubling of the period of a passage is a multiplier of one: a branch point. The balance knows of the balls that they are alike,
//! and has the harmonics of a passage only.

use hertzian::EventKind::{BranchPoint, Fold};
use hertzian::{EventKind, FrequencyResponse, Shooting};

use super::{Found, all_found, of_shooting};

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
const UPPER: [(EventKind, f64); 1] = [(BranchPoint, 0.734_596_381_464_95)];
const LOWER: [(EventKind, f64); 1] = [(BranchPoint, 0.664_785_786_802_24)];

#[test]
fn both_folds_are_found() {
    run([0.35, 0.36], &FOLDS, 1e-13);
}

#[test]
fn the_upper_doubling_of_a_passage_is_found() {
    run([0.733, 0.736], &UPPER, 1e-11);
    run([0.736, 0.733], &UPPER, 1e-11);
}

#[test]
fn the_lower_doubling_of_a_passage_is_found() {
    run([0.664, 0.666], &LOWER, 1e-11);
}

#[test]
fn the_balance_finds_them_too() {
    let model = Bearing { load: 1.0 };
    for (range, known, digits) in [
        ([0.352, 0.3585], &FOLDS[..], 1e-13),
        ([0.7352, 0.734], &UPPER[..], 1e-11),
    ] {
        let request = FrequencyResponse::of(&model).from(range[0]).to(range[1]);
        let request = request.stability(false).bifurcations(range[0] > 0.7);
        let branch = request.run().unwrap();
        let events = branch.events.iter().map(|event| Found {
            kind: event.kind,
            value: event.point.value,
            error: event.error,
        });
        all_found(&events.collect::<Vec<_>>(), known, digits);
    }
}

fn run([from, to]: [f64; 2], known: &[(EventKind, f64)], digits: f64) {
    let model = Bearing { load: 1.0 };
    let request = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .from(from)
        .to(to)
        .max_points(120);
    let found = of_shooting(&request.run().unwrap());
    all_found(&found, known, digits);
}
