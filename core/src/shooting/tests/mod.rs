//! Shooting on a flow that is easy to believe: steps of Runge and Kutta on a smooth oscillator, against the harmonic balance.

mod runge_kutta;

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::compute::{branch, orbit};
use super::problem::{ShootingProblem, Source};
use crate::branches::branch::Branch;
use crate::branches::error::OrbitError;
use crate::branches::progress::Progress;
use crate::branches::recurrence::{CyclicSymmetry, Recurrence, SignedPermutation};
use crate::branches::request::Guess;
use crate::continuation::follow::Stop;
use crate::continuation::jacobian::Jacobian;
use crate::continuation::problem::Problem;
use crate::continuation::step_control::StepControl;
use crate::error::Error;
use crate::event::EventKind;
use crate::orbit::observe::Accuracy;
use crate::response::FrequencyResponse;
use crate::system::Variable;
use crate::time::MotionError;
use crate::time::{Flow, Work};
use runge_kutta::RungeKutta;

hertzian::oscillator! {
    Duffing(x) {
        param zeta >= 0;
        param cubic;
        param drive;
        param load = 0;
        ddot(x) + 2*zeta*dot(x) + x + cubic*x^3 = drive*cos(omega*t) + load;
    }
}

/// Steps in a period that leave this error about.
fn steps(tolerance: f64) -> usize {
    (10.0 * tolerance.powf(-0.25)) as usize
}

fn problem(parameters: [f64; 4], variable: Variable, omega: f64) -> ShootingProblem {
    let make = move |tolerance: f64| -> Result<Box<dyn Flow>, Error> {
        Ok(Box::new(RungeKutta {
            parameters,
            omega,
            steps: steps(tolerance),
            work: Work::default(),
        }))
    };
    ShootingProblem {
        source: Source {
            make: Box::new(make),
            exact: false,
            tolerance: 1e-8,
        },
        system: Arc::new(Duffing {
            zeta: parameters[0],
            cubic: parameters[1],
            drive: parameters[2],
            load: parameters[3],
        }),
        varied: "something".to_owned(),
        parameters: parameters.to_vec(),
        omega,
        variable,
        divisor: 1,
        period: 1,
        segments: 1,
        rigid: 0,
        symmetries: vec![CyclicSymmetry::none()],
        at_once: Vec::new(),
        stability: true,
        accuracy: Accuracy::default(),
        points: 2000,
        steps: StepControl::default(),
        cancel: crate::cancel::Cancel::new(),
        keep: None,
    }
}

/// The branch along a range from an orbit near a state.
fn followed(problem: &ShootingProblem, state: [f64; 2], from: f64, to: f64) -> Branch {
    let guess = Guess::State(state.to_vec());
    let go = &mut |_: Progress<'_>| ControlFlow::Continue(());
    branch(problem, &guess, [from, to], go).unwrap().branch
}

/// Against central differences, for one and several segments, a whole and half a period, every variable.
#[test]
fn jacobian_agrees_with_differences() {
    use super::equations::{Equations, Frame, Span};
    for (period, half, segments) in [(1, false, 1), (1, true, 1), (2, false, 3), (3, true, 2)] {
        for variable in [
            Variable::Omega,
            Variable::Parameter(0),
            Variable::Parameter(2),
        ] {
            let problem = problem([0.1, 0.5, 0.3, 0.0], variable, 0.9);
            let image = if half {
                SignedPermutation::minus(1)
            } else {
                SignedPermutation::identity()
            };
            let span = Span {
                recurrence: Recurrence {
                    period,
                    parts: if half { 2 } else { 1 },
                    image,
                },
                segments,
            };
            let frame = Frame {
                variable,
                reference: vec![0.2],
                omega: 0.9,
                ratio: 1.0,
            };
            let mut equations = Equations::new(&problem, 1e-6, span.clone(), frame).unwrap();
            let n = equations.unknowns();
            let mut u: Vec<f64> = (0..=n).map(|i| (i as f64 + 0.7).sin()).collect();
            u[n] = 0.8;
            let mut jacobian = Jacobian::new(equations.partition());
            let mut residual = vec![0.0; n];
            equations.evaluate(&u, &mut residual, Some(&mut jacobian));
            jacobian.set_border(&vec![0.0; n + 1]);
            let entries = jacobian.entries();
            for j in 0..=n {
                let mut at = |by: f64| {
                    let mut moved = u.clone();
                    moved[j] += by;
                    let mut residual = vec![0.0; n];
                    equations.evaluate(&moved, &mut residual, None);
                    residual
                };
                let (plus, minus) = (at(1e-5), at(-1e-5));
                for i in 0..n {
                    let difference = (plus[i] - minus[i]) / 2e-5;
                    let error = (entries[(i, j)] - difference).abs();
                    assert!(error < 1e-7, "{span:?} {variable:?} {i} {j}: {error}");
                }
            }
        }
    }
}

#[test]
fn folds_of_a_smooth_oscillator_are_those_of_the_balance() {
    let problem = problem([0.05, 1.0, 0.2, 0.0], Variable::Omega, 0.5);
    let found = followed(&problem, [0.2, 0.0], 0.7, 1.8);
    assert_eq!(found.stopped, Stop::ReachedEnd);
    assert!(found.turns.is_empty(), "{:?}", found.turns);
    assert_eq!(found.events.len(), 2, "{:?}", found.events);
    let model = Duffing {
        zeta: 0.05,
        cubic: 1.0,
        drive: 0.2,
        load: 0.0,
    };
    let request = FrequencyResponse::of(&model).from(0.7).to(1.8);
    let branch = request.tolerance(1e-10).run().unwrap();
    let folds: Vec<_> = branch.folds().collect();
    for (by_shooting, by_balance) in found.events.iter().zip(folds) {
        assert_eq!(by_shooting.kind, EventKind::Fold);
        let error = (by_shooting.point.value - by_balance.point.value).abs();
        assert!(
            error < by_shooting.error + by_balance.error,
            "{by_shooting} {by_balance}"
        );
        assert!(by_shooting.error < 1e-10, "{by_shooting}");
        let (a, b) = (
            by_shooting.point.peak_to_peak(),
            by_balance.point.peak_to_peak(),
        );
        assert!((a - b).abs() < 1e-7, "{a} {b}");
    }
    for point in &found.points {
        let expected = (-TAU * 2.0 * 0.05 / point.omega()).exp();
        let product = point
            .stability
            .multipliers
            .iter()
            .product::<crate::Complex<f64>>();
        assert!((product - expected).norm() < 1e-8, "{product} {expected}");
    }
}

/// The state of a balance's orbit at phase zero is refined; the error stated covers what another tolerance gives.
#[test]
fn an_orbit_of_the_balance_is_refined() {
    let model = Duffing {
        zeta: 0.05,
        cubic: 1.0,
        drive: 0.2,
        load: 0.1,
    };
    let request = FrequencyResponse::of(&model).from(0.8).to(0.9);
    let by_balance = request.harmonics(3).max_points(2).run().unwrap();
    let known = &by_balance.points[0].orbit;
    for segments in [1, 3] {
        let mut problem = problem([0.05, 1.0, 0.2, 0.1], Variable::Omega, 0.8);
        problem.segments = segments;
        let refined = orbit(&problem, &Guess::Orbit(known.clone()), 0.8).unwrap();
        problem.source.tolerance = 1e-12;
        let guess = Guess::State(refined.orbit.state());
        let again = orbit(&problem, &guess, 0.8).unwrap();
        let pairs = refined.orbit.state().into_iter().zip(again.orbit.state());
        let change = pairs.fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()));
        let stated = refined.peak_to_peak() * refined.error.expect("with its stability");
        assert!(change < stated && stated < 1e-7, "{change} {refined:?}");
        let [a, b] = [&refined, &again].map(|point| &point.stability.multipliers);
        let change = crate::numeric::spectrum::distance(a, b);
        assert!(
            change < refined.stability.error && change < 1e-8,
            "{change} {refined:?}"
        );
        assert_eq!(
            refined.stability.verdict,
            crate::orbit::stability::Verdict::Stable
        );
    }
}

/// By half a period, by a whole one, and by the balance.
#[test]
fn symmetry_breaks_where_the_balance_says() {
    let mut problem = problem([0.1, 1.0, 1.0, 0.0], Variable::Parameter(2), 1.0);
    let model = Duffing {
        zeta: 0.1,
        cubic: 1.0,
        drive: 1.0,
        load: 0.0,
    };
    let request = FrequencyResponse::of(&model).vary("drive").omega(1.0);
    let by_balance = request.from(0.1).to(12.0).tolerance(1e-9).run().unwrap();
    assert_eq!(by_balance.events.len(), 2);
    for (odd, kind) in [
        (true, EventKind::SymmetryBreaking),
        (false, EventKind::BranchPoint),
    ] {
        let minus = CyclicSymmetry {
            parts: 2,
            image: SignedPermutation::minus(1),
        };
        problem.symmetries = vec![if odd { minus } else { CyclicSymmetry::none() }];
        let found = followed(&problem, [0.1, 0.0], 0.1, 12.0);
        assert_eq!(found.stopped, Stop::ReachedEnd);
        assert!(found.turns.is_empty(), "{:?}", found.turns);
        assert_eq!(found.events.len(), 2, "{:?}", found.events);
        for (event, expected) in found.events.iter().zip(&by_balance.events) {
            assert_eq!((event.kind, event.point.orbit.symmetric), (kind, odd));
            let error = (event.point.value - expected.point.value).abs();
            assert!(error < event.error + expected.error, "{event} {expected}");
            assert!(event.error < 1e-6 && error < 1e-8, "{event} {error}");
            let one = event.point.stability.multipliers[0];
            assert!((one - 1.0).norm() < 1e-9, "{one}");
        }
    }
}

/// The branch of twice the period ends on the branch that doubles, where that has a multiplier of minus one.
#[test]
fn a_period_doubles_where_the_branch_of_twice_the_period_ends() {
    let mut problem = problem([0.1, 1.0, 1.0, 0.3], Variable::Parameter(2), 1.0);
    let found = followed(&problem, [0.1, 0.0], 0.1, 12.0);
    let [doubling] = &found.events[..] else {
        panic!("{:?}", found.events);
    };
    assert_eq!(doubling.kind, EventKind::PeriodDoubling);
    let one = doubling.point.stability.multipliers[0];
    assert!((one + 1.0).norm() < 1e-10, "{one}");
    // Beyond it the motion settles on twice the period.
    let mut flow = problem.flow(1e-6).unwrap();
    flow.set(Variable::Parameter(2), 7.3).unwrap();
    let mut state = doubling.point.orbit.state();
    for _ in 0..1000 {
        flow.advance(0.0, TAU, &mut state, None, None).unwrap();
    }
    problem.period = 2;
    problem.segments = 2;
    let found = followed(&problem, [state[0], state[1]], 7.3, 7.0);
    let end = found.events.last().unwrap();
    let joined = Stop::Joined {
        period: 1,
        symmetric: false,
        value: end.point.value,
    };
    assert_eq!(found.stopped, joined);
    assert_eq!(end.kind, EventKind::BranchPoint);
    let error = (end.point.value - doubling.point.value).abs();
    assert!(error < end.error + doubling.error, "{end} {doubling}");
    assert!(error < 1e-9, "{end} {doubling}");
}

#[test]
fn beyond_a_fold_there_is_no_orbit_and_the_fold_is_named() {
    let problem = problem([0.05, 1.0, 0.2, 0.0], Variable::Omega, 0.5);
    let found = followed(&problem, [0.2, 0.0], 0.7, 1.8);
    let fold = &found.events[0].point;
    let guess = Guess::State(fold.orbit.state());
    let beyond = fold.value + 1e-7;
    let error = orbit(&problem, &guess, beyond).unwrap_err();
    let Some(&OrbitError::Beyond { value, fold: named }) = error.downcast_ref() else {
        panic!("{error}");
    };
    assert_eq!(value, beyond);
    assert!((named - fold.value).abs() < 1e-10, "{named} {}", fold.value);
    let text = error.to_string();
    assert!(text.contains("turns back at 1.52244802"), "{text}");
    let before = orbit(&problem, &guess, fold.value - 1e-7).unwrap();
    assert!((before.orbit.state()[0] - fold.orbit.state()[0]).abs() < 1e-2);
}

#[test]
fn a_motion_without_end_is_an_error_and_not_a_panic() {
    let problem = problem([0.05, -1.0, 0.2, 0.0], Variable::Omega, 0.5);
    let error = orbit(&problem, &Guess::State(vec![3.0, 3.0]), 0.7).unwrap_err();
    assert!(error.downcast_ref::<MotionError>().is_some(), "{error}");
}

#[test]
fn an_orbit_of_a_shorter_period_is_not_the_one_asked_for() {
    let mut problem = problem([0.05, 1.0, 0.2, 0.0], Variable::Omega, 0.5);
    problem.period = 3;
    let error = orbit(&problem, &Guess::State(vec![0.2, 0.0]), 0.7).unwrap_err();
    assert!(
        matches!(
            error.downcast_ref(),
            Some(OrbitError::NoSuchPeriod { period: 3, .. })
        ),
        "{error}"
    );
}

#[test]
fn evaluations_do_not_allocate() {
    use super::equations::{Equations, Frame, Span};
    let variable = Variable::Omega;
    let problem = problem([0.1, 0.5, 0.3, 0.0], variable, 0.9);
    let span = Span::of(Recurrence::whole(2), 3);
    let frame = Frame {
        variable,
        reference: vec![0.2],
        omega: 0.9,
        ratio: 1.0,
    };
    let mut equations = Equations::new(&problem, 1e-4, span, frame).unwrap();
    let n = equations.unknowns();
    let mut jacobian = Jacobian::new(equations.partition());
    let (u, mut residual) = (vec![0.5; n + 1], vec![0.0; n]);
    let allocations = crate::testing::allocations::count(|| {
        for _ in 0..3 {
            jacobian.clear();
            equations.evaluate(&u, &mut residual, Some(&mut jacobian));
            equations.evaluate(&u, &mut residual, None);
        }
    });
    assert_eq!(allocations, 0);
}
