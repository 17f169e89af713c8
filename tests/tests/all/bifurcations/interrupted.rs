//! Computations that their caller ends give back what they have.

use std::ops::ControlFlow;

use hertzian::attractors::basin::{Axis, Basin, Grid};
use hertzian::bifurcation::{Bifurcations, Reason};
use hertzian::error::ErrorKind;
use hertzian::{Cancel, FrequencyResponse, Progress, Shooting, Stop};

use crate::bifurcations::cascade::MODEL;

#[test]
fn a_search_for_coexisting_motions() {
    let axis = |entry| Axis::of(entry).from(-20.0).to(20.0).cells(64);
    let basin = Basin::of(&MODEL).grid(Grid::new(vec![0.0, 0.0], axis(0), axis(1)));
    let mut asked = 0;
    let watch = |progress: Progress<'_>| {
        assert_eq!(progress.total, Some(64 * 64));
        asked += 1;
        ControlFlow::Break(())
    };
    let request = Bifurcations::of(&MODEL).vary("drive").omega(1.0);
    let request = request.from(1.0).to(1.2).depth(0).search(1.0, basin);
    let visit = |_: Progress<'_>| ControlFlow::Continue(());
    let diagram = request.run_watched(visit, watch).unwrap();
    assert_eq!(asked, 1);
    assert_eq!(diagram.branches.len(), 1);
    assert_eq!(diagram.missed, [(1.0, Reason::Interrupted)]);
}

/// What begins on the first branch, and what a search would find, is not followed, with the reason.
#[test]
fn branches_that_begin_on_one_another() {
    let cancel = Cancel::new();
    let request = Bifurcations::of(&MODEL).vary("drive").omega(1.0);
    let request = request.from(1.0).to(1.5).depth(1).cancel(&cancel);
    let diagram = request.run_with(|progress| {
        if progress.point.is_some_and(|point| point.orbit.period == 2) {
            cancel.cancel();
        }
        ControlFlow::Continue(())
    });
    let diagram = diagram.unwrap();
    assert_eq!(diagram.branches.len(), 2);
    assert_eq!(diagram.branches[0].branch.stopped, Stop::ReachedEnd);
    let part = &diagram.branches[1].branch;
    assert_eq!(part.stopped, Stop::Interrupted);
    assert_eq!(part.points.len(), 1);
    // At the same place with the token cancelled beforehand nothing begins at all.
    let kind = request.run().unwrap_err().kind();
    assert_eq!(kind, ErrorKind::Cancelled);
}

#[test]
fn a_curve_in_two_parameters() {
    let shooting = FrequencyResponse::of(&MODEL)
        .by(Shooting::new())
        .from(0.6)
        .to(1.1);
    let branch = shooting.run().unwrap();
    let fold = branch.folds().next().unwrap();
    let mut seen = 0;
    let track = shooting.track_with(fold, "drive", [0.03, 0.5], |_| {
        seen += 1;
        if seen < 5 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    let track = track.unwrap();
    assert_eq!(seen, 5);
    assert_eq!(track.points.len(), 5);
    assert_eq!(track.ends, [Stop::Interrupted; 2]);
    // The points that it has are those of the whole curve.
    let whole = shooting.track(fold, "drive", [0.03, 0.5]).unwrap();
    let first = whole
        .points
        .iter()
        .position(|point| *point == track.points[0]);
    let first = first.expect("a point of the whole curve");
    assert_eq!(whole.points[first..first + 5], track.points);
}
