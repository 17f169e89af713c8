//! Where curves of folds of twice the period end, and closed ones, which are followed once.

use hertzian::bifurcation::{Bifurcations, Reason};
use hertzian::shooting::{Special, SpecialKind};
use hertzian::{EventKind, FrequencyResponse, Shooting, Side, Stop};

use crate::bifurcations::codimension::Bending;

hertzian::oscillator! {
    /// A cubic spring with a stop of Hertz.
    CubicWithStop(x) {
        param drive;
        law stop(gap) { gap > 0 => 20*gap^1.5, else => 0 }
        ddot(x) + 0.06*dot(x) + x + x^3 + stop(x - 1) = drive*cos(omega*t);
    }
}

fn apart(a: &Special, b: [f64; 2]) -> f64 {
    (a.values[0] - b[0]).abs().max((a.values[1] - b[1]).abs())
}

/// The branch that begins at the edge of the tongue bends with the sign of `bend`: its folds end where that is zero, at the edge.
#[test]
fn folds_of_twice_the_period_end_at_a_degenerate_doubling() {
    let model = Bending { k: 0.2, bend: -0.7 };
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("k")
        .omega(1.0)
        .from(0.1)
        .to(0.4);
    let branch = shooting.run().unwrap();
    let found = branch
        .events(EventKind::PeriodDoubling)
        .find_map(|doubling| {
            let branch = shooting.switch(doubling, Side::One).unwrap();
            let fold = branch.events(EventKind::Fold).next().cloned();
            fold.map(|fold| (doubling.point.value, fold))
        });
    let (edge, fold) = found.unwrap();
    let track = shooting.track(&fold, "bend", [-1.0, 1.0]).unwrap();
    assert!(
        track.ends.contains(&Stop::JoinedDoublings),
        "{:?}",
        track.ends
    );
    let special = track.special.iter();
    let special: Vec<_> = special
        .filter(|special| special.kind == SpecialKind::Degenerate)
        .collect();
    let [special] = special[..] else {
        panic!("{:?}", track.special);
    };
    let error = apart(special, [edge, 0.0]);
    assert!(
        error <= special.error && special.error < 1e-6,
        "{special:?} {edge} {error:.1e}"
    );
}

/// The doublings close upon themselves, and are degenerate at two points; there the folds of twice the period end, after one cusp.
/// That does not depend on where the points of the curves are.
#[test]
fn a_closed_curve_is_followed_once_and_folds_end_on_it() {
    for from in [1.0, 1.007] {
        folds_end_on_doublings(from);
    }
}

fn folds_end_on_doublings(from: f64) {
    let model = CubicWithStop { drive: 1.0 };
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .from(from)
        .to(1.4);
    let branch = shooting.run().unwrap();
    let doubling = branch.events(EventKind::PeriodDoubling).next().unwrap();
    let doublings = shooting.track(doubling, "drive", [0.5, 2.0]).unwrap();
    assert_eq!(doublings.ends, [Stop::Closed; 2]);
    let degenerate = |special: &&Special| special.kind == SpecialKind::Degenerate;
    let begins: Vec<_> = doublings.special.iter().filter(degenerate).collect();
    assert_eq!(begins.len(), 2, "{:?}", doublings.special);
    let longer = shooting.switch(doubling, Side::One).unwrap();
    let fold = longer.folds().next().unwrap();
    let folds = shooting.track(fold, "drive", [0.5, 2.0]).unwrap();
    assert_eq!(folds.ends, [Stop::JoinedDoublings; 2]);
    let cusps = folds.special.iter();
    let cusps = cusps.filter(|special| special.kind == SpecialKind::Cusp);
    assert_eq!(cusps.count(), 1, "{:?}", folds.special);
    let ends: Vec<_> = folds.special.iter().filter(degenerate).collect();
    assert_eq!(ends.len(), 2);
    for end in ends {
        let apart = |begin: &&&Special| apart(begin, end.values);
        let begin = begins.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
        let begin = begin.unwrap();
        let (error, stated) = (apart(&begin), begin.error + end.error);
        assert!(
            error < 1e-6 && error <= stated,
            "{begin:?} {end:?} {error:.1e}"
        );
    }
}

/// Below the stop the orbits are symmetric, and a loop of orbits without the symmetry leaves them at one point and meets them at another.
#[test]
fn a_closed_branch_is_followed_once() {
    let model = CubicWithStop { drive: 1.0 };
    let request = Bifurcations::of(&model).from(0.6).to(0.8);
    let diagram = request.run().unwrap();
    let closed = |end: Stop| end == Stop::Closed;
    let loops = diagram.branches.iter();
    let loops = loops.filter(|branch| closed(branch.branch.stopped));
    assert_eq!(loops.count(), 1);
    let known = diagram.omitted.iter();
    let mut known = known.filter(|omitted| matches!(omitted.reason, Reason::BranchEnds { .. }));
    assert!(known.next().is_some(), "{:?}", diagram.omitted);
}

/// The orbit does not touch the stop, and is odd although the system is not: its harmonic next to the first is the third.
#[test]
fn one_harmonic_of_an_odd_orbit_says_what_it_leaves_out() {
    let model = CubicWithStop { drive: 0.3 };
    let request = FrequencyResponse::of(&model);
    let exact = request.orbit(1.8).unwrap().peak_to_peak();
    let one = request.harmonics(1).orbit(1.8).unwrap();
    let error = (one.peak_to_peak() / exact - 1.0).abs();
    let stated = one.error.unwrap();
    assert!(error > 1e-6 && error <= stated, "{error:.1e} {stated:.1e}");
}
