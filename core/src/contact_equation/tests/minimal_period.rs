//! Orbits that come back earlier, and orbits of several periods, against shooting.

use super::{derivatives_are_those_of_differences_of, first_of};
use crate::branches::recurrence::{Recurrence, SignedPermutation};
use crate::{Branch, ContactEquation, EventKind, FrequencyResponse, Shooting, Stop};

crate::oscillator! {
    /// One law on both sides.
    Stops(x) {
        law stop(gap) { gap > 0.3 => 8*(gap - 0.3), gap < -0.3 => 8*(gap + 0.3), else => 0 }
        ddot(x) + 0.05*dot(x) + 0.2*x + stop(x) = 0.3*cos(omega*t);
    }
}

crate::oscillator! {
    /// Two laws that are each other's image.
    Sides(x, y) {
        param drive;
        law left(gap) { gap > 0 => 5*gap + 0.2*gap*dot(gap), else => 0 }
        law right(gap) { gap > 0 => 5*gap + 0.2*gap*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + 0.5*x + (x - y) + left(x - 0.2) - right(-x - 0.2) = drive*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 0.3*y - (x - y) = 0;
    }
}

crate::oscillator! {
    /// Three contacts around, of which each takes the next one's place in a third of the period.
    Around(x, y) {
        param load;
        law ball(gap) { gap > 0 => 2*gap + 0.1*gap*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + for j in 0..3 {
            let angle = omega*t + 2*pi*j/3;
            cos(angle)*ball(x*cos(angle) + y*sin(angle) - 0.1)
        } = load;
        ddot(y) + 0.1*dot(y) + 0.4*y + for j in 0..3 {
            let angle = omega*t + 2*pi*j/3;
            sin(angle)*ball(x*cos(angle) + y*sin(angle) - 0.1)
        } = 0;
    }
}

crate::oscillator! {
    OneSided(x) {
        param drive;
        law contact(gap) { gap > 0 => 0.04*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = 1 + drive*cos(omega*t);
    }
}

fn minus(coordinates: usize) -> Recurrence {
    Recurrence {
        period: 1,
        parts: 2,
        image: SignedPermutation::minus(coordinates),
    }
}

#[test]
fn matrices_of_a_part_are_those_of_differences() {
    let sides = Sides { drive: 0.5 };
    derivatives_are_those_of_differences_of(&sides, None, 0.8, 1, &minus(2));
    derivatives_are_those_of_differences_of(&sides, Some("drive"), 0.8, 2, &minus(2));
}

/// Kind, value and number of contacts of all events but touches, in order, and of the touches.
fn events(branch: &Branch) -> [Vec<(EventKind, f64, usize)>; 2] {
    let is_touch = |kind: EventKind| matches!(kind, EventKind::Grazing { .. });
    [false, true].map(|touches| {
        let of_kind = branch.events.iter();
        let of_kind = of_kind.filter(|event| is_touch(event.kind) == touches);
        let mut all: Vec<_> = of_kind
            .map(|e| (e.kind, e.point.value, e.contacts))
            .collect();
        all.sort_by(|a, b| a.1.total_cmp(&b.1));
        all
    })
}

/// The same branch by both, with its events, of which there are so many.
fn is_that_of_shooting(request: &FrequencyResponse, parts: usize, count: usize, tolerance: f64) {
    let branch = request.clone().by(ContactEquation::new()).run().unwrap();
    let exact = request.clone().by(Shooting::new().tolerance(1e-12));
    let exact = exact.run().unwrap();
    assert_eq!(branch.turns, []);
    let of_part = |branch: &Branch| {
        let mut points = branch.points.iter();
        points.all(|point| point.orbit.parts == parts)
    };
    assert!(of_part(&branch) && of_part(&exact));
    assert!(branch.events.len() >= count, "{:?}", events(&branch));
    for (found, exact) in events(&branch).iter().zip(&events(&exact)) {
        assert_eq!(found.len(), exact.len(), "{found:?} {exact:?}");
        for (found, exact) in found.iter().zip(exact) {
            assert_eq!((found.0, found.2), (exact.0, exact.2));
            assert!((found.1 - exact.1).abs() < tolerance, "{found:?} {exact:?}");
        }
    }
    let middle = &branch.points[branch.points.len() / 2];
    let shooting = request.clone().by(Shooting::new().tolerance(1e-12));
    let other = shooting
        .near_orbit(&middle.orbit)
        .orbit(middle.value)
        .unwrap();
    let pairs = middle.observed.motions.iter().zip(&other.observed.motions);
    for (a, b) in pairs {
        assert!((a.maximum - b.maximum).abs() < 1e-6, "{a:?} {b:?}");
        assert!((a.minimum - b.minimum).abs() < 1e-6, "{a:?} {b:?}");
    }
    let [a, b] = [middle, &other].map(|point| &point.stability);
    let spread = crate::numeric::spectrum::distance(&a.multipliers, &b.multipliers);
    assert!(spread < a.error + b.error + 1e-9, "{spread:e}");
    assert_eq!(middle.observed.switches, other.observed.switches);
}

#[test]
fn symmetric_orbits_are_followed_for_half_of_a_period() {
    is_that_of_shooting(
        &FrequencyResponse::of(&Stops {}).from(0.3).to(2.0),
        2,
        6,
        1e-9,
    );
    let sides = Sides { drive: 0.5 };
    is_that_of_shooting(&FrequencyResponse::of(&sides).from(0.6).to(1.2), 2, 0, 1e-8);
}

#[test]
fn contacts_in_turn_are_followed_for_one_passage() {
    let around = Around { load: 0.5 };
    is_that_of_shooting(
        &FrequencyResponse::of(&around).from(0.5).to(0.7),
        3,
        0,
        1e-8,
    );
}

/// Orbits of two periods, which end where they have one: as by shooting.
#[test]
fn orbits_of_two_periods_end_where_they_have_one() {
    let model = OneSided { drive: 1.4 };
    let request = FrequencyResponse::of(&model).from(1.0).to(2.0).period(2);
    let branch = request.clone().by(ContactEquation::new()).run().unwrap();
    let exact = request.by(Shooting::new().tolerance(1e-11)).run().unwrap();
    let joint = |branch: &Branch| match branch.stopped {
        Stop::Joined {
            period: 1, value, ..
        } => value,
        other => panic!("{other:?}"),
    };
    assert!((joint(&branch) - joint(&exact)).abs() < 1e-8);
    // That is where orbits of one period double, which is a simple zero along them.
    let doubled = FrequencyResponse::of(&model).from(1.4).to(1.5);
    let doubled = doubled.by(Shooting::new().tolerance(1e-12)).run().unwrap();
    let doubled = doubled.events(EventKind::PeriodDoubling).next().unwrap();
    let crossed = branch.events(EventKind::BranchPoint).next().unwrap();
    let apart = (crossed.point.value - doubled.point.value).abs();
    assert!(apart <= crossed.error + doubled.error, "{apart:e}");
    assert!(crossed.error < 1e-9, "{:e}", crossed.error);
    assert!(branch.points.iter().all(|point| point.orbit.period == 2));
    let doublings = |branch: &Branch| -> Vec<f64> {
        let found = branch.events(EventKind::PeriodDoubling);
        found.map(|event| event.point.value).collect()
    };
    let (found, exact) = (doublings(&branch), doublings(&exact));
    assert_eq!(found.len(), exact.len());
    assert!((found[0] - exact[0]).abs() < 1e-9, "{found:?} {exact:?}");
}

/// An orbit of one period is none of two.
#[test]
fn an_orbit_of_a_shorter_period_is_refused() {
    let model = OneSided { drive: 0.1 };
    let plain = FrequencyResponse::of(&model);
    let near = plain.orbit(1.4).unwrap();
    let request = plain.by(ContactEquation::new()).period(2);
    let refused = request.near_orbit(&near.orbit).orbit(1.4);
    assert!(refused.is_err(), "{refused:?}");
}

/// What is followed is a half of the orbit, with half of the unknowns.
#[test]
fn half_of_an_orbit_has_half_of_the_unknowns() {
    let sides = Sides { drive: 0.5 };
    let unknowns = |recurrence: &Recurrence| {
        let (equations, _) = first_of(&sides, None, 0.8, [16, 1], recurrence);
        equations.skeleton.forces
    };
    assert_eq!(2 * unknowns(&minus(2)), unknowns(&Recurrence::whole(1)));
}
