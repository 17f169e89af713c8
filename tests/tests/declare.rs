//! Declarations that must compile, and what their types say of themselves.

use hertzian::law::{Derivatives, On, RateDependence};
use hertzian::system::{Bound, Place, System, Variable};

hertzian::oscillator! {
    /// One-sided contact with damping.
    pub OneSided(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// normal load
        param load;
        /// excitation amplitude
        param drive;

        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap^1.5,
            else    => 0,
        }

        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    pub(crate) AsInThePaper(x) {
        param zeta in 0.0..;
        param alpha > 0;
        param load;
        param drive;
        ddot(x) + 2*zeta*H(x)*dot(x) + H(x)*sgn(x)*|x|^alpha = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    Continuous(x) {
        param zeta in 0.0..1.0;
        param alpha in 0.5..=3;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^alpha = cos(omega*t);
    }
}

/// The module has constants of the same names, which the generated code must not mean.
#[allow(non_snake_case, reason = "these are the names of constants")]
mod beside_constants {
    pub const K: f64 = 4e4;
    pub static E: f64 = 2.1e11;

    hertzian::oscillator! {
        pub Beam(x) {
            param K > 0;
            param E > 0;
            law stop(gap) { gap > 1 => E*(gap - 1)^K, else => 0 }
            ddot(x) + K*x + stop(x) = cos(omega*t);
        }
    }
}

hertzian::oscillator! {
    TwoWells(x) { ddot(x) + 0.1*dot(x) + ||x|-1|^1.5 = 0.2*cos(omega*t); }
}

hertzian::oscillator! {
    Backlash(x) {
        param play > 0;
        param ζ in 0.0..;
        law teeth(gap) {
            gap > play => gap - play,
            -play <= gap <= play => 0,
            gap < -play => gap + play,
        }
        ddot(x) + 2*ζ*dot(x) + (1 + 0.2*cos(omega*t))*teeth(x) = 0.1;
    }
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

hertzian::oscillator! {
    Smooth(x) {
        param mu;
        ddot(x) + mu*(x^2 - 1)*dot(x) + x + x^3 + 0.1*|dot(x)|*dot(x) + tanh(x) + sqrt(1 + x^2) = 0;
    }
}

hertzian::oscillator! {
    Mathieu(x) { param e; ddot(x) + (1 + e*cos(2*omega*t))*x + 0.01*dot(x)/2 + (x^2)^alpha/4 = 0; param alpha > 0.5; }
}

hertzian::oscillator! {
    TwoMasses(x1, x2) {
        param m1 > 0;
        ddot(x1) + (x1 - x2) + 100*(x1 - x2)^3/m1 = 0;
        2*ddot(x2) + 2*(x2 - x1) + 100*(x2 - x1)^3 = cos(omega*t)^3;
    }
}

hertzian::oscillator! {
    /// Contacts of the literature, side by side.
    Literature(x) {
        param k > 0;
        param c in 0.0..;
        param n >= 1;
        param a > 0;
        param preload in 0.0..=2.0;
        law hunt_crossley(gap) { gap > 0 => k*gap^n*(1 + c*dot(gap)), else => 0 }
        law preloaded(gap) { gap >= 0 => preload + gap, else => 0 }
        law bilinear(gap) { gap > 0 => k*gap, else => 0.5*gap }
        law adhesive(gap) { gap > 0 => gap^1.5 - 1/a^2, else => -(a - gap)^-2 }
        ddot(x) + hunt_crossley(x - 1) + preloaded(x) + bilinear(x) - adhesive(-x) + c*|dot(x)|^1.8*sgn(dot(x)) = cos(omega*t);
    }
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

fn coefficient(system: &dyn System, place: Place, omega: f64) -> f64 {
    let facts = system.facts();
    let mut parameters = vec![0.0; facts.parameters.len()];
    system.values(&mut parameters);
    let mut values = vec![0.0; facts.places.len()];
    system.coefficients(&parameters, omega, &mut values);
    facts
        .places
        .iter()
        .zip(&values)
        .filter(|(other, _)| **other == place)
        .map(|(_, value)| value)
        .sum()
}

fn force(system: &dyn System, law: usize, arguments: &[f64], gap: f64, rate: f64) -> f64 {
    let mut force = [0.0];
    system
        .law(law)
        .force(On::AllPieces, arguments, &[gap], &[rate], &mut force);
    force[0]
}

#[test]
fn parameters_may_be_called_as_constants_are() {
    let model = beside_constants::Beam { K: 3.0, E: 2.0 };
    let mut values = [f64::NAN; 2];
    model.values(&mut values);
    assert_eq!(values, [3.0, 2.0]);
    assert_eq!([beside_constants::K, beside_constants::E], [4e4, 2.1e11]);
}

#[test]
fn a_law_keeps_its_pieces_and_its_damping() {
    let model = OneSided {
        zeta: 0.032,
        load: 1.0,
        drive: 0.1,
    };
    let facts = model.facts();
    assert_eq!(facts.parameters[0].documentation, "damping ratio");
    assert_eq!(facts.parameters[0].minimum, Bound::Included(0.0));
    assert_eq!(
        facts.equation,
        "ddot(x) + contact(x) = drive*cos(omega*t) + load"
    );
    assert_eq!(model.law(0).facts().rate, RateDependence::Linear);
    assert_eq!(force(&model, 0, &[0.032], -1.0, 3.0), 0.0);
    let expected = 2.0 * 0.032 * 3.0 + 8.0;
    assert!((force(&model, 0, &[0.032], 4.0, 3.0) - expected).abs() < 1e-14);
}

#[test]
fn both_notations_are_one_model() {
    let law = OneSided {
        zeta: 0.1,
        load: 0.0,
        drive: 0.0,
    };
    let paper = AsInThePaper {
        zeta: 0.1,
        alpha: 1.5,
        load: 0.0,
        drive: 0.0,
    };
    assert_eq!(
        law.law(0).facts().levels.len(),
        paper.law(0).facts().levels.len()
    );
    for gap in [-1.0, 0.0, 1e-3, 2.0] {
        let (a, b) = (
            force(&law, 0, &[0.1], gap, 0.7),
            force(&paper, 0, &[0.1, 1.5], gap, 0.7),
        );
        assert!((a - b).abs() <= 1e-15 * a.abs(), "{a} {b}");
    }
}

#[test]
fn linear_damping_is_no_force_of_the_law() {
    let model = Continuous {
        zeta: 0.3,
        alpha: 0.7,
    };
    assert_eq!(
        coefficient(&model, Place::Damping { row: 0, column: 0 }, 1.0),
        0.6
    );
    assert_eq!(model.law(0).facts().rate, RateDependence::None);
    assert!(model.law(0).facts().odd);
    assert_eq!(force(&model, 0, &[0.7], -1.0, 5.0), -1.0);
}

#[test]
fn nested_absolute_values_are_four_pieces() {
    let model = TwoWells {};
    let mut levels = [0.0; 3];
    model.law(0).levels(&[], &mut levels);
    assert_eq!(levels, [-1.0, 0.0, 1.0]);
    for gap in [-2.5_f64, -0.4, 0.3, 1.7] {
        let expected = (gap.abs() - 1.0).abs().powf(1.5);
        assert!((force(&model, 0, &[], gap, 0.0) - expected).abs() < 1e-14);
    }
}

#[test]
fn levels_follow_their_parameter() {
    let model = Backlash {
        play: 0.25,
        ζ: 0.01,
    };
    let (mut levels, mut slopes) = ([0.0; 2], [0.0; 2]);
    model.law(0).levels(&[0.25], &mut levels);
    model.law(0).levels_by(&[0.25], 0, &mut slopes);
    assert_eq!((levels, slopes), ([-0.25, 0.25], [-1.0, 1.0]));
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

#[test]
fn a_force_between_two_masses_is_one_contact() {
    let model = TwoMasses { m1: 4.0 };
    let facts = model.facts();
    assert_eq!((facts.laws, facts.contacts.len()), (1, 1));
}

#[test]
fn contacts_of_the_literature_are_laws() {
    let model = Literature {
        k: 2.0,
        c: 0.5,
        n: 1.5,
        a: 0.1,
        preload: 0.3,
    };
    let facts = model.facts();
    let names: Vec<String> = (0..facts.laws)
        .map(|law| model.law(law).facts().name.to_string())
        .collect();
    assert_eq!(
        names,
        [
            "hunt_crossley",
            "preloaded",
            "bilinear",
            "adhesive",
            "force 1"
        ]
    );
    assert_eq!(model.law(0).facts().rate, RateDependence::Linear);
    assert!(
        model.law(1).facts().levels[0].force_jumps && model.law(1).facts().levels[0].belongs_above
    );
    assert!(model.law(2).facts().pieces.iter().all(|piece| piece.affine));
    assert!(!model.law(3).facts().levels[0].force_jumps);
    assert_eq!(model.law(4).facts().rate, RateDependence::General);
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
    /// A ball pressed on a plate, in newtons, millimetres and tonnes.
    Ball(x: mm) {
        /// mass
        param m: t = 1e-3 > 0;
        /// contact stiffness
        param k: N/mm^1.5 = 4e4 in 0.0..;
        /// damping of the contact
        param c: s/mm = 1e-4 in 0.0..;
        param drive: N = 10;
        law contact(gap) {
            gap > 0 => max(0, k*gap^1.5*(1 + c*dot(gap))),
            else    => 0,
        }
        m*ddot(x) + contact(x) = drive*cos(omega*t);
    }
}

#[test]
fn defaults_make_a_model() {
    let model = Ball::default();
    assert_eq!(model.k, 4e4);
    let facts = model.facts();
    assert_eq!(
        facts.parameters[1].documentation,
        "contact stiffness [N/mm^1.5]"
    );
    assert_eq!(facts.parameters[3].documentation, "[N]");
}

#[test]
fn a_contact_without_tension_lets_go() {
    let model = Ball::default();
    let arguments = [4e4, 1e-4];
    assert_eq!(model.law(0).facts().rate, RateDependence::General);
    for (gap, rate) in [
        (0.25_f64, 100.0),
        (0.25, -9000.0),
        (0.25, -11000.0),
        (-0.1, 5.0),
    ] {
        let pressed = if gap > 0.0 {
            (4e4 * gap.powf(1.5) * (1.0 + 1e-4 * rate)).max(0.0)
        } else {
            0.0
        };
        let found = force(&model, 0, &arguments, gap, rate);
        assert!(
            (found - pressed).abs() <= 1e-12 * pressed,
            "{found} {pressed}"
        );
    }
    let (mut force, mut by_gap, mut by_rate) = ([9.0], [9.0], [9.0]);
    let out = Derivatives {
        force: &mut force,
        by_gap: &mut by_gap,
        by_rate: &mut by_rate,
    };
    model
        .law(0)
        .derivatives(On::AllPieces, &arguments, &[0.25], &[-11000.0], out);
    assert_eq!((force, by_gap, by_rate), ([0.0], [0.0], [0.0]));
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
