//! What the flow in closed form and the integrated one promise alike.

use std::f64::consts::TAU;

use super::affine::Affine;
use super::*;
use crate::model::request::RequestError;

crate::oscillator! {
    /// Two stops that move, with friction of their own; levels, masses and damping are parameters.
    Play(x) {
        param mass;
        param zeta in 0.0..;
        param half >= 0;
        law stops(gap) {
            gap > half   => 3*(gap - half) + 0.2*dot(gap) + 0.1,
            gap <= -half => 2*(gap + half),
            else         => 0,
        }
        mass*ddot(x) + 2*zeta*dot(x) + 0.4*x + stops(x - 0.1*sin(2*omega*t))
            = cos(omega*t) + 0.3*sin(3*omega*t);
    }
}

const MODEL: Play = Play {
    mass: 1.0,
    zeta: 0.05,
    half: 0.5,
};
const VALUES: [f64; 3] = [1.0, 0.05, 0.5];

fn flows() -> [Box<dyn Flow>; 2] {
    [
        Box::new(Affine::new(&MODEL, &VALUES, 0.9).unwrap()),
        Box::new(Integrated::new(&MODEL, &VALUES, 0.9, 1e-13).unwrap()),
    ]
}

/// Backwards a motion comes to where it began, along the way it went, and its derivatives to the unit matrix.
#[test]
fn motions_return_the_way_they_came() {
    let (from, to) = (0.3, 0.3 + 1.7 * TAU);
    let start = [0.2, 0.7];
    let [mut exact, _] = flows();
    let at = |flow: &mut dyn Flow, phase: f64| {
        let mut state = start;
        flow.advance(from, phase, &mut state, None, None).unwrap();
        state
    };
    for mut flow in flows() {
        for by in [
            Variable::Omega,
            Variable::Parameter(1),
            Variable::Parameter(2),
        ] {
            let (mut state, mut tangent) = (start, Tangent::of_state(1, Some(by)));
            flow.advance(from, to, &mut state, Some(&mut tangent), None)
                .unwrap();
            let (mut phase, mut between) = (to, [0.0; 2]);
            let mut see = |stretch: &dyn Stretch| {
                let (first, last) = stretch.phases();
                assert!((first - phase).abs() < 1e-12 && last < first);
                let middle = 0.5 * (first + last);
                stretch.state(middle, &mut between);
                let known = at(&mut *exact, middle);
                for (x, y) in between.iter().zip(known) {
                    assert!((x - y).abs() < 1e-11, "{middle}: {x} {y}");
                }
                phase = last;
            };
            let before = flow.work();
            flow.advance(to, from, &mut state, Some(&mut tangent), Some(&mut see))
                .unwrap();
            assert!((phase - from).abs() < 1e-12);
            assert!(flow.work().switches > before.switches + 4);
            let unit = Tangent::of_state(1, Some(by)).columns;
            for (x, y) in state.iter().zip(start) {
                assert!((x - y).abs() < 1e-11, "{by:?} {x} {y}");
            }
            for (x, y) in tangent.columns.iter().zip(unit) {
                assert!((x - y).abs() < 1e-10, "{by:?} {:?}", tangent.columns);
            }
        }
    }
}

crate::oscillator! {
    /// A stop of unbounded stiffness away from zero.
    Away(x) {
        param stop > 0;
        law wall(gap) { gap > stop => 40*(gap - stop)^0.6, else => 0 }
        ddot(x) + 0.05*dot(x) + x + wall(x) = 2*cos(omega*t) + stop;
    }
}

crate::oscillator! {
    /// The same from the stop on.
    There(x) {
        law wall(gap) { gap > 0 => 40*gap^0.6, else => 0 }
        ddot(x) + 0.05*dot(x) + x + wall(x) = 2*cos(omega*t);
    }
}

/// Beside a level that is not zero a distance is rounded, and an unbounded stiffness with it: the motion is as exact as ever, its derivatives
/// by as much less as rounding says.
#[test]
fn levels_of_unbounded_stiffness_may_be_anywhere() {
    for stop in [0.37, 5e3] {
        let (away, there) = (Away { stop }, There {});
        let flows = [
            Integrated::new(&away, &[stop], 1.3, 1e-12).unwrap(),
            Integrated::new(&there, &[], 1.3, 1e-12).unwrap(),
        ];
        let mut states = [[stop - 0.1, 0.8], [-0.1, 0.8]];
        let mut tangents = [Tangent::of_state(1, None), Tangent::of_state(1, None)];
        for ((mut flow, state), tangent) in flows.into_iter().zip(&mut states).zip(&mut tangents) {
            flow.advance(0.0, TAU, state, Some(tangent), None).unwrap();
            assert!(flow.work().switches > 1);
        }
        let unit = f64::EPSILON * stop.max(1.0);
        assert!((states[0][0] - stop - states[1][0]).abs() < 1e-10 + 100.0 * unit);
        let known = 1e-9 + 100.0 * 40.0 * unit.powf(0.6);
        let pairs = tangents[0].columns.iter().zip(&tangents[1].columns);
        for (a, b) in pairs {
            assert!((a - b).abs() < known * b.abs().max(1.0), "{stop} {a} {b}");
        }
    }
}

/// What cannot be set is refused, and the flow goes on as before.
#[test]
fn values_that_cannot_be_are_refused() {
    let refused = [
        (Variable::Omega, -1.0),
        (Variable::Omega, 0.0),
        (Variable::Omega, f64::NAN),
        (Variable::Parameter(0), 0.0),
        (Variable::Parameter(1), f64::INFINITY),
        (Variable::Parameter(2), -0.5),
        (Variable::Parameter(99), 1.0),
    ];
    for mut flow in flows() {
        let mut before = [0.2, 0.7];
        flow.advance(0.0, TAU, &mut before, None, None).unwrap();
        for (variable, value) in refused {
            let error = flow.set(variable, value).unwrap_err();
            match variable {
                Variable::Parameter(0) => {
                    assert_eq!(error, FlowError::SingularMass { determinant: 0.0 });
                }
                Variable::Parameter(2) => assert_eq!(error, FlowError::Levels { contact: 0 }),
                _ => assert!(matches!(error, FlowError::Value { .. }), "{error}"),
            }
            let mut state = [0.2, 0.7];
            flow.advance(0.0, TAU, &mut state, None, None).unwrap();
            assert_eq!(state, before);
        }
        assert!(flow.admits(Variable::Parameter(1), 0.0));
        assert!(!flow.admits(Variable::Parameter(1), -0.1));
        assert!(!flow.admits(Variable::Parameter(99), 1.0));
        assert!(!flow.admits(Variable::Omega, -1.0));
    }
}

/// States and tangents that do not fit are errors, and nothing moves.
#[test]
fn entries_are_counted() {
    for mut flow in flows() {
        for entries in [0, 1, 4] {
            let mut state = vec![0.1; entries];
            let error = flow.advance(0.0, 1.0, &mut state, None, None).unwrap_err();
            let expected = 2;
            assert_eq!(error, FlowError::Entries { entries, expected });
            assert!(state.iter().all(|&x| x == 0.1));
        }
        for (entries, by) in [(0, Some(Variable::Omega)), (3, None), (1, None)] {
            let columns = vec![0.0; entries];
            let by = by.into_iter().collect();
            let mut tangent = Tangent { columns, by };
            let mut state = [0.1, 0.2];
            let error = flow.advance(0.0, 1.0, &mut state, Some(&mut tangent), None);
            assert!(matches!(error, Err(FlowError::Entries { .. })), "{error:?}");
        }
        let mut none = Tangent {
            columns: Vec::new(),
            by: Vec::new(),
        };
        flow.advance(0.0, 1.0, &mut [0.1, 0.2], Some(&mut none), None)
            .unwrap();
    }
}

/// As many values as parameters, each in its range; levels in order.
#[test]
fn flows_of_unusable_values_are_refused() {
    let refused: [(&[f64], f64); 5] = [
        (&[1.0], 0.9),
        (&[1.0, 0.05, 0.5, 0.0], 0.9),
        (&[1.0, -0.05, 0.5], 0.9),
        (&[0.0, 0.05, 0.5], 0.9),
        (&VALUES, -0.9),
    ];
    for (values, omega) in refused {
        let errors = [
            at(&MODEL, values, omega, 1e-10).map(|_| ()).unwrap_err(),
            Affine::new(&MODEL, values, omega).map(|_| ()).unwrap_err(),
            divergence::Divergence::new(&MODEL, values, omega)
                .map(|_| ())
                .unwrap_err(),
        ];
        let [first, others @ ..] = &errors;
        assert!(others.iter().all(|error| error == first), "{errors:?}");
        let few = matches!(
            first.downcast_ref(),
            Some(RequestError::Values { expected: 3, .. })
        );
        assert_eq!(few, values.len() != 3, "{first}");
    }
}

crate::oscillator! {
    /// The paper's continuous spring, with the exponent as a parameter: a level at zero, and a step from there to there.
    Continuous(x) {
        param alpha > 0;
        param zeta in 0.0..;
        param drive;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^alpha = 1 + drive*cos(omega*t);
    }
}

/// With the exponent one and at resonance motions settle to `1 + drive / (2 zeta) sin tau`.
#[test]
fn many_periods_at_once_settle_to_the_closed_form() {
    let (zeta, drive) = (0.032, 1.785);
    for (tolerance, start) in [
        (1e-6, [-2.0, 0.2]),
        (1e-10, [0.0, 0.0]),
        (1e-12, [1.0, 0.0]),
    ] {
        let model = Continuous {
            alpha: 1.0,
            zeta,
            drive,
        };
        let mut flow = Integrated::new(&model, &[1.0, zeta, drive], 1.0, tolerance).unwrap();
        let mut state = start;
        flow.advance(0.0, 300.0 * TAU, &mut state, None, None)
            .unwrap();
        let exact = [1.0, drive / (2.0 * zeta)];
        for (found, exact) in state.iter().zip(exact) {
            let error = (found - exact).abs() / (drive / (2.0 * zeta));
            // What each of the last periods adds has died out by `exp(-2 pi zeta)` a period later.
            assert!(error < 100.0 * tolerance, "{tolerance:e}: {error:e}");
        }
    }
}

/// Where a gap opens for a moment only, a step to its second crossing is not taken again and again.
#[test]
fn a_motion_that_almost_touches_goes_on() {
    let drive = 0.1;
    let model = Continuous {
        alpha: 1.5,
        zeta: 0.0,
        drive,
    };
    let [coarse, fine] = [1e-6, 1e-12].map(|tolerance| {
        let mut flow = Integrated::new(&model, &[1.5, 0.0, drive], 1.0, tolerance).unwrap();
        let mut state = [0.0, 0.0];
        flow.advance(0.0, 30.0 * TAU, &mut state, None, None)
            .unwrap();
        state
    });
    for (x, y) in coarse.iter().zip(fine) {
        assert!((x - y).abs() < 1e-3, "{coarse:?} {fine:?}");
    }
}

/// A token ends a motion before its next step, forwards and back, and what it says of the phase is where the state is.
#[test]
fn a_cancelled_motion_stops_where_it_is() {
    for (from, to) in [(0.0, 40.0 * TAU), (40.0 * TAU, 0.0)] {
        for mut flow in flows() {
            let mut whole = [0.3, 0.1];
            let mut first = Vec::new();
            let mut record = |stretch: &dyn Stretch| first.push(stretch.phases().1);
            flow.advance(from, to, &mut whole, None, Some(&mut record))
                .unwrap();
            let cancel = Cancel::new();
            let mut flow: Box<dyn Flow> = if flow.work().forces == 0 {
                super::at(&MODEL, &VALUES, 0.9, 1e-13).unwrap()
            } else {
                Box::new(Integrated::new(&MODEL, &VALUES, 0.9, 1e-13).unwrap())
            };
            flow.until(&cancel);
            let (mut state, mut seen) = ([0.3, 0.1], Vec::new());
            let mut stop = |stretch: &dyn Stretch| {
                seen.push(stretch.phases().1);
                if seen.len() == 5 {
                    cancel.cancel();
                }
            };
            let ended = flow.advance(from, to, &mut state, None, Some(&mut stop));
            assert_eq!(seen, first[..5]);
            let Err(FlowError::Cancelled { phase }) = ended else {
                panic!("{ended:?}");
            };
            assert!((phase - seen[4]).abs() < 1e-13 * 40.0 * TAU, "{phase}");
            let steps = flow.work().steps;
            let before = state;
            let ended = flow.advance(from, to, &mut state, None, None);
            assert_eq!(ended, Err(FlowError::Cancelled { phase: from }));
            assert_eq!((flow.work().steps, state), (steps, before));
        }
    }
}

/// Columns by several variables at once are those by each of them, at every stop between too, and both flows say the same.
#[test]
fn several_variables_move_as_each_of_them() {
    let all = [
        Variable::Omega,
        Variable::Parameter(0),
        Variable::Parameter(1),
        Variable::Parameter(2),
    ];
    let (ends, stops) = ([0.3, 0.3 + 1.2 * TAU], [0.3, 1.1, 2.5, 4.0, 7.7]);
    let mut ways: Vec<Vec<f64>> = Vec::new();
    for mut flow in flows() {
        let mut shown = |by: &[Variable]| {
            let (mut state, mut tangent) = ([0.2, 0.7], Tangent::of_state(1, by.to_vec()));
            let mut seen = Vec::new();
            let mut show = |number: usize, state: &[f64], columns: &[f64]| {
                assert_eq!(number, seen.len());
                seen.push([state, columns].concat());
            };
            flow.advance_by(ends, &stops, &mut state, &mut tangent, &mut show)
                .unwrap();
            assert_eq!(seen.len(), stops.len());
            seen.push([&state, &tangent.columns[..]].concat());
            seen
        };
        let together = shown(&all);
        for (index, &variable) in all.iter().enumerate() {
            for (alone, together) in shown(&[variable]).iter().zip(&together) {
                // The state with its two homogeneous columns, and then one of two entries.
                let own = &together[6 + 2 * index..][..2];
                let pairs = alone.iter().zip(together[..6].iter().chain(own));
                for (a, b) in pairs {
                    assert!(
                        (a - b).abs() < 1e-11 * a.abs().max(1.0),
                        "{variable:?} {a} {b}"
                    );
                }
            }
        }
        ways.push(together.concat());
    }
    for (a, b) in ways[0].iter().zip(&ways[1]) {
        assert!((a - b).abs() < 1e-9 * a.abs().max(1.0), "{a} {b}");
    }
}

/// What a flow knows between its steps is what is there when it is moved from stop to stop, forwards and backwards.
#[test]
fn stops_are_shown_as_ends_are() {
    let by = [Variable::Omega, Variable::Parameter(1)];
    for ends in [[0.3, 6.1], [6.1, 0.3]] {
        // One is before the first end, and one beyond the last.
        let mut stops = [0.1, 0.9, 2.0, 5.0, 9.0];
        if ends[0] > ends[1] {
            stops.reverse();
        }
        for mut flow in flows() {
            let start = [0.2, 0.7];
            let mut shown = [Vec::new(), Vec::new()];
            let [known, moved] = &mut shown;
            let (mut state, mut tangent) = (start, Tangent::of_state(1, by));
            let mut show = |_: usize, state: &[f64], columns: &[f64]| {
                known.extend([state, columns].concat());
            };
            flow.advance_by(ends, &stops, &mut state, &mut tangent, &mut show)
                .unwrap();
            let (mut state, mut tangent) = (start, Tangent::of_state(1, by));
            let mut show = |_: usize, state: &[f64], columns: &[f64]| {
                moved.extend([state, columns].concat());
            };
            let flow = flow.as_mut();
            from_stop_to_stop(flow, ends, &stops, &mut state, &mut tangent, &mut show).unwrap();
            assert_eq!(shown[0].len(), 10 * stops.len());
            for (a, b) in shown[0].iter().zip(&shown[1]) {
                assert!((a - b).abs() < 1e-10 * a.abs().max(1.0), "{ends:?} {a} {b}");
            }
        }
    }
}
