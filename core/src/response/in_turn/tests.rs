//! What comes after a branch that is lost. It is cut off here, wherever a method is lost by itself.

use std::ops::ControlFlow;

use super::patience::Patience;
use super::{Either, First};
use crate::balance_branch::options::HarmonicBalance;
use crate::branches::point::Point;
use crate::branches::progress::{Progress, Stage};
use crate::branches::request::Request;
use crate::continuation::newton::NewtonError;
use crate::{
    Branch, ContactEquation, EventKind, FrequencyResponse, OrbitMethodKind, Shooting, Stop,
};

crate::oscillator! {
    OneSided(x) {
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
    }
}

/// By either method first.
fn both() -> [(Either, OrbitMethodKind); 2] {
    let balance = HarmonicBalance::new().bifurcations(true);
    [
        (
            Either::of(First::ContactEquation(ContactEquation::new()), balance),
            OrbitMethodKind::ContactEquation,
        ),
        (
            Either::of(First::Shooting(Shooting::new()), balance),
            OrbitMethodKind::Shooting,
        ),
    ]
}

fn request() -> Request {
    let request = FrequencyResponse::of(&OneSided {}).from(0.6).to(1.4);
    request.tolerance(1e-4).request
}

/// Lost after so many orbits.
fn lost(either: &Either, points: usize) -> Branch {
    let part = Request {
        max_points: points,
        ..request()
    };
    let otherwise = either.otherwise(None);
    let found = either
        .first
        .run(&part, otherwise, &mut |_| ControlFlow::Continue(()));
    let found = found.expect("a branch");
    let value = found.points.last().expect("orbits").value;
    let reason = NewtonError::NotFinite { iterations: 0 };
    let (step, reason) = (1e-5, reason);
    Branch {
        stopped: Stop::StepTooShort {
            step,
            value,
            reason,
        },
        ..found
    }
}

#[test]
fn the_balance_comes_farther_and_finds_all() {
    for (either, _) in both() {
        let lost = lost(&either, 40);
        let mut stages = Vec::new();
        let found = either.or_balance(&request(), Ok(lost.clone()), &mut |progress| {
            stages.push(progress.stage);
            ControlFlow::Continue(())
        });
        let found = found.expect("a branch");
        assert_eq!(found.method(), Some(OrbitMethodKind::HarmonicBalance));
        assert_eq!(found.stopped, Stop::ReachedEnd);
        assert!(stages == vec![Stage::Again; found.points.len()]);
        let of = |kind: EventKind| found.events(kind).count();
        // The balance that looks for folds alone has no grazing.
        assert!(of(EventKind::Fold) == 2 && of(EventKind::Grazing { turns: false }) > 0);
        // What was followed in vain is counted.
        assert!(found.elapsed > lost.elapsed);
    }
}

/// As a file has it.
#[cfg(feature = "serde")]
fn from_file(branch: &Branch) -> Branch {
    let text = serde_json::to_string(branch).expect("a text");
    let mut read: Branch = serde_json::from_str(&text).expect("a branch");
    read.attach(&OneSided {}).expect("its model");
    read
}

#[cfg(not(feature = "serde"))]
fn from_file(branch: &Branch) -> Branch {
    branch.clone()
}

/// Interrupted before it comes as far it is tried anew, and after that it goes on.
#[test]
fn what_is_interrupted_goes_on_to_the_same() {
    for (either, first) in both() {
        let go_on = |_: Progress<'_>| ControlFlow::Continue(());
        let whole = either.or_balance(&request(), Ok(lost(&either, 40)), &mut { go_on });
        let whole = whole.expect("a branch");
        for (points, method) in [
            (1, first),
            (5, first),
            (90, OrbitMethodKind::HarmonicBalance),
        ] {
            let part = either.or_balance(&request(), Ok(lost(&either, 40)), &mut |progress| {
                if progress.done < points {
                    ControlFlow::Continue(())
                } else {
                    ControlFlow::Break(())
                }
            });
            let part = part.expect("a part");
            assert_eq!(
                (part.method(), part.stopped),
                (Some(method), Stop::Interrupted)
            );
            for part in [from_file(&part), part] {
                let resumed = part.resume().run().expect("a branch");
                assert_eq!(resumed.stopped, whole.stopped);
                assert!(resumed.points == whole.points && resumed.events == whole.events);
            }
        }
    }
}

/// Cancelled before the balance has an orbit, nothing is lost either.
#[test]
fn what_is_cancelled_is_left() {
    for (either, _) in both() {
        let request = request();
        let lost = lost(&either, 40);
        request.cancel.cancel();
        let part = either.or_balance(&request, Ok(lost.clone()), &mut |_| {
            ControlFlow::Continue(())
        });
        let part = part.expect("a part");
        assert_eq!(part.stopped, Stop::Interrupted);
        assert!(part.points == lost.points);
        let resumed = part.resume().run().expect("a branch");
        assert_eq!(
            (resumed.method(), resumed.stopped),
            (Some(OrbitMethodKind::HarmonicBalance), Stop::ReachedEnd)
        );
    }
}

/// A balance that does not come as far in many times as many orbits is given up, and what the first method has found stands.
#[test]
fn a_balance_that_creeps_is_given_up() {
    for (either, first) in both() {
        let branch = lost(&either, 40);
        let [begin, end] = [0, 39].map(|place| branch.points[place].clone());
        let far = (end.value - begin.value).abs();
        let orbits = |patience: &mut Patience, point: &Point, last: usize| {
            let mut done = 1..=last;
            done.find(|&done| patience.ends(&Progress::orbit(done, point)))
        };
        let mut creeps = Patience::with(40, far);
        assert_eq!(orbits(&mut creeps, &begin, 1000), Some(8 * 40 + 51));
        assert!(creeps.has_ended());
        let mut comes = Patience::with(40, 0.9 * far);
        assert_eq!(orbits(&mut comes, &begin, 300), None);
        assert_eq!(orbits(&mut comes, &end, 1000), None);
        // Two orbits as far apart as the range: the balance has 66 to come there, and steps that are too short for it.
        let short = Branch {
            points: vec![begin, end],
            ..branch
        };
        let request = Request {
            largest_step: 1e-3,
            ..request()
        };
        let found = either.or_balance(&request, Ok(short.clone()), &mut |_| {
            ControlFlow::Continue(())
        });
        let found = found.expect("a branch");
        assert_eq!(found.method(), Some(first));
        assert!(found.points == short.points && found.stopped == short.stopped);
        assert!(found.statistics.accepted_steps > short.statistics.accepted_steps);
    }
}
