//! Touches of levels where the stiffness is unbounded: slopes and multipliers are continuous there, and change faster than steps can see.

use hertzian::{Branch, EventKind, FrequencyResponse, Shooting, Stop, System};

hertzian::oscillator! {
    /// Two masses, one of which comes to a stop that is stiffer than any spring at first.
    Masses(x, y) {
        law stop(gap) { gap > 0 => 6.425*gap^0.6 + 0.02198*dot(gap), else => 0 }
        ddot(x) + 0.02198*dot(x) + x + 0.5*(x - y) + stop(x - 0.819) = 0.74101*cos(omega*t);
        ddot(y) + 0.02198*dot(y) + y + 0.5*(y - x) = 0;
    }
}

hertzian::oscillator! {
    /// The same with an exponent below a half: what the stop does to the motion rises faster than the root of how far it goes in.
    Harder(x, y) {
        law stop(gap) { gap > 0 => 6.425*gap^0.4 + 0.02198*dot(gap), else => 0 }
        ddot(x) + 0.02198*dot(x) + x + 0.5*(x - y) + stop(x - 0.819) = 0.74101*cos(omega*t);
        ddot(y) + 0.02198*dot(y) + y + 0.5*(y - x) = 0;
    }
}

hertzian::oscillator! {
    /// A cubic spring that is pressed into such a stop.
    Pressed(x) {
        law stop(gap) { gap > 0 => 3.018*gap^0.6 + 0.01046*dot(gap), else => 0 }
        ddot(x) + 0.01046*dot(x) + x + 0.2*x^3 + stop(x + 0.398) = 0.5932*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// Two masses with a cubic spring that is pressed into such a stop.
    PressedMasses(x, y) {
        law stop(gap) { gap > 0 => 2.882*gap^0.6 + 0.1288*dot(gap), else => 0 }
        ddot(x) + 0.1288*dot(x) + x + 0.2*x^3 + 0.5*(x - y) + stop(x + 0.669) = 1.0015*cos(omega*t);
        ddot(y) + 0.1288*dot(y) + y + 0.5*(y - x) = 0;
    }
}

fn branch(model: &dyn System, from: f64, to: f64) -> Branch {
    let request = FrequencyResponse::of(model).by(Shooting::new());
    let branch = request.from(from).to(to).run().unwrap();
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    branch
}

fn values(branch: &Branch, is_wanted: impl Fn(EventKind) -> bool) -> Vec<f64> {
    let wanted = branch.events.iter().filter(|event| is_wanted(event.kind));
    let mut values: Vec<f64> = wanted.map(|event| event.point.value).collect();
    values.sort_by(f64::total_cmp);
    values
}

fn is_touch(kind: EventKind) -> bool {
    matches!(kind, EventKind::Grazing { .. })
}

/// The largest displacement of the first of both masses without a stop: half of the sum of two modes, whose squared frequencies are one
/// and two.
fn free_amplitude(omega: f64) -> f64 {
    let mode = |square: f64| {
        let (re, im) = (square - omega * omega, 0.02198 * omega);
        let size = re * re + im * im;
        [re / size, -im / size]
    };
    let [a, b] = [mode(1.0), mode(2.0)];
    0.5 * 0.74101 * (a[0] + b[0]).hypot(a[1] + b[1])
}

/// Where the amplitude without a stop is the clearance, between two frequencies.
fn touch_between(mut low: f64, mut high: f64) -> f64 {
    let beyond = |omega: f64| free_amplitude(omega) > 0.819;
    let rises = beyond(high);
    assert_ne!(beyond(low), rises);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if beyond(middle) == rises {
            &mut high
        } else {
            &mut low
        }) = middle;
    }
    0.5 * (low + high)
}

fn touches_of_free_masses() -> [f64; 3] {
    [
        touch_between(0.6, 0.65),
        touch_between(1.1, 1.2),
        touch_between(1.2, 1.35),
    ]
}

fn assert_touches(branch: &Branch, exact: [f64; 3]) {
    for value in exact {
        let mut events = branch.events.iter().filter(|event| is_touch(event.kind));
        let found = events.find(|event| (event.point.value - value).abs() <= event.error);
        assert!(found.is_some(), "{value} {:?}", values(branch, is_touch));
    }
}

/// Multipliers are unbounded beside such a touch, and the branch may have a corner there.
#[test]
fn touches_of_an_exponent_below_a_half_are_passed() {
    let exact = touches_of_free_masses();
    let model = Harder {};
    let both = [(0.6, 1.6), (1.6, 0.6)].map(|(from, to)| branch(&model, from, to));
    for branch in &both {
        assert_touches(branch, exact);
        // Whatever changes has its event.
        assert_eq!(branch.turns, []);
    }
    let wanted: [fn(EventKind) -> bool; 4] = [
        |kind| kind == EventKind::Fold,
        |kind| kind == EventKind::PeriodDoubling,
        |kind| kind == EventKind::NeimarkSacker,
        |kind| kind == EventKind::Grazing { turns: true },
    ];
    for wanted in wanted {
        let [up, down] = [0, 1].map(|which| values(&both[which], wanted));
        assert_eq!(up.len(), down.len(), "{up:?} {down:?}");
        for (a, b) in up.iter().zip(&down) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
    }
}

/// Whichever way the branch is followed, it passes every touch, and each is where the motion without a stop reaches it. Folds and torus
/// bifurcations that lie within `1e-9` of a touch are found with it.
#[test]
fn what_lies_beside_a_touch_is_found_from_both_sides() {
    let exact = touches_of_free_masses();
    let model = Masses {};
    let [up, down] = [(0.6, 1.6), (1.6, 0.6)].map(|(from, to)| branch(&model, from, to));
    for branch in [&up, &down] {
        assert_touches(branch, exact);
    }
    let folds = [&up, &down].map(|branch| values(branch, |kind| kind == EventKind::Fold));
    assert_eq!(folds[0].len(), folds[1].len(), "{folds:?}");
    for (a, b) in folds[0].iter().zip(&folds[1]) {
        assert!((a - b).abs() < 1e-10, "{a} {b}");
    }
    assert!(folds[0].iter().any(|fold| (fold - exact[1]).abs() < 1e-9));
}

/// Where no step leads beyond a touch the orbit behind it is gone to by its height above the level. The change of the verdict is said to
/// be at the touch.
#[test]
fn a_touch_that_no_step_passes_is_passed() {
    let model = Pressed {};
    let from = FrequencyResponse::of(&model).from(1.1075).to(1.3);
    let balance = from.clone().run().unwrap();
    let near = from
        .by(Shooting::new())
        .near_orbit(&balance.points[0].orbit);
    let branch = near.run().unwrap();
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    let touches = values(&branch, is_touch);
    let touch = touches[0];
    let back = self::branch(&model, 1.3, 1.1);
    let same = values(&back, is_touch);
    let apart = |value: &f64| (value - touch).abs();
    assert!(
        same.iter().any(|value| apart(value) < 1e-9),
        "{touch} {same:?}"
    );
    for branch in [&branch, &back] {
        for turn in &branch.turns {
            assert!((turn.value - touch).abs() < 1e-8, "{turn:?}");
        }
    }
}

/// Doublings beside a touch are the same in both directions.
#[test]
fn doublings_beside_a_touch_are_found_from_both_sides() {
    let model = PressedMasses {};
    let doubles = |kind| kind == EventKind::PeriodDoubling;
    let found = [(0.7, 1.1), (1.1, 0.7)].map(|(from, to)| {
        let branch = branch(&model, from, to);
        [values(&branch, doubles), values(&branch, is_touch)]
    });
    let [[up, touches], [down, _]] = &found;
    assert_eq!(up.len(), down.len(), "{found:?}");
    for (a, b) in up.iter().zip(down) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
    let last = up.last().unwrap();
    let beside = touches.iter().any(|touch| (touch - last).abs() < 1e-9);
    assert!(beside, "{last} {touches:?}");
}
