//! Results against values known from elsewhere.

use hertzian::{FrequencyResponse, Shooting, Verdict};
use hertzian_cli::response::model_file::Varied;
use hertzian_cli::response::models::model;

use super::{array, options, rows, run_in};
use crate::folder::Folder;

/// States of periods 1, 2 and 3 computed independently from the closed-form flow, in 80-bit arithmetic confirmed with 60 digits.
#[test]
fn a_basin_lists_the_orbits_and_labels_the_cells() {
    let folder = Folder::new("basin");
    let outcome = run_in(
        &folder,
        "basin",
        &["--basin", "--alpha", "1", "--drive", "1", "--grid", "40"],
    );
    let summary = outcome.expect("basins").summary;
    assert!(
        summary.contains("period 3a") && summary.contains("period 28"),
        "{summary}"
    );
    let text = folder.text("basin.csv");
    let mut lines = text.lines();
    let names = "attractor,period,cells,point,x,dx,multiplier_1_re,multiplier_1_im,multiplier_2_re,multiplier_2_im";
    assert_eq!(lines.next(), Some(names));
    let table = rows(&text);
    let exact = [
        [-1.999_776_122_757_642_7, 0.178_235_874_603_685_45],
        [-8.051_070_357_195_234, -2.756_595_228_529_427],
        [-31.334_287_816_436_888, 0.605_360_285_158_400_4],
    ];
    for (attractor, state) in exact.iter().enumerate() {
        let row = table.iter().find(|row| row[0] == attractor as f64);
        let row = row.expect("an orbit");
        assert_eq!(row[1], attractor as f64 + 1.0);
        assert!(
            (row[4] - state[0]).hypot(row[5] - state[1]) < 1e-11,
            "{row:?}"
        );
    }
    let (header, labels) = array(&folder.read("basin.npy"));
    assert!(header.contains("'shape': (40, 40)"), "{header}");
    let first = labels.iter().filter(|&&label| label == 0.0).count();
    assert_eq!(table[0][2], first as f64);
    let svg = folder.text("basin.svg");
    for part in [
        "initial x",
        "initial rate of x",
        "aria-label=\"period 1\"",
        "aria-label=\"1\"",
        "numbers: the orbit of that period itself",
    ] {
        assert!(svg.contains(part), "{part}");
    }
}

/// Without damping nothing settles: a table of classes only.
#[test]
fn a_basin_without_periodic_attractors_is_written() {
    let folder = Folder::new("none");
    let task = [
        "--basin",
        "--alpha",
        "1",
        "--zeta",
        "0",
        "--grid",
        "4",
        "--patience",
        "50",
    ];
    run_in(&folder, "none", &task).expect("basins");
    let text = folder.text("none.csv");
    let columns = |line: &str| line.split(',').count();
    let mut lines = text.lines().map(columns);
    let head = lines.next();
    assert!(lines.all(|count| Some(count) == head), "{text}");
}

/// Period one at A = 1: the exponents are half the logarithm of the determinant of its multipliers, which are exact values.
#[test]
fn exponents_of_a_periodic_orbit_are_those_of_its_multipliers() {
    let folder = Folder::new("lyapunov");
    let task = [
        "--lyapunov",
        "--alpha",
        "1",
        "--drives",
        "1",
        "0.5",
        "--transient",
        "1000",
        "--periods",
        "2000",
        "--batches",
        "4",
    ];
    let outcome = run_in(&folder, "lyapunov", &task).expect("exponents");
    assert!(
        outcome
            .summary
            .contains("the divergence over the same motion")
    );
    let table = rows(&folder.text("lyapunov.csv"));
    assert_eq!(table.len(), 2);
    let [re, im] = [-0.655_596_449_627_929_2_f64, 0.615_582_920_279_132_8];
    let expected = re.hypot(im).ln();
    let row = &table[0];
    assert!(
        (row[2] - expected).abs() < 1e-3 && (row[4] - expected).abs() < 1e-3,
        "{row:?}"
    );
    // The sum of both, by determinants and by the divergence.
    assert!((row[6] - 2.0 * expected).abs() < 1e-11, "{row:?}");
    assert!((row[7] - row[6]).abs() < 1e-11, "{row:?}");
}

/// A contact of exponent 3/2, whose motions are integrated numerically, at frequencies between its folds: two attractors of period
/// one. Exact peaks to peaks of the upper and the lower one, from event-located DOP853 in 80-bit arithmetic, independent of this
/// project; to nine decimals, as the frequencies.
#[test]
fn other_exponents_are_integrated() {
    let folder = Folder::new("hertz");
    for (omega, exact, upper) in [
        ("1.093995426", 2.589_037_875, true),
        ("1.11032312", 0.773_510_966, false),
    ] {
        let task = [
            "--phase",
            "--drive",
            "0.1",
            "--omega",
            omega,
            "--x-range",
            "-1",
            "3",
            "--v-range",
            "-2",
            "2",
            "--starts",
            "4",
        ];
        run_in(&folder, "hertz", &task).expect("a portrait");
        let table = rows(&folder.text("hertz.csv"));
        let varied = Varied {
            name: "omega",
            value: 1.0,
        };
        let model = model(&options(&task).model, varied).expect("a model");
        let omega = omega.parse().expect("a number");
        let mut found: Vec<f64> = Vec::new();
        for row in &table {
            assert_eq!(row[2], 1.0, "{row:?}");
            let cycle = FrequencyResponse::of(&*model)
                .by(Shooting::new())
                .near_state(&row[4..])
                .orbit(omega)
                .expect("an orbit");
            assert_eq!(cycle.stability.verdict, Verdict::Stable);
            for (x, y) in row[4..].iter().zip(cycle.orbit.state()) {
                assert!((x - y).abs() < 1e-8, "{row:?} {:?}", cycle.orbit.state());
            }
            found.push(cycle.peak_to_peak());
        }
        found.sort_by(f64::total_cmp);
        assert_eq!(found.len(), 2, "{found:?}");
        let error = found[usize::from(upper)] - exact;
        assert!(error.abs() < 2e-8, "{found:?} {error:e}");
    }
}

/// A linear motion: at the beginning of a period its spring force is that of where it is.
#[test]
fn a_sweep_draws_what_is_asked_for() {
    let folder = Folder::new("plotted");
    let model = folder.file("m.txt");
    let text = "Mount(x: mm) {
        param m: t = 1e-3 > 0;
        param k: N/mm = 40;
        param drive: N = 2;
        m*ddot(x) + 0.1*m*omega*dot(x) + k*x = drive*cos(omega*t);
        output spring: N = k*x;
        output shaking: m/s^2 = ddot(x);
    }";
    std::fs::write(&model, text).expect("written");
    let sweep = [
        "--sweep", "omega", "--model", &model, "--from", "50", "--to", "100",
    ];
    let few = ["--values", "3", "--transient", "300", "--periods", "1"];
    let run = |more: &[&str]| run_in(&folder, "m", &[&sweep[..], &few, more].concat());
    run(&["--plot", "spring,shaking,x", "--axis", "hz"]).expect("a sweep");
    let svg = folder.text("m.svg");
    for part in [
        "spring at the beginning of each period [N]",
        "shaking at the beginning of each period [m/s^2]",
        "x at the beginning of each period [mm]",
        "excitation frequency [Hz]",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    let refused = |more: &[&str]| run(more).expect_err("it is none").to_string();
    let said = refused(&["--plot", "tip"]);
    assert!(said.contains("there are spring, shaking, x"), "{said}");
    let said = refused(&["--plot", "spring", "--section", "0"]);
    assert!(said.contains("--section looks elsewhere"), "{said}");
    let drive = [
        "--sweep", "drive", "--from", "1", "--to", "2", "--axis", "hz",
    ];
    let said = run_in(&folder, "m", &[&drive[..], &few].concat());
    assert!(
        said.expect_err("no frequency")
            .to_string()
            .contains("--axis is for --sweep omega")
    );
}
