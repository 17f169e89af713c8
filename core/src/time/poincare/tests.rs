//! Crossings against closed forms.

use super::*;
use crate::model::request::RequestError;
use crate::time::affine::Affine;
use crate::time::{Flow, Integrated};

crate::oscillator! {
    Linear(x) {
        param drive;
        ddot(x) + 4*x = drive*cos(omega*t);
    }
}

fn map(model: &Linear) -> Stroboscope {
    let flow = Affine::new(model, &[model.drive], 1.0).expect("affine");
    Stroboscope::new(Box::new(flow))
}

/// `x = cos 2 tau + b` passes zero where `cos 2 tau = -b`.
fn crossings(section: &Section<'_>) -> Vec<(f64, bool)> {
    let model = Linear { drive: 0.0 };
    let mut found = Vec::new();
    let mut state = [1.0, 0.0];
    section
        .follow(&mut map(&model), &mut state, 2, &mut |crossing| {
            found.push((TAU * crossing.periods, crossing.rises));
        })
        .expect("a motion");
    found
}

#[test]
fn crossings_are_where_the_closed_form_says() {
    let offset: f64 = 0.3;
    let section = || Section::entry(0, -offset);
    let angle = (-offset).acos() / 2.0;
    let pi = std::f64::consts::PI;
    let found = crossings(&section().both());
    let expected = (0..4).flat_map(|k| {
        let start = pi * f64::from(k);
        [(start + angle, false), (start + pi - angle, true)]
    });
    let expected: Vec<_> = expected.collect();
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert!(
            (found.0 - expected.0).abs() < 1e-13,
            "{found:?} {expected:?}"
        );
        assert_eq!(found.1, expected.1);
    }
    assert_eq!(crossings(&section()).len(), 4);
    assert_eq!(crossings(&section().falling()).len(), 4);
}

/// Two crossings within a hundredth of the distance of samples, and a turn just before the surface: wherever the pair lies
/// between samples, and with stretches that begin anywhere.
#[test]
fn two_crossings_between_samples_are_both_found() {
    let model = Linear { drive: 0.0 };
    let flow = |exact: bool| -> Box<dyn Flow> {
        if exact {
            return Box::new(Affine::new(&model, &[0.0], 1.0).expect("affine"));
        }
        Box::new(Integrated::new(&model, &[0.0], 1.0, 1e-13).expect("a flow"))
    };
    let depth: f64 = 1e-7;
    let half = depth.sqrt() / 2_f64.sqrt();
    for (exact, step) in (0..200).map(|k| (k < 100, k % 100)) {
        // From just before a pair to just behind the next one.
        let start = std::f64::consts::PI * (0.5 + 0.99 * f64::from(step) / 100.0) + 1e-3;
        let mut found = Vec::new();
        for depth in [depth, -depth] {
            let mut state = [(2.0 * start).cos(), -2.0 * (2.0 * start).sin()];
            let mut map = Stroboscope::new(flow(exact)).phase(start);
            Section::entry(0, depth - 1.0)
                .both()
                .follow(&mut map, &mut state, 2, &mut |crossing| {
                    found.push(start + TAU * crossing.periods);
                })
                .expect("a motion");
        }
        assert_eq!(found.len(), 8, "{start} {found:?}");
        for (k, pair) in found.chunks(2).enumerate() {
            let middle = std::f64::consts::PI * (k as f64 + 1.5);
            for (crossing, sign) in pair.iter().zip([-1.0, 1.0]) {
                let error = crossing - middle - sign * half;
                // A crossing at a shallow angle is known to the error of the motion over the slope.
                assert!(error.abs() < 1e-9, "{error:e}");
            }
        }
    }
}

/// A state that is too short for the surface, or for the system, is an error.
#[test]
fn entries_are_counted() {
    let model = Linear { drive: 0.0 };
    for (entry, entries) in [(7, 2), (0, 1), (0, 4)] {
        let section = Section::entry(entry, 0.0);
        let mut state = vec![0.0; entries];
        let error = section
            .follow(&mut map(&model), &mut state, 1, &mut |_| {})
            .expect_err("no such entry");
        assert!(matches!(error, FlowError::Entries { .. }), "{error}");
    }
}

/// A surface through the start, through switches and at the ends of periods is passed once each time.
#[test]
fn a_surface_at_the_end_of_a_stretch_is_crossed_once() {
    let model = Linear { drive: 0.0 };
    let section = Section::new(|_, state| state[1]).both();
    let mut quarters = Vec::new();
    let mut state = [1.0, 0.0];
    section
        .follow(&mut map(&model), &mut state, 10, &mut |crossing| {
            quarters.push((4.0 * crossing.periods).round() as usize);
        })
        .expect("a motion");
    // x' = -2 sin 2 tau: at every quarter of a period. The last one is where the motion ends, on either side by rounding.
    let last = quarters.len();
    assert!(last == 39 || last == 40);
    assert_eq!(quarters, (1..=last).collect::<Vec<_>>());
}

/// A stop that moves, `g = x - b cos tau`, and does not push: the motion is `cos 2 tau`, and the crossings are where both
/// meet.
#[test]
fn a_moving_gap_is_crossed_where_it_closes() {
    crate::oscillator! {
        Moving(x) {
            param stiffness in 0.0..;
            law stop(gap) { gap > 0 => gap, else => 0 }
            ddot(x) + 4*x + stiffness*stop(x - 0.5*cos(omega*t)) = 0;
        }
    }
    let model = Moving { stiffness: 0.0 };
    let flow = Affine::new(&model, &[0.0], 1.0).expect("affine");
    let mut map = Stroboscope::new(Box::new(flow));
    let section = Section::gap(&model, &[0.0], 1.0, 0, 0.0);
    let mut phases = Vec::new();
    let mut state = [1.0, 0.0];
    section
        .expect("a contact")
        .both()
        .follow(&mut map, &mut state, 1, &mut |crossing| {
            phases.push(crossing.phase);
        })
        .expect("a motion");
    // cos 2 tau = 0.5 cos tau: with c = cos tau, 2 c^2 - c / 2 - 1 = 0.
    let roots = [-1.0, 1.0].map(|sign: f64| (0.5 + sign * 8.25_f64.sqrt()) / 4.0);
    let (near, far) = (roots[1].acos(), roots[0].acos());
    let expected = [near, far, TAU - far, TAU - near];
    assert_eq!(phases.len(), 4, "{phases:?}");
    for (found, expected) in phases.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }
    let of = |values, contact| {
        let section = Section::gap(&model, values, 1.0, contact, 0.0);
        section.map(|_| ()).expect_err("it cannot be")
    };
    assert!(matches!(
        of(&[0.0], 1).downcast_ref(),
        Some(RequestError::Option { .. })
    ));
    assert!(matches!(
        of(&[0.0, 0.0], 0).downcast_ref(),
        Some(RequestError::Values { .. })
    ));
}
