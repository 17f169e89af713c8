//! Laws whose stiffness is unbounded on both sides of a level, which are followed by shooting unless another method is asked for.

use std::ops::ControlFlow;

use hertzian::{Branch, Event, FrequencyResponse, OrbitMethodKind, Stop};

hertzian::oscillator! {
    /// A power below one, to both sides.
    Steep(x) {
        param zeta > 0;
        param drive;
        param load;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^0.6 = drive*cos(omega*t) + load;
    }
}

/// Damping ratio, drive and load.
const STEEP: [(f64, f64, f64); 4] = [
    (0.02, 0.1, 0.3),
    (0.064, 0.1, 0.3),
    (0.064, 0.3, 1.0),
    (0.2, 0.1, 0.3),
];

/// The same events, each at the same place.
fn have_equal_events(branch: &Branch, other: &Branch) {
    let sorted = |branch: &Branch| {
        let mut events: Vec<Event> = branch.events.clone();
        events.sort_by(|a, b| a.point.value.total_cmp(&b.point.value));
        events
    };
    let (events, others) = (sorted(branch), sorted(other));
    let kinds = |events: &[Event]| events.iter().map(|event| event.kind).collect::<Vec<_>>();
    assert_eq!(kinds(&events), kinds(&others));
    for (event, other) in events.iter().zip(&others) {
        let apart = (event.point.value - other.point.value).abs();
        assert!(
            apart <= event.error + other.error + 1e-12,
            "{event} {other}"
        );
    }
}

/// Where the stiffness is unbounded on both sides of a level, curves are whole through every touch of it, forwards, backwards and from
/// within, with the same events, and orbits have their series.
#[test]
fn curves_of_steep_laws_are_whole() {
    for (zeta, drive, load) in STEEP {
        let steep = Steep { zeta, drive, load };
        let request = FrequencyResponse::of(&steep);
        let followed = |from, to| {
            let branch = request.clone().from(from).to(to).run().expect("a branch");
            assert_eq!(branch.method(), Some(OrbitMethodKind::Shooting));
            assert_eq!(branch.stopped, Stop::ReachedEnd, "{zeta} {drive} {load}");
            assert!(branch.turns.is_empty(), "{:?}", branch.turns);
            let orbits = branch.at(1.0).expect("orbits");
            assert!(orbits.iter().all(|point| point.orbit.harmonics() > 0));
            branch
        };
        let (up, down) = (followed(0.6, 1.6), followed(1.6, 0.6));
        have_equal_events(&up, &down);
        let both_ways = request
            .clone()
            .from(0.6)
            .to(1.6)
            .through(1.2)
            .expect("a branch");
        assert_eq!(both_ways.method(), Some(OrbitMethodKind::Shooting));
        assert_eq!(
            (both_ways.begin, both_ways.stopped),
            (Some(Stop::ReachedEnd), Stop::ReachedEnd)
        );
        have_equal_events(&up, &both_ways);
    }
}

/// In memory and in a file: killed on the way or stopped, it goes on to what an uninterrupted run gives.
#[test]
fn a_branch_that_is_kept_goes_on_by_shooting() {
    let (zeta, drive, load) = STEEP[1];
    let steep = Steep { zeta, drive, load };
    let name = format!("hertzian-steep-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    let request = FrequencyResponse::of(&steep).from(0.6).to(1.0);
    let whole = request.run().expect("a branch");
    let kept = request.keep(&path);
    let mut killed = None;
    let part = kept.run_with(|progress| {
        if progress.done < 20 {
            return ControlFlow::Continue(());
        }
        killed = std::fs::read(&path).ok();
        ControlFlow::Break(())
    });
    let part = part.expect("a part");
    assert_eq!(part.stopped, Stop::Interrupted);
    let resumed = part.resume().run().expect("a branch");
    assert_eq!(resumed.method(), Some(OrbitMethodKind::Shooting));
    assert!(resumed.points == whole.points && resumed.events == whole.events);
    let stopped = std::fs::read(&path).expect("a file");
    for text in [stopped, killed.expect("a file")] {
        std::fs::write(&path, text).expect("written");
        let mut read = Branch::read(&path).expect("read");
        read.attach(&steep).expect("its model");
        let resumed = read.resume().keep(&path).run().expect("a branch");
        assert_eq!(resumed.method(), Some(OrbitMethodKind::Shooting));
        assert!(resumed.points == whole.points && resumed.events == whole.events);
        assert!(Branch::read(&path).expect("read").points == whole.points);
    }
    std::fs::remove_file(path).expect("removed");
}

/// Beyond its range, and anew, it goes on by the same method.
#[test]
fn a_branch_goes_on_beyond_its_range_by_shooting() {
    let (zeta, drive, load) = STEEP[2];
    let steep = Steep { zeta, drive, load };
    let request = FrequencyResponse::of(&steep).from(0.6).to(1.0);
    let short = request.run().expect("a branch");
    let whole = request.clone().to(1.4).run().expect("a branch");
    let longer = short.resume().to(1.4).run().expect("a branch");
    let finer = short.resume().tolerance(1e-8).run().expect("a branch");
    for branch in [&longer, &finer] {
        assert_eq!(branch.method(), Some(OrbitMethodKind::Shooting));
        assert_eq!(branch.stopped, Stop::ReachedEnd);
    }
    have_equal_events(&longer, &whole);
    have_equal_events(&finer, &short);
}
