//! Uncertainty of the folds of figure 5b of Wang et al. (2021): what variants do, against linear propagation by the sensitivities.

use std::fs;
use std::ops::ControlFlow;

use crate::common::Folder as Temporary;
use crate::rows::{number, text};
use hertzian::Cancel;
use hertzian_study::{
    Folder, Keep, Method, Picture, Prepared, Request, Runner, Spread, Study, Variants, Which,
};

hertzian::oscillator! {
    OneSided(x) {
        param zeta = 0.032 in 0.0..;
        param load = 1;
        param drive = 0.1;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

const MEANS: [(&str, f64); 3] = [("zeta", 0.032), ("load", 1.0), ("drive", 0.1)];
/// Standard deviation of each parameter over its mean.
const PART: f64 = 0.05;
const VARIANTS: usize = 64;

fn study(variants: Variants, sensitivities: bool, pictures: &[Picture]) -> Prepared {
    let request = Request::response(0.6, 1.6)
        .by(Method::ContactEquation)
        .stability(false);
    let study = Study::of(&OneSided::default()).variants(variants);
    let keep = Keep::new().events(["fold"]).sensitivities(sensitivities);
    let study = study.request(request).keep(keep);
    let study = study.pictures(pictures.iter().cloned());
    study.prepare().expect("a study")
}

/// All three parameters normal.
fn normal(count: usize) -> Variants {
    let means = MEANS.into_iter();
    means.fold(Variants::sobol(count), |variants, (name, mean)| {
        variants.over(name, Spread::normal(mean, PART * mean))
    })
}

/// Place and deviation of the lower and of the upper fold by linear propagation.
fn linear() -> [[f64; 2]; 2] {
    let means = MEANS.into_iter();
    let study = study(
        means.fold(Variants::grid(), |variants, (name, mean)| {
            variants.over(name, Spread::list(&[mean]))
        }),
        true,
        &[],
    );
    let mut folds: Vec<[f64; 2]> = study
        .rows(0)
        .iter()
        .map(|row| {
            let squares = MEANS.map(|(name, mean)| {
                (PART * mean * number(&study, row, &format!("by_{name}"))).powi(2)
            });
            [
                number(&study, row, "value"),
                squares.iter().sum::<f64>().sqrt(),
            ]
        })
        .collect();
    folds.sort_by(|a, b| a[0].total_cmp(&b[0]));
    folds.try_into().expect("two folds")
}

/// The upper fold moves by a hundredth of itself, over which it is straight. The lower one would move by a third of the frequency: there the branch
/// that has it is another one, and linear propagation says nothing.
#[test]
fn folds_are_spread_as_sensitivities_say_where_they_are_straight() {
    let study = study(normal(VARIANTS), false, &[]);
    let [lower, upper] = linear();
    let places = |index: usize| -> Vec<f64> {
        let rows = study.rows(index);
        let folds = rows
            .iter()
            .filter(|row| text(&study, row, "row") == "event");
        folds.map(|row| number(&study, row, "value")).collect()
    };
    let all: Vec<Vec<f64>> = (0..VARIANTS).map(places).collect();
    let highest: Vec<f64> = all
        .iter()
        .map(|places| places.iter().copied().fold(f64::MIN, f64::max))
        .collect();
    let count = VARIANTS as f64;
    let mean = highest.iter().sum::<f64>() / count;
    let squares = highest.iter().map(|place| (place - mean).powi(2));
    let deviation = (squares.sum::<f64>() / count).sqrt();
    // Points of Sobol have their moments to a few thousandths; second derivatives move the mean by 0.017 deviations.
    assert!(
        (deviation / upper[1] - 1.0).abs() < 0.02,
        "{deviation} {upper:?}"
    );
    assert!(
        (mean - upper[0]).abs() < 0.05 * upper[1],
        "{mean} {upper:?}"
    );
    // A normal distribution of a third has 17 % above 1.
    assert!((lower[1] - 0.33).abs() < 0.01, "{lower:?}");
    let above = all
        .iter()
        .filter(|places| places.len() == 2 && places.iter().all(|place| *place > 1.0));
    assert!((above.count() as f64) < 0.1 * count);
}

/// The picture needs no sensitivities in the table.
#[test]
fn histograms_say_what_linear_propagation_says() {
    let pictures =
        [Which::Highest, Which::Lowest].map(|which| Picture::histogram("fold", which).linear(true));
    let study = study(normal(8), false, &pictures);
    let [lower, upper] = linear();
    let temporary = Temporary::new("uncertainty");
    let folder = Folder::open(temporary.join("results"), &study).expect("a folder");
    let runner = Runner::new(&study, &folder);
    runner
        .run(&mut |_| ControlFlow::Continue(()))
        .expect("a run");
    let files = study.draw(&[folder], &Cancel::new()).expect("pictures");
    for (file, [place, _]) in files.iter().zip([upper, lower]) {
        let picture = fs::read_to_string(file).expect("a picture");
        let said = format!("median {place:.6}");
        assert!(picture.contains("linear propagation: ") && picture.contains(&said));
    }
}

#[test]
fn what_has_no_distribution_has_no_propagation() {
    let picture = Picture::histogram("fold", Which::Highest).linear(true);
    for (variants, picture, said) in [
        (
            Variants::grid().over("drive", Spread::list(&[0.1])),
            picture.clone(),
            "`linear` needs distributions",
        ),
        (
            Variants::sobol(4).over("drive", Spread::uniform(0.1, 0.2)),
            Picture::fan().linear(true),
            "`linear` belongs to what = \"histogram\"",
        ),
    ] {
        let study = Study::of(&OneSided::default()).variants(variants);
        let study = study
            .request(Request::response(0.6, 1.6))
            .pictures([picture]);
        let error = study.prepare().expect_err(said).to_string();
        assert!(error.contains(said), "{error}");
    }
}
