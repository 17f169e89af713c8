//! Folds of figures 2a, 4a, 5a, 5b, 5c of Wang et al. (2021), and of two masses with a stop.

use hertzian::{Branch, Event, FrequencyResponse, HarmonicBalance, System};
use hertzian_tests::{Continuous, OneSided, OneSidedLinear, TwoMasses};

use super::{Make, assert_near, names, richardson_of, shot, unloaded};

/// The fold of a perturbed system next to one of another, on a short branch that begins beside it, and its height.
fn place(system: &dyn System, fold: &Event, beside: f64) -> [f64; 2] {
    let omega = fold.point.value;
    let request = shot(system, &fold.point.orbit).stability(false);
    let begin = request.orbit(beside).unwrap();
    let away = 2.0 * omega - beside;
    let branch = request
        .near_orbit(&begin.orbit)
        .from(beside)
        .to(away)
        .max_points(400);
    let branch = branch.run().unwrap();
    let near = |a: &&Event, b: &&Event| {
        let [a, b] = [a, b].map(|event| (event.point.value - omega).abs());
        a.total_cmp(&b)
    };
    let found = branch.folds().min_by(near);
    let found = found.unwrap_or_else(|| {
        let values: Vec<f64> = branch.points.iter().map(|point| point.value).collect();
        panic!(
            "no fold from {beside} near {omega}: {:?} {values:?}",
            branch.stopped
        )
    });
    [found.point.value, found.point.peak_to_peak()]
}

/// All folds in a range against differences; the step is a part of each parameter.
fn compare(name: &str, values: &[f64], [from, to]: [f64; 2], make: &Make) {
    let model = make(values);
    let request = FrequencyResponse::of(model.as_ref()).stability(false);
    let request = request.from(from).to(to);
    let branch = request.clone().run().unwrap();
    assert!(branch.folds().count() > 0, "{name}");
    let height = format!("{}:p2p", branch.model.coordinates[0]);
    for fold in branch.folds() {
        let omega = fold.point.value;
        if name == "two masses" && omega < 0.7 {
            let by_balance = request.clone().by(HarmonicBalance::new()).run().unwrap();
            let mut known = by_balance.folds();
            let known = known.find(|known| (known.point.value - omega).abs() < 1e-4);
            assert_beside_touch(&by_balance, known.unwrap());
            continue;
        }
        let moves = branch.event_sensitivities(fold).unwrap();
        assert!(moves.measured.is_empty() && moves.of_place("omega").is_none());
        let is_said = |what: &str| moves.missing.iter().any(|missing| missing.what == what);
        assert!(is_said("measured") && is_said("multipliers"));
        let before = &branch.points[fold.after - 1];
        // Both orbits near the fold are on one side of it.
        let side = (before.value - omega).signum();
        for (index, parameter) in names(&branch).iter().enumerate() {
            let derivative = moves.of_place(parameter).unwrap();
            let scale = omega / values[index].abs();
            // The fold moves by less than the distance at which the branch begins.
            let step =
                2e-3 * (values[index] * (scale / derivative.value).abs()).min(values[index].abs());
            let beside = omega + side * 0.02 * omega;
            let of = |change: f64| {
                let mut values = values.to_vec();
                values[index] += change;
                place(make(&values).as_ref(), fold, beside)
            };
            // Where steps reach another fold, extrapolation does not settle.
            let steps = [step, step / 8.0].map(|step| richardson_of(step, of));
            let better = |index: usize| {
                let [coarse, fine] = steps.map(|both| both[index]);
                if coarse.1 < fine.1 { coarse } else { fine }
            };
            let what = format!("{name} at {omega:.4} by {parameter}");
            assert_near(&what, derivative, better(0), scale, 1e-12 * scale);
            let size = fold.point.peak_to_peak();
            let height = moves.of_moving(&height, parameter).unwrap();
            let scale = size / values[index].abs();
            let what = format!("{what}, height");
            assert_near(&what, height, better(1), scale, 1e-9 * scale);
        }
    }
}

/// That of two masses at 0.65344 is where the first begins to touch: it is 1e-6 beyond the stop, of 2 from peak to peak, and all of the turn of the branch
/// is within that, so that a flow of 1e-12 leaves 1e-6 in what is zero at a fold, and 1e-7 is asked for. That is said; differences by a parameter, whose
/// steps reach across the touch, would be those of the linear resonance on one side.
fn assert_beside_touch(branch: &Branch, fold: &Event) {
    let size = fold.point.peak_to_peak();
    assert!((2.0..2.000_004).contains(&size), "{size}");
    let said = branch.event_sensitivities(fold).map(|moves| moves.place);
    let said = said.unwrap_err().to_string();
    assert!(said.starts_with("there is no fold nearby"), "{said}");
}

fn continuous(alpha: f64, load: f64) -> (Vec<f64>, Box<Make>) {
    let make = |v: &[f64]| -> Box<dyn System> {
        let [zeta, alpha, load, drive] = [v[0], v[1], v[2], v[3]];
        Box::new(Continuous {
            zeta,
            alpha,
            load,
            drive,
        })
    };
    (vec![0.01, alpha, load, 0.1], Box::new(make))
}

fn one_sided(alpha: f64) -> (Vec<f64>, Box<Make>) {
    let make = |v: &[f64]| -> Box<dyn System> {
        let [zeta, alpha, load, drive] = [v[0], v[1], v[2], v[3]];
        Box::new(OneSided {
            zeta,
            alpha,
            load,
            drive,
        })
    };
    (vec![0.032, alpha, 1.0, 0.1], Box::new(make))
}

/// Heights of resonances move as differences say, and their places.
#[test]
fn of_figure_2a() {
    compare("2a", &[0.01, 1.5, 0.1], [0.7, 1.5], &unloaded);
}

#[test]
fn of_figure_4a() {
    let (values, make) = continuous(1.5, 1.0);
    compare("4a", &values, [0.7, 1.7], make.as_ref());
}

#[test]
fn of_figure_5a() {
    let make = |v: &[f64]| -> Box<dyn System> {
        Box::new(OneSidedLinear {
            zeta: v[0],
            load: v[1],
            drive: v[2],
        })
    };
    compare("5a", &[0.032, 1.0, 0.1], [0.6, 1.4], &make);
}

#[test]
fn of_figure_5b() {
    let (values, make) = one_sided(1.5);
    compare("5b", &values, [0.6, 1.6], make.as_ref());
}

#[test]
fn of_figure_5c() {
    let (values, make) = one_sided(0.6);
    compare("5c", &values, [0.5, 1.2], make.as_ref());
}

#[test]
fn of_two_masses() {
    let make = |v: &[f64]| -> Box<dyn System> {
        Box::new(TwoMasses {
            stop: v[0],
            drive: v[1],
        })
    };
    compare("two masses", &[100.0, 0.1], [0.64, 0.77], &make);
}
