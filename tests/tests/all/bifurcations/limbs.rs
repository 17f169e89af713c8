//! Walks that could step from one limb of a branch to another beside the touch of a level: whichever way and by whatever method a branch is
//! followed, it has the same events, reaches the end of its range, and turns at no place that was not found.

use hertzian::{Branch, ContactEquation, EventKind, FrequencyResponse, Shooting, Stop, System};

use crate::bifurcations::behind_touch::chain;

hertzian::oscillator! {
    /// Gears with an error of their motion, in the gap
    Kinematic(x) {
        law mesh(gap) { gap > 1 => gap - 1, -1 <= gap <= 1 => 0, gap < -1 => gap + 1 }
        ddot(x) + 0.104*dot(x) + mesh(x - 0.35*sin(omega*t)) = 0.19;
    }
}

hertzian::oscillator! {
    /// Gears whose stiffness changes with two harmonics of the mesh
    Meshing(x) {
        law mesh(gap) { gap > 1.4 => gap - 1.4, -1.4 <= gap <= 1.4 => 0, gap < -1.4 => gap + 1.4 }
        ddot(x) + 0.174*dot(x) + (1 + 0.062*cos(omega*t) + 0.18*cos(2*omega*t + 0.7))*mesh(x) = 0.29 + 0.065*omega^2*cos(omega*t);
    }
}

/// Values and errors of all events, in the order of their values.
fn events(branch: &Branch) -> Vec<(EventKind, f64, f64)> {
    let events = branch.events.iter();
    let mut events: Vec<_> = events
        .map(|event| (event.kind, event.point.value, event.error))
        .collect();
    events.sort_by(|a, b| a.1.total_cmp(&b.1));
    events
}

/// Every walk finds what the first one does.
pub(super) fn agrees(system: &dyn System, [from, to]: [f64; 2]) {
    let mut first = None;
    for ends in [[from, to], [to, from]] {
        let request = FrequencyResponse::of(system).from(ends[0]).to(ends[1]);
        let by_contact_equation = request.clone().by(ContactEquation::new()).run().unwrap();
        let by_shooting = request.by(Shooting::new()).run().unwrap();
        for branch in [by_contact_equation, by_shooting] {
            assert_eq!(branch.stopped, Stop::ReachedEnd, "{ends:?}");
            assert_eq!(branch.turns, [], "{ends:?}");
            let found = events(&branch);
            let wanted = first.get_or_insert_with(|| found.clone());
            assert_eq!(found.len(), wanted.len(), "{ends:?}: {found:?} {wanted:?}");
            for (found, wanted) in found.iter().zip(&*wanted) {
                assert_eq!(found.0, wanted.0, "{found:?} {wanted:?}");
                assert!(found.2 < 1e-6, "{found:?}");
                let off = (found.1 - wanted.1).abs();
                assert!(
                    off <= 3.0 * (found.2 + wanted.2) + 1e-14,
                    "{found:?} {wanted:?}"
                );
            }
        }
    }
}

/// Backwards a step of shooting leads from the branch onto a closed curve beside the touch at 0.5124.
#[test]
fn gears_with_an_error_of_their_motion() {
    agrees(&Kinematic {}, [0.4, 2.3]);
}

/// Beside the touches of two equal stops steps lead to other limbs, by both methods; from one orbit to the next of the contact equation shooting
/// needs another orbit between them.
#[test]
fn masses_between_two_equal_stops() {
    let stops = [(1, 1.0, 27.0, 0.92), (1, -1.0, 27.0, 0.92)];
    let structure = chain(3, 0.029, 0.15, &stops);
    agrees(&structure, [0.3, 1.3]);
    let request = FrequencyResponse::of(&structure).from(1.3).to(0.3);
    let by_contact_equation = request.clone().by(ContactEquation::new()).run().unwrap();
    let by_shooting = request.by(Shooting::new()).run().unwrap();
    let [one, other] = [by_contact_equation, by_shooting].map(|branch| branch.at(0.65).unwrap());
    assert_eq!(one.len(), other.len());
    for (one, other) in one.iter().zip(&other) {
        let off = (one.peak_to_peak() / other.peak_to_peak() - 1.0).abs();
        let stated = one.error.unwrap() + other.error.unwrap();
        assert!(off <= 3.0 * stated + 1e-13, "{off:e} {stated:e}");
    }
}

/// Forwards a step of the contact equation leads behind a fold that no gap tells of, from where the walk would go back.
#[test]
fn a_step_round_a_fold() {
    let stops = [
        (0, 1.0, 4.3, 1.0),
        (1, 1.0, 44.0, 0.38),
        (2, 1.0, 4.9, 0.56),
    ];
    agrees(&chain(4, 0.052, 0.11, &stops), [0.25, 1.1]);
}

/// Backwards two minima of the gap reach the level in one step of the contact equation, in the middle of which no orbit is found.
#[test]
fn two_touches_of_a_gear() {
    agrees(&Meshing {}, [0.4, 2.3]);
}

/// At one frequency there are three orbits. That on the middle limb is so unstable that the way from its neighbours leads to another one.
#[test]
fn orbits_on_three_limbs() {
    let system = chain(3, 0.046, 0.33, &[(0, 1.0, 88.0, 0.6), (0, -1.0, 88.0, 0.6)]);
    let request = FrequencyResponse::of(&system).from(0.3).to(1.3);
    let branch = request.by(ContactEquation::new()).run().unwrap();
    let found = branch.at(0.437).unwrap();
    let heights: Vec<f64> = found.iter().map(hertzian::Point::peak_to_peak).collect();
    let wanted = [1.240_409_866_82, 1.257_157_029_03, 1.256_989_635_09];
    assert_eq!(heights.len(), 3, "{heights:?}");
    for (found, wanted) in heights.iter().zip(wanted) {
        assert!((found - wanted).abs() < 1e-8, "{found} {wanted}");
    }
}

hertzian::oscillator! {
    /// A spring of two stiffnesses
    Bilinear(x) {
        law spring(gap) { gap > 0 => 9*gap, else => gap }
        ddot(x) + 0.08*dot(x) + spring(x) = 0.3902*cos(omega*t) + 0.4;
    }
}

/// Downwards a step of the contact equation leads from 0.486, where the parameter rises before a fold, to orbits of 0.505 that were passed, where it falls: slope and determinant
/// change their signs at no place.
#[test]
fn a_step_back_to_orbits_that_were_passed() {
    let request = FrequencyResponse::of(&Bilinear {}).from(3.5).to(0.4);
    let by_contact_equation = request.clone().by(ContactEquation::new()).run().unwrap();
    let by_shooting = request.by(Shooting::new()).run().unwrap();
    let [one, other] = [by_contact_equation, by_shooting].map(|branch| {
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        assert_eq!(branch.turns, []);
        let folds = branch.events(EventKind::Fold);
        folds.map(|event| event.point.value).collect::<Vec<f64>>()
    });
    assert_eq!(one.len(), 12);
    assert_eq!(other.len(), 12);
    for (one, other) in one.iter().zip(&other) {
        assert!((one - other).abs() < 1e-12, "{one} {other}");
    }
}
