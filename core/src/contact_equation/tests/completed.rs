//! Steps from a state, against its motion by integration at a tolerance of 1e-12; and what is read again at folds, against what was read with them.

use std::f64::consts::TAU;

use crate::branches::observed::Motion;
use crate::cancel::Cancel;
use crate::contact_equation::completed::Solved;
use crate::contact_equation::equations::setting::Setting;
use crate::contact_equation::march::March;
use crate::contact_equation::problem::ContactProblem;
use crate::shooting::Asked;
use crate::system::{System, Variable};
use crate::{ContactEquation, FrequencyResponse, Shooting, time};

crate::oscillator! {
    /// A mass before a ball on a spring that is a thousand times as stiff, with a pull that grows until the ball lets go.
    Stiff(x, y) {
        law ball(g) { g > 0 => 40*g^1.5 + 0.2*g*dot(g), else => 0 }
        ddot(x) + 0.05*dot(x) + x + 1000*(x - y) = 0.2*cos(omega*t);
        0.01*ddot(y) + 0.2*dot(y - x) + 1000*(y - x) + ball(y - 0.05) = 0;
        output squeezed = y - x;
        output force = force(ball);
    }
}

crate::oscillator! {
    /// Loads in resonance with the linear part, and contacts whose directions turn.
    Turning(x, y) {
        law ball(g) { g > 0 => 20*g^1.5, else => 0 }
        let angle = omega*t;
        let force = ball(x*cos(angle) + y*sin(angle) - 0.1);
        ddot(x) + x + force*cos(angle) = 0.1*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 2*y + force*sin(angle) = 0.1;
    }
}

crate::oscillator! {
    /// A mass before a ball, beside a mode that is a thousand times as fast.
    Aside(x, y) {
        law ball(g) { g > 0 => 40*g^1.5, else => 0 }
        ddot(x) + 0.05*dot(x) + x + ball(x + 0.1*y - 0.05) = 0.2*cos(omega*t);
        ddot(y) + 100*dot(y) + 1_000_000*y + 0.1*ball(x + 0.1*y - 0.05) = 0;
        output squeezed = x + 0.1*y;
        output force = force(ball);
    }
}

fn steps_are_near(system: &dyn System, omega: f64, state: [f64; 4]) {
    let shared = system.shared();
    let cancel = Cancel::new();
    let setting = Setting::new(&shared, Variable::Omega, Vec::new(), omega, &cancel);
    let values = setting.values(omega).unwrap();
    let count = 4096;
    let mut march = March::new(&setting, &values, TAU / f64::from(count)).unwrap();
    march.begin(0.0, &state);
    let mut flow = time::of(system, omega, 1e-12).unwrap();
    let mut exact = state;
    let mut found = [0.0; 4];
    for index in 0..count {
        assert!(march.step());
        let ends = [index, index + 1].map(|at| TAU * f64::from(at) / f64::from(count));
        flow.advance(ends[0], ends[1], &mut exact, None, None)
            .unwrap();
        march.write(&mut found);
        let apart = found.iter().zip(&exact).map(|(a, b)| (a - b).abs());
        let apart = apart.fold(0.0, f64::max);
        assert!(apart < 2e-3, "{}: {apart:e}", ends[1]);
    }
}

#[test]
fn steps_follow_the_motion() {
    steps_are_near(&Stiff {}, 1.1, [0.1, 0.1, 0.3, 0.3]);
    steps_are_near(&Turning {}, 1.0, [0.3, 0.1, 0.2, -0.3]);
}

/// The other limb of a fold is within what its value tells.
#[test]
fn orbits_at_folds_are_those_of_the_branch() {
    let request = FrequencyResponse::of(&Stiff {}).by(ContactEquation::new());
    let branch = request.from(0.3).to(3.0).run().unwrap();
    assert!(branch.folds().count() > 0);
    for fold in branch.folds() {
        let point = &fold.point;
        let completed = branch.complete(point).unwrap();
        let pairs = point.observed.outputs.iter();
        for (known, own) in pairs.zip(&completed.observed.outputs) {
            let apart = own.apart(known) / known.peak_to_peak();
            assert!(apart < 1e-6, "{}: {apart:e}", point.value);
        }
    }
}

/// What is read of an orbit that was solved for again is what shooting reads of it, without an integration: outputs beyond the accuracy of the branch, and extremes of
/// coordinates, which the branch has read, as far as its orbits are known. A branch completes its orbits so.
#[test]
fn stiff_orbits_are_solved_for_again() {
    let request = FrequencyResponse::of(&Aside {}).by(ContactEquation::new());
    let request = request.from(0.9).to(1.1).tolerance(1e-6);
    let branch = request.run().unwrap();
    let shooting = Shooting::new();
    for point in branch.points.iter().step_by(7) {
        let asked = Asked::of(&request.request, &shooting).held();
        let asked = asked.problem(point.value, point.value).unwrap();
        let problem = ContactProblem::new(asked, 1e-6);
        let completed = Solved::of(&problem, point).unwrap().complete(point);
        assert_eq!(branch.complete(point).unwrap(), completed);
        let exact = FrequencyResponse::of(&Aside {}).by(Shooting::new());
        let exact = exact.tolerance(1e-12).near_orbit(&point.orbit);
        let exact = exact.orbit(point.value).unwrap();
        let apart = (completed.peak_to_peak() / exact.peak_to_peak() - 1.0).abs();
        assert!(apart <= point.error.unwrap() + 1e-11, "{apart:e}");
        let [own, exact] = [&completed, &exact].map(|point| &point.observed.outputs);
        assert_eq!(own.len(), 2);
        for (own, exact) in own.iter().zip(exact) {
            let numbers = |of: &Motion| [of.minimum, of.maximum, of.mean.unwrap(), of.rms.unwrap()];
            for (own, other) in numbers(own).into_iter().zip(numbers(exact)) {
                let apart = (own - other).abs() / exact.peak_to_peak();
                assert!(apart < 1e-10, "{}: {own} {other}", point.value);
            }
        }
    }
}
