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

fn place(study: &Prepared, name: &str) -> usize {
    let mut names = study.columns().iter().map(|column| column.name.as_str());
    names.position(|known| known == name).expect(name)
}

fn number(study: &Prepared, row: &[Value], name: &str) -> f64 {
    match row[place(study, name)] {
        Value::Number(value) => value,
        Value::Whole(value) => value as f64,
        ref other => panic!("{name}: {other:?}"),
    }
}

fn text<'r>(study: &Prepared, row: &'r [Value], name: &str) -> &'r str {
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
