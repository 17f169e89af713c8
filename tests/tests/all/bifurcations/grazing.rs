//! Where a gap touches a level.

use hertzian::shooting::BifurcationCurve;
use hertzian::{Event, EventKind, FrequencyResponse, Shooting, Stop, System};

use crate::bifurcations::cascade::MODEL;
use crate::bifurcations::curves::Hertz;

fn grazings(events: &[Event]) -> Vec<&Event> {
    let grazing = |event: &&Event| matches!(event.kind, EventKind::Grazing { .. });
    events.iter().filter(grazing).collect()
}

/// As long as contact lasts, the motion is that of a linear oscillator at resonance, of amplitude `A / (2 zeta)`: it touches zero
/// at `A = 2 zeta W`.
#[test]
fn contact_is_lost_where_the_linear_motion_reaches_zero() {
    let shooting = FrequencyResponse::of(&MODEL)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0);
    let branch = shooting.from(0.02).to(0.2).run().unwrap();
    let [grazing] = grazings(&branch.events)[..] else {
        panic!("{:?}", branch.events);
    };
    let error = (grazing.point.value - 2.0 * 0.032).abs();
    assert!(
        error < 1e-10 && error <= grazing.error,
        "{grazing} {error:.1e}"
    );
    assert_eq!(grazing.kind, EventKind::Grazing { turns: false });
    assert!(grazing.point.observed.motions[0].minimum.abs() < 1e-9);
    // Before it nothing switches, behind it twice a period.
    let (before, behind) = branch.points.split_at(grazing.after);
    assert!(
        before
            .iter()
            .all(|cycle| cycle.observed.switches == Some(0))
    );
    assert!(
        behind
            .iter()
            .all(|cycle| cycle.observed.switches == Some(2))
    );
}

hertzian::oscillator! {
    /// A cubic spring with a Hertzian stop on one side.
    Stopped(x) {
        param drive;
        param clearance;
        law stop(gap) { gap > 0 => 10*gap^1.5, else => 0 }
        ddot(x) + 0.06*dot(x) + x + 0.3*x^3 + stop(x - clearance) = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// An exponent below one: unbounded stiffness where it touches.
    Softening(x) {
        param zeta >= 0;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^0.6, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

/// The curves through all grazing of a branch in the frequency.
fn curves(
    model: &dyn System,
    [from, to]: [f64; 2],
    second: &str,
    within: [f64; 2],
) -> Vec<BifurcationCurve> {
    let shooting = FrequencyResponse::of(model)
        .by(Shooting::new())
        .from(from)
        .to(to);
    let branch = shooting.run().unwrap();
    let events = grazings(&branch.events).into_iter();
    let curves = events.map(|event| shooting.track(event, second, within).unwrap());
    curves.collect()
}

/// Five points, spread by the golden ratio: the branch in the frequency through each of them touches the level there.
fn assert_touches(track: &BifurcationCurve, model: impl Fn(f64) -> Box<dyn System>) {
    for index in 1..=5 {
        let part = (f64::from(index) * 0.618_033_988_749_895).fract();
        let index = (part * track.points.len() as f64) as usize;
        let [omega, second] = track.values[index];
        let model = model(second);
        let near = FrequencyResponse::of(&*model)
            .by(Shooting::new())
            .near_state(&track.points[index].orbit.state());
        // Beside a fold a branch is short.
        let mut parts = [1e-4, -1e-4, 1e-5, -1e-5, 1e-6, -1e-6].into_iter();
        let found = parts.any(|part| {
            let ends = [-part, part].map(|part| omega * (1.0 + part));
            let branch = near.clone().from(ends[0]).to(ends[1]).run();
            let is_there = |event: &&Event| (event.point.value - omega).abs() < 1e-8;
            branch.is_ok_and(|branch| grazings(&branch.events).iter().any(is_there))
        });
        assert!(found, "{omega} {second}");
    }
}

/// By integrated motions, as for closed forms: where contact is lost under a Hertzian contact.
#[test]
fn a_hertzian_contact_is_lost_on_one_curve() {
    let (zeta, load) = (0.032, 1.0);
    let model = Hertz {
        zeta,
        load,
        drive: 0.1,
    };
    let curves = curves(&model, [0.6, 1.6], "drive", [0.03, 0.5]);
    assert_eq!(curves.len(), 2);
    for track in &curves {
        assert_eq!(track.ends, [Stop::ReachedEnd; 2]);
        assert_touches(track, |drive| Box::new(Hertz { zeta, load, drive }));
    }
    // Both events are on one curve, which leaves the range at the same two places.
    let ends = |track: &BifurcationCurve| {
        let mut ends = [0, track.points.len() - 1].map(|index| track.values[index]);
        ends.sort_by(|a, b| a[0].total_cmp(&b[0]));
        ends
    };
    let [one, other] = [&curves[0], &curves[1]].map(ends);
    for (a, b) in one.as_flattened().iter().zip(other.as_flattened()) {
        assert!((a - b).abs() < 1e-9, "{one:?} {other:?}");
    }
}

/// Without damping the orbit touches exactly where it begins and ends.
#[test]
fn a_curve_of_grazing_reaches_the_end_of_its_range() {
    let (load, drive) = (1.0, 0.1);
    let model = Hertz {
        zeta: 0.032,
        load,
        drive,
    };
    for track in curves(&model, [0.6, 1.6], "zeta", [0.0, 0.2]) {
        assert_eq!(track.ends, [Stop::ReachedEnd; 2]);
        assert_touches(&track, |zeta| Box::new(Hertz { zeta, load, drive }));
    }
}

#[test]
fn a_stop_is_touched_on_a_curve() {
    let (drive, clearance) = (0.3, 0.5);
    let model = Stopped { drive, clearance };
    let tracks = curves(&model, [0.3, 0.8], "drive", [0.1, 1.0]);
    assert!(!tracks.is_empty());
    for track in &tracks {
        assert_eq!(track.ends, [Stop::ReachedEnd; 2]);
        assert_touches(track, |drive| Box::new(Stopped { drive, clearance }));
    }
    for track in curves(&model, [0.3, 0.8], "clearance", [0.1, 1.0]) {
        assert_eq!(track.ends, [Stop::ReachedEnd; 2]);
        assert_touches(&track, |clearance| Box::new(Stopped { drive, clearance }));
    }
}

/// Unbounded stiffness at the level.
#[test]
fn an_exponent_below_one_is_tracked_too() {
    let model = Softening {
        zeta: 0.032,
        drive: 0.1,
    };
    let curves = curves(&model, [0.5, 2.0], "drive", [0.03, 0.5]);
    assert_eq!(curves.len(), 2);
    for track in &curves {
        assert_eq!(track.ends, [Stop::ReachedEnd; 2]);
        assert_touches(track, |drive| Box::new(Softening { zeta: 0.032, drive }));
    }
}
