//! The frequency responses of Wang et al. (2021), with exponents of the force that are not one: motions are integrated.
//!
//! Exact values: computed independently of this project by event-located DOP853 in 80-bit arithmetic, with errors in omega below
//! 1e-12, confirmed by a second integrator (`frequency_response` of the reference values).
#![allow(
    clippy::unreadable_literal,
    reason = "numbers as they were published, to be searched for"
)]

use std::f64::consts::TAU;

use hertzian::time;
use hertzian::{Branch, Event, EventKind, FrequencyResponse, Shooting, Stop, System, Verdict};
use hertzian_tests::{Continuous, OneSided};

/// What the exact values leave open.
const EXACT: f64 = 1e-12;

pub fn continuous(alpha: f64, load: f64) -> Box<dyn System> {
    let (zeta, drive) = (0.01, 0.1);
    Box::new(Continuous {
        zeta,
        alpha,
        load,
        drive,
    })
}

pub fn one_sided(alpha: f64) -> Box<dyn System> {
    let (zeta, load, drive) = (0.032, 1.0, 0.1);
    Box::new(OneSided {
        zeta,
        alpha,
        load,
        drive,
    })
}

/// The event is the exact one to 1e-9, and to the error that it states.
fn assert_exact(event: &Event, omega: f64, peak_to_peak: f64) {
    let error = (event.point.value - omega).abs();
    assert!(error < 1e-9, "{event}: {error:.1e}");
    assert!(error <= event.error + EXACT, "{event}: {error:.1e}");
    assert!(event.error < 1e-8, "{event}");
    let error = (event.point.peak_to_peak() - peak_to_peak).abs();
    assert!(error < 1e-6 * peak_to_peak, "{event}: {error:.1e}");
}

/// The events of one kind of a sweep that reaches its end are these, in order of the frequency.
fn assert_events(branch: &Branch, kind: EventKind, exact: &[(f64, f64)]) {
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    assert!(branch.turns.is_empty(), "{:?}", branch.turns);
    let mut found: Vec<_> = branch.events(kind).collect();
    found.sort_by(|a, b| a.point.value.total_cmp(&b.point.value));
    assert_eq!(found.len(), exact.len(), "{found:?}");
    for (event, &(omega, peak_to_peak)) in found.iter().zip(exact) {
        assert_exact(event, omega, peak_to_peak);
    }
}

/// A sweep that starts at the orbit of the balance; all of it with the defaults.
fn sweep(system: &dyn System, from: f64, to: f64) -> Branch {
    FrequencyResponse::of(system)
        .by(Shooting::new())
        .from(from)
        .to(to)
        .run()
        .unwrap()
}

fn assert_folds(system: &dyn System, (from, to): (f64, f64), exact: &[(f64, f64)]) {
    assert_events(&sweep(system, from, to), EventKind::Fold, exact);
}

#[test]
fn folds_of_figure_2a() {
    let folds = [
        (0.909513715044238, 0.73119729640989),
        (1.332696002393464, 7.58758050982389),
    ];
    assert_folds(&*continuous(1.5, 0.0), (0.6, 1.7), &folds);
}

#[test]
fn superharmonic_resonances_of_figure_2a() {
    let branch = sweep(&*continuous(1.5, 0.0), 0.2, 0.7);
    let folds = [
        (0.241956653790653, 0.82516070425166),
        (0.252011071022547, 0.74770373992845),
    ];
    let breaks = [
        (0.353730954670214, 0.60555123830267),
        (0.402310407656194, 0.62590483419901),
    ];
    assert_events(&branch, EventKind::Fold, &folds);
    assert_events(&branch, EventKind::SymmetryBreaking, &breaks);
}

#[test]
fn folds_and_broken_symmetry_of_figure_2b() {
    let branch = sweep(&*continuous(0.6, 0.0), 0.66, 1.4);
    let folds = [
        (0.704927892945083, 13.95841092159222),
        (1.320305358301798, 0.16810907816816),
    ];
    let breaks = [
        (0.868864958044575, 0.04256659866046),
        (0.973916250536018, 0.04981473636398),
    ];
    assert_events(&branch, EventKind::Fold, &folds);
    assert_events(&branch, EventKind::SymmetryBreaking, &breaks);
}

/// The exact values do not list a pair of folds that are closer together than the steps of the sweep they are from; the
/// harmonic balance finds it too, to 1e-7.
#[test]
fn superharmonic_resonances_of_figure_2b() {
    let folds = [
        (0.396401365447262, 0.08912386642737),
        (0.400955186850763, 0.07834108073471),
        (0.401353864568085, 0.08501365087996),
        (0.457909272249307, 0.052470322683),
        (0.600295303778675, 0.16365127739608),
        (0.655311078341127, 0.08855353862405),
    ];
    let branch = sweep(&*continuous(0.6, 0.0), 0.37, 0.7);
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    let is_listed = |event: &&Event| !(0.639..0.641).contains(&event.point.value);
    let (listed, others): (Vec<_>, Vec<_>) = branch.folds().partition(is_listed);
    assert_eq!(others.len(), 2, "{others:?}");
    for (event, by_balance) in others.iter().rev().zip([0.6394528, 0.6401352]) {
        assert!((event.point.value - by_balance).abs() < 1e-7, "{event}");
    }
    assert_eq!(listed.len(), folds.len(), "{listed:?}");
    for (omega, peak_to_peak) in folds {
        let near = |event: &&&Event| (event.point.value - omega).abs() < 1e-5;
        assert_exact(listed.iter().find(near).unwrap(), omega, peak_to_peak);
    }
}

#[test]
fn folds_of_figure_4a() {
    let folds = [
        (1.09502860674539, 2.51105266160399),
        (1.136461722203842, 1.3720908015233),
        (1.158212487926707, 2.79711894879371),
        (1.337227934760159, 7.54601168339949),
    ];
    assert_folds(&*continuous(1.5, 1.0), (0.7, 1.7), &folds);
    let folds = [
        (1.484450028723123, 6.61956624711188),
        (1.56555114602055, 2.52464397380281),
    ];
    assert_folds(&*continuous(1.5, 5.0), (1.0, 2.2), &folds);
}

/// Exponent one here as a parameter, so that nothing is in closed form.
#[test]
fn folds_of_figure_5() {
    let folds = [
        (0.715119549676419, 6.57285386554094),
        (0.96016367187857, 2.03840168022514),
    ];
    assert_folds(&*one_sided(1.0), (0.6, 1.4), &folds);
    let folds = [
        (0.685842253572486, 8.49925607475378),
        (1.144516913788162, 1.42840466595153),
    ];
    assert_folds(&*one_sided(1.5), (0.6, 1.6), &folds);
    let folds = [
        (0.631308249440869, 6.70995724971599),
        (0.765568492941199, 2.5062453564083),
        (0.845526217725541, 2.04759428540706),
        (0.849176252131873, 2.2597031710872),
    ];
    assert_folds(&*one_sided(0.6), (0.5, 1.2), &folds);
}

/// The state on which the motion from a state settles: a stable orbit.
fn settled(system: &dyn System, omega: f64, state: [f64; 2]) -> [f64; 2] {
    let mut flow = time::of(system, omega, 1e-7).unwrap();
    let mut state = state;
    for _ in 0..400 {
        flow.advance(0.0, TAU, &mut state, None, None).unwrap();
    }
    state
}

/// The branch of asymmetric orbits from one on which the motion settles to the point where it meets the symmetric branch. The
/// branch goes on from there to the orbits that are its mirror images.
fn asymmetric(system: &dyn System, start: f64, end: f64) -> Vec<Event> {
    let symmetric = FrequencyResponse::of(system)
        .by(Shooting::new())
        .orbit(start)
        .unwrap();
    assert!(symmetric.orbit.symmetric);
    assert_eq!(symmetric.stability.verdict, Verdict::Unstable);
    let state = symmetric.orbit.state();
    let state = settled(system, start, [1.1 * state[0], state[1]]);
    let request = FrequencyResponse::of(system)
        .by(Shooting::new())
        .near_state(&state);
    let branch = request.from(start).to(end).run().unwrap();
    assert!(branch.turns.is_empty(), "{:?}", branch.turns);
    let is_end = |event: &Event| event.kind == EventKind::BranchPoint;
    let end = branch.events.iter().position(is_end).unwrap();
    branch.events[..=end].to_vec()
}

/// Each of these is among the events.
fn assert_among(events: &[Event], exact: &[(EventKind, f64, f64)]) {
    for &(kind, omega, peak_to_peak) in exact {
        let near = |event: &&Event| (event.point.value - omega).abs() < 1e-5;
        let found = events.iter().find(near).unwrap();
        assert_eq!(found.kind, kind, "{found}");
        assert_exact(found, omega, peak_to_peak);
    }
}

#[test]
fn asymmetric_orbits_of_figure_2a() {
    let system = continuous(1.5, 0.0);
    let below = asymmetric(&*system, 0.38, 0.3);
    let end = (EventKind::BranchPoint, 0.353730954670214, 0.60555123830267);
    assert_among(&below, &[end]);
    let above = asymmetric(&*system, 0.38, 0.45);
    let events = [
        (EventKind::Fold, 0.382084326345429, 0.83145299112814),
        (EventKind::Fold, 0.385408321288445, 0.81536041384917),
        (EventKind::BranchPoint, 0.402310407656194, 0.62590483419901),
    ];
    assert_among(&above, &events);
}

#[test]
fn asymmetric_orbits_of_figure_2b() {
    let system = continuous(0.6, 0.0);
    let below = asymmetric(&*system, 0.95, 0.8);
    let events = [
        (EventKind::Fold, 0.902396742342991, 0.13765525914597),
        (EventKind::Fold, 0.934177569964217, 0.09513266861952),
        (
            EventKind::PeriodDoubling,
            0.904833344193996,
            0.07487229901887,
        ),
        (
            EventKind::PeriodDoubling,
            0.896507260971036,
            0.07400828471589,
        ),
        (EventKind::BranchPoint, 0.868864958044575, 0.04256659866046),
    ];
    assert_among(&below, &events);
    let above = asymmetric(&*system, 0.95, 1.05);
    let end = (EventKind::BranchPoint, 0.973916250536018, 0.04981473636398);
    assert_among(&above, &[end]);
}
