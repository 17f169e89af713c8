//! What the flow promises beside accuracy: which systems it takes, that it repeats itself, and that it allocates nothing.

use std::f64::consts::TAU;

use super::random::Stops;
use super::touch::Thrown;
use super::{OneSided, flow, one_sided};
use crate::oscillator;
use crate::system::{System, Variable};
use crate::testing::allocations::count;
use crate::testing::by_hand::PowerForm;
use crate::time::affine::Affine;
use crate::time::{Flow, FlowError, Tangent};

oscillator! {
    /// Stiffness that varies in time.
    Parametric(x) {
        ddot(x) + (1 + 0.1*cos(omega*t))*x = 0;
    }
}

#[test]
fn other_systems_are_refused() {
    let power = PowerForm::new(true, 1.5, 0.03, 1.0, 0.1);
    assert!(Affine::new(&power, &power.values, 1.0).is_err());
    assert!(Affine::new(&Parametric {}, &[], 1.0).is_err());
    let values = [0.032, 1.0, 1.0];
    assert!(Affine::new(&one_sided(1.0), &values, 0.0).is_err());
    assert!(Affine::new(&one_sided(1.0), &values, f64::NAN).is_err());
}

/// Many periods at once are the same bits as one after the other, whatever happened in between.
#[test]
fn periods_repeat() {
    let model = one_sided(1.78);
    let mut flow = flow(&model, 1.0);
    let (mut once, mut each) = ([-0.33, 0.33], [-0.33, 0.33]);
    flow.advance(0.0, 5.0 * TAU, &mut once, None, None).unwrap();
    for _ in 0..5 {
        flow.advance(0.0, TAU, &mut each, None, None).unwrap();
        flow.set(Variable::Parameter(2), 1.5).unwrap();
        flow.advance(0.3, 4.0, &mut [1.0, 1.0], None, None).unwrap();
        flow.set(Variable::Parameter(2), 1.78).unwrap();
    }
    assert_eq!(once, each);
}

/// Moving on with other values of a parameter, with and without derivatives, allocates nothing once all pieces were met.
#[test]
fn nothing_is_allocated_again() {
    let stops = Stops {
        mass: 1.0,
        damping: 0.1,
        stiffness: 0.2,
        play: 0.1,
        upper: 3.0,
        lower: 2.0,
        rub: 0.1,
        preload: 0.1,
        shake: 0.1,
        load: 0.1,
        drive: 1.0,
        half: 0.3,
    };
    let single = one_sided(1.0);
    let systems: [&dyn System; 2] = [&stops, &single];
    for system in systems {
        let mut flow = flow(system, 1.0);
        let mut tangent = Tangent::of_state(1, Some(Variable::Omega));
        let mut plain = Tangent::of_state(1, None);
        let mut run = |omega: f64| {
            flow.set(Variable::Omega, omega).unwrap();
            let mut state = [0.1, 0.2];
            let by = Some(&mut tangent);
            flow.advance(0.0, 20.0, &mut state, by, None).unwrap();
            flow.advance(0.0, 20.0, &mut state, Some(&mut plain), None)
                .unwrap();
            flow.advance(0.0, 20.0, &mut state, None, Some(&mut |_| {}))
                .unwrap();
        };
        run(1.0);
        assert_eq!(count(|| run(1.1)), 0);
    }
}

#[test]
fn rest_at_a_level_stays() {
    let model = Thrown {
        weight: 0.0,
        preload: 0.0,
        stiffness: 1.0,
    };
    let mut flow = flow(&model, 1.0);
    let mut state = [0.0, 0.0];
    flow.advance(0.0, 30.0, &mut state, None, None).unwrap();
    assert_eq!((state, flow.work().switches), ([0.0, 0.0], 0));
}

/// A stop too stiff to be followed matters only if it is met.
#[test]
fn stiffness_beyond_resolution_is_reported_where_it_is_met() {
    let model = Thrown {
        weight: 1.0,
        preload: 0.0,
        stiffness: 1e20,
    };
    let mut flow = flow(&model, 1.0);
    let mut state = [-1.0, 0.0];
    flow.advance(0.0, 1.0, &mut state, None, None).unwrap();
    assert!((state[0] + 1.5).abs() < 1e-15);
    let mut state = [-1.0, 5.0];
    let result = flow.advance(0.0, 1.0, &mut state, None, None);
    assert!(
        matches!(result, Err(FlowError::StepTooShort { .. })),
        "{result:?}"
    );
    assert!(state[0].abs() < 1e-15);
}

#[test]
fn a_singular_mass_is_reported() {
    let stops = Stops {
        mass: 1.0,
        damping: 0.0,
        stiffness: 1.0,
        play: 1.0,
        upper: 1.0,
        lower: 1.0,
        rub: 0.0,
        preload: 0.0,
        shake: 0.0,
        load: 0.0,
        drive: 0.0,
        half: 0.0,
    };
    let mut flow = flow(&stops, 1.0);
    let result = flow.set(Variable::Parameter(0), 0.0);
    assert_eq!(result, Err(FlowError::SingularMass { determinant: 0.0 }));
}

/// Where the spring in contact is a thousand million times stiffer than the load, contacts are as sharp as impacts, and a
/// multiplier of many decades is still right: the mass returns each time with the speed at which it came.
#[test]
fn stiff_contacts_are_resolved() {
    for stiffness in [1e4, 1e9] {
        let model = Thrown {
            weight: -1.0,
            preload: 0.0,
            stiffness,
        };
        let mut flow = flow(&model, 1.0);
        let mut state = [-0.5, 0.0];
        let mut tangent = Tangent::of_state(1, None);
        // Half of the fall on either side of a contact that lasts as its own closed form says, from x = 0 with the speed one.
        let rate = f64::sqrt(stiffness);
        let contact = 2.0 * (std::f64::consts::PI - (rate).atan()) / rate;
        let to = 2.0 + contact;
        flow.advance(0.0, to, &mut state, Some(&mut tangent), None)
            .unwrap();
        let error = (state[0] + 0.5).abs() + state[1].abs();
        assert!(error < 1e-15 * rate.max(10.0), "{stiffness:e}: {error:e}");
        let [a, b, c, d] = tangent.columns[..] else {
            unreachable!()
        };
        let size = a.abs().max(b.abs()).max(c.abs()).max(d.abs());
        let area = (a * d - b * c - 1.0).abs();
        assert!(area < 1e-14 * size * size, "{stiffness:e}: {area:e} {size}");
    }
}

/// One column of the tangent with respect to a parameter that nothing depends on is zero.
#[test]
fn without_excitation_its_derivative_vanishes_in_free_flight() {
    let model = OneSided {
        zeta: 0.1,
        load: 0.0,
        drive: 0.0,
    };
    let mut flow = flow(&model, 1.0);
    let mut tangent = Tangent::of_state(1, Some(Variable::Parameter(0)));
    flow.advance(0.0, 3.0, &mut [-1.0, -1.0], Some(&mut tangent), None)
        .unwrap();
    assert_eq!(tangent.columns, [1.0, 0.0, 3.0, 1.0, 0.0, 0.0]);
}
