//! Tangents and sensitivities against differences of motions.

use super::*;
use crate::testing::allocations::count;

hertzian::oscillator! {
    /// Everything that a derivative can pass through: levels and exponents that are parameters, a contact that moves, forces
    /// that jump, a stiffness that varies, damping and loads with the frequency.
    Everything(x, y) {
        param stiff = 2;
        param alpha in 1.2..3.0;
        param level in 0.05..0.5;
        param jump = 0.1;
        param sway = 0.2;
        param mass > 0;
        law stop(gap, a, l, j) {
            gap > l => (gap - l)^a * (1 + 0.2*dot(gap)) + j + 0.1*dot(gap),
            0 < gap <= l => 0.3*gap,
            else => 0,
        }
        mass*ddot(x) + 0.1*dot(x) + (stiff + 0.3*cos(omega*t))*x - y + stop(x + 0.4*y - sway*sin(omega*t), alpha, level, jump)
            = 1.5*cos(omega*t) + 0.2*omega^2*sin(2*omega*t);
        ddot(y) + 0.05*omega*dot(y) + 2*y - x + y^3 = 0.4;
    }
}

/// The model with the values of its parameters.
fn everything() -> (Everything, [f64; 6]) {
    let model = Everything {
        stiff: 2.0,
        alpha: 1.7,
        level: 0.2,
        jump: 0.1,
        sway: 0.2,
        mass: 1.3,
    };
    let mut values = [0.0; 6];
    model.values(&mut values);
    (model, values)
}

/// What it is varied by, and the values.
fn variables(values: &[f64; 6]) -> impl Iterator<Item = (Variable, f64)> {
    let parameters = values.iter().enumerate();
    let parameters = parameters.map(|(index, value)| (Variable::Parameter(index), *value));
    parameters.chain([(Variable::Omega, 0.9)])
}

/// The end of a motion over two periods and a half, with one number changed.
fn end(change: impl FnOnce(&mut Integrated, &mut [f64])) -> [f64; 4] {
    let (model, values) = everything();
    let mut flow = Integrated::new(&model, &values, 0.9, 1e-13).unwrap();
    let mut state = [0.1, -0.2, 0.3, 0.4];
    change(&mut flow, &mut state);
    flow.advance(0.3, 0.3 + 2.5 * TAU, &mut state, None, None)
        .unwrap();
    state
}

/// Central differences of order four: what is left of three of them by Richardson's extrapolation.
fn difference(end: impl Fn(f64) -> [f64; 4]) -> [f64; 4] {
    let h = 2e-3;
    let central = |h: f64| {
        let (ahead, behind) = (end(h), end(-h));
        std::array::from_fn(|i| (ahead[i] - behind[i]) / (2.0 * h))
    };
    let [a, b, c]: [[f64; 4]; 3] = [central(h), central(h / 2.0), central(h / 4.0)];
    std::array::from_fn(|i| {
        let (first, second) = ((4.0 * b[i] - a[i]) / 3.0, (4.0 * c[i] - b[i]) / 3.0);
        (16.0 * second - first) / 15.0
    })
}

#[test]
fn tangents_are_derivatives() {
    let (model, values) = everything();
    for (variable, value) in variables(&values) {
        let mut tangent = Tangent::of_state(2, Some(variable));
        let mut flow = Integrated::new(&model, &values, 0.9, 1e-13).unwrap();
        let mut state = [0.1, -0.2, 0.3, 0.4];
        flow.advance(0.3, 0.3 + 2.5 * TAU, &mut state, Some(&mut tangent), None)
            .unwrap();
        assert!(flow.work().switches >= 8, "{:?}", flow.work());
        let by_variable = difference(|h| end(|flow, _| flow.set(variable, value + h).unwrap()));
        let compare = |column: usize, exact: [f64; 4]| {
            let size = exact.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            for (i, exact) in exact.iter().enumerate() {
                let error = (tangent.columns[4 * column + i] - exact).abs();
                assert!(
                    error < 1e-8 * size,
                    "{variable:?} {column} {i} {error:e} {exact}"
                );
            }
        };
        compare(4, by_variable);
        if variable == Variable::Omega {
            for i in 0..4 {
                compare(i, difference(|h| end(|_, state| state[i] += h)));
            }
        }
    }
}

/// Other values and the motion with its derivatives by them allocate nothing once all maps of steps are known: levels, exponents
/// and jumps that move, a contact that moves.
#[test]
fn nothing_is_allocated_at_other_values() {
    let (model, values) = everything();
    for (variable, value) in variables(&values) {
        let mut flow = Integrated::new(&model, &values, 0.9, 1e-10).unwrap();
        let mut tangent = Tangent::of_state(2, Some(variable));
        let mut run = || {
            for value in [value, value + 0.01] {
                let mut state = [0.1, -0.2, 0.3, 0.4];
                flow.set(variable, value).unwrap();
                for tangent in [None, Some(&mut tangent)] {
                    flow.advance(0.0, TAU, &mut state, tangent, None).unwrap();
                }
            }
        };
        run();
        assert_eq!(count(run), 0, "{variable:?}");
    }
}

/// So close to a level that its stiffness is beyond all bounds, a motion is what it is from the level itself.
#[test]
fn stiffness_beside_a_level_does_not_stop_a_motion() {
    let model = PowerForm::new(false, 0.1, 0.0, 0.0, 0.0);
    let end = |x: f64| {
        let mut flow = Integrated::new(&model, &model.values, 1.0, 1e-10).unwrap();
        let mut state = [x, 1.0];
        flow.advance(0.0, 1.0, &mut state, None, None).unwrap();
        state
    };
    let exact = end(0.0);
    for x in [1e-40, -1e-40, 1e-20] {
        for (found, exact) in end(x).iter().zip(exact) {
            assert!((found - exact).abs() < 1e-9, "{x:e}: {found} {exact}");
        }
    }
}

/// Moving again, with derivatives and shown to a watcher, allocates nothing.
#[test]
fn nothing_is_allocated_again() {
    let model = PowerForm::new(true, 0.6, 0.032, 1.0, 1.0);
    let mut flow = Integrated::new(&model, &model.values, 0.9, 1e-10).unwrap();
    let mut tangent = Tangent::of_state(1, Some(Variable::Omega));
    let mut run = || {
        let (mut state, mut last) = ([1.2, 0.4], [0.0; 2]);
        let mut see = |stretch: &dyn Stretch| stretch.state(stretch.phases().1, &mut last);
        let by = Some(&mut tangent);
        flow.advance(0.0, 4.0 * TAU, &mut state, by, Some(&mut see))
            .unwrap();
    };
    run();
    assert_eq!(count(run), 0);
}
