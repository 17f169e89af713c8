//! What rows say, against what is known from elsewhere.

use crate::common::{Linear, peak_to_peak, study};
use hertzian_study::{Keep, Method, Prepared, Request, Spread, Study, Value, Variants};

hertzian::oscillator! {
    /// One-sided contact of two spheres.
    OneSided(x) {
        param zeta = 0.032 in 0.0..;
        param drive = 0.1;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

pub fn place(study: &Prepared, name: &str) -> usize {
    let mut names = study.columns().iter().map(|column| column.name.as_str());
    names.position(|known| known == name).expect(name)
}

pub fn number(study: &Prepared, row: &[Value], name: &str) -> f64 {
    match row[place(study, name)] {
        Value::Number(value) => value,
        Value::Whole(value) => value as f64,
        ref other => panic!("{name}: {other:?}"),
    }
}

pub fn text<'r>(study: &Prepared, row: &'r [Value], name: &str) -> &'r str {
    match &row[place(study, name)] {
        Value::Text(text) => text,
        other => panic!("{name}: {other:?}"),
    }
}

#[test]
fn amplitudes_are_those_of_the_linear_oscillator() {
    let study = study(12);
    for index in 0..12 {
        let rows = study.rows(index);
        assert_eq!(rows.len(), 2);
        let values = study.values(index);
        for (row, omega) in rows.iter().zip([1.0, 2.5]) {
            assert_eq!(row.len(), study.columns().len());
            assert_eq!(text(&study, row, "row"), "at");
            assert_eq!(number(&study, row, "variant"), index as f64);
            assert_eq!(number(&study, row, "value"), omega);
            let expected = peak_to_peak(values[0], values[1], omega);
            assert!((number(&study, row, "x:p2p") / expected - 1.0).abs() < 1e-9);
        }
    }
    assert!(study.rows(12).is_empty());
}

/// The folds of Wang et al. (2021), figure 5b, as an independent computation has them.
#[test]
fn folds_have_their_places_and_errors_by_every_method() {
    for method in [Method::Balance, Method::ContactEquation] {
        let variants = Variants::grid().over("zeta", Spread::list(&[0.032]));
        let study = Study::of(&OneSided::default()).variants(variants);
        let study = study
            .request(Request::response(0.6, 1.6).by(method))
            .keep(Keep::new().events(["fold"]));
        let study = study.prepare().expect("a study");
        let rows = study.rows(0);
        let mut places: Vec<[f64; 2]> = rows
            .iter()
            .map(|row| ["value", "error"].map(|name| number(&study, row, name)))
            .collect();
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let exact = [0.685_842_253_9, 1.144_516_914];
        assert_eq!(places.len(), 2);
        for ([place, error], exact) in places.into_iter().zip(exact) {
            // The exact values have nine digits.
            assert!(
                (place - exact).abs() < error + 1e-9,
                "{method:?}: {place} {error}"
            );
        }
        assert!(
            rows.iter()
                .all(|row| text(&study, row, "ended") == "reached the end of the range")
        );
    }
}

/// Against the folds of neighbouring variants, which the contact equation has to 1e-12.
#[test]
fn places_of_folds_move_as_their_neighbours_say() {
    let (middle, step) = ([0.032, 0.1], 2e-6);
    let table: String = [[0.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]]
        .map(|[zeta, drive]| format!("{},{}\n", middle[0] + step * zeta, middle[1] + step * drive))
        .concat();
    let study = Study::of(&OneSided::default()).table(format!("zeta,drive\n{table}"));
    let request = Request::response(0.6, 1.6).by(Method::ContactEquation);
    let keep = Keep::new().events(["fold"]).sensitivities(true);
    let study = study
        .request(request)
        .keep(keep)
        .prepare()
        .expect("a study");
    let folds: Vec<Vec<f64>> = (0..5)
        .map(|index| {
            let rows = study.rows(index);
            rows.iter()
                .map(|row| number(&study, row, "value"))
                .collect()
        })
        .collect();
    let rows = study.rows(0);
    assert_eq!(rows.len(), 2);
    for (fold, row) in rows.iter().enumerate() {
        for (name, [below, above]) in [("zeta", [1, 2]), ("drive", [3, 4])] {
            let expected = (folds[above][fold] - folds[below][fold]) / (2.0 * step);
            let found = number(&study, row, &format!("by_{name}"));
            // Third derivatives move the difference by the square of the step.
            assert!(
                (found / expected - 1.0).abs() < 1e-5,
                "{name}: {found} {expected}"
            );
            assert!(number(&study, row, &format!("error_by_{name}")) < 1e-6 * found.abs());
        }
        assert_eq!(row[place(&study, "without")], Value::Missing);
    }
}

hertzian::oscillator! {
    /// Meets a stop that is preloaded.
    Preloaded(x) {
        param play = 1.0 > 0;
        law stop(gap) { gap > play => 1 + 10*(gap - play), else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x) = 0.3*cos(omega*t);
    }
}

/// Where a level is touched at which the force jumps, on the side that does not touch it: `(1 - w^2)^2 + (0.1 w)^2 = (0.3 / play)^2`.
#[test]
fn touches_where_a_force_jumps_have_sensitivities() {
    let variants = Variants::grid().over("play", Spread::list(&[1.0]));
    let request = Request::response(0.5, 0.9).by(Method::Shooting);
    let study = Study::of(&Preloaded::default()).variants(variants);
    let keep = Keep::new().events(["grazing"]).sensitivities(true);
    let study = study
        .request(request)
        .keep(keep)
        .prepare()
        .expect("a study");
    let rows = study.rows(0);
    assert!(!rows.is_empty());
    for row in &rows {
        let omega = number(&study, row, "value");
        let w = omega * omega;
        let expected = 0.18 / (2.0 * omega * (2.0 * (1.0 - w) - 0.01));
        let found = number(&study, row, "by_play");
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        assert!(number(&study, row, "error_by_play") < 1e-6);
        assert_eq!(row[place(&study, "without")], Value::Missing);
    }
    let refused = Study::of(&OneSided::default())
        .variants(Variants::grid().over("drive", Spread::list(&[0.1])))
        .request(Request::solutions(0.65, 1.05, &[0.8]))
        .keep(Keep::new().sensitivities(true));
    let error = refused.prepare().expect_err("no events").to_string();
    assert!(error.contains("keep.sensitivities"), "{error}");
}

hertzian::oscillator! {
    /// Names that columns have.
    Named(x) {
        param value = 4 > 0;
        param by_value = 1;
        ddot(x) + 0.2*dot(x) + value*x = by_value*cos(omega*t);
    }
}

/// Two columns of one name cannot be read by numpy, and pictures would show the wrong one.
#[test]
fn parameters_with_names_of_columns_have_their_own() {
    let variants = Variants::sobol(1)
        .over("value", Spread::uniform(3.0, 5.0))
        .over("by_value", Spread::uniform(1.0, 2.0));
    let study = Study::of(&Named::default()).variants(variants);
    let study = study
        .request(Request::response(0.5, 3.0).stability(false))
        .keep(Keep::new().sensitivities(true).at(&[1.0]))
        .prepare()
        .expect("a study");
    let names: Vec<&str> = study.columns().iter().map(|column| &*column.name).collect();
    assert_eq!(names[..4], ["variant", "value_", "by_value_", "row"]);
    for (place, name) in names.iter().enumerate() {
        assert!(!names[..place].contains(name), "{names:?}");
    }
    let row = &study.rows(0)[0];
    assert_eq!(row.len(), names.len());
    assert_eq!(number(&study, row, "value"), 1.0);
    assert_eq!(number(&study, row, "value_"), study.values(0)[0]);
}

/// Where the drive is so large that nothing is found, or a value is refused, the others have their rows all the same.
#[test]
fn a_variant_that_fails_is_a_row_that_says_why() {
    let mut wild = Spread::normal(1.0, 1.0);
    wild.to = Some(8.0);
    let variants = Variants::sobol(16).over("k", wild);
    let study = Study::of(&Linear::default()).variants(variants);
    let keep = Keep::new().at(&[1.0]);
    let study = study
        .request(Request::response(0.5, 3.0))
        .keep(keep)
        .prepare()
        .expect("a study");
    let mut failed = 0;
    for index in 0..16 {
        let (k, rows) = (study.values(index)[0], study.rows(index));
        assert_eq!(rows.len(), 1);
        let row = text(&study, &rows[0], "row");
        assert_eq!(row == "failed", k <= 0.0, "{k}: {row}");
        if k <= 0.0 {
            failed += 1;
            let why = text(&study, &rows[0], "ended");
            assert!(why.contains("k = ") && why.contains("range"), "{why}");
        }
    }
    assert!(failed > 0);
}

#[test]
fn solutions_have_a_row_for_each_value() {
    let variants = Variants::grid().over("drive", Spread::list(&[0.02, 0.1]));
    let request = Request::solutions(0.65, 1.4, &[0.7, 0.9]);
    let study = Study::of(&OneSided::default())
        .variants(variants)
        .request(request);
    let study = study.prepare().expect("a study");
    // The contact is never lost at the smaller drive; at the larger one the response bends, with folds at 0.6858 and 1.1445.
    let stable: Vec<f64> = (0..2)
        .flat_map(|index| study.rows(index))
        .map(|row| number(&study, &row, "stable"))
        .collect();
    assert_eq!(stable, [1.0, 1.0, 2.0, 2.0]);
}

#[test]
fn the_largest_orbit_is_near_the_resonance() {
    let variants = Variants::grid().over("k", Spread::list(&[4.0]));
    let study = Study::of(&Linear::default()).variants(variants);
    let study = study
        .request(Request::response(1.0, 3.0))
        .keep(Keep::new().largest(["x:max"]));
    let study = study.prepare().expect("a study");
    let rows = study.rows(0);
    assert_eq!(text(&study, &rows[0], "row"), "largest");
    assert_eq!(text(&study, &rows[0], "kind"), "x:max");
    // Displacement resonance at the root of k - c^2/2; a branch has points at finite distances.
    let omega = number(&study, &rows[0], "value");
    assert!((omega - 3.98_f64.sqrt()).abs() < 0.1, "{omega}");
    assert_eq!(text(&study, &rows[0], "verdict"), "stable");
}
