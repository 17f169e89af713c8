//! Ranges covered by several branches: folds and doublings are those of Wang et al. (2021), computed with 60 digits independently of
//! this project.

use hertzian::attractors::basin::Fate;
use hertzian::bifurcation::{Bifurcations, Diagram, DiagramBranch, Origin, Settling};
use hertzian::{
    Complex, EventKind, FrequencyResponse, OrbitMethod, Point, Shooting, Stop, Verdict,
};
use hertzian_tests::{OneSided, OneSidedLinear};

const HERTZ: OneSided = OneSided {
    zeta: 0.032,
    alpha: 1.5,
    load: 1.0,
    drive: 0.1,
};
/// Where the branch of small orbits of figure 5b turns back.
const FOLD: f64 = 1.144_516_913_788;
/// A1 of figure 8: from here on the orbits of period one are unstable.
const DOUBLING: f64 = 1.282_584_167_663_767;

/// A sweep that begins on a branch that turns back goes on from the other end.
fn turns_back<M: OrbitMethod>(request: &FrequencyResponse<M>) {
    assert_eq!(request.run().expect("a branch").stopped, Stop::LeftAtStart);
    let diagram = request.cover().expect("branches");
    let origins: Vec<Origin> = diagram
        .branches
        .iter()
        .map(|branch| branch.origin)
        .collect();
    assert_eq!(origins, [Origin::First, Origin::OtherEnd]);
    assert_eq!(diagram.branches[1].branch.stopped, Stop::ReachedEnd);
    assert!(diagram.uncovered.is_empty() && diagram.missed.is_empty());
    // There is a stable orbit at every value: no motion was followed.
    assert!(diagram.searched.is_empty());
    let folds: Vec<_> = diagram.events(EventKind::Fold).collect();
    assert_eq!(folds.len(), 1);
    let (branch, fold) = folds[0];
    assert_eq!(branch, 0);
    assert!((fold.point.value - FOLD).abs() <= 3.0 * fold.error + 1e-10);
}

#[test]
fn a_branch_that_turns_back_is_joined_by_that_from_the_other_end() {
    let request = FrequencyResponse::of(&HERTZ).from(1.0).to(1.6);
    turns_back(&request);
    turns_back(&request.by(Shooting::new()));
}

fn of_period_two(diagram: &Diagram) {
    let searched = &diagram.searched[0];
    assert!(searched.value > DOUBLING);
    let orbit = searched.orbits[0];
    assert_eq!(orbit.period, 2);
    assert!(searched.count(Fate::Periodic(0)) > 0);
    let branch = &diagram.branches[orbit.branch.expect("a branch")].branch;
    let joins = |stop: Option<Stop>| match stop {
        Some(Stop::Joined { value, .. }) => (value - DOUBLING).abs() < 1e-6,
        _ => false,
    };
    assert!(joins(branch.begin) || joins(Some(branch.stopped)));
    let at = branch.at(1.4).expect("orbits");
    assert!(
        at.iter()
            .any(|point| point.stability.verdict == Verdict::Stable)
    );
    assert!(diagram.uncovered.is_empty());
}

/// Beyond a doubling motions settle to orbits of twice the period.
#[test]
fn where_all_is_unstable_motions_lead_to_what_is_not() {
    let model = OneSidedLinear {
        zeta: 0.032,
        load: 1.0,
        drive: 1.0,
    };
    let request = FrequencyResponse::of(&model).vary("drive").omega(1.0);
    let request = request.from(1.2).to(1.5);
    of_period_two(&request.cover().expect("branches"));
    of_period_two(
        &request
            .clone()
            .by(Shooting::new())
            .cover()
            .expect("branches"),
    );
    // Its own number of motions, at the values that were asked for.
    let request = Bifurcations::starting_with(request.by(Shooting::new()));
    let settling = Settling::new().values(4).starts(6);
    let diagram = request.depth(1).max_period(2).cover(settling).run();
    let diagram = diagram.expect("branches");
    assert_eq!(diagram.searched.len(), 4);
    for searched in &diagram.searched {
        assert_eq!(searched.fates.len(), 6);
        let periodic = searched
            .fates
            .iter()
            .filter(|fate| matches!(fate, Fate::Periodic(_)));
        assert!(periodic.count() > 0);
        assert!(searched.orbits.iter().all(|orbit| orbit.branch.is_some()));
    }
    let begun = diagram
        .branches
        .iter()
        .filter(|branch| matches!(branch.origin, Origin::Event { .. }));
    assert!(begun.clone().count() > 0 && begun.clone().all(|branch| branch.period() <= 2));
}

/// What cannot be is refused before any work.
#[test]
fn options_that_cannot_be_are_refused() {
    let request = Bifurcations::of(&HERTZ).from(1.0).to(1.6);
    for settling in [
        Settling::new().starts(0),
        Settling::new().longest(0),
        Settling::new().patience(0),
        Settling::new().values(usize::MAX),
    ] {
        let error = request
            .clone()
            .cover(settling)
            .run()
            .expect_err("a refusal");
        assert_eq!(error.kind(), hertzian::error::ErrorKind::Request, "{error}");
    }
}

hertzian::oscillator! {
    /// A mass in one of two wells.
    Wells(x) {
        ddot(x) + 0.2*dot(x) - x + x^3 = 0.05*cos(omega*t);
    }
}

/// One motion settles in one of the wells. The orbit in the other one is its image: `-x(t + T/2)`.
#[test]
fn images_of_what_one_motion_settles_to_are_covered_too() {
    let request = Bifurcations::of(&Wells {}).from(1.1).to(1.2).depth(0);
    let settling = Settling::new().values(1).starts(1);
    let diagram = request.by(Shooting::new()).cover(settling).run();
    let diagram = diagram.expect("branches");
    let searched = &diagram.searched[0];
    assert_eq!(searched.fates.len(), 2);
    let orbits = searched.orbits.iter().map(|orbit| {
        let branch = &diagram.branches[orbit.branch.expect("a branch")].branch;
        branch.at(searched.value).expect("orbits").remove(0)
    });
    let ends: Vec<[f64; 2]> = orbits
        .map(|point| point.observed.motions[0])
        .map(|motion| [motion.minimum, motion.maximum])
        .collect();
    assert_eq!(ends.len(), 2);
    assert!((ends[0][0] + ends[1][1]).abs() < 1e-9 && (ends[0][1] + ends[1][0]).abs() < 1e-9);
    assert!(ends[0][0] * ends[0][1] > 0.0, "{ends:?}");
}

/// The orbit of period three at frequency one that is stable there: peak-to-peak and a multiplier, as in `coexisting`.
const OF_PERIOD_3: (f64, [f64; 2]) = (
    40.702_307_432_878_71,
    [-0.380_774_924_593_537_2, 0.817_888_662_584_343_5],
);

/// Few motions settle to it from rest and from the nearest orbit. Newton's method leads to its branch.
#[test]
fn orbits_that_no_motion_settles_to_are_solved_for() {
    let model = OneSidedLinear {
        zeta: 0.032,
        load: 1.0,
        drive: 1.0,
    };
    let request = Bifurcations::of(&model).from(1.2).to(0.8).depth(0);
    let settling = Settling::new().values(4).starts(2);
    let diagram = request.cover(settling).run().expect("branches");
    let solved = |branch: &&DiagramBranch| matches!(branch.origin, Origin::Solved { .. });
    assert!(diagram.branches.iter().filter(solved).count() > 3);
    let (peak_to_peak, [re, im]) = OF_PERIOD_3;
    let is_it = |point: &Point| {
        let pair = &point.stability.multipliers;
        let exact = Complex::new(re, im);
        let near = pair.iter().any(|m| (m - exact).norm() < 1e-9);
        near && (point.peak_to_peak() / peak_to_peak - 1.0).abs() < 1e-9
    };
    let passing = diagram.branches.iter().filter(|branch| {
        let at = branch.branch.at(1.0).unwrap_or_default();
        branch.period() == 3 && at.iter().any(is_it)
    });
    assert_eq!(passing.count(), 1, "{} branches", diagram.branches.len());
}
