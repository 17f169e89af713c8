//! The same orbits in several ways, and all orbits at a value.

use hertzian::{Aft, Branch, ContactEquation, FrequencyResponse, Shooting, System, Verdict};

use crate::response::{CONTACT, Continuous, Duffing};

#[test]
fn a_sweep_of_the_drive_is_the_same_curve() {
    let by_omega = FrequencyResponse::of(&CONTACT)
        .from(0.6)
        .to(1.0)
        .run()
        .unwrap();
    let target = by_omega.at(0.8).unwrap();
    let by_drive = FrequencyResponse::of(&CONTACT)
        .vary("drive")
        .omega(0.8)
        .from(0.01)
        .to(0.2)
        .run()
        .unwrap();
    let found = by_drive.at(0.1).unwrap();
    assert!((found[0].peak_to_peak() - target[0].peak_to_peak()).abs() < 1e-9);
    assert_eq!(by_drive.varied, "drive");
    assert_eq!(found[0].omega(), 0.8);
    assert_eq!(found[0].value, 0.1);
    assert_eq!(found[0].parameters[3], 0.1);
}

#[test]
fn every_solution_at_a_value_is_returned() {
    let model = Continuous {
        zeta: 0.01,
        alpha: 1.5,
        load: 0.0,
        drive: 0.1,
    };
    let branch = FrequencyResponse::of(&model)
        .from(0.6)
        .to(1.7)
        .run()
        .unwrap();
    let three = branch.at(1.1).unwrap();
    assert_eq!(three.len(), 3);
    assert_eq!(
        three
            .iter()
            .map(|p| p.stability.verdict)
            .collect::<Vec<_>>(),
        [Verdict::Stable, Verdict::Unstable, Verdict::Stable]
    );
    assert!(three.iter().all(|point| point.omega() == 1.1));
    assert_eq!(branch.at(1.5).unwrap().len(), 1);
    assert!(branch.at(2.0).unwrap().is_empty());
    assert_eq!(branch.at(0.6).unwrap().len(), 1);
}

#[test]
fn generated_and_interpreted_models_give_one_curve() {
    let interpreted = CONTACT.generic();
    let request = |system| FrequencyResponse::of(system).from(1.2).to(1.5).harmonics(8);
    let a = request(&CONTACT as &dyn System).run().unwrap();
    let b = request(&interpreted).run().unwrap();
    assert_eq!(a.points.len(), b.points.len());
    for (p, q) in a.points.iter().zip(&b.points) {
        assert!((p.peak_to_peak() - q.peak_to_peak()).abs() < 1e-12);
    }
}

/// Near a fold there are three orbits on one side and one on the other; all are found by every method, and none twice. Those of the contact
/// equation are those of shooting within the stated errors.
#[test]
fn every_solution_is_returned_beside_a_fold() {
    let model = Continuous {
        zeta: 0.01,
        alpha: 1.5,
        load: 0.0,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model).from(0.6).to(1.7);
    let balance = request.clone().harmonics(10).samples(512).run().unwrap();
    let contact = request.clone().by(ContactEquation::new()).run().unwrap();
    let shooting = request.by(Shooting::new()).run().unwrap();
    for branch in [&balance, &contact, &shooting] {
        for (value, count) in beside_folds(branch, &[1e-3, 1e-4, 3e-5, 1e-5, 1e-6]) {
            let found = branch.at(value).unwrap();
            let sizes: Vec<f64> = found.iter().map(hertzian::Point::peak_to_peak).collect();
            let method = branch.method();
            assert_eq!(found.len(), count, "{method:?} {value}: {sizes:?}");
            assert!(found.iter().all(|point| point.value == value));
            assert!(
                sizes
                    .windows(2)
                    .all(|pair| (pair[0] - pair[1]).abs() > 1e-6),
                "{sizes:?}"
            );
        }
    }
    for (value, count) in beside_folds(&contact, &[0.1, 1e-2, 1e-4]) {
        let [orbits, others] = [&contact, &shooting].map(|branch| branch.at(value).unwrap());
        assert_eq!([orbits.len(), others.len()], [count; 2]);
        for (orbit, other) in orbits.iter().zip(&others) {
            let apart = (orbit.peak_to_peak() / other.peak_to_peak() - 1.0).abs();
            let stated = orbit.error.unwrap() + other.error.unwrap();
            assert!(
                apart <= stated && stated < 1e-6,
                "{value}: {apart} {stated}"
            );
        }
    }
}

/// Orbits at a value have as many nodes as the tolerance asks for, and not those that a search begins with.
#[test]
fn orbits_at_a_value_follow_the_tolerance() {
    let request = FrequencyResponse::of(&CONTACT).from(0.6).to(0.9);
    let exact = request.clone().by(Shooting::new()).tolerance(1e-12).run();
    let exact = exact.unwrap().at(0.7).unwrap();
    for tolerance in [1e-6, 1e-10] {
        let contact = request.clone().by(ContactEquation::new());
        let found = contact.tolerance(tolerance).run().unwrap().at(0.7).unwrap();
        assert_eq!(found.len(), exact.len());
        for (orbit, exact) in found.iter().zip(&exact) {
            let apart = (orbit.peak_to_peak() / exact.peak_to_peak() - 1.0).abs();
            let stated = orbit.error.unwrap();
            assert!(stated <= tolerance, "{stated} for {tolerance}");
            assert!(apart <= stated + exact.error.unwrap(), "{apart} {stated}");
        }
    }
}

/// Values beside the folds of a branch that bends to smaller ones, at some distances, with how many orbits there are.
fn beside_folds(branch: &Branch, distances: &[f64]) -> Vec<(f64, usize)> {
    let folds: Vec<f64> = branch.folds().map(|fold| fold.point.value).collect();
    let (upper, lower) = (folds[0].max(folds[1]), folds[0].min(folds[1]));
    let beside = distances.iter().flat_map(|distance| {
        [
            (upper - distance, 3),
            (upper + distance, 1),
            (lower + distance, 3),
            (lower - distance, 1),
        ]
    });
    beside.collect()
}

/// All three methods agree where contact is not lost.
#[test]
fn methods_agree_on_a_smooth_orbit() {
    let at = |aft| {
        let request = FrequencyResponse::of(&CONTACT)
            .from(1.5)
            .to(1.6)
            .harmonics(8);
        let branch = request.aft(aft).stability(false).run().unwrap();
        branch.points[0].peak_to_peak()
    };
    let switched = at(Aft::Switched);
    for aft in [Aft::Sampled, Aft::Primitive] {
        assert!((at(aft) / switched - 1.0).abs() < 1e-10, "{aft}");
    }
}

/// An odd system with one harmonic is not perfect: its next harmonic is the third.
#[test]
fn one_harmonic_of_an_odd_system_states_its_error() {
    let model = Duffing {
        zeta: 0.05,
        drive: 1.0,
    };
    let request = FrequencyResponse::of(&model).from(0.5).to(0.6);
    let one = request.clone().harmonics(1).run().unwrap().points[0].clone();
    let many = request.harmonics(21).run().unwrap().points[0].clone();
    let off = (one.peak_to_peak() / many.peak_to_peak() - 1.0).abs();
    let stated = one.error.unwrap();
    assert!(off > 0.05 && stated > off / 3.0, "{off} {stated}");
}
