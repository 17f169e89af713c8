//! Orbits against those of shooting, and derivatives against differences.

mod affine;
mod both_sides;
mod closed;
mod completed;
mod direction;
mod grazings;
mod growing;
mod images;
mod jumps;
mod kept_tables;
mod kinks;
mod minimal_period;
mod modes;
mod moving_stiffness;
mod narrow;
mod order;
mod outputs;
mod rigid;
mod ringing;
mod several;
mod symmetry;

use nalgebra::DMatrix;

use super::equations::Equations;
use super::equations::setting::{Frame, Setting};
use super::orbit::gaps::Gaps;
use super::skeleton::placement::Resolution;
use super::switches::plan::Plan;
use crate::branches::recurrence::Recurrence;
use crate::branches::solve;
use crate::cancel::Cancel;
use crate::continuation::jacobian::Jacobian;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::Problem;
use crate::event::EventKind;
use crate::system::{System, Variable};
use crate::{Branch, ContactEquation, FrequencyResponse, Shooting, Stop};

crate::oscillator! {
    OneSided(x) {
        param alpha > 0;
        param load;
        param drive;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap^alpha, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

crate::oscillator! {
    TwoMasses(x, y) {
        param gap;
        law stop(g) { g > 0 => 20*g + 0.1*g*dot(g), else => 0 }
        law hertz(g) { g > 0 => 5*g^1.5, else => 0 }
        ddot(x) + 0.1*dot(x) + x + (x - y) + 0.05*dot(x - y) + stop(x - gap) = 0.3*cos(omega*t);
        ddot(y) + 0.05*dot(y) + 0.5*y - (x - y) - hertz(-y - 0.1*cos(omega*t)) = 0.1*sin(2*omega*t);
    }
}

crate::oscillator! {
    /// The modes change with what couples the masses, and are complex.
    Coupled(x, y) {
        param coupling;
        law stop(g) { g > 0 => 5*g, else => 0 }
        ddot(x) + 0.1*dot(x) + x + coupling*(x - y) + stop(x - 0.2) = 0.3*cos(omega*t);
        2*ddot(y) + 0.05*dot(y) + 0.5*y - coupling*(x - y) = 0;
    }
}

crate::oscillator! {
    /// A contact whose direction turns. Its force is smooth beside the level too, where a guess has nodes.
    Turning(x, y) {
        param load;
        law ball(g) { g > 0 => 2*g + 0.1*g*dot(g), else => 0 }
        let angle = omega*t;
        let force = ball(x*cos(angle) + y*sin(angle) - 0.1);
        ddot(x) + 0.1*dot(x) + x + force*cos(angle) = load;
        ddot(y) + 0.1*dot(y) + 2*y + force*sin(angle) = 0;
    }
}

crate::oscillator! {
    /// Without the contact an undamped oscillator, which its load drives in resonance at one.
    Resonant(x) {
        param drive;
        law stop(g) { g > 0 => 4*g + 0.4*dot(g), else => 0 }
        ddot(x) + x + stop(x - 0.1) = drive*cos(omega*t);
    }
}

crate::oscillator! {
    /// A mass between two wells, with a stop that its small motions do not reach.
    Wells(x, y) {
        law stop(g) { g > 0 => 0.2*g^1.5, else => 0 }
        2.09*ddot(x) + 0.038*dot(x) + 1.369*x^3 - 0.71*x + 0.448*(x - y) + 0.0138*dot(x - y) + stop(x - 0.79) = 0;
        2.263*ddot(y) + 0.0137*dot(y) + 1.287*y - 0.448*(x - y) - 0.0138*dot(x - y) = 0.5775*cos(omega*t);
    }
}

pub(in crate::contact_equation) fn first(
    system: &dyn System,
    vary: Option<&str>,
    omega: f64,
    resolution: [usize; 2],
) -> (Equations, Vec<f64>) {
    first_of(system, vary, omega, resolution, &Recurrence::whole(1))
}

fn first_of(
    system: &dyn System,
    vary: Option<&str>,
    omega: f64,
    [nodes, panels]: [usize; 2],
    recurrence: &Recurrence,
) -> (Equations, Vec<f64>) {
    let request = FrequencyResponse::of(system);
    let point = request.orbit(omega).unwrap();
    let parameters = crate::model::values(system);
    let variable = vary.map_or(Variable::Omega, |name| {
        let names = system.facts().parameters.iter();
        Variable::Parameter(names.map(|p| &p.name).position(|p| p == name).unwrap())
    });
    let value = match variable {
        Variable::Omega => omega,
        Variable::Parameter(index) => parameters[index],
    };
    let setting = Setting::new(
        &system.shared(),
        variable,
        parameters,
        omega,
        &Cancel::new(),
    );
    let values = setting.values(value).unwrap();
    let base = point.orbit.omega;
    let coordinates = point.orbit.coordinates();
    let at = |phase: f64, state: &mut [f64]| {
        for i in 0..coordinates {
            (state[i], state[coordinates + i]) = point.orbit.state_at(i, phase / base).unwrap();
        }
    };
    let gaps = Gaps {
        values: &values,
        at: &at,
        coordinates,
    };
    let plan = Plan::sampled(&gaps, recurrence);
    let frame = Frame {
        reference: vec![0.0; 2 * coordinates],
        size: point.size(),
        resolution: Resolution { nodes, panels },
    };
    plan.equations(&setting, value, &gaps, &frame).unwrap()
}

fn derivatives_are_those_of_differences(
    system: &dyn System,
    vary: Option<&str>,
    omega: f64,
    panels: usize,
) {
    let whole = Recurrence::whole(1);
    derivatives_are_those_of_differences_of(system, vary, omega, panels, &whole);
}

fn derivatives_are_those_of_differences_of(
    system: &dyn System,
    vary: Option<&str>,
    omega: f64,
    panels: usize,
    recurrence: &Recurrence,
) {
    let (mut equations, u) = first_of(system, vary, omega, [12, panels], recurrence);
    let n = u.len() - 1;
    let matrix = entries(&mut equations, &u);
    let mut at = |column: usize, step: f64| {
        let mut u = u.clone();
        u[column] += step;
        equations.compute(&u, false);
        equations.residual.clone()
    };
    for column in 0..=n {
        // A force of exponent 3/2 is not smooth beside its level.
        let h = 1e-7;
        let [a, b] = [at(column, h), at(column, -h)];
        for row in 0..n {
            let difference = (a[row] - b[row]) / (2.0 * h);
            let exact = matrix[(row, column)];
            assert!(
                (difference - exact).abs() < 1e-5 * (1.0 + exact.abs()),
                "row {row} column {column}: {difference} {exact}"
            );
        }
    }
}

/// Derivatives of all residuals by all unknowns and the parameter, as what the solution with their factors inverts.
fn entries(equations: &mut Equations, u: &[f64]) -> DMatrix<f64> {
    let n = u.len() - 1;
    let mut jacobian = Jacobian::new(equations.partition());
    jacobian.clear();
    equations.evaluate(u, &mut vec![0.0; n], Some(&mut jacobian));
    let mut border = vec![0.0; n + 1];
    border[n] = 1.0;
    jacobian.set_border(&border);
    jacobian.factorise().unwrap();
    let mut inverse = DMatrix::identity(n + 1, n + 1);
    for mut column in inverse.column_iter_mut() {
        jacobian.solve(column.as_mut_slice());
    }
    inverse.try_inverse().unwrap()
}

#[test]
fn matrices_are_those_of_differences() {
    let one = OneSided {
        alpha: 1.5,
        load: 1.0,
        drive: 0.5,
    };
    derivatives_are_those_of_differences(&one, None, 0.7, 1);
    derivatives_are_those_of_differences(&one, Some("drive"), 0.7, 4);
    let two = TwoMasses { gap: 0.2 };
    derivatives_are_those_of_differences(&two, None, 0.9, 4);
    derivatives_are_those_of_differences(&two, Some("gap"), 0.9, 1);
    derivatives_are_those_of_differences(&Coupled { coupling: 1.0 }, Some("coupling"), 0.9, 1);
    let turning = Turning { load: 0.3 };
    derivatives_are_those_of_differences(&turning, None, 0.7, 1);
    derivatives_are_those_of_differences(&turning, Some("load"), 0.7, 2);
    derivatives_are_those_of_differences(&Resonant { drive: 0.2 }, None, 1.0, 1);
    derivatives_are_those_of_differences(&Resonant { drive: 0.2 }, Some("drive"), 1.0, 2);
}

fn solved(system: &dyn System, omega: f64, nodes: usize) -> (Equations, Vec<f64>) {
    let (mut equations, mut u) = first(system, None, omega, [nodes, 1]);
    let mut newton = Newton::new(&equations);
    let options = NewtonOptions {
        tolerance: 1e-11,
        iterations: 20,
        damped: false,
    };
    solve::at_value(&mut equations, &mut newton, &mut u, options).unwrap();
    // Kinks are those of the guess at first.
    for _ in 0..3 {
        equations.compute(&u, false);
        if !equations.has_kinks() {
            break;
        }
        let mut other = equations.at_kinks(&u).unwrap();
        u = equations.rearranged(&other, &u);
        newton = Newton::new(&other);
        solve::at_value(&mut other, &mut newton, &mut u, options).unwrap();
        equations = other;
    }
    (equations, u)
}

#[test]
fn multipliers_are_those_of_shooting() {
    let one = OneSided {
        alpha: 1.5,
        load: 1.0,
        drive: 0.5,
    };
    let two = TwoMasses { gap: 0.2 };
    let (one, two): (&dyn System, &dyn System) = (&one, &two);
    // A stretch of two masses is cut where the other contact begins and ends, and is not all of what 24 nodes resolve.
    for (system, omega, tolerance) in [
        (one, 0.7, 1e-8),
        (one, 1.0, 1e-8),
        (two, 0.9, 1e-7),
        (two, 1.4, 1e-7),
    ] {
        let (mut equations, u) = solved(system, omega, 24);
        let map = equations.map(&u).unwrap();
        let found = crate::numeric::spectrum::eigenvalues(&map);
        let shooting = FrequencyResponse::of(system).by(Shooting::new().tolerance(1e-13));
        let exact = shooting.orbit(omega).unwrap().stability.multipliers;
        let apart = crate::numeric::spectrum::distance(&found, &exact);
        assert!(apart < tolerance, "{omega}: {found:?} {exact:?}");
    }
}

/// Folds and touches of figure 5 of Wang et al. (2021), from either end: as shooting has them, which are exact to rounding where the
/// force is affine.
#[test]
fn events_are_those_of_shooting() {
    for (alpha, from, to) in [(1.0, 0.5, 1.5), (1.5, 1.3, 0.6), (0.6, 1.0, 0.6)] {
        let model = OneSided {
            alpha,
            load: 1.0,
            drive: 0.1,
        };
        let request = FrequencyResponse::of(&model).from(from).to(to);
        events_agree(&request);
    }
}

/// Events of a branch are those of shooting.
fn events_agree(request: &FrequencyResponse) -> Branch {
    let branch = request.clone().by(ContactEquation::new()).run().unwrap();
    let shooting = request.clone().by(Shooting::new().tolerance(1e-12));
    let exact = shooting.run().unwrap();
    match [branch.stopped, exact.stopped] {
        // It is found by steps that become ever shorter.
        [Stop::PulledOn { value: a }, Stop::PulledOn { value: b }] => {
            assert!((a - b).abs() < 1e-6, "{a} {b}");
        }
        [a, b] => assert_eq!(a, b),
    }
    assert_eq!(branch.turns, []);
    let sorted = |branch: &Branch| {
        let events = branch.events.iter();
        let mut events: Vec<_> = events.map(|e| (e.point.value, e.kind)).collect();
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        events
    };
    let (found, exact) = (sorted(&branch), sorted(&exact));
    assert_eq!(found.len(), exact.len(), "{found:?} {exact:?}");
    for (found, exact) in found.iter().zip(&exact) {
        assert_eq!(found.1, exact.1);
        assert!((found.0 - exact.0).abs() < 1e-9, "{found:?} {exact:?}");
    }
    branch
}

/// The symmetry of an orbit breaks whose equations do not have it, since there is a stop on one side that it does not reach.
#[test]
fn branches_cross_where_a_symmetry_breaks_beside_a_stop() {
    let request = FrequencyResponse::of(&Wells {}).from(1.1).to(0.966);
    events_agree(&request);
    let branch = request.by(ContactEquation::new()).run().unwrap();
    assert!(branch.events.iter().all(|event| event.error < 1e-9));
}

/// The pair of switches between which a gap is about to open: `H` passes zero, and the branch goes on.
#[test]
fn a_touch_is_passed_smoothly() {
    let one = OneSided {
        alpha: 1.5,
        load: 1.0,
        drive: 0.1,
    };
    let (mut equations, mut u) = first(&one, None, 1.2005, [16, 1]);
    let mut newton = Newton::new(&equations);
    let options = NewtonOptions {
        tolerance: 1e-11,
        iterations: 20,
        damped: false,
    };
    assert_eq!(equations.skeleton.switches.len(), 2);
    let square = equations.skeleton.slot(1);
    let mut values = Vec::new();
    for h in [-0.01, -1e-3, -1e-5, -1e-8, 1e-8, 1e-5, 1e-3] {
        u[square] = h;
        solve::with_held(&mut equations, &mut newton, &mut u, square, options).unwrap();
        values.push(u[u.len() - 1]);
    }
    // Shooting has the touch at 1.199413489, and the value falls with H.
    assert!((values[3] - 1.199_413_489).abs() < 1e-7, "{values:?}");
    assert!(
        values.windows(2).all(|pair| pair[1] < pair[0]),
        "{values:?}"
    );
}

/// Along a branch whose modes change, orbits and multipliers are those of shooting, whose motions are exact here; what is stated of their
/// errors holds, where a finer solution has shown them and between.
#[test]
fn orbits_are_those_of_shooting_and_their_errors_hold() {
    let coupled = Coupled { coupling: 1.0 };
    let one = OneSided {
        alpha: 1.5,
        load: 1.0,
        drive: 0.1,
    };
    let of = |system| FrequencyResponse::of(system).by(ContactEquation::new());
    let requests = [
        of(&coupled).vary("coupling").omega(0.9).from(0.5).to(2.0),
        of(&one).from(0.6).to(0.8),
    ];
    for request in requests {
        errors_hold(&request);
    }
}

/// Along a branch what is stated of orbits and multipliers holds against shooting.
fn errors_hold(request: &FrequencyResponse<ContactEquation>) {
    let branch = request.run().unwrap();
    assert!(branch.points.len() > 10);
    for point in &branch.points {
        let shooting = request.clone().by(Shooting::new().tolerance(1e-12));
        let exact = shooting
            .near_orbit(&point.orbit)
            .orbit(point.value)
            .unwrap();
        let pairs = point.observed.motions.iter().zip(&exact.observed.motions);
        let size = |motion: &crate::observe::Motion| motion.peak_to_peak();
        let largest = exact.observed.motions.iter().map(size).fold(0.0, f64::max);
        let apart = pairs.map(|(a, b)| (size(a) - size(b)).abs() / largest);
        let (apart, stated) = (apart.fold(0.0, f64::max), point.error.unwrap());
        assert!(
            apart <= stated + 1e-11,
            "{}: {apart:e} {stated:e}",
            point.value
        );
        let [a, b] = [&point.stability, &exact.stability];
        let spread = crate::numeric::spectrum::distance(&a.multipliers, &b.multipliers);
        let known = a.error + b.error + 1e-9;
        assert!(spread <= known, "{}: {spread:e} {known:e}", point.value);
        assert_eq!(a.verdict, b.verdict);
    }
}

/// At an event an orbit is at no given value: beside a fold those at one value tell nothing of its size.
#[test]
fn sizes_at_events_are_those_of_shooting_and_their_errors_hold() {
    let one = OneSided {
        alpha: 1.5,
        load: 1.0,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&one).from(0.6).to(1.6);
    let exact = request.clone().by(Shooting::new().tolerance(1e-12));
    let exact = exact.run().unwrap().events;
    let found = request.by(ContactEquation::new()).run().unwrap().events;
    let folds = found.iter().filter(|event| event.kind == EventKind::Fold);
    assert_eq!(folds.count(), 2);
    for event in &found {
        let same = exact.iter().find(|known| {
            known.kind == event.kind && (known.point.value - event.point.value).abs() < 1e-8
        });
        let same = same.unwrap_or_else(|| panic!("{:?} {}", event.kind, event.point.value));
        let size = same.point.peak_to_peak();
        let apart = (event.point.peak_to_peak() - size).abs() / size;
        let stated = event.point.error.unwrap();
        let known = stated + 1e-11;
        assert!(apart <= known, "{apart:e} {known:e}");
        assert!(stated < 1e-6, "{} {stated:e}", event.point.value);
    }
}
