//! What is read off orbits at a fixed frequency.

use hertzian::observe::Wanted;
use hertzian::sensitivity::Sensitivities;
use hertzian::{Branch, FrequencyResponse, Point, System};
use hertzian_tests::{OneSided, TwoMasses};

use super::{Make, assert_near, names, richardson, shot, unloaded};

/// Everything that is read off the orbits at a frequency, against differences by the frequency and all parameters.
pub(super) fn compare(name: &str, values: &[f64], omega: f64, range: [f64; 2], make: &Make) {
    let model = make(values);
    let branch = FrequencyResponse::of(model.as_ref()).stability(false);
    let branch = branch.from(range[0]).to(range[1]).run().unwrap();
    let variables = [vec!["omega".to_owned()], names(&branch)].concat();
    let [mut unsettled, mut compared] = [0, 0];
    for (index, point) in branch.at(omega).unwrap().iter().enumerate() {
        let at_orbit = branch.sensitivities(point).unwrap();
        assert_eq!(at_orbit.variables, variables);
        assert_quick_alike(&branch, point, &at_orbit);
        for (which, variable) in variables.iter().enumerate() {
            let value = at_orbit.values[which];
            let step = 4e-3 * value.abs();
            let read = |change: f64| {
                let mut values = values.to_vec();
                let mut omega = omega;
                match which.checked_sub(1) {
                    None => omega += change,
                    Some(parameter) => values[parameter] += change,
                }
                let model = make(&values);
                let request = shot(model.as_ref(), &point.orbit);
                let orbit = request.orbit(omega).unwrap();
                let branch = request
                    .from(omega)
                    .to(omega * 1.001)
                    .max_points(2)
                    .run()
                    .unwrap();
                let of = |measured: &hertzian::sensitivity::Measured| {
                    if measured.name == "power" {
                        return branch
                            .complete(&orbit)
                            .unwrap()
                            .observed
                            .input_power
                            .unwrap();
                    }
                    if let Some(part) = measured.name.strip_prefix("multiplier_") {
                        let (number, part) = part.split_once('_').unwrap();
                        let number: usize = number.parse().unwrap();
                        let value = orbit.stability.multipliers[number - 1];
                        return if part == "re" { value.re } else { value.im };
                    }
                    let wanted = measured.name.parse().unwrap();
                    branch.measured(&wanted, &orbit).unwrap().unwrap()
                };
                at_orbit.measured.iter().map(of).collect::<Vec<f64>>()
            };
            let parts = [1.0, 0.5, 0.25, 0.125, 0.0625, 0.031_25, 0.015_625];
            let steps: Vec<f64> = parts
                .iter()
                .flat_map(|part| [part * step, -part * step])
                .collect();
            let all: Vec<Vec<f64>> = steps.iter().map(|step| read(*step)).collect();
            for (row, measured) in at_orbit.measured.iter().enumerate() {
                let at = |change: f64| {
                    let place = steps.iter().position(|step| *step == change).unwrap();
                    all[place][row]
                };
                // What is steep settles at shorter steps only. A phase has turned by a whole turn, or a small amplitude passes zero:
                // differences say nothing.
                let each = [1.0, 0.25, 0.0625].map(|part| richardson(part * step, at));
                let settled = |of: &(f64, f64)| of.1 <= 1e-4 * of.0.abs() + 1e-9;
                let Some(expected) = each.into_iter().find(settled) else {
                    unsettled += 1;
                    continue;
                };
                compared += 1;
                // Harmonics are read off 1024 samples: what is folded into them is below 1e-12 of the motion, and in the phase of a small
                // one as much more as that is smaller. Its amplitude stands before it.
                let size = if measured.name.contains(":phase") {
                    at_orbit.measured[row - 1].value.min(1.0)
                } else {
                    1.0
                };
                let noise = 1e-12 * (1.0 + 1.0 / value.abs()) / size;
                let what = format!("{name}, orbit {index}, {} by {variable}", measured.name);
                let size = of_number(&at_orbit, row);
                assert_near(&what, measured.by[which], expected, size / value, noise);
            }
        }
    }
    assert!(
        compared > 100 && unsettled * 20 < compared,
        "{unsettled} of {compared}"
    );
}

/// What is read off; of a part of a multiplier its modulus, since the error is one of the complex number.
fn of_number(at_orbit: &Sensitivities, row: usize) -> f64 {
    let rows = &at_orbit.measured;
    match rows[row].name.rsplit_once('_') {
        Some((_, "re")) => rows[row].value.hypot(rows[row + 1].value),
        Some((_, "im")) => rows[row].value.hypot(rows[row - 1].value),
        _ => rows[row].value,
    }
}

/// Those without errors are the same, by the last variable alone too.
fn assert_quick_alike(branch: &Branch, point: &Point, all: &Sensitivities) {
    let named = all
        .measured
        .iter()
        .filter(|row| row.name != "power" && !row.name.starts_with("multiplier_"));
    let wanted = named.clone().map(|row| row.name.parse().unwrap());
    let wanted: Vec<Wanted> = wanted.collect();
    let last = all.variables.len() - 1;
    let by = [all.variables[last].as_str(), "omega"];
    let quick = branch.quick_sensitivities_of(point, &wanted, &by).unwrap();
    let mut before = 1.0;
    for (row, fine) in quick.measured.iter().zip(named) {
        assert_eq!(row.name, fine.name);
        // The amplitude stands before its phase: that of nothing has none.
        let is_phase = row.name.contains(":phase");
        let size = if is_phase { f64::min(before, 1.0) } else { 1.0 };
        before = row.value;
        for (quick, fine) in [(row.by[0], fine.by[last]), (row.by[1], fine.by[0])] {
            let apart = (quick.value - fine.value).abs();
            // A mean may be nothing but rounding.
            let noise = 1e-6 * (fine.value.abs() + row.value.abs()) + 1e-9;
            assert!(
                apart <= noise / size,
                "{}: {} {}",
                row.name,
                quick.value,
                fine.value
            );
            assert_eq!(quick.error, f64::INFINITY);
        }
    }
    let error = branch.quick_sensitivities_of(point, &wanted, &["nothing"]);
    let error = error.unwrap_err().to_string();
    assert!(
        error.starts_with("there is no parameter nothing; there are "),
        "{error}"
    );
}

#[test]
fn of_figure_5b() {
    let make = |v: &[f64]| -> Box<dyn System> {
        let [zeta, alpha, load, drive] = [v[0], v[1], v[2], v[3]];
        Box::new(OneSided {
            zeta,
            alpha,
            load,
            drive,
        })
    };
    compare("5b", &[0.032, 1.5, 1.0, 0.1], 1.0, [0.6, 1.6], &make);
}

#[test]
fn of_two_masses() {
    let make = |v: &[f64]| -> Box<dyn System> {
        Box::new(TwoMasses {
            stop: v[0],
            drive: v[1],
        })
    };
    compare("two masses", &[100.0, 0.1], 0.7, [0.64, 0.77], &make);
}

hertzian::oscillator! {
    Linear(x) {
        param zeta in 0.0..;
        param stiffness > 0;
        ddot(x) + 2*zeta*dot(x) + stiffness*x = cos(omega*t);
    }
}

/// Multipliers of a linear oscillator are `exp((-zeta +- i sqrt(k - zeta^2)) T)`. Its damping is zero, at the end of its range.
#[test]
fn multipliers_without_damping() {
    let model = Linear {
        zeta: 0.0,
        stiffness: 1.0,
    };
    let (omega, period) = (0.7, std::f64::consts::TAU / 0.7);
    let request = FrequencyResponse::of(&model).by(hertzian::Shooting::new());
    let branch = request.from(0.6).to(0.8).stability(false).run().unwrap();
    let at = branch.sensitivities(&branch.at(omega).unwrap()[0]).unwrap();
    let [s, c] = [period.sin(), period.cos()];
    // That with a positive imaginary part stands first.
    let side = s.signum();
    let expected = [
        ("multiplier_1_re", "zeta", -period * c),
        ("multiplier_1_im", "zeta", -period * s * side),
        ("multiplier_1_re", "stiffness", -0.5 * period * s),
        ("multiplier_1_im", "stiffness", 0.5 * period * c * side),
        ("multiplier_2_im", "stiffness", -0.5 * period * c * side),
        ("multiplier_1_re", "omega", period / omega * s),
        ("multiplier_1_im", "omega", -period / omega * c * side),
    ];
    for (name, by, value) in expected {
        let found = at.of(name, by).unwrap();
        let apart = (found.value - value).abs();
        assert!(
            apart < 1e-7 * period && apart <= found.error,
            "{name} by {by}: {found:?} {value}"
        );
        assert!(found.error < 1e-5 * period, "{name} by {by}: {found:?}");
    }
}

/// A motion that is its own mirror image has no even harmonics: neither their amplitudes nor their phases have derivatives.
#[test]
fn harmonics_that_vanish_are_said_to() {
    let model = unloaded(&[0.01, 1.5, 0.1]);
    let request = FrequencyResponse::of(model.as_ref()).stability(false);
    let branch = request.from(1.4).to(1.6).run().unwrap();
    let at = branch.sensitivities(&branch.at(1.5).unwrap()[0]).unwrap();
    for (name, is_there) in [
        ("x:h2", false),
        ("x:phase2", false),
        ("x:h3", true),
        ("x:phase1", true),
    ] {
        assert_eq!(at.of(name, "drive").is_some(), is_there, "{name}");
        assert_eq!(
            at.missing.iter().any(|missing| missing.what == name),
            !is_there,
            "{name}"
        );
    }
}

/// The largest and the smallest value of a symmetric motion are of one size. A load makes one of them larger, whatever its sign: the crest factor
/// has a kink. What keeps the symmetry moves both alike.
#[test]
fn a_crest_factor_has_a_kink_where_a_motion_is_symmetric() {
    hertzian::oscillator! {
        Play(x) {
            param zeta in 0.0..;
            param load;
            param drive;
            law play(gap) { gap > 0.2 => gap - 0.2, -0.2 <= gap <= 0.2 => 0, gap < -0.2 => gap + 0.2 }
            ddot(x) + 2*zeta*dot(x) + 0.3*x + play(x) = drive*cos(omega*t) + load;
        }
    }
    let at = |load: f64, omega: f64| {
        let model = Play {
            zeta: 0.05,
            load,
            drive: 0.6,
        };
        let request = FrequencyResponse::of(&model).stability(false);
        let branch = request.from(0.85).to(0.95).run().unwrap();
        let orbit = &branch.at(omega).unwrap()[0];
        let wanted = ["x:crest".parse().unwrap()];
        branch.sensitivities_of(orbit, &wanted).unwrap()
    };
    let [left, here, right] = [-1e-6, 0.0, 1e-6].map(|load| at(load, 0.9));
    let slope = |of: &Sensitivities| of.of("x:crest", "load").unwrap().value;
    assert!(slope(&left) < -0.5 && slope(&right) > 0.5);
    assert!(slope(&here).is_nan());
    let missing: Vec<&str> = here.missing.iter().map(|own| own.what.as_str()).collect();
    assert_eq!(missing, ["x:crest by load"]);
    let by_drive = |of: &Sensitivities| of.of("x:crest", "drive").unwrap().value;
    let [here, right] = [&here, &right].map(by_drive);
    assert!((here - right).abs() < 1e-3 * right.abs(), "{here} {right}");
}

/// At rest any drive makes the largest value larger and the smallest one smaller: extremes have no derivatives by it. The mean has those of a spring under
/// a load, `1 / k`.
#[test]
fn at_rest_extremes_have_no_derivatives() {
    hertzian::oscillator! {
        Rests(x) {
            param load;
            param drive;
            ddot(x) + 0.1*dot(x) + 4*x = drive*cos(omega*t) + load;
        }
    }
    for load in [0.0, 0.3] {
        let model = Rests { load, drive: 0.0 };
        let request = FrequencyResponse::of(&model).stability(false);
        let branch = request.from(0.5).to(0.6).run().unwrap();
        let at = branch.sensitivities(&branch.points[0]).unwrap();
        for name in ["x:p2p", "x:max", "x:min", "x:crest", "x:h1"] {
            assert_eq!(at.of(name, "drive"), None, "{name}");
            assert!(at.missing.iter().any(|own| own.what == name), "{name}");
        }
        let mean = at.of("x:mean", "load").unwrap();
        assert!((mean.value - 0.25).abs() < 1e-12, "{mean:?}");
    }
}
