//! Where terms go: matrices, contacts between coordinates, arrays, and contacts that move.

use hertzian::law::{Derivatives, On};
use hertzian::system::{Place, System, Variable};

use super::{coefficient, force};

hertzian::oscillator! {
    Smooth(x) {
        param mu;
        ddot(x) + mu*(x^2 - 1)*dot(x) + x + x^3 + 0.1*|dot(x)|*dot(x) + tanh(x) + sqrt(1 + x^2) = 0;
    }
}

#[test]
fn smooth_forces_leave_their_linear_part_to_the_matrices() {
    let model = Smooth { mu: 0.4 };
    assert_eq!(
        coefficient(&model, Place::Damping { row: 0, column: 0 }, 1.0),
        -0.4
    );
    let (gap, rate) = ([0.5], [-2.0]);
    let (mut force, mut by_gap, mut by_rate) = ([0.0], [0.0], [0.0]);
    let out = Derivatives {
        force: &mut force,
        by_gap: &mut by_gap,
        by_rate: &mut by_rate,
    };
    model
        .law(0)
        .derivatives(On::AllPieces, &[0.4], &gap, &rate, out);
    let expected = 0.4 * 0.25 * -2.0 + 0.125 - 0.4 + 0.5_f64.tanh() + 1.25_f64.sqrt();
    assert!((force[0] - expected).abs() < 1e-14);
    assert!((by_rate[0] - (0.4 * 0.25 + 0.4)).abs() < 1e-14);
}

hertzian::oscillator! {
    Mathieu(x) { param e; ddot(x) + (1 + e*cos(2*omega*t))*x + 0.01*dot(x)/2 + (x^2)^alpha/4 = 0; param alpha > 0.5; }
}

#[test]
fn harmonic_stiffness_stands_in_the_stiffness_matrix() {
    let model = Mathieu {
        e: 0.3,
        alpha: 0.75,
    };
    let facts = model.facts();
    let waves = facts
        .places
        .iter()
        .filter(|place| matches!(place, Place::Stiffness { .. }))
        .count();
    assert_eq!(waves, 2);
    assert!((force(&model, 0, &[1.5], -2.0, 0.0) - 2.0_f64.powf(1.5)).abs() < 1e-14);
}

hertzian::oscillator! {
    TwoMasses(x1, x2) {
        param m1 > 0;
        ddot(x1) + (x1 - x2) + 100*(x1 - x2)^3/m1 = 0;
        2*ddot(x2) + 2*(x2 - x1) + 100*(x2 - x1)^3 = cos(omega*t)^3;
    }
}

#[test]
fn a_force_between_two_masses_is_one_contact() {
    let model = TwoMasses { m1: 4.0 };
    let facts = model.facts();
    assert_eq!((facts.laws, facts.contacts.len()), (1, 1));
}

hertzian::oscillator! {
    /// A rotor with two moving contacts.
    Bearing(x, y) {
        param m > 0;
        param eccentricity;
        param clearance >= 0;
        param k > 0;
        law hertz(gap, stiffness) { gap >= 0 => stiffness*gap^1.5, else => 0 }
        let speed = omega*t/3;
        m*ddot(x) + 2*dot(x) + cos(speed)*hertz(x*cos(speed) + y*sin(speed) - clearance, k)
            - cos(speed)*hertz(-x*cos(speed) - y*sin(speed) - clearance, k) = m*eccentricity*omega^2*cos(omega*t);
        m*ddot(y) + 2*dot(y) + sin(speed)*hertz(x*cos(speed) + y*sin(speed) - clearance, k)
            - sin(speed)*hertz(-x*cos(speed) - y*sin(speed) - clearance, k) = m*eccentricity*omega^2*sin(omega*t + pi/6);
    }
}

#[test]
fn moving_gaps_share_contacts_between_equations() {
    let model = Bearing {
        m: 2.0,
        eccentricity: 0.1,
        clearance: 0.5,
        k: 10.0,
    };
    let facts = model.facts();
    assert_eq!((facts.divisor, facts.laws, facts.contacts.len()), (3, 1, 2));
    let mut derivatives = vec![0.0; facts.places.len()];
    let mut parameters = vec![0.0; 4];
    model.values(&mut parameters);
    model.coefficients_by(Variable::Omega, &parameters, 3.0, &mut derivatives);
    let load = facts
        .places
        .iter()
        .position(|place| matches!(place, Place::Load { row: 0, .. }))
        .unwrap();
    assert!((derivatives[load] - 2.0 * 0.1 * 2.0 * 3.0).abs() < 1e-15);
}

hertzian::oscillator! {
    /// Beads on a line between two walls.
    Beads(x[64]) {
        param k > 0;
        param squeeze >= 0;
        param drive;
        law hertz(gap) { gap > 0 => k*gap^1.5, else => 0 }
        ddot(x[0]) + hertz(x[0] - x[1] + squeeze) - hertz(drive*cos(omega*t) - x[0] + squeeze) = 0;
        for j in 1..63 {
            ddot(x[j]) + hertz(x[j] - x[j + 1] + squeeze) - hertz(x[j - 1] - x[j] + squeeze) = 0;
        }
        ddot(x[63]) + hertz(x[63] + squeeze) - hertz(x[62] - x[63] + squeeze) = 0;
    }
}

#[test]
fn an_array_is_written_out() {
    let model = Beads {
        k: 2.0,
        squeeze: 0.1,
        drive: 0.3,
    };
    let facts = model.facts();
    assert_eq!(
        (facts.coordinates.len(), facts.laws, facts.contacts.len()),
        (64, 1, 65)
    );
    assert_eq!(facts.coordinates[63], "x[63]");
    let direction = Place::GapDirection {
        contact: 5,
        column: 5,
        wave: hertzian::system::Wave::CONSTANT,
    };
    assert_eq!(coefficient(&model, direction, 1.0).abs(), 1.0);
}

hertzian::oscillator! {
    /// A rotor on eight balls, which move with the cage.
    Ring(x, y) {
        param m > 0;
        param k > 0;
        param clearance;
        param eccentricity;
        let cage = 2/5*omega*t;
        law ball(gap) { gap > 0 => k*gap^1.5, else => 0 }
        m*ddot(x) + 0.1*dot(x) + for j in 0..8 {
            let angle = cage + 2*pi*j/8;
            cos(angle)*ball(x*cos(angle) + y*sin(angle) - clearance)
        } = m*eccentricity*omega^2*cos(omega*t);
        m*ddot(y) + 0.1*dot(y) + for j in 0..8 {
            let angle = cage + 2*pi*j/8;
            sin(angle)*ball(x*cos(angle) + y*sin(angle) - clearance)
        } = m*eccentricity*omega^2*sin(omega*t);
    }
}

#[test]
fn moving_contacts_are_declared_in_a_loop() {
    let model = Ring {
        m: 1.0,
        k: 2.0,
        clearance: 0.1,
        eccentricity: 0.01,
    };
    let facts = model.facts();
    assert_eq!((facts.divisor, facts.laws, facts.contacts.len()), (5, 1, 8));
}

hertzian::oscillator! {
    Pressed(x) {
        param c in 0.0..;
        param drive;
        law contact(gap) { gap > 0 => max(0, gap^1.5*(1 + c*dot(gap))), else => 0 }
        ddot(x) + contact(x) = 1 + drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    Coupled(x, y) {
        param gamma;
        ddot(x) + 0.1*dot(x) + x + gamma*x*y^2 = 0.1*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 2*y + gamma*x^2*y = 0.05*cos(omega*t);
    }
}

#[test]
fn kinks_and_polynomials_have_branches() {
    let pressed = Pressed { c: 0.1, drive: 0.3 };
    let coupled = Coupled { gamma: 0.5 };
    let systems: [&dyn System; 2] = [&pressed, &coupled];
    for system in systems {
        let request = hertzian::FrequencyResponse::of(system).from(0.4).to(1.8);
        let branch = request.harmonics(8).samples(256).run().unwrap();
        let last = branch.points.last().unwrap();
        assert!((last.value - 1.8).abs() < 1e-12, "{}", last.value);
    }
}

hertzian::oscillator! {
    /// Forces written in place, of gaps whose first coefficient may be zero.
    InPlace(x, y) {
        param a = 0;
        ddot(x) + x = cos(omega*t);
        ddot(y) + 2*y + tanh(a*x + y) + (a*x - 2*y)^3 = 0;
    }
}

/// A gap is divided by a coefficient that is a number, so that none is lost where a parameter vanishes.
#[test]
fn a_vanishing_coefficient_does_not_take_the_gap_with_it() {
    for a in [0.0, 0.7] {
        let model = InPlace { a };
        let facts = model.facts();
        let mut coefficients = vec![0.0; facts.places.len()];
        model.coefficients(&[a], 1.0, &mut coefficients);
        let (x, y) = (0.3, -0.4);
        let mut total = 0.0;
        for contact in 0..facts.contacts.len() {
            let sum = |wanted: fn(Place, usize) -> Option<usize>, by: [f64; 2]| -> f64 {
                let places = facts.places.iter().zip(&coefficients);
                places
                    .filter_map(|(&place, value)| Some(value * by[wanted(place, contact)?]))
                    .sum()
            };
            let gap = sum(
                |place, of| match place {
                    Place::GapDirection {
                        contact, column, ..
                    } if contact == of => Some(column),
                    _ => None,
                },
                [x, y],
            );
            let direction = sum(
                |place, of| match place {
                    Place::ForceDirection { contact, row, .. } if contact == of => Some(row),
                    _ => None,
                },
                [0.0, 1.0],
            );
            let law = facts.contacts[contact].law;
            let mut arguments = vec![0.0; model.law(law).facts().arguments.len()];
            for (place, value) in facts.places.iter().zip(&coefficients) {
                if let Place::Argument { contact: of, index } = *place
                    && of == contact
                {
                    arguments[index] += value;
                }
            }
            total += direction * force(&model, law, &arguments, gap, 0.0);
        }
        let expected = (a * x + y).tanh() + (a * x - 2.0 * y).powi(3);
        assert!((total - expected).abs() < 1e-14, "{a}: {total} {expected}");
    }
}
