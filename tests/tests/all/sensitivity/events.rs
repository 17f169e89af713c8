//! Where periods double, a symmetry breaks and quasi-periodic motions begin: places of the reference, and how they move.
//!
//! Places are exact values of `exact.json` and `many.json` (independent computations in 80 and 128 bits).

use hertzian::{Branch, Event, EventKind, FrequencyResponse, Point, Shooting, System};
use hertzian_tests::{Continuous, OneSidedLinear, TwoMasses};

use super::{Make, assert_near, names, richardson, unloaded};

/// An event of the reference.
struct Case<'c> {
    name: &'c str,
    kind: EventKind,
    /// What is varied, and the frequency where that is a parameter.
    varied: &'c str,
    omega: f64,
    place: f64,
    /// Of the orbit, in periods of the excitation.
    period: usize,
    /// Which orbit to begin near.
    near: Near,
    /// Half of the range in which it is looked for, as a part of the place.
    reach: f64,
}

/// An orbit to begin near.
enum Near {
    Any,
    /// One that passes this state.
    State([f64; 2]),
    /// The largest there, of the branch over a range.
    Largest([f64; 2]),
}

impl Case<'_> {
    /// The branch through the place, by shooting with a flow as fine as it can be.
    fn branch(&self, system: &dyn System, near: Option<&Event>, about: f64) -> Branch {
        let request = FrequencyResponse::of(system)
            .by(Shooting::new().tolerance(1e-13))
            .period(self.period)
            .from(about * (1.0 - self.reach))
            .to(about * (1.0 + self.reach))
            .max_points(400);
        let request = match (near, &self.near) {
            (Some(event), _) => request.near_orbit(&event.point.orbit),
            (None, Near::State(state)) => request.near_state(state),
            (None, Near::Largest(range)) => {
                let [from, to] = *range;
                let whole = FrequencyResponse::of(system).stability(false);
                let whole = whole.from(from).to(to).run().unwrap();
                let orbits = whole.at(about).unwrap();
                let size = |orbit: &Point| orbit.peak_to_peak();
                let largest = orbits.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
                request.near_orbit(&largest.unwrap().orbit)
            }
            (None, Near::Any) => request,
        };
        let request = if self.varied == "omega" {
            request
        } else {
            request.vary(self.varied).omega(self.omega)
        };
        request.run().unwrap()
    }

    fn event(&self, branch: &Branch, about: f64) -> Event {
        let near = |a: &&Event, b: &&Event| {
            let [a, b] = [a, b].map(|event| (event.point.value - about).abs());
            a.total_cmp(&b)
        };
        let found = branch.events(self.kind).min_by(near);
        let found = found.unwrap_or_else(|| {
            let values: Vec<f64> = branch.points.iter().map(|point| point.value).collect();
            panic!(
                "{} about {about}: {:?}, {} {values:?}",
                self.name, branch.events, branch.stopped
            )
        });
        found.clone()
    }

    /// Derivatives by all parameters, and by the frequency where that is not varied, against differences.
    fn compare(&self, values: &[f64], make: &Make) {
        let model = make(values);
        let branch = self.branch(model.as_ref(), None, self.place);
        let event = self.event(&branch, self.place);
        let off = (event.point.value - self.place).abs();
        assert!(off < 1e-9, "{}: {off:.1e}", self.name);
        let moves = branch.event_sensitivities(&event).unwrap();
        assert_eq!(moves.kind, Some(self.kind));
        assert!(moves.of_place(self.varied).is_none());
        for (index, parameter) in names(&branch).iter().enumerate() {
            if parameter == self.varied {
                continue;
            }
            let derivative = moves.of_place(parameter).unwrap();
            let scale = self.place / values[index].abs();
            let reach = 0.1 * self.reach * values[index];
            let step = reach * (scale / derivative.value).abs().min(0.2);
            let of = |change: f64| {
                let mut values = values.to_vec();
                values[index] += change;
                let about = self.place + derivative.value * change;
                let branch = self.branch(make(&values).as_ref(), Some(&event), about);
                self.event(&branch, about).point.value
            };
            let expected = richardson(step, of);
            let what = format!("{} by {parameter}", self.name);
            assert_near(&what, derivative, expected, scale, 1e-10 * scale);
        }
    }
}

fn one_sided(v: &[f64]) -> Box<dyn System> {
    let [zeta, load, drive] = [v[0], v[1], v[2]];
    Box::new(OneSidedLinear { zeta, load, drive })
}

/// A case of the drive, at `omega = 1`.
fn doubling(name: &str, place: f64, period: usize, state: [f64; 2]) -> Case<'_> {
    Case {
        name,
        kind: EventKind::PeriodDoubling,
        varied: "drive",
        omega: 1.0,
        place,
        period,
        near: Near::State(state),
        reach: 0.01,
    }
}

#[test]
fn doubling_of_a1() {
    let state = [-2.508_552_764_323_553, 0.158_458_581_918_452_05];
    let case = doubling("A1", 1.282_584_167_663_767_7, 1, state);
    case.compare(&[0.032, 1.0, 1.28], &one_sided);
}

#[test]
fn doubling_of_a4() {
    let state = [-0.096_568_334_976_684_32, 0.283_059_688_324_145_8];
    let case = doubling("A4", 1.531_044_135_499_983, 2, state);
    case.compare(&[0.032, 1.0, 1.53], &one_sided);
}

#[test]
fn doubling_of_a6() {
    let state = [0.877_694_177_529_276_8, 0.218_337_486_036_976_5];
    let case = doubling("A6", 1.880_077_405_264_828_8, 2, state);
    case.compare(&[0.032, 1.0, 1.88], &one_sided);
}

#[test]
fn broken_symmetry_of_figure_2a() {
    for place in [0.402_310_407_656_194, 0.353_730_954_670_214] {
        let case = Case {
            name: "2a",
            kind: EventKind::SymmetryBreaking,
            varied: "omega",
            omega: 1.0,
            place,
            period: 1,
            near: Near::Any,
            reach: 0.02,
        };
        case.compare(&[0.01, 1.5, 0.1], &unloaded);
    }
}

/// A load is none of the parameters that a symmetry depends on smoothly: with it branches cross no more.
#[test]
fn a_broken_symmetry_has_no_derivative_by_what_breaks_it() {
    let model = Continuous {
        zeta: 0.01,
        alpha: 1.5,
        load: 0.0,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model).by(Shooting::new().tolerance(1e-13));
    let branch = request.from(0.4).to(0.405).run().unwrap();
    let mut events = branch.events.iter();
    let event = events.find(|event| event.kind == EventKind::SymmetryBreaking);
    let event = event.expect("a broken symmetry");
    assert!((event.point.value - 0.402_310_407_656_194).abs() < 1e-9);
    let found = branch.event_sensitivities_of(event, &[]).unwrap();
    let place = |name: &str| {
        let index = found.variables.iter().position(|own| own == name);
        found.place[index.expect("a variable")]
    };
    assert_eq!(place("load"), None);
    assert!(place("zeta").is_some() && place("alpha").is_some() && place("drive").is_some());
    assert!(
        found
            .missing
            .iter()
            .any(|missing| missing.what == "place by load")
    );
}

#[test]
fn torus_and_doubling_of_two_masses() {
    let make = |v: &[f64]| -> Box<dyn System> {
        let [stop, drive] = [v[0], v[1]];
        Box::new(TwoMasses { stop, drive })
    };
    let places = [
        (EventKind::NeimarkSacker, 0.581_900_650_364_619_4, Near::Any),
        (EventKind::NeimarkSacker, 0.618_606_874_267_020_4, Near::Any),
        (
            EventKind::PeriodDoubling,
            0.738_783_025_373_251_7,
            Near::Largest([0.64, 0.77]),
        ),
    ];
    for (kind, place, near) in places {
        let case = Case {
            name: "two masses",
            kind,
            varied: "omega",
            omega: 1.0,
            place,
            period: 1,
            near,
            reach: 0.004,
        };
        case.compare(&[100.0, 0.1], &make);
    }
}
