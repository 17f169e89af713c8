//! The balance with forces integrated from switch to switch: its Jacobian against differences where forces jump, and that
//! iterations do not allocate.

use super::tests::{RESOLUTION, jacobian_error, values};
use super::*;
use crate::continuation::newton::{Border, Newton, NewtonOptions};
use crate::continuation::problem::Scale;
use crate::numeric::fourier::crossings::crossings;
use crate::testing::allocations::count;
use crate::testing::random::Random;

hertzian::oscillator! {
    /// Two coordinates and two stops, one of which moves, the other with a direction that turns. Force and damping jump, at a level
    /// that is a parameter, and grow with a power that is one too.
    Stops(x, y) {
        param mass > 0;
        param damping >= 0;
        param clearance;
        param stiffness > 0;
        param preload;
        param alpha > 0;
        law stop(gap, k, p, c, a) {
            gap > c => p + k*(gap - c)^a + 0.3*dot(gap),
            else    => 0,
        }
        mass*ddot(x) + damping*dot(x) + x
            + cos(omega*t)*stop(x*cos(omega*t) + y*sin(omega*t), stiffness, preload, clearance, alpha)
            + stop(x - y - 0.2*cos(omega*t), 2*stiffness, preload, 2*clearance, alpha)
            = cos(omega*t) + 0.3;
        ddot(y) + damping*dot(y) + 2*y
            + sin(omega*t)*stop(x*cos(omega*t) + y*sin(omega*t), stiffness, preload, clearance, alpha)
            - stop(x - y - 0.2*cos(omega*t), 2*stiffness, preload, 2*clearance, alpha)
            = sin(omega*t);
    }
}

const STOPS: Stops = Stops {
    mass: 1.3,
    damping: 0.2,
    clearance: 0.1,
    stiffness: 1.7,
    preload: 0.4,
    alpha: 1.5,
};
const OMEGA: f64 = 0.7;
const SWITCHED: Resolution = Resolution {
    aft: Aft::Switched,
    ..RESOLUTION
};
/// States whose gaps cross levels more slowly than this, or turn nearer to one, are left out: differences need steps far below
/// that.
const FAST: f64 = 0.1;
const CLEAR: f64 = 0.02;

fn random_state(random: &mut Random) -> Vec<f64> {
    let length = series::length(SWITCHED.harmonics);
    let size = |index: usize| {
        let k = (index % length).div_ceil(2) as f64;
        1.5 / (1.0 + k * k)
    };
    let entries = (0..2 * length).map(|index| random.between(-1.0, 1.0) * size(index));
    let mut u: Vec<f64> = entries.collect();
    u.push(OMEGA);
    u
}

/// Whether both gaps cross their levels, and cross them fast.
fn switches_fast(u: &[f64]) -> bool {
    let mut balance = Balance::new(&STOPS, &values(&STOPS), OMEGA, Variable::Omega, SWITCHED);
    balance.set(OMEGA);
    let mut gap = vec![0.0; series::length(balance.gap_harmonics())];
    let mut slope = gap.clone();
    let levels = [STOPS.clearance, 2.0 * STOPS.clearance];
    let layouts = balance.layout().contacts.iter().zip(levels);
    layouts.into_iter().all(|(contact, level)| {
        let coefficients = balance.coefficients();
        let (period, length) = (SWITCHED.period, balance.length());
        gap_series(contact, coefficients, period, u, length, &mut gap);
        series::differentiate(&gap, &mut slope);
        let (mut found, mut turns) = (Vec::new(), Vec::new());
        crossings(&gap, level, &mut found);
        crossings(&slope, 0.0, &mut turns);
        let fast = |at: f64| series::value_and_derivatives(&gap, at).1.abs() > FAST;
        let clear = |at: f64| (series::value(&gap, at) - level).abs() > CLEAR;
        !found.is_empty()
            && found.iter().all(|crossing| fast(crossing.tau))
            && turns.iter().all(|turn| clear(turn.tau))
    })
}

/// The force jumps, so that only the impulses of moving switches make the Jacobian the derivative: by the unknowns, by the frequency,
/// and by every parameter, those that move a level and the exponent among them.
#[test]
fn jacobian_is_the_derivative_where_forces_jump() {
    let mut random = Random::seeded(11);
    let mut seen = 0;
    while seen < 12 {
        let mut u = random_state(&mut random);
        if !switches_fast(&u) {
            continue;
        }
        seen += 1;
        let error = jacobian_error(&STOPS, Variable::Omega, SWITCHED, &u, OMEGA, 2e-4);
        assert!(error < 1e-8, "{error:e} {u:?}");
        for (parameter, value) in values(&STOPS).into_iter().enumerate() {
            u[14] = value;
            let variable = Variable::Parameter(parameter);
            let error = jacobian_error(&STOPS, variable, SWITCHED, &u, OMEGA, 2e-4);
            assert!(error < 1e-8, "{parameter}: {error:e} {u:?}");
        }
    }
}

/// What an iteration has met is kept, rules for its panels among it: the same correction again allocates nothing.
#[test]
fn iterations_do_not_allocate() {
    let mut balance = Balance::new(&STOPS, &values(&STOPS), OMEGA, Variable::Omega, SWITCHED);
    let mut newton = Newton::new(&balance);
    let mut row = [0.0; 15];
    row[14] = 1.0;
    let border = Border {
        row: &row,
        value: OMEGA,
    };
    let options = NewtonOptions {
        tolerance: 1e-10,
        iterations: 40,
        damped: true,
    };
    let mut u = vec![0.0; 15];
    u[14] = OMEGA;
    let mut tangent = vec![0.0; 15];
    let mut solve = |newton: &mut Newton, u: &mut [f64]| {
        newton
            .correct(&mut balance, u, border, Scale::UNIT, options)
            .unwrap();
        newton.tangent(&mut balance, u, &mut tangent, false);
    };
    solve(&mut newton, &mut u);
    u[1] += 0.1;
    let disturbed = u.clone();
    solve(&mut newton, &mut u);
    u.copy_from_slice(&disturbed);
    let allocated = count(|| solve(&mut newton, &mut u));
    assert!(newton.statistics.jacobians > 4);
    assert_eq!(allocated, 0);
}
