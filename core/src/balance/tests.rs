//! The balance against sums written out by hand, and its Jacobian against differences.

use std::f64::consts::TAU;

use proptest::prelude::*;

use super::*;
use crate::continuation::jacobian::Jacobian;
use crate::continuation::problem::Problem;
use crate::law::On;
use crate::system::Place;
use crate::testing::by_hand::PowerForm;

hertzian::oscillator! {
    /// Two coordinates, contacts whose direction turns with the excitation, a parametric stiffness, an unbalance.
    Rotor(x, y) {
        param mass > 0;
        param damping >= 0;
        param clearance;
        param stiffness > 0;
        param unbalance;
        // Smooth enough at its level that differences converge.
        law contact(gap, k) { gap > 0 => k*gap^5 + 0.1*gap^4*dot(gap), else => 0 }
        mass*ddot(x) + 0.1*ddot(y) + damping*dot(x) + (1 + 0.3*cos(2*omega*t))*x
            + (1 + 0.2*sin(omega*t))*cos(omega*t)*contact(x*cos(omega*t) + y*sin(omega*t) - clearance, stiffness)
            + contact(x - y - 0.1*cos(omega*t), 2*stiffness)
            = unbalance*omega^2*cos(omega*t) + 0.3;
        0.1*ddot(x) + mass*ddot(y) + damping*dot(y) + 2*y
            + sin(omega*t)*contact(x*cos(omega*t) + y*sin(omega*t) - clearance, stiffness)
            - contact(x - y - 0.1*cos(omega*t), 2*stiffness)
            = unbalance*omega^2*sin(omega*t);
    }
}

const ROTOR: Rotor = Rotor {
    mass: 1.3,
    damping: 0.2,
    clearance: 0.1,
    stiffness: 1.7,
    unbalance: 0.4,
};

pub(super) fn values(system: &dyn System) -> Vec<f64> {
    let mut values = vec![0.0; system.facts().parameters.len()];
    system.values(&mut values);
    values
}

fn wave_at(wave: crate::system::Wave, phase: f64) -> f64 {
    let angle = f64::from(wave.harmonic) * phase;
    match wave.part {
        crate::system::Part::Cosine => angle.cos(),
        crate::system::Part::Sine => angle.sin(),
    }
}

/// The equations of motion at one phase of the excitation, straight from their definition.
fn equations(
    system: &dyn System,
    omega: f64,
    phase: f64,
    q: &[f64],
    v: &[f64],
    a: &[f64],
) -> Vec<f64> {
    let facts = system.facts();
    let mut coefficients = vec![0.0; facts.places.len()];
    system.coefficients(&values(system), omega, &mut coefficients);
    let contacts = facts.contacts.len();
    let (mut gap, mut rate) = (vec![0.0; contacts], vec![0.0; contacts]);
    let wave_at = |wave| wave_at(wave, phase);
    let mut arguments: Vec<Vec<f64>> = (0..contacts)
        .map(|c| vec![0.0; system.law(facts.contacts[c].law).facts().arguments.len()])
        .collect();
    let mut sum = vec![0.0; q.len()];
    // The phase runs at the base frequency.
    let speed = omega / f64::from(facts.divisor);
    let slope = |wave: crate::system::Wave| {
        let (derivative, sign) = wave.derivative();
        sign * f64::from(wave.harmonic) * speed * wave_at(derivative)
    };
    for (place, &value) in facts.places.iter().zip(&coefficients) {
        match *place {
            Place::Mass { row, column } => sum[row] += value * a[column],
            Place::Damping { row, column } => sum[row] += value * v[column],
            Place::Stiffness { row, column, wave } => {
                sum[row] += value * wave_at(wave) * q[column];
            }
            Place::Load { row, wave } => sum[row] -= value * wave_at(wave),
            Place::GapDirection {
                contact,
                column,
                wave,
            } => {
                gap[contact] += value * wave_at(wave) * q[column];
                rate[contact] += value * (wave_at(wave) * v[column] + slope(wave) * q[column]);
            }
            Place::Offset { contact, wave } => {
                gap[contact] -= value * wave_at(wave);
                rate[contact] -= value * slope(wave);
            }
            Place::Argument { contact, index } => arguments[contact][index] += value,
            Place::ForceDirection { .. } => {}
            ref other => panic!("{other:?}"),
        }
    }
    for (place, &value) in facts.places.iter().zip(&coefficients) {
        if let Place::ForceDirection { contact, row, wave } = *place {
            let law = system.law(facts.contacts[contact].law);
            let (arguments, gap, rate) = (&arguments[contact], [gap[contact]], [rate[contact]]);
            let mut force = [0.0];
            law.force(On::AllPieces, arguments, &gap, &rate, &mut force);
            sum[row] += value * wave_at(wave) * force[0];
        }
    }
    sum
}

/// The residual as plain sums over samples.
fn naive_residual(system: &dyn System, resolution: Resolution, u: &[f64], omega: f64) -> Vec<f64> {
    let length = series::length(resolution.harmonics);
    let n = u.len() / length;
    let base = omega / (f64::from(system.facts().divisor) * resolution.period as f64);
    let mut residual = vec![0.0; u.len()];
    for j in 0..resolution.samples {
        let tau = TAU * j as f64 / resolution.samples as f64;
        let states = u
            .chunks_exact(length)
            .map(|s| series::value_and_derivatives(s, tau));
        let (mut q, mut v, mut a) = (vec![], vec![], vec![]);
        for (x, x1, x2) in states {
            q.push(x);
            v.push(base * x1);
            a.push(base * base * x2);
        }
        let phase = tau * resolution.period as f64;
        let sum = equations(system, omega, phase, &q, &v, &a);
        for row in 0..n {
            for index in 0..length {
                let k = index.div_ceil(2) as f64;
                let weight = match index {
                    0 => 1.0,
                    odd if odd % 2 == 1 => 2.0 * (k * tau).cos(),
                    _ => 2.0 * (k * tau).sin(),
                };
                residual[row * length + index] += weight * sum[row] / resolution.samples as f64;
            }
        }
    }
    residual
}

/// Largest difference between the Jacobian and central differences of a step and its half, extrapolated, relative to the largest entry.
pub(super) fn jacobian_error(
    system: &dyn System,
    variable: Variable,
    resolution: Resolution,
    u: &[f64],
    omega: f64,
    step: f64,
) -> f64 {
    let mut balance = Balance::new(system, &values(system), omega, variable, resolution);
    let n = balance.unknowns();
    let mut jacobian = Jacobian::new(balance.partition());
    let mut residual = vec![0.0; n];
    balance.evaluate(u, &mut residual, Some(&mut jacobian));
    let jacobian = jacobian.entries();
    let largest = jacobian.amax();
    let mut worst = 0.0_f64;
    for column in 0..=n {
        let mut difference = |h: f64| {
            let mut at = |step: f64| {
                let mut moved = u.to_vec();
                moved[column] += step;
                let mut residual = vec![0.0; n];
                balance.evaluate(&moved, &mut residual, None);
                residual
            };
            let (ahead, behind) = (at(h), at(-h));
            ahead
                .iter()
                .zip(behind)
                .map(|(a, b)| (a - b) / (2.0 * h))
                .collect::<Vec<f64>>()
        };
        let (wide, narrow) = (difference(step), difference(0.5 * step));
        for row in 0..n {
            let extrapolated = (4.0 * narrow[row] - wide[row]) / 3.0;
            worst = worst.max((jacobian[(row, column)] - extrapolated).abs());
        }
    }
    worst / largest
}

fn state(n: usize, length: usize, parameter: f64) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0_f64, n).prop_map(move |mut u| {
        for (index, x) in u.iter_mut().enumerate() {
            let k = (index % length).div_ceil(2) as f64;
            *x /= 1.0 + k * k;
        }
        u.push(parameter);
        u
    })
}

pub(super) const RESOLUTION: Resolution = Resolution {
    harmonics: 3,
    core: 3,
    parity: Parity::All,
    stride: 1,
    samples: 64,
    aft: Aft::Sampled,
    period: 2,
};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn residual_is_the_projected_equation(u in state(14, 7, 0.7)) {
        let mut balance = Balance::new(&ROTOR, &values(&ROTOR), 0.7, Variable::Omega, RESOLUTION);
        let mut residual = vec![0.0; 14];
        balance.evaluate(&u, &mut residual, None);
        let expected = naive_residual(&ROTOR, RESOLUTION, &u[..14], 0.7);
        for (a, b) in residual.iter().zip(&expected) {
            prop_assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{a} {b}");
        }
        let mut jacobian = Jacobian::new(balance.partition());
        let mut again = vec![0.0; 14];
        balance.evaluate(&u, &mut again, Some(&mut jacobian));
        for (a, b) in residual.iter().zip(&again) {
            prop_assert!((a - b).abs() < 1e-13 * (1.0 + b.abs()));
        }
    }

    /// The force of [`Rotor`] has a jump in its fifth derivative only, so differences extrapolate well.
    #[test]
    fn jacobian_is_the_derivative_for_moving_contacts(u in state(14, 7, 0.7)) {
        let error = jacobian_error(&ROTOR, Variable::Omega, RESOLUTION, &u, 0.7, 2e-3);
        prop_assert!(error < 1e-7, "{error:e}");
    }

    #[test]
    fn jacobian_is_the_derivative_in_every_parameter(u in state(14, 7, 0.0), parameter in 0_usize..5) {
        let mut u = u;
        u[14] = values(&ROTOR)[parameter];
        let error = jacobian_error(&ROTOR, Variable::Parameter(parameter), RESOLUTION, &u, 0.7, 2e-3);
        prop_assert!(error < 1e-7, "{error:e}");
    }

    #[test]
    fn jacobian_is_the_derivative_in_an_exponent(u in state(9, 9, 0.9)) {
        let by_hand = PowerForm::new(false, 2.5, 0.05, 1.0, 0.3);
        let resolution = Resolution { harmonics: 4, core: 4, parity: Parity::All, stride: 1, samples: 64, aft: Aft::Sampled, period: 1 };
        let error = jacobian_error(&by_hand, Variable::Parameter(1), resolution, &{
            let mut u = u;
            u[9] = 2.5;
            u
        }, 0.9, 2e-3);
        prop_assert!(error < 1e-5, "{error:e}");
    }
}

#[test]
fn generated_and_interpreted_balances_agree() {
    let interpreted = ROTOR.generic();
    let u: Vec<f64> = (0..15).map(|i| 0.3 / f64::from(i + 1)).collect();
    let mut results = Vec::new();
    for system in [&ROTOR as &dyn System, &interpreted] {
        let mut balance = Balance::new(system, &values(system), 0.7, Variable::Omega, RESOLUTION);
        let mut jacobian = Jacobian::new(balance.partition());
        let mut residual = vec![0.0; 14];
        balance.evaluate(&u, &mut residual, Some(&mut jacobian));
        residual.extend(jacobian.entries().iter());
        results.push(residual);
    }
    for (a, b) in results[0].iter().zip(&results[1]) {
        assert!((a - b).abs() < 1e-14 * (1.0 + a.abs()), "{a} {b}");
    }
}

/// From the second correction on, Newton's method and everything below it reuse what they have.
#[test]
fn iterations_do_not_allocate() {
    use crate::continuation::newton::{Border, Newton, NewtonOptions};
    use crate::continuation::problem::Scale;
    use crate::testing::allocations::count;
    let mut balance = Balance::new(&ROTOR, &values(&ROTOR), 0.7, Variable::Omega, RESOLUTION);
    let mut newton = Newton::new(&balance);
    let mut row = [0.0; 15];
    row[14] = 1.0;
    let border = Border {
        row: &row,
        value: 0.7,
    };
    let scale = Scale::UNIT;
    let options = NewtonOptions {
        tolerance: 1e-10,
        iterations: 20,
        damped: true,
    };
    let mut u = vec![0.0; 15];
    u[14] = 0.7;
    let mut tangent = vec![0.0; 15];
    newton
        .correct(&mut balance, &mut u, border, scale, options)
        .unwrap();
    u[1] += 0.1;
    let allocated = count(|| {
        newton
            .correct(&mut balance, &mut u, border, scale, options)
            .unwrap();
        newton.tangent(&mut balance, &u, &mut tangent, false);
    });
    assert!(newton.statistics.jacobians > 4);
    assert_eq!(allocated, 0);
    assert!(
        count(|| drop(std::hint::black_box(vec![1]))) > 0,
        "the counter works"
    );
}

/// What the core and the tail leave out, the directional derivative has.
#[test]
fn the_derivative_in_a_direction_is_that_of_the_whole_jacobian() {
    let mut random = crate::testing::random::Random::seeded(5);
    for aft in [Aft::Sampled, Aft::Switched] {
        let dense = Resolution { aft, ..RESOLUTION };
        let split = Resolution { core: 1, ..dense };
        let new =
            |resolution| Balance::new(&ROTOR, &values(&ROTOR), 0.7, Variable::Omega, resolution);
        let (mut all, mut part) = (new(dense), new(split));
        let u: Vec<f64> = (0..15)
            .map(|i| {
                if i == 14 {
                    0.7
                } else {
                    random.between(-0.5, 0.5)
                }
            })
            .collect();
        let direction: Vec<f64> = (0..15).map(|_| random.between(-1.0, 1.0)).collect();
        let mut jacobian = Jacobian::new(all.partition());
        let mut residual = vec![0.0; 14];
        all.evaluate(&u, &mut residual, Some(&mut jacobian));
        let expected = jacobian.entries() * nalgebra::DVector::from_column_slice(&direction);
        let mut derivative = vec![0.0; 14];
        part.apply(&u, &direction, &mut derivative);
        for (a, b) in derivative.iter().zip(expected.iter()) {
            assert!((a - b).abs() < 1e-11 * (1.0 + b.abs()), "{aft} {a} {b}");
        }
        // The tail has the diagonal of the whole.
        let mut tail = Jacobian::new(part.partition());
        let mut again = vec![0.0; 14];
        part.evaluate(&u, &mut again, Some(&mut tail));
        let (whole, tail) = (jacobian.entries(), tail.entries());
        for (a, b) in residual.iter().zip(&again) {
            assert!((a - b).abs() < 1e-13 * (1.0 + b.abs()));
        }
        for &row in &part.partition().core {
            for &column in &part.partition().core {
                assert!((whole[(row, column)] - tail[(row, column)]).abs() < 1e-12);
            }
            assert!((whole[(row, 14)] - tail[(row, 14)]).abs() < 1e-12);
        }
    }
}
