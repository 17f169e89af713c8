//! Branches that are followed both ways from an orbit, interrupted in either part and resumed: equal to the last bit to those that were not.

use std::ops::ControlFlow;

use hertzian::{
    Branch, ContactEquation, FrequencyResponse, OrbitMethod, OrbitMethodKind, Shooting, Stop,
};

use super::resumed::{ONE, texts, written_and_read};

const VALUE: f64 = 0.68;

/// Stopped at so many orbits of both parts together.
fn part_of<M: OrbitMethod>(request: &FrequencyResponse<M>, orbits: usize) -> Branch {
    let mut seen = 0;
    let part = request.through_with(VALUE, |_| {
        seen += 1;
        if seen < orbits {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    part.expect("a part")
}

/// Interrupted in both parts, and at each time written, read and resumed.
fn resumes<M: OrbitMethod>(request: &FrequencyResponse<M>, name: &str, stride: usize) {
    let mut orbits = 0;
    let whole = request.through_with(VALUE, |_| {
        orbits += 1;
        ControlFlow::Continue(())
    });
    let whole = whole.expect("a branch");
    let ends = [whole.points.first(), whole.points.last()].map(|end| end.map(|end| end.value));
    assert_eq!(ends, [Some(0.66), Some(0.73)]);
    let mut begun = [0, 0];
    for orbits in (1..orbits).step_by(stride) {
        let part = part_of(request, orbits);
        begun[usize::from(part.begin.is_some())] += 1;
        let mut read = written_and_read(&part, name);
        read.attach(&ONE).expect("its model");
        let resumed = read.resume().run().expect("a branch");
        assert!(texts(&resumed) == texts(&whole), "{name} from {orbits}");
    }
    assert!(begun[0] > 1 && begun[1] > 1, "{begun:?}");
}

#[test]
fn by_the_balance() {
    let request = FrequencyResponse::of(&ONE).from(0.66).to(0.73);
    resumes(&request.harmonics(9), "both-balance", 7);
}

#[test]
fn by_shooting() {
    let request = FrequencyResponse::of(&ONE).from(0.66).to(0.73);
    let request = request.by(Shooting::new()).tolerance(1e-5);
    resumes(&request, "both-shooting", 9);
}

#[test]
fn by_the_contact_equation() {
    let request = FrequencyResponse::of(&ONE).from(0.66).to(0.73);
    let request = request.by(ContactEquation::new()).tolerance(1e-5);
    resumes(&request, "both-contact", 3);
    let branch = request.through(VALUE).expect("a branch");
    assert_eq!(branch.method(), Some(OrbitMethodKind::ContactEquation));
}

/// Each part may have as many points; with more of them both go on.
#[test]
fn a_limit_is_that_of_each_part() {
    let request = FrequencyResponse::of(&ONE).from(0.66).to(0.73).harmonics(9);
    let whole = request.through(VALUE).expect("a branch");
    let limited = request.max_points(4).through(VALUE).expect("a branch");
    let limit = Stop::PointLimit { points: 4 };
    assert_eq!((limited.begin, limited.stopped), (Some(limit), limit));
    assert_eq!(limited.points.len(), 7);
    let resumed = limited.resume().max_points(20_000).run();
    assert_eq!(texts(&resumed.expect("a branch")), texts(&whole));
}

/// What each part has is counted for itself, also where both together have more than a new limit; and where nothing is said of it.
#[test]
fn a_new_limit_is_that_of_each_part() {
    let request = FrequencyResponse::of(&ONE).from(0.66).to(0.73).harmonics(9);
    let whole = request.through(VALUE).expect("a branch");
    let limited = request.max_points(4).through(VALUE).expect("a branch");
    for (resume, points) in [
        (limited.resume().max_points(5), 5),
        (limited.resume().max_points(6), 6),
        (limited.resume(), 8),
    ] {
        let resumed = resume.run().expect("a branch");
        let limit = Stop::PointLimit { points };
        assert_eq!((resumed.begin, resumed.stopped), (Some(limit), limit));
        assert_eq!(resumed.points.len(), 2 * points - 1);
        let all = resumed.resume().max_points(20_000).run();
        assert_eq!(texts(&all.expect("a branch")), texts(&whole));
    }
    let refused = limited.resume().max_points(4).run();
    let said = refused.expect_err("it has as many").to_string();
    assert!(said.contains("must be more than the points"), "{said}");
    // Beyond its range goes the part to its end.
    let count = whole.points.len();
    let forth = whole
        .points
        .iter()
        .filter(|point| point.value >= VALUE)
        .count();
    let longer = whole.resume().to(0.8).max_points(count + 1).run();
    let longer = longer.expect("a branch");
    assert_eq!(longer.points.len(), count + (count + 1 - forth));
}

/// Resumed and interrupted again in its first part, a branch still has what was known of the other one.
#[test]
fn what_was_known_of_a_part_stays() {
    let request = FrequencyResponse::of(&ONE).from(0.66).to(0.73).harmonics(9);
    let whole = request.through(VALUE).expect("a branch");
    let limited = request.max_points(4).through(VALUE).expect("a branch");
    let resume = limited.resume().max_points(20_000);
    let again = resume.run_with(|_| ControlFlow::Break(()));
    let again = again.expect("a branch");
    assert_eq!(again.stopped, Stop::Interrupted);
    assert!(again.points.len() >= limited.points.len());
    let resumed = again.resume().max_points(20_000).run();
    assert_eq!(texts(&resumed.expect("a branch")), texts(&whole));
}

/// With another tolerance both parts are followed once more, from the same orbit.
#[test]
fn once_more_is_both_ways_too() {
    let request = FrequencyResponse::of(&ONE).from(0.66).to(0.73);
    let branch = request.through(VALUE).expect("a branch");
    let finer = branch.resume().tolerance(1e-8).run().expect("a branch");
    assert_eq!(finer.begin, Some(Stop::ReachedEnd));
    assert_eq!(finer.stopped, Stop::ReachedEnd);
    let ends = [finer.points.first(), finer.points.last()].map(|end| end.map(|end| end.value));
    assert_eq!(ends, [Some(0.66), Some(0.73)]);
    assert!(finer.points.iter().all(|point| point.error < Some(1e-8)));
}

/// Folds of both parts are found again with another tolerance.
#[test]
fn once_more_has_the_same_folds() {
    let request = FrequencyResponse::of(&ONE).from(0.6).to(1.2);
    let branch = request.tolerance(1e-4).through(VALUE).expect("a branch");
    let finer = branch.resume().tolerance(1e-6).run().expect("a branch");
    assert_eq!(branch.folds().count(), 2);
    assert_eq!(finer.folds().count(), 2);
    let mut folds = branch.folds().zip(finer.folds());
    assert!(folds.all(|(a, b)| (a.point.value - b.point.value).abs() < a.error + b.error));
}

/// What a file says of the two parts may be anything.
#[test]
fn parts_that_are_none_are_refused() {
    let request = FrequencyResponse::of(&ONE).from(0.66).to(0.73).harmonics(9);
    let whole = request.max_points(4).through(VALUE).expect("a branch");
    let name = format!("hertzian-both-changed-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    whole.write(&path).expect("written");
    let text = std::fs::read_to_string(&path).expect("a file");
    let at = text.find("\"both_ways\":").expect("both parts");
    for (from, to) in [
        ("\"points\":4", "\"points\":0"),
        ("\"points\":4", "\"points\":9"),
        ("\"events\":0", "\"events\":3"),
        ("\"turns\":0", "\"turns\":18446744073709551615"),
        ("\"value\":0.68}", "\"value\":\"NaN\"}"),
        ("\"value\":0.68}", "\"value\":1e300}"),
        ("\"value\":0.68}", "\"value\":0.7}"),
    ] {
        let (before, both) = text.split_at(at);
        assert!(both.contains(from), "{from}");
        let changed = format!("{before}{}", both.replace(from, to));
        std::fs::write(&path, changed).expect("written");
        let mut read = Branch::read(&path).expect("a branch");
        let resumed = read.attach(&ONE).and_then(|()| read.resume().run());
        let error = resumed.expect_err(to);
        assert_eq!(error.to_string().lines().count(), 1, "{error}");
    }
    std::fs::remove_file(path).expect("removed");
}
