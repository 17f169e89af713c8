//! What is stated of errors: orbits at a coarse tolerance against the same orbits at a fine one.

use hertzian::{FrequencyResponse, Point, Shooting, System, Verdict};
use hertzian_tests::distance;

use super::integrated::{continuous, one_sided};

/// Errors of states and multipliers are within what is stated, and no verdict is false.
pub fn assert_stated(cycle: &Point, finer: &Point) {
    let pairs = cycle.orbit.state().into_iter().zip(finer.orbit.state());
    let state = pairs.fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()));
    let omega = cycle.omega().max(1.0);
    // What is stated is relative to peak-to-peak.
    let stated = cycle.error.unwrap() * cycle.peak_to_peak();
    assert!(state <= stated * omega, "{state:.1e} {cycle:?}");
    let found = &cycle.stability;
    let error = distance(&found.multipliers, &finer.stability.multipliers);
    assert!(error <= found.error, "{error:.1e} {cycle:?}");
    if found.verdict != Verdict::Undecided {
        assert_eq!(found.verdict, finer.stability.verdict, "{cycle:?}");
    }
}

fn compare(system: &dyn System, (from, to): (f64, f64)) {
    let coarse = FrequencyResponse::of(system).by(Shooting::new().tolerance(1e-7));
    let fine = FrequencyResponse::of(system).by(Shooting::new().tolerance(1e-13));
    let branch = coarse.from(from).to(to).run().unwrap();
    let mut undecided = 0;
    for cycle in branch.points.iter().step_by(3) {
        let finer = fine
            .clone()
            .near_orbit(&cycle.orbit)
            .orbit(cycle.value)
            .unwrap();
        assert_stated(cycle, &finer);
        undecided += usize::from(cycle.stability.verdict == Verdict::Undecided);
    }
    assert!(undecided <= branch.points.len() / 50, "{undecided}");
}

#[test]
fn errors_of_continuous_springs() {
    compare(&*continuous(1.5, 0.0), (0.6, 1.7));
    compare(&*continuous(0.6, 0.0), (0.66, 1.4));
}

#[test]
fn errors_of_contacts() {
    compare(&*one_sided(1.5), (0.6, 1.6));
    compare(&*one_sided(0.6), (0.5, 1.2));
}

hertzian::oscillator! {
    /// A contact whose time runs `rate` times as fast.
    Faster(x) {
        param rate > 0;
        law linear(gap) { gap > 0 => gap, else => 0 }
        law hertz(gap) { gap > 0 => gap^1.5, else => 0 }
        ddot(x) + 0.2*rate*dot(x) + 0.7*rate^2*linear(x) + 0.3*rate^2*hertz(x)
            = 0.4*rate^2*cos(omega*t) + rate^2;
    }
}

hertzian::oscillator! {
    /// The same with a flow in closed form.
    FasterLinear(x) {
        param rate > 0;
        law linear(gap) { gap > 0 => gap, else => 0 }
        ddot(x) + 0.2*rate*dot(x) + rate^2*linear(x) = 0.4*rate^2*cos(omega*t) + rate^2;
    }
}

/// What is known of an orbit does not depend on the unit of time.
#[test]
fn seconds_and_milliseconds_tell_the_same() {
    for linear in [false, true] {
        let [slow, fast] = [1.0, 1e4].map(|rate| {
            let model: Box<dyn System> = if linear {
                Box::new(FasterLinear { rate })
            } else {
                Box::new(Faster { rate })
            };
            FrequencyResponse::of(&*model)
                .by(Shooting::new())
                .orbit(0.9 * rate)
                .unwrap()
        });
        assert_eq!(slow.stability.verdict, Verdict::Stable);
        assert_eq!(fast.stability.verdict, Verdict::Stable);
        for (a, b) in [
            (slow.stability.error, fast.stability.error),
            (slow.error.unwrap(), fast.error.unwrap()),
        ] {
            assert!(b < 10.0 * a && a < 10.0 * b, "{linear} {a:.1e} {b:.1e}");
        }
    }
}

/// A flow of the finest tolerance has no finer one to be compared with; what it leaves is stated all the same.
#[test]
fn the_finest_tolerance_has_an_error() {
    let system = continuous(1.5, 0.0);
    let events = [1e-12, 1e-14].map(|tolerance| {
        let shooting = FrequencyResponse::of(&*system).by(Shooting::new().tolerance(tolerance));
        let branch = shooting.from(0.6).to(1.7).run().unwrap();
        branch.folds().next().unwrap().clone()
    });
    for event in &events {
        // By event-located integration in 80-bit arithmetic (`frequency_response` of the reference values), to 3e-15.
        let error = (event.point.value - 1.332_696_002_393_464).abs();
        assert!(error <= event.error + 3e-15, "{event} {error:.1e}");
        // More than the rounding of the value alone.
        assert!(event.error > 3e-15, "{event}");
        let of_states = event.point.error.unwrap() * event.point.peak_to_peak();
        assert!(of_states > 1e-14, "{event}");
        assert!(event.error < 1e-10, "{event}");
    }
}
