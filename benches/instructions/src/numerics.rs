//! What a branch is made of: residual, Jacobian and multipliers of one orbit, a whole curve by every method, and flows.
//!
//! Figures 5a and 5b of Wang et al. (2021), the orbit at omega = 0.9.

use std::f64::consts::TAU;
use std::hint::black_box;

use hertzian::attractors::basin::{Axis, Basin, Grid};
use hertzian::stability::Method;
use hertzian::stages::Stages;
use hertzian::time::affine::Affine;
use hertzian::time::{Flow, Integrated, Tangent};
use hertzian::{ContactEquation, Error, FrequencyResponse, Shooting, System, oscillator};

oscillator! {
    /// One-sided contact with a linear spring.
    Linear(x) {
        param zeta in 0.0..;
        param load;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

oscillator! {
    /// One-sided contact of two spheres.
    Hertz(x) {
        param zeta in 0.0..;
        param load;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

/// Damping ratio, load and amplitude of the curves.
const CURVE: [f64; 3] = [0.032, 1.0, 0.1];
/// Where motions are chaotic, figure 10.
const CHAOS: f64 = 1.78;
/// A state there.
const START: [f64; 2] = [-0.33, 0.33];
/// Cells of the basin along each axis.
const CELLS: usize = 32;

/// Shows every call once, by name, to what counts it.
pub fn all(count: &mut dyn FnMut(&str, &mut dyn FnMut())) -> Result<(), Error> {
    let [zeta, load, drive] = CURVE;
    branch("alpha 1", &Linear { zeta, load, drive }, count)?;
    branch("alpha 1.5", &Hertz { zeta, load, drive }, count)?;
    flows(count)
}

fn branch(
    name: &str,
    system: &dyn System,
    count: &mut dyn FnMut(&str, &mut dyn FnMut()),
) -> Result<(), Error> {
    let request = FrequencyResponse::of(system).from(0.6).to(1.4);
    for harmonics in [10, 40] {
        let name = format!("{name}, {harmonics} harmonics");
        let request = request.clone().harmonics(harmonics).stability(false);
        let branch = request.run()?;
        let point = &branch.at(0.9)?[0];
        let Some(mut stages) = Stages::at(&branch, point) else {
            continue;
        };
        count(&format!("{name}\tresidual"), &mut || {
            black_box(stages.residual());
        });
        count(&format!("{name}\tresidual and Jacobian"), &mut || {
            stages.jacobian();
        });
        for method in [Method::Default, Method::Monodromy] {
            count(&format!("{name}\tmultipliers, {method}"), &mut || {
                black_box(branch.multipliers(point, method).is_ok());
            });
        }
    }
    let balance = request.clone().harmonics(10);
    for (what, stability) in [("without", false), ("with", true)] {
        let request = balance.clone().stability(stability);
        count(
            &format!("{name}, 10 harmonics\tcurve {what} multipliers"),
            &mut || {
                black_box(request.run().is_ok());
            },
        );
    }
    let shooting = request.clone().by(Shooting::new()).max_points(2000);
    count(&format!("{name}\tcurve by shooting"), &mut || {
        black_box(shooting.run().is_ok());
    });
    let contact = request.by(ContactEquation::new());
    count(
        &format!("{name}\tcurve by the contact equation"),
        &mut || {
            black_box(contact.run().is_ok());
        },
    );
    Ok(())
}

fn flows(count: &mut dyn FnMut(&str, &mut dyn FnMut())) -> Result<(), Error> {
    let [zeta, load, _] = CURVE;
    let (drive, values) = (CHAOS, [zeta, load, CHAOS]);
    let model = Linear { zeta, load, drive };
    let mut exact = Affine::new(&model, &values, 1.0)?;
    let mut integrated = Integrated::new(&model, &values, 1.0, 1e-10)?;
    count("strobe\t2000 periods in closed form", &mut || {
        advance(&mut exact, 2000, false);
    });
    count("strobe\t2000 periods with derivatives", &mut || {
        advance(&mut exact, 2000, true);
    });
    count("strobe\t100 periods integrated", &mut || {
        advance(&mut integrated, 100, false);
    });
    let axis = |entry, from, to| Axis::of(entry).from(from).to(to).cells(CELLS);
    let grid = Grid::new(vec![0.0; 2], axis(0, -110.0, 15.0), axis(1, -16.0, 16.0));
    let model = Linear {
        drive: 1.0,
        ..model
    };
    let basin = Basin::of(&model).omega(1.0).grid(grid).threads(1);
    count("basin\t32 by 32 cells", &mut || {
        black_box(basin.run().is_ok());
    });
    Ok(())
}

fn advance(flow: &mut dyn Flow, periods: usize, derivatives: bool) {
    let (mut state, unit) = (START, Tangent::of_state(1, None));
    let mut tangent = unit.clone();
    for _ in 0..periods {
        tangent.clone_from(&unit);
        let tangent = derivatives.then_some(&mut tangent);
        if flow.advance(0.0, TAU, &mut state, tangent, None).is_err() {
            return;
        }
    }
}
