//! Contacts whose forces are affine: nothing is unknown but states and switches, and orbits are exact. Shooting has them in closed form, too, by
//! other equations (`time::affine`).

use super::{derivatives_are_those_of_differences, events_agree, first};
use crate::contact_equation::ContactEquation;
use crate::continuation::follow::Stop;
use crate::event::EventKind;
use crate::response::FrequencyResponse;
use crate::shooting::Shooting;

crate::oscillator! {
    /// A stop with a spring and a damper, whose force jumps with the rate.
    Stop1(x) {
        param damping = 0.1;
        law stop(gap) { gap > 0 => 5*gap + damping*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - 0.2) = 0.1 + 0.4*cos(omega*t);
    }
}

crate::oscillator! {
    /// Backlash of a mass that nothing else holds.
    Backlash(x) {
        law mesh(gap) { gap > 1 => gap - 1, gap < -1 => gap + 1, else => 0 }
        ddot(x) + 0.06*dot(x) + mesh(x) = 0.3 + 0.2*cos(omega*t);
    }
}

crate::oscillator! {
    /// Two masses with stops, whose dampers are no part of the modes.
    Pair(x, y) {
        param k = 20;
        param c = 0.3;
        law stop(gap) { gap > 0 => k*gap + c*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + 0.5*x + x - y + stop(x - 0.2) = 0.4*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 0.3*y - x + y - stop(-y - 0.2) = 0;
    }
}

crate::oscillator! {
    /// A stop that is far stiffer than the spring, with a damper.
    Hard(x) {
        law stop(gap) { gap > 0 => 10000*gap + 5*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - 0.2) = 0.4*cos(omega*t);
    }
}

#[test]
fn no_force_is_unknown() {
    let models: [&dyn crate::system::System; 3] = [
        &Stop1 { damping: 0.1 },
        &Backlash {},
        &Pair { k: 20.0, c: 0.3 },
    ];
    for model in models {
        let (equations, u) = first(model, None, 0.8, [12, 1]);
        assert_eq!(equations.skeleton.forces, 0);
        assert!(!equations.skeleton.configurations.is_empty());
        let switches = equations.skeleton.switches.len();
        assert_eq!(u.len(), equations.skeleton.order + switches + 1);
    }
}

#[test]
fn derivatives_in_closed_form_are_those_of_differences() {
    derivatives_are_those_of_differences(&Stop1 { damping: 0.1 }, None, 0.9, 1);
    derivatives_are_those_of_differences(&Stop1 { damping: 0.1 }, Some("damping"), 0.9, 1);
    derivatives_are_those_of_differences(&Backlash {}, None, 0.9, 1);
    for vary in [None, Some("k"), Some("c")] {
        derivatives_are_those_of_differences(&Pair { k: 20.0, c: 0.3 }, vary, 0.8, 1);
    }
}

#[test]
fn events_are_those_of_the_other_closed_form() {
    events_agree(
        &FrequencyResponse::of(&Stop1 { damping: 0.1 })
            .from(2.0)
            .to(0.3),
    );
    events_agree(&FrequencyResponse::of(&Backlash {}).from(0.3).to(1.5));
    let pair = Pair { k: 20.0, c: 0.3 };
    events_agree(&FrequencyResponse::of(&pair).from(2.2).to(1.0));
    let by_stiffness = FrequencyResponse::of(&pair).vary("k").omega(0.8);
    events_agree(&by_stiffness.from(60.0).to(2.0));
}

/// A first orbit of which the balance knows too little is that of shooting. A fold lies `5e-8` beside the touch that it belongs to, and
/// is told apart from it whatever the steps are.
#[test]
fn a_fold_beside_a_touch_is_told_from_it() {
    let mut folds = Vec::new();
    for [from, to] in [[0.8, 2.2], [0.9, 2.2], [2.2, 0.9]] {
        let request = FrequencyResponse::of(&Hard {}).from(from).to(to);
        let branch = request.by(ContactEquation::new()).run().unwrap();
        assert_eq!(
            (branch.stopped, &branch.turns[..]),
            (Stop::ReachedEnd, &[][..])
        );
        let events = branch.events.iter();
        let beside = events.filter(|event| (event.point.value - 1.729_885_7).abs() < 1e-6);
        let mut beside: Vec<_> = beside
            .map(|event| (event.kind, event.point.value))
            .collect();
        beside.sort_by(|a, b| a.1.total_cmp(&b.1));
        let kinds: Vec<_> = beside.iter().map(|(kind, _)| *kind).collect();
        assert_eq!(
            kinds,
            [EventKind::Fold, EventKind::Grazing { turns: false }]
        );
        folds.push(beside[0].1);
    }
    let request = FrequencyResponse::of(&Hard {}).from(0.9).to(2.2);
    let exact = request.by(Shooting::new()).run().unwrap();
    let exact = exact.folds().last().unwrap().point.value;
    for fold in folds {
        assert!((fold - exact).abs() < 1e-11, "{fold} {exact}");
    }
}

/// Where the damper of a stop is critical, eigenvectors of the configuration are dependent: nodes take its place there.
#[test]
fn branches_go_through_critical_damping() {
    let pair = Pair { k: 20.0, c: 1.0 };
    let request = FrequencyResponse::of(&pair).vary("c").omega(1.2);
    let ways = [[1.0, 30.0], [30.0, 1.0]];
    for [from, to] in ways {
        let request = request.clone().from(from).to(to);
        let branch = request.clone().by(ContactEquation::new()).run().unwrap();
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        let exact = request.by(Shooting::new().tolerance(1e-12)).run().unwrap();
        let [found, exact] = [branch, exact].map(|b| b.points.last().unwrap().peak_to_peak());
        assert!((found - exact).abs() < 1e-10, "{found} {exact}");
    }
}
