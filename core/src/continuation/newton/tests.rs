//! How fast updates shrink.

use super::{Border, Newton, NewtonError, NewtonOptions};
use crate::balance::aft::Aft;
use crate::balance::{Balance, Parity, Resolution};
use crate::continuation::problem::Scale;
use crate::response::FrequencyResponse;
use crate::system::Variable;

hertzian::oscillator! {
    /// Spring and damper on one side: the force jumps with the contact.
    OneSided(x) {
        param zeta >= 0;
        param load;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

const HARMONICS: usize = 10;

/// Lengths of the updates of Newton's method, with a new Jacobian for each, from far beside an orbit that loses contact.
fn updates(core: usize) -> Vec<f64> {
    let model = OneSided {
        zeta: 0.032,
        load: 1.0,
        drive: 1.0,
    };
    let branch = FrequencyResponse::of(&model)
        .vary("drive")
        .omega(1.0)
        .from(0.02)
        .to(1.0)
        .harmonics(HARMONICS)
        .stability(false)
        .run()
        .unwrap();
    let mut u = branch.points.last().unwrap().orbit.row(0).to_vec();
    u.push(1.0);
    u[1] += 1.0;
    u[4] -= 0.8;
    let resolution = Resolution {
        harmonics: HARMONICS,
        core,
        parity: Parity::All,
        stride: 1,
        samples: 256,
        period: 1,
        aft: Aft::Switched,
    };
    let parameters = [0.032, 1.0, 1.0];
    let mut balance = Balance::new(&model, &parameters, 1.0, Variable::Omega, resolution);
    let mut newton = Newton::new(&balance);
    let mut row = vec![0.0; u.len()];
    row[u.len() - 1] = 1.0;
    let border = Border {
        row: &row,
        value: 1.0,
    };
    let options = NewtonOptions {
        tolerance: 0.0,
        iterations: 1,
        damped: true,
    };
    (0..5)
        .map(
            |_| match newton.correct(&mut balance, &mut u, border, Scale::UNIT, options) {
                Err(NewtonError::NotConverged { update, .. }) => update,
                other => panic!("{other:?}"),
            },
        )
        .collect()
}

/// The order is two where nothing is left out, switches and jumps included, and one where core and tail leave something out.
#[test]
fn newtons_method_is_quadratic() {
    // Of the last three.
    let order = |sizes: &[f64]| (sizes[4] / sizes[3]).ln() / (sizes[3] / sizes[2]).ln();
    let dense = updates(HARMONICS);
    assert!(order(&dense) > 1.9, "{dense:?}");
    assert!(dense[4] < 1e-11, "{dense:?}");
    let split = updates(4);
    assert!(order(&split) < 1.5, "{split:?}");
}
