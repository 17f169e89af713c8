//! Shooting on a flow that is easy to believe: steps of Runge and Kutta on a smooth oscillator, against the harmonic balance.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use super::compute::{branch, cycle};
use super::setting::{Setting, Source};
use super::start::Guess;
use super::{Cycle, CycleBranch, End};
use crate::branch::EventKind;
use crate::continuation::problem::Problem;
use crate::continuation::step::StepControl;
use crate::error::Error;
use crate::flow::{Flow, FlowError, See, Stretch, Tangent, Work};
use crate::jacobian::Jacobian;
use crate::system::Variable;
use crate::{FrequencyResponse, Stop};

hertzian::oscillator! {
    Duffing(x) {
        param zeta >= 0;
        param cubic;
        param drive;
        param load = 0;
        ddot(x) + 2*zeta*dot(x) + x + cubic*x^3 = drive*cos(omega*t) + load;
    }
}

/// The classical method of Runge and Kutta with steps of equal phase.
struct RungeKutta {
    /// zeta, cubic, drive, load
    parameters: [f64; 4],
    omega: f64,
    steps: usize,
    work: Work,
}

struct Step {
    phases: (f64, f64),
    /// State at both ends, and acceleration.
    ends: [[f64; 3]; 2],
    time: f64,
}

impl Stretch for Step {
    fn phases(&self) -> (f64, f64) {
        self.phases
    }

    /// The quintic through positions, velocities and accelerations.
    fn state(&self, phase: f64, state: &mut [f64]) {
        let (from, to) = self.phases;
        let (s, h) = ((phase - from) / (to - from), self.time);
        let [[x0, v0, a0], [x1, v1, a1]] = self.ends;
        let d = x1 - x0 - h * v0 - 0.5 * h * h * a0;
        let e = h * (v1 - v0 - h * a0);
        let f = h * h * (a1 - a0);
        let c3 = 10.0 * d - 4.0 * e + 0.5 * f;
        let c4 = -15.0 * d + 7.0 * e - f;
        let c5 = 6.0 * d - 3.0 * e + 0.5 * f;
        state[0] = x0 + s * (h * v0 + s * (0.5 * h * h * a0 + s * (c3 + s * (c4 + s * c5))));
        state[1] = v0 + s * (h * a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)) / h);
    }
}

impl RungeKutta {
    fn acceleration(&self, phase: f64, [x, v]: [f64; 2]) -> f64 {
        let [zeta, cubic, drive, load] = self.parameters;
        drive * phase.cos() + load - 2.0 * zeta * v - x - cubic * x * x * x
    }

    /// Derivatives by time of the state and of one tangent.
    fn slope(&self, phase: f64, y: [f64; 4], by: Option<Variable>) -> [f64; 4] {
        let [x, v, dx, dv] = y;
        let [zeta, cubic, ..] = self.parameters;
        let explicit = match by {
            Some(Variable::Parameter(0)) => -2.0 * v,
            Some(Variable::Parameter(1)) => -x * x * x,
            Some(Variable::Parameter(2)) => phase.cos(),
            Some(Variable::Parameter(_)) => 1.0,
            Some(Variable::Omega) | None => 0.0,
        };
        let stiffness = 1.0 + 3.0 * cubic * x * x;
        let acceleration = self.acceleration(phase, [x, v]);
        [
            v,
            acceleration,
            dv,
            explicit - 2.0 * zeta * dv - stiffness * dx,
        ]
    }

    /// One step in phase, of the state and of one tangent. With `y' = f / omega` by phase, the derivative by omega has
    /// `- f / omega^2` more.
    fn step(&self, phase: f64, h: f64, y: [f64; 4], by: Option<Variable>) -> [f64; 4] {
        let slope = |phase: f64, y: [f64; 4]| {
            let mut f = self.slope(phase, y, by).map(|x| x / self.omega);
            if by == Some(Variable::Omega) {
                f[2] -= f[0] / self.omega;
                f[3] -= f[1] / self.omega;
            }
            f
        };
        let plus = |a: f64, k: [f64; 4]| std::array::from_fn(|i| y[i] + a * k[i]);
        let k1 = slope(phase, y);
        let k2 = slope(phase + 0.5 * h, plus(0.5 * h, k1));
        let k3 = slope(phase + 0.5 * h, plus(0.5 * h, k2));
        let k4 = slope(phase + h, plus(h, k3));
        std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    }
}

impl Flow for RungeKutta {
    fn coordinates(&self) -> usize {
        1
    }

    fn set(&mut self, variable: Variable, value: f64) {
        match variable {
            Variable::Omega => self.omega = value,
            Variable::Parameter(index) => self.parameters[index] = value,
        }
    }

    fn advance(
        &mut self,
        from: f64,
        to: f64,
        state: &mut [f64],
        mut tangent: Option<&mut Tangent>,
        mut see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        let steps = ((to - from) / TAU * self.steps as f64).ceil().max(1.0);
        let h = (to - from) / steps;
        for step in 0..steps as usize {
            let phase = from + h * step as f64;
            let start = [state[0], state[1]];
            if let Some(Tangent { columns, by }) = tangent.as_deref_mut() {
                let last = columns.len() / 2 - 1;
                for (index, column) in columns.chunks_exact_mut(2).enumerate() {
                    let by = by.filter(|_| index == last);
                    let y = [start[0], start[1], column[0], column[1]];
                    let y = self.step(phase, h, y, by);
                    column.copy_from_slice(&y[2..]);
                }
            }
            let y = self.step(phase, h, [start[0], start[1], 0.0, 0.0], None);
            state.copy_from_slice(&y[..2]);
            self.work.steps += 1;
            if !(y[0] + y[1]).is_finite() {
                return Err(FlowError::NotFinite { phase });
            }
            if let Some(see) = &mut see {
                let end = [y[0], y[1]];
                let with = |p: f64, s: [f64; 2]| [s[0], s[1], self.acceleration(p, s)];
                see(&Step {
                    phases: (phase, phase + h),
                    ends: [with(phase, start), with(phase + h, end)],
                    time: h / self.omega,
                });
            }
        }
        Ok(())
    }

    fn work(&self) -> Work {
        self.work
    }
}

/// Steps in a period that leave this error about.
fn steps(tolerance: f64) -> usize {
    (10.0 * tolerance.powf(-0.25)) as usize
}

fn setting(parameters: [f64; 4], variable: Variable, omega: f64) -> Setting<'static> {
    let make = move |tolerance: f64| -> Result<Box<dyn Flow>, Error> {
        Ok(Box::new(RungeKutta {
            parameters,
            omega,
            steps: steps(tolerance),
            work: Work::default(),
        }))
    };
    Setting {
        source: Source {
            make: Box::new(make),
            exact: false,
            tolerance: 1e-8,
        },
        varied: "something".to_owned(),
        parameters: parameters.to_vec(),
        omega,
        variable,
        divisor: 1,
        period: 1,
        segments: 1,
        odd: false,
        stability: true,
        points: 2000,
        steps: StepControl::default(),
    }
}

/// The branch along a range from an orbit near a state.
fn followed(setting: &Setting<'static>, state: [f64; 2], from: f64, to: f64) -> CycleBranch {
    let guess = Guess::State(state.to_vec());
    let go = &mut |_: &Cycle| ControlFlow::Continue(());
    branch(setting, &guess, [from, to], go).unwrap()
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
            let setting = setting([0.1, 0.5, 0.3, 0.0], variable, 0.9);
            let span = Span {
                period,
                half,
                segments,
            };
            let frame = Frame {
                variable,
                reference: vec![0.2],
                omega: 0.9,
                ratio: 1.0,
            };
            let mut equations = Equations::new(&setting, 1e-6, span, frame).unwrap();
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
    let setting = setting([0.05, 1.0, 0.2, 0.0], Variable::Omega, 0.5);
    let found = followed(&setting, [0.2, 0.0], 0.7, 1.8);
    assert_eq!(found.end, End::Stopped(Stop::ReachedEnd));
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
        let error = (by_shooting.cycle.value - by_balance.point.value).abs();
        assert!(
            error < by_shooting.error + by_balance.error,
            "{by_shooting} {by_balance}"
        );
        assert!(by_shooting.error < 1e-10, "{by_shooting}");
        let (a, b) = (
            by_shooting.cycle.peak_to_peak(),
            by_balance.point.peak_to_peak(),
        );
        assert!((a - b).abs() < 1e-7, "{a} {b}");
    }
    for cycle in &found.cycles {
        let expected = (-TAU * 2.0 * 0.05 / cycle.omega).exp();
        let product = cycle
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
    let orbit = &by_balance.points[0].orbit;
    for segments in [1, 3] {
        let mut setting = setting([0.05, 1.0, 0.2, 0.1], Variable::Omega, 0.8);
        setting.segments = segments;
        let refined = cycle(&setting, &Guess::Series(orbit.clone()), 0.8).unwrap();
        assert!((1..8).contains(&refined.iterations), "{refined:?}");
        setting.source.tolerance = 1e-12;
        let guess = Guess::State(refined.state().to_vec());
        let again = cycle(&setting, &guess, 0.8).unwrap();
        let pairs = refined.state().iter().zip(again.state());
        let change = pairs.fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()));
        assert!(
            change < refined.error && refined.error < 1e-7,
            "{change} {refined:?}"
        );
        let [a, b] = [&refined, &again].map(|cycle| &cycle.stability.multipliers);
        let change = crate::stability::distance(a, b);
        assert!(
            change < refined.stability.error && change < 1e-8,
            "{change} {refined:?}"
        );
        assert_eq!(refined.stability.verdict, crate::Verdict::Stable);
    }
}

/// By half a period, by a whole one, and by the balance.
#[test]
fn symmetry_breaks_where_the_balance_says() {
    let mut setting = setting([0.1, 1.0, 1.0, 0.0], Variable::Parameter(2), 1.0);
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
        setting.odd = odd;
        let found = followed(&setting, [0.1, 0.0], 0.1, 12.0);
        assert_eq!(found.end, End::Stopped(Stop::ReachedEnd));
        assert!(found.turns.is_empty(), "{:?}", found.turns);
        assert_eq!(found.events.len(), 2, "{:?}", found.events);
        for (event, expected) in found.events.iter().zip(&by_balance.events) {
            assert_eq!((event.kind, event.cycle.symmetric), (kind, odd));
            let error = (event.cycle.value - expected.point.value).abs();
            assert!(error < event.error + expected.error, "{event} {expected}");
            assert!(event.error < 1e-6 && error < 1e-8, "{event} {error}");
            let one = event.cycle.stability.multipliers[0];
            assert!((one - 1.0).norm() < 1e-9, "{one}");
        }
    }
}

/// The branch of twice the period ends on the branch that doubles, where that has a multiplier of minus one.
#[test]
fn a_period_doubles_where_the_branch_of_twice_the_period_ends() {
    let mut setting = setting([0.1, 1.0, 1.0, 0.3], Variable::Parameter(2), 1.0);
    let found = followed(&setting, [0.1, 0.0], 0.1, 12.0);
    let [doubling] = &found.events[..] else {
        panic!("{:?}", found.events);
    };
    assert_eq!(doubling.kind, EventKind::PeriodDoubling);
    let one = doubling.cycle.stability.multipliers[0];
    assert!((one + 1.0).norm() < 1e-10, "{one}");
    // Beyond it the motion settles on twice the period.
    let mut flow = setting.flow(1e-6).unwrap();
    flow.set(Variable::Parameter(2), 7.3);
    let mut state = doubling.cycle.state().to_vec();
    for _ in 0..1000 {
        flow.advance(0.0, TAU, &mut state, None, None).unwrap();
    }
    setting.period = 2;
    setting.segments = 2;
    let found = followed(&setting, [state[0], state[1]], 7.3, 7.0);
    let joined = End::Joined {
        period: 1,
        symmetric: false,
    };
    assert_eq!(found.end, joined);
    let end = found.events.last().unwrap();
    assert_eq!(end.kind, EventKind::BranchPoint);
    let error = (end.cycle.value - doubling.cycle.value).abs();
    assert!(error < end.error + doubling.error, "{end} {doubling}");
    assert!(error < 1e-9, "{end} {doubling}");
}

#[test]
fn beyond_a_fold_there_is_no_orbit_and_the_fold_is_named() {
    let setting = setting([0.05, 1.0, 0.2, 0.0], Variable::Omega, 0.5);
    let found = followed(&setting, [0.2, 0.0], 0.7, 1.8);
    let fold = &found.events[0].cycle;
    let guess = Guess::State(fold.state().to_vec());
    let beyond = fold.value + 1e-7;
    let error = cycle(&setting, &guess, beyond).unwrap_err();
    let Error::Beyond {
        parameter,
        fold: named,
    } = error
    else {
        panic!("{error}");
    };
    assert_eq!(parameter, beyond);
    assert!((named - fold.value).abs() < 1e-10, "{named} {}", fold.value);
    let text = error.to_string();
    assert!(text.contains("turns back at 1.52244802"), "{text}");
    let before = cycle(&setting, &guess, fold.value - 1e-7).unwrap();
    assert!((before.state()[0] - fold.state()[0]).abs() < 1e-2);
}

#[test]
fn a_motion_without_end_is_an_error_and_not_a_panic() {
    let setting = setting([0.05, -1.0, 0.2, 0.0], Variable::Omega, 0.5);
    let error = cycle(&setting, &Guess::State(vec![3.0, 3.0]), 0.7).unwrap_err();
    assert!(matches!(error, Error::Motion { .. }), "{error}");
}

#[test]
fn an_orbit_of_a_shorter_period_is_not_the_one_asked_for() {
    let mut setting = setting([0.05, 1.0, 0.2, 0.0], Variable::Omega, 0.5);
    setting.period = 3;
    let error = cycle(&setting, &Guess::State(vec![0.2, 0.0]), 0.7).unwrap_err();
    assert!(
        matches!(error, Error::NoSuchPeriod { period: 3, .. }),
        "{error}"
    );
}
