//! Bifurcations located by the harmonic balance: branch points, tori, touches of levels, and orbits without the symmetry of their
//! system. Doublings of the period are in `doubling`.

use hertzian::{Branch, Event, EventKind, FrequencyResponse, Shooting, Stop, System, Verdict};
use hertzian_tests::{OneSidedLinear, TwoMasses};

use crate::bifurcations::cascade::MODEL;
use crate::bifurcations::symmetry::{HARDENING, Hardening, SOFTENING, Softening};
use crate::bifurcations::torus::Circulatory;

hertzian::oscillator! {
    /// Two wells, at minus one and one.
    Wells(x) {
        param drive;
        ddot(x) + 0.1*dot(x) - x + x^3 = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// A spring, and a stop whose force begins with a jump.
    Preloaded(x) {
        param preload >= 0;
        param drive;
        law stop(gap) { gap >= 1 => preload + 5*(gap - 1), else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x) = drive*cos(omega*t);
    }
}

fn of_kind(branch: &Branch, kind: EventKind) -> Vec<&Event> {
    branch
        .events
        .iter()
        .filter(|event| event.kind == kind)
        .collect()
}

fn grazings(branch: &Branch) -> Vec<&Event> {
    let grazing = |event: &&Event| matches!(event.kind, EventKind::Grazing { .. });
    branch.events.iter().filter(grazing).collect()
}

/// `s^2 + c s + k + i p = 0` has the root `s = -i sqrt(k)` at `p = c sqrt(k)`: flutter. The balance of a linear system is exact.
#[test]
fn flutter_begins_where_the_characteristic_equation_says() {
    let (c, k) = (0.1_f64, 1.44_f64);
    let model = Circulatory {
        c,
        k,
        p: 0.05,
        drive: 0.3,
    };
    let request = FrequencyResponse::of(&model)
        .vary("p")
        .omega(0.7)
        .bifurcations(true);
    let branch = request.from(0.05).to(0.2).run().unwrap();
    let [event] = &branch.events[..] else {
        panic!("{:?} {:?}", branch.events, branch.turns);
    };
    assert_eq!(event.kind, EventKind::NeimarkSacker);
    let error = (event.point.value - c * k.sqrt()).abs();
    assert!(error < 1e-9 && error <= event.error, "{event} {error:.1e}");
}

/// At omega 0.61861 a torus is born, by an independent computation with five digits.
#[test]
fn a_torus_is_born_of_two_masses_with_a_stop() {
    let model = TwoMasses {
        stop: 100.0,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model)
        .harmonics(60)
        .bifurcations(true);
    let branch = request.from(0.616).to(0.621).run().unwrap();
    let [event] = of_kind(&branch, EventKind::NeimarkSacker)[..] else {
        panic!("{:?} {:?}", branch.events, branch.turns);
    };
    let error = (event.point.value - 0.61861).abs();
    assert!(event.test.abs() < 1e-10 && event.error < 1e-4, "{event}");
    assert!(error < 5e-6 + 3.0 * event.error, "{event} {error:.1e}");
    let largest = event.point.stability.multipliers[0];
    assert!(
        largest.im != 0.0 && (largest.norm() - 1.0).abs() < 1e-3,
        "{largest}"
    );
}

/// As long as contact lasts, the motion is that of a linear oscillator at resonance, of amplitude `A / (2 zeta)`: it touches zero
/// at `A = 2 zeta W`.
#[test]
fn contact_is_lost_where_the_linear_motion_reaches_zero() {
    let request = FrequencyResponse::of(&MODEL)
        .vary("drive")
        .omega(1.0)
        .bifurcations(true);
    let branch = request.from(0.02).to(0.2).run().unwrap();
    let [event] = &branch.events[..] else {
        panic!("{:?} {:?}", branch.events, branch.turns);
    };
    let error = (event.point.value - 2.0 * 0.032).abs();
    assert!(error < 1e-10 && error <= event.error, "{event} {error:.1e}");
    assert_eq!(event.kind, EventKind::Grazing { turns: false });
    let (before, behind) = branch.points.split_at(event.after);
    assert!(
        before
            .iter()
            .all(|point| point.observed.contacts[0].fraction == 1.0)
    );
    assert!(
        behind
            .iter()
            .all(|point| point.observed.contacts[0].fraction < 1.0)
    );
}

/// Figure 5a: contact is lost where the linear motion reaches zero, `A = | 1 - w^2 + 2 i zeta w |` at `W = 1`; the spring with a stop
/// meets it where its linear motion has an amplitude of one. Shooting has the first at the same place.
#[test]
fn levels_are_touched_where_the_linear_motion_reaches_them() {
    let contact = OneSidedLinear {
        zeta: 0.032,
        load: 1.0,
        drive: 0.1,
    };
    let branch = FrequencyResponse::of(&contact).from(0.8).to(1.3);
    let branch = branch.bifurcations(true).run().unwrap();
    let [event] = grazings(&branch)[..] else {
        panic!("{:?} {:?}", branch.events, branch.turns);
    };
    let omega = event.point.value;
    let amplitude = 0.1 / (1.0 - omega * omega).hypot(2.0 * 0.032 * omega);
    assert!((amplitude - 1.0).abs() < 1e-10, "{event}");
    assert_eq!(event.kind, EventKind::Grazing { turns: false });
    let shooting = FrequencyResponse::of(&contact)
        .by(Shooting::new())
        .from(0.8)
        .to(1.3)
        .run()
        .unwrap();
    let mut touches = shooting.events(EventKind::Grazing { turns: false });
    assert!((touches.next().unwrap().point.value - omega).abs() < 1e-10);
}

/// A spring with a stop meets it where its linear motion has an amplitude of one, `1 = A / | 1 - w^2 + 0.1 i w |`. Above the resonance the
/// jump of the force drives the motion on, and the branch turns back there, whichever way it is followed; below it goes on, and the
/// period doubles close by, where the motion in closed form from switch to switch has a multiplier of minus one.
#[test]
fn a_preloaded_stop_is_left_where_the_linear_motion_leaves_it() {
    let (preload, drive) = (0.05_f64, 0.15_f64);
    // (1 - w^2)^2 + 0.01 w^2 = A^2
    let root = (0.995_f64 * 0.995 - 1.0 + drive * drive).sqrt();
    let [low, high] = [-root, root].map(|root| (0.995 + root).sqrt());
    let model = Preloaded { preload, drive };
    for [from, to] in [[0.6, 1.6], [1.6, 0.6]] {
        let branch = FrequencyResponse::of(&model).bifurcations(true);
        let branch = branch.from(from).to(to).run().unwrap();
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        assert!(branch.turns.is_empty(), "{:?}", branch.turns);
        assert_eq!(branch.folds().count(), 1);
        assert_eq!(branch.events.len(), 4, "{:?}", branch.events);
        let [doubling] = of_kind(&branch, EventKind::PeriodDoubling)[..] else {
            panic!("{:?}", branch.events);
        };
        let error = (doubling.point.value - 0.939_885_292_226_7).abs();
        assert!(error <= doubling.error, "{doubling} {error:.1e}");
        for (omega, turns) in [(low, false), (high, true)] {
            let [event] = of_kind(&branch, EventKind::Grazing { turns })[..] else {
                panic!("{:?}", branch.events);
            };
            let error = (event.point.value - omega).abs();
            assert!(error < 1e-10 && error <= event.error, "{event} {error:.1e}");
            assert!(event.error < 1e-9, "{event}");
        }
    }
}

/// Figure 2: with all harmonics the branch of symmetric orbits is crossed where the symmetry breaks.
#[test]
fn broken_symmetry_is_a_branch_point_of_all_harmonics() {
    let (zeta, drive) = (0.01, 0.1);
    let systems: [(&dyn System, [f64; 2], [f64; 2]); 2] = [
        (&Hardening { zeta, drive }, [0.41, 0.34], HARDENING),
        (&Softening { zeta, drive }, [0.98, 0.86], SOFTENING),
    ];
    for (system, [from, to], exact) in systems {
        let request = FrequencyResponse::of(system).symmetric(false);
        let branch = request.bifurcations(true).from(from).to(to).run().unwrap();
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        let found = of_kind(&branch, EventKind::BranchPoint);
        assert_eq!(found.len(), 2, "{:?} {:?}", branch.events, branch.turns);
        for (event, exact) in found.iter().zip(exact) {
            let error = (event.point.value - exact).abs();
            assert!(error < 1e-6 && error <= event.error, "{event} {error:.1e}");
        }
    }
}

/// The branch without the symmetry is found from the middle of its range, and ends where it meets the symmetric one.
#[test]
fn orbits_without_the_symmetry_are_found() {
    let systems: [(&dyn System, [f64; 2], f64); 2] = [
        (
            &Hardening {
                zeta: 0.01,
                drive: 0.1,
            },
            [0.39, 0.45],
            HARDENING[0],
        ),
        (
            &Softening {
                zeta: 0.01,
                drive: 0.1,
            },
            [0.92, 1.0],
            SOFTENING[0],
        ),
    ];
    for (system, [from, to], exact) in systems {
        let request = FrequencyResponse::of(system)
            .symmetric(false)
            .stability(false);
        let branch = request.from(from).to(to).run().unwrap();
        let Stop::Joined { value, .. } = branch.stopped else {
            panic!("{}", branch.stopped);
        };
        assert!((value - exact).abs() < 1e-4, "{value}");
    }
}

/// In a well `x = 1 + y` with `y'' + 0.1 y' + 2 y = 0.02 cos(omega t)` to first order; on the hill between the wells the orbit is
/// unstable.
#[test]
fn the_orbit_in_a_well_is_found() {
    let model = Wells { drive: 0.02 };
    let request = FrequencyResponse::of(&model).from(0.8).to(0.9);
    let hill = request.run().unwrap();
    assert_eq!(hill.points[0].stability.verdict, Verdict::Unstable);
    let well = request.symmetric(false).run().unwrap();
    let first = &well.points[0];
    assert_eq!(first.stability.verdict, Verdict::Stable);
    assert!((first.motion().mean.unwrap().abs() - 1.0).abs() < 1e-3);
    let linear = 0.02 / (2.0 - 0.64_f64).hypot(0.08);
    assert!((0.5 * first.peak_to_peak() / linear - 1.0).abs() < 1e-2);
    assert_eq!(well.stopped, Stop::ReachedEnd);
    // One that is given need not be asked for.
    let again = FrequencyResponse::of(&model).near_orbit(&first.orbit);
    let again = again.from(0.8).to(0.81).run().unwrap();
    assert!((again.points[0].motion().mean.unwrap() - first.motion().mean.unwrap()).abs() < 1e-9);
}

hertzian::oscillator! {
    /// Two oscillators that are driven a quarter of a period apart, each before a stop of its own.
    Copies(x, y) {
        law stop(gap) { gap > 1 => (gap - 1)^1.5, else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x) = 0.3*cos(omega*t);
        ddot(y) + 0.1*dot(y) + y + stop(y) = 0.3*sin(omega*t);
    }
}

/// Up to the touch both are linear: `(1 - w^2)^2 + (0.1 w)^2 = 0.3^2`.
#[test]
fn contacts_that_are_copies_of_each_other_touch_at_once() {
    let square = 0.5 * (1.99 - f64::sqrt(1.99_f64.powi(2) - 4.0 * 0.91));
    let branch = FrequencyResponse::of(&Copies {})
        .from(0.7)
        .to(0.9)
        .bifurcations(true)
        .run()
        .unwrap();
    let [event] = grazings(&branch)[..] else {
        panic!("{:?}", branch.events);
    };
    assert!((event.point.value - square.sqrt()).abs() < 1e-10);
    assert_eq!(event.contacts, 2);
    assert!(event.to_string().ends_with("2 contacts at once"), "{event}");
    assert!(branch.turns.is_empty(), "{:?}", branch.turns);
}

hertzian::oscillator! {
    /// A force that is there on a way of 1.5e-4 only, which the harmonics of an orbit of size one do not show.
    Pulse(x) {
        param damping > 0;
        param width > 0;
        law pulse(gap) { 0.6583816224547495*(gap/width)*exp(-((gap/width)^2)) }
        2.0999359774410786*ddot(x) + damping*dot(x) + 0.7078247253465377*x - pulse(-x - 0.48557887774729314) = 1.0354062375339494*cos(omega*t);
    }
}

/// The few harmonics have doublings where multipliers, of orbits closed by integration, are far from minus one. By shooting there are none.
#[test]
fn events_that_multipliers_contradict_have_no_error() {
    let model = Pulse {
        damping: 0.020_069_002_514_133_95,
        width: 1.499_313_264_010_605_4e-4,
    };
    let response = FrequencyResponse::of(&model).from(0.97).to(0.91);
    let shooting = response.clone().by(Shooting::new()).run().unwrap();
    assert_eq!(shooting.stopped, Stop::ReachedEnd);
    assert!(shooting.events.is_empty(), "{:?}", shooting.events);
    let balance = response.bifurcations(true).run().unwrap();
    for event in &balance.events {
        assert!(event.error.is_infinite(), "{event}");
    }
}
