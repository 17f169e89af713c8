//! Equal masses that move alike, or alike half a period later, until they do not: the symmetry by which they take each other's place breaks
//! where the motion of their difference, or of their sum, has a multiplier of one or of minus one by Mathieu's equation with damping.
//!
//! Exact values: Hill's determinant of that equation of order 41, with 15 digits; without damping it has the characteristic values of
//! Mathieu's functions (Abramowitz and Stegun, chapter 20).

use hertzian::{Branch, Event, EventKind, FrequencyResponse, Shooting, Side, System};

hertzian::oscillator! {
    /// The difference `w` has `w'' + 0.02 w' + (1 + 2 spring + cos(omega t)/2) w + 2 w^3 = 0`, the sum a spring and the drive alone.
    pub Alike(x, y) {
        param spring;
        ddot(x) + 0.11*dot(x) + 0.09*dot(y) + x + (spring + cos(omega*t)/4)*(x - y) + (x - y)^3 = 0.1*cos(omega*t);
        ddot(y) + 0.09*dot(x) + 0.11*dot(y) + y - (spring + cos(omega*t)/4)*(x - y) - (x - y)^3 = 0.1*cos(omega*t);
    }
}

/// Half of Hill's `delta` less one, for `w'' + 0.02 w' + (delta + cos(t)/2) w = 0` with a solution of period `2 pi`.
const ALIKE: [f64; 2] = [-0.008_722_335_397_24, 0.044_746_595_947_88];

hertzian::oscillator! {
    /// The sum `u` has `u'' + 0.04 u' + (spring + 0.2 cos(2 omega t)) u + u^2 + u^3 = 0`, the difference a spring and the drive.
    pub Opposite(x, y) {
        param spring;
        ddot(x) + 0.12*dot(x) - 0.08*dot(y) + 1.3*x - 1.3*y
            + (spring/2 + 0.1*cos(2*omega*t))*(x + y) + (x + y)^2/2 + (x + y)^3/2 = cos(omega*t);
        ddot(y) - 0.08*dot(x) + 0.12*dot(y) - 1.3*x + 1.3*y
            + (spring/2 + 0.1*cos(2*omega*t))*(x + y) + (x + y)^2/2 + (x + y)^3/2 = -cos(omega*t);
    }
}

/// Hill's `delta` for `u'' + 0.04 u' + (delta + 0.2 cos(2 t)) u = 0` with a solution of period `2 pi` that changes its sign after half of it.
const OPPOSITE: [f64; 2] = [0.907_121_038_078_296, 1.090_379_082_111_55];

/// Both places where the symmetry breaks, and nothing else that crosses.
fn breaks(branch: &Branch, known: [f64; 2]) -> Vec<&Event> {
    let kinds = [
        EventKind::SymmetryBreaking,
        EventKind::BranchPoint,
        EventKind::PeriodDoubling,
    ];
    let events = branch.events.iter();
    let events: Vec<_> = events.filter(|event| kinds.contains(&event.kind)).collect();
    assert_eq!(events.len(), 2, "{events:?} {:?}", branch.turns);
    let rises = events[0].point.value < events[1].point.value;
    for (i, event) in events.iter().enumerate() {
        assert_eq!(event.kind, EventKind::SymmetryBreaking);
        let known = known[if rises { i } else { 1 - i }];
        let error = (event.point.value - known).abs();
        assert!(
            error < event.error + 1e-13 && error < 1e-8,
            "{event} {known}"
        );
    }
    events
}

fn request(model: &dyn System, [from, to]: [f64; 2]) -> FrequencyResponse {
    let request = FrequencyResponse::of(model).vary("spring").omega(1.0);
    request.from(from).to(to).largest_step(0.1)
}

#[test]
fn masses_that_move_alike_cease_to() {
    let model = Alike { spring: 0.0 };
    for range in [[-0.02, 0.06], [0.06, -0.02]] {
        let by_balance = request(&model, range).bifurcations(true).run().unwrap();
        breaks(&by_balance, ALIKE);
    }
}

/// A half of the period is followed, so that the multiplier is minus one there.
#[test]
fn masses_that_move_alike_half_a_period_later_cease_to() {
    let model = Opposite { spring: 1.0 };
    for range in [[0.85, 1.15], [1.15, 0.85]] {
        let by_balance = request(&model, range).bifurcations(true).run().unwrap();
        breaks(&by_balance, OPPOSITE);
        let by_shooting = request(&model, range).by(Shooting::new()).run().unwrap();
        breaks(&by_shooting, OPPOSITE);
        let parts = |branch: &Branch| branch.points.iter().all(|point| point.orbit.parts == 2);
        assert!(parts(&by_shooting));
    }
}

/// What begins there are orbits of the same period, on the two sides with the masses in each other's place.
#[test]
fn the_two_sides_are_images_of_each_other() {
    let model = Opposite { spring: 1.0 };
    let request = request(&model, [0.85, 1.15]).by(Shooting::new());
    let branch = request.run().unwrap();
    sides_are_images(&branch, 1.08);
}

#[test]
fn the_two_sides_are_images_by_the_balance() {
    let model = Alike { spring: 0.0 };
    let request = request(&model, [-0.02, 0.06]).bifurcations(true);
    let branch = request.tolerance(1e-9).run().unwrap();
    sides_are_images(&branch, 0.03);
}

/// At a value that what begins at the last event passes.
fn sides_are_images(branch: &Branch, value: f64) {
    let mut events = branch.events(EventKind::SymmetryBreaking);
    let event = events.next_back().unwrap();
    let [a, b] = [Side::One, Side::Other].map(|side| {
        let broken = branch.switch(event, side).unwrap();
        assert_eq!(broken.period(), 1);
        assert!(broken.points.iter().all(|point| point.orbit.parts == 1));
        let found = broken.at(value).unwrap();
        let motions = &found.last().unwrap().observed.motions;
        [motions[0].peak_to_peak(), motions[1].peak_to_peak()]
    });
    assert!((a[0] - a[1]).abs() > 1e-3, "{a:?}");
    assert!(
        (a[0] - b[1]).abs() < 1e-7 && (a[1] - b[0]).abs() < 1e-7,
        "{a:?} {b:?}"
    );
}

hertzian::oscillator! {
    /// A rotor on equal supports that harden, with an unbalance.
    Rotor(x, y) {
        ddot(x) + 0.3*dot(x) + 0.2*y + x + x^3 = cos(omega*t);
        ddot(y) + 0.3*dot(y) - 0.2*x + y + y^3 = sin(omega*t);
    }
}

/// A quarter of a turn later the two directions are in each other's place: a quarter of the period is followed, and multipliers are those of
/// all of it.
#[test]
fn a_rotor_on_equal_supports_comes_back_after_a_quarter_of_a_turn() {
    let model = Rotor {};
    let request = FrequencyResponse::of(&model).from(0.5).to(0.6);
    let by_balance = request.clone().tolerance(1e-9).run().unwrap();
    let by_shooting = request.by(Shooting::new()).run().unwrap();
    assert!(
        by_shooting
            .points
            .iter()
            .all(|point| point.orbit.parts == 4)
    );
    for value in [0.52, 0.57] {
        let [a, b] = [&by_balance, &by_shooting].map(|branch| branch.at(value).unwrap());
        let [a, b] = [&a[0], &b[0]];
        for (a, b) in a.observed.motions.iter().zip(&b.observed.motions) {
            assert!((a.maximum - b.maximum).abs() < 1e-8, "{a:?} {b:?}");
            assert!((a.minimum - b.minimum).abs() < 1e-8, "{a:?} {b:?}");
        }
        for m in &b.stability.multipliers {
            let others = a.stability.multipliers.iter();
            let nearest = others.map(|other| (other - m).norm());
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-7, "{m} {:?}", a.stability);
        }
    }
}
