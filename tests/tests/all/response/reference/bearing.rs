//! A rotor on eight balls that move with the cage, in the manner of Sunnersjo (1978).
//!
//! The balls are alike, so the orbits come back after the passage of one, a sixteenth of the period of the declaration. All methods
//! know of the balls that they are alike: the balance has the harmonics of a passage only, the others follow a passage only. What
//! begins where the time of a passage doubles has an eighth of the declared period, and multipliers of one over all of it.

use hertzian::EventKind::PeriodDoubling;
use hertzian::{Branch, Complex, ContactEquation, FrequencyResponse, Shooting, Side, Verdict};
use hertzian_tests::reference::{Accuracy, Case, touches};

use super::from_either_end;

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

const ACCURACY: Accuracy = Accuracy {
    of_peaks: 1e-8,
    of_multipliers: 1e-8,
};

/// Where folds are, and where the passage of a ball doubles, with what their last digits leave open.
const FOLDS: [f64; 2] = [0.35, 0.36];
const OF_FOLDS: f64 = 1e-13;
const UPPER: [f64; 2] = [0.7344, 0.7348];
const LOWER: [f64; 2] = [0.6646, 0.665];
const OF_DOUBLINGS: f64 = 1e-11;

/// Every event of a range, one for each that is known, and none besides but grazings.
fn all_and_no_more(branch: &Branch, [a, b]: [f64; 2], digits: f64) {
    let case = Case::of("E1").within([a.min(b), a.max(b)]);
    assert!(!case.events.is_empty());
    let besides = case.besides(branch, digits);
    assert!(
        besides.iter().all(|event| touches(event.kind)),
        "{besides:#?}"
    );
    assert!(branch.turns.is_empty(), "{:?}", branch.turns);
    for point in &branch.points {
        assert_eq!((point.orbit.period, point.orbit.parts), (1, 16));
    }
}

hertzian::oscillator! {
    /// Three balls that turn with the excitation, their forces as outputs.
    Three(x, y) {
        law ball(gap) { gap > 0 => gap^1.5, else => 0 }
        let second = omega*t + 2*pi/3;
        let third = omega*t + 4*pi/3;
        let a = x*cos(omega*t) + y*sin(omega*t) - 0.1;
        let b = x*cos(second) + y*sin(second) - 0.1;
        let c = x*cos(third) + y*sin(third) - 0.1;
        ddot(x) + 0.3*dot(x) + cos(omega*t)*ball(a) + cos(second)*ball(b) + cos(third)*ball(c) = 1;
        ddot(y) + 0.3*dot(y) + sin(omega*t)*ball(a) + sin(second)*ball(b) + sin(third)*ball(c) = 0;
        output first = ball(a);
        output next = ball(b);
        output last = ball(c);
    }
}

/// Each ball carries the load once in a turn, as every other one does, though a passage alone is followed.
#[test]
fn every_ball_has_its_turn() {
    let request = FrequencyResponse::of(&Three {}).from(0.5).to(0.52);
    let by_shooting = request.clone().by(Shooting::new()).run().unwrap();
    let by_contact_equation = request.by(ContactEquation::new()).run().unwrap();
    for branch in [by_shooting, by_contact_equation] {
        for point in &branch.points {
            assert_eq!(point.orbit.parts, 3);
            let [first, others @ ..] = &point.observed.outputs[..] else {
                panic!("no outputs");
            };
            assert!(first.maximum > 0.5 && first.minimum == 0.0, "{first:?}");
            for other in others {
                let apart = (other.maximum / first.maximum - 1.0).abs();
                assert!(apart < 1e-10, "{} {apart:e}", point.value);
                assert_eq!(other.minimum, 0.0);
            }
        }
    }
}

#[test]
fn both_folds_are_found() {
    by_shooting(FOLDS, OF_FOLDS);
}

#[test]
fn the_upper_doubling_of_a_passage_is_found() {
    by_shooting(UPPER, OF_DOUBLINGS);
}

#[test]
fn the_lower_doubling_of_a_passage_is_found() {
    by_shooting(LOWER, OF_DOUBLINGS);
}

#[test]
fn the_contact_equation_finds_all() {
    let model = Bearing { load: 1.0 };
    let request = FrequencyResponse::of(&model).by(ContactEquation::new());
    for (range, digits) in [
        (FOLDS, OF_FOLDS),
        (UPPER, OF_DOUBLINGS),
        (LOWER, OF_DOUBLINGS),
    ] {
        for branch in from_either_end(&request, range) {
            all_and_no_more(&branch, range, digits);
        }
    }
}

#[test]
fn the_balance_finds_the_folds() {
    by_balance([0.352, 0.3585], OF_FOLDS, false);
}

#[test]
fn the_balance_finds_the_doublings_of_a_passage() {
    let turned = |[low, high]: [f64; 2]| [high, low];
    by_balance(turned(UPPER), OF_DOUBLINGS, true);
    by_balance(turned(LOWER), OF_DOUBLINGS, true);
}

/// From one end of a range to the other, which takes half a minute of a core; and back, where the variable `HERTZIAN_BOTH_WAYS` is set.
fn by_balance(range: [f64; 2], digits: f64, bifurcations: bool) {
    let model = Bearing { load: 1.0 };
    let request = FrequencyResponse::of(&model).stability(false);
    let request = request.bifurcations(bifurcations);
    let follow = |[from, to]: [f64; 2]| {
        let branch = request.clone().from(from).to(to).run().unwrap();
        all_and_no_more(&branch, range, digits);
    };
    follow(range);
    if std::env::var_os("HERTZIAN_BOTH_WAYS").is_some() {
        follow([range[1], range[0]]);
    }
}

fn by_shooting(range: [f64; 2], digits: f64) {
    let model = Bearing { load: 1.0 };
    let request = FrequencyResponse::of(&model).by(Shooting::new());
    for branch in from_either_end(&request.max_points(120), range) {
        all_and_no_more(&branch, range, digits);
    }
}

/// Known are multipliers of the passage of a ball, of which those of the declared period are powers. Over all passages every ball has the largest
/// force of all.
#[test]
fn orbits_are_those_that_are_known() {
    let model = Bearing { load: 1.0 };
    let request = FrequencyResponse::of(&model);
    for range in [[0.35, 0.36], [0.6995, 0.7005], [0.9995, 1.0005]] {
        let mut case = Case::of("E1").within(range);
        for orbit in &mut case.orbits {
            let largest = orbit
                .max_contact_force
                .iter()
                .fold(0.0, |m: f64, x| m.max(*x));
            orbit.max_contact_force = vec![largest; 2];
            for multiplier in &mut orbit.multipliers {
                let all = Complex::new(multiplier[0], multiplier[1]).powi(16);
                *multiplier = [all.re, all.im];
            }
        }
        let request = request.clone().from(range[0]).to(range[1]);
        let by_shooting = request.clone().by(Shooting::new()).run();
        let by_contact_equation = request.by(ContactEquation::new()).run();
        for branch in [by_shooting, by_contact_equation] {
            case.assert_orbits(&branch.unwrap(), &["ball_1", "ball_4"], ACCURACY);
        }
    }
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
