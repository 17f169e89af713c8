//! Curves of bifurcations in two parameters: points of them are found again by following branches, where another test function
//! decides.

use hertzian::shooting::{BifurcationCurve, SpecialKind};
use hertzian::{Error, EventKind, FrequencyResponse, RequestError, Shooting, System};
use hertzian_tests::{OneSidedLinear, nearest};

hertzian::oscillator! {
    pub Hertz(x) {
        param zeta >= 0;
        param load;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

/// A contact of one exponent or the other, at a drive.
fn model(hertz: bool, drive: f64) -> Box<dyn System> {
    let (zeta, load) = (0.032, 1.0);
    if hertz {
        Box::new(Hertz { zeta, load, drive })
    } else {
        Box::new(OneSidedLinear { zeta, load, drive })
    }
}

/// Five points, spread by the golden ratio, are events of branches in the frequency.
fn assert_confirmed(track: &BifurcationCurve, hertz: bool) {
    for index in 1..=5 {
        let part = (f64::from(index) * 0.618_033_988_749_895).fract();
        let index = (part * track.points.len() as f64) as usize;
        let [omega, drive] = track.values[index];
        let model = model(hertz, drive);
        // The branch is on one side of a fold, and close to another fold it is short.
        let starts = [2e-4, 2e-5, 2e-3].iter().flat_map(|part| [-part, *part]);
        let found = starts.into_iter().find_map(|part| {
            let aside = |part: f64| omega * (1.0 + part);
            let near = FrequencyResponse::of(&*model)
                .by(Shooting::new())
                .period(track.period)
                .near_state(&track.points[index].orbit.state());
            let branch = near.from(aside(part)).to(aside(-part)).run().ok()?;
            let values = branch.events(track.kind).map(|event| event.point.value);
            nearest(values, omega, |value| *value)
        });
        let error = found.map(|value| (value - omega).abs());
        assert!(
            error.is_some_and(|e| e < 1e-8),
            "{omega} {drive}: {found:?}"
        );
    }
}

pub fn folds(hertz: bool, omega: [f64; 2]) -> BifurcationCurve {
    let model = model(hertz, 0.1);
    let shooting = FrequencyResponse::of(&*model)
        .by(Shooting::new())
        .from(omega[0])
        .to(omega[1]);
    let branch = shooting.run().unwrap();
    let fold = branch.folds().next().unwrap();
    shooting.track(fold, "drive", [0.03, 0.5]).unwrap()
}

/// Folds are born in a cusp: below its drive there are none, above it two.
fn assert_cusp(track: &BifurcationCurve, hertz: bool) {
    let cusps = track.special.iter().filter(|s| s.kind == SpecialKind::Cusp);
    let [cusp] = cusps.collect::<Vec<_>>()[..] else {
        panic!("{:?}", track.special);
    };
    let [omega, drive] = cusp.values;
    for (drive, expected) in [(0.99 * drive, 0), (1.01 * drive, 2)] {
        let model = model(hertz, drive);
        let shooting = FrequencyResponse::of(&*model)
            .by(Shooting::new())
            .largest_step(0.02);
        let branch = shooting.from(1.05 * omega).to(0.95 * omega).run().unwrap();
        assert_eq!(branch.folds().count(), expected, "{drive}");
    }
}

#[test]
fn folds_of_a_linear_contact() {
    let track = folds(false, [0.6, 1.6]);
    assert_confirmed(&track, false);
    assert_cusp(&track, false);
}

/// Where contact is lost, the curve of folds grazes.
#[test]
fn folds_of_a_hertzian_contact() {
    let track = folds(true, [0.6, 1.6]);
    assert_confirmed(&track, true);
    assert_cusp(&track, true);
    let grazing = track
        .special
        .iter()
        .filter(|s| s.kind == SpecialKind::Grazing);
    let grazing: Vec<_> = grazing.collect();
    assert_eq!(grazing.len(), 2);
    for special in grazing {
        let beside = [special.after - 1, special.after];
        let [before, behind] = beside.map(|i| track.points[i].observed.switches);
        assert_ne!(before, behind);
        for k in 0..2 {
            let ends = beside.map(|i| track.values[i][k]);
            let range = ends[0].min(ends[1])..=ends[0].max(ends[1]);
            assert!(range.contains(&special.values[k]), "{special:?} {ends:?}");
        }
        // A branch at that drive touches the level there.
        let [omega, drive] = special.values;
        let model = model(true, drive);
        let branch = FrequencyResponse::of(&*model)
            .by(Shooting::new())
            .from(0.6)
            .to(1.6)
            .run()
            .unwrap();
        let touches = |kind| matches!(kind, EventKind::Grazing { .. });
        let events = branch.events.iter().filter(|event| touches(event.kind));
        let nearest = events.map(|event| (event.point.value - omega).abs());
        let error = nearest.fold(f64::INFINITY, f64::min);
        assert!(special.error < 1e-4, "{special:?}");
        assert!(error <= special.error, "{special:?} {error:e}");
    }
}

/// An event must be inside the ranges of its curve.
#[test]
fn a_curve_begins_inside_its_ranges() {
    let model = model(false, 0.1);
    let shooting = FrequencyResponse::of(&*model)
        .by(Shooting::new())
        .from(0.6)
        .to(1.6);
    let branch = shooting.run().unwrap();
    let fold = branch.folds().next().unwrap();
    let outside = shooting.track(fold, "drive", [0.2, 0.5]).unwrap_err();
    let is_named = |error: &Error, expected: &str| matches!(error.downcast_ref(), Some(RequestError::Option { name, .. }) if *name == expected);
    assert!(is_named(&outside, "within"), "{outside}");
    let narrow = FrequencyResponse::of(&*model)
        .by(Shooting::new())
        .from(1.2)
        .to(1.6);
    let outside = narrow.track(fold, "drive", [0.03, 0.5]).unwrap_err();
    assert!(is_named(&outside, "from"), "{outside}");
}

#[test]
fn period_doublings_of_both_contacts() {
    for (hertz, drive, range) in [(false, 1.35, [1.2, 1.0]), (true, 1.0, [2.7, 2.2])] {
        let model = model(hertz, drive);
        let shooting = FrequencyResponse::of(&*model)
            .by(Shooting::new())
            .from(range[0])
            .to(range[1]);
        let branch = shooting.run().unwrap();
        let doubling = branch.events(EventKind::PeriodDoubling).next().unwrap();
        let track = shooting
            .track(doubling, "drive", [0.9 * drive, 1.1 * drive])
            .unwrap();
        assert_confirmed(&track, hertz);
    }
}
