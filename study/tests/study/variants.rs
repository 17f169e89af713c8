//! Which values variants have.

use crate::common::Linear;
use hertzian_study::{Prepared, Request, Spread, Study, StudyError, Variants};
use sobol::{Sobol, params::JoeKuoD6};

fn prepared(variants: Variants) -> Result<Prepared, StudyError> {
    let request = Request::response(0.5, 3.0);
    Study::of(&Linear::default())
        .variants(variants)
        .request(request)
        .prepare()
}

fn columns(study: &Prepared) -> [Vec<f64>; 2] {
    let values: Vec<Vec<f64>> = (0..study.count())
        .map(|index| study.values(index))
        .collect();
    [0, 1].map(|place| values.iter().map(|values| values[place]).collect())
}

fn unit(variants: Variants) -> Prepared {
    let variants = variants.over("drive", Spread::uniform(0.0, 1.0));
    prepared(variants.over("k", Spread::uniform(1.0, 2.0))).expect("a study")
}

#[test]
fn a_grid_has_every_pair_and_the_last_parameter_changes_first() {
    let variants = Variants::grid()
        .over("drive", Spread::list(&[1.0, 2.0]))
        .over("k", Spread::even(3.0, 5.0, 3));
    let study = prepared(variants).expect("a study");
    assert_eq!(study.names(), ["k", "drive"]);
    let [k, drive] = columns(&study);
    assert_eq!(k, [3.0, 3.0, 4.0, 4.0, 5.0, 5.0]);
    assert_eq!(drive, [1.0, 2.0, 1.0, 2.0, 1.0, 2.0]);
    assert!(study.values(6).is_empty());
}

#[test]
fn a_logarithmic_side_is_even_in_the_logarithm_and_has_both_ends() {
    let mut side = Spread::even(0.01, 1.0, 3);
    side.scale = Some(hertzian_study::SpreadScale::Log);
    let study = prepared(Variants::grid().over("k", side)).expect("a study");
    let values: Vec<f64> = (0..3).map(|index| study.values(index)[0]).collect();
    assert_eq!([values[0], values[2]], [0.01, 1.0]);
    assert!((values[1] - 0.1).abs() < 1e-15);
}

/// The definition of `McKay`, Beckman and Conover: each of as many equal parts has one variant, of every parameter.
#[test]
fn a_latin_hypercube_meets_every_part_once() {
    let study = unit(Variants::latin_hypercube(1000));
    for (from, column) in [1.0, 0.0].into_iter().zip(columns(&study)) {
        let mut parts: Vec<usize> = column
            .iter()
            .map(|value| ((value - from) * 1000.0) as usize)
            .collect();
        parts.sort_unstable();
        assert_eq!(parts, (0..1000).collect::<Vec<_>>());
    }
}

/// The same points as the library gives one after the other, up to a shift of their digits: differences of bits do not have it.
#[test]
fn the_sequence_of_sobol_is_known_at_any_number() {
    let study = unit(Variants::sobol(5000));
    let library: Vec<Vec<f64>> = Sobol::<f64>::new(2, &JoeKuoD6::minimal())
        .take(5000)
        .collect();
    let [k, drive] = columns(&study);
    let bits = |value: f64| (value * 2_f64.powi(40)) as u64;
    // In the order of the declaration.
    let first = [bits(k[0] - 1.0), bits(drive[0])];
    for index in 0..5000 {
        for (place, own) in [k[index] - 1.0, drive[index]].into_iter().enumerate() {
            let expected = bits(library[index][place]) ^ bits(library[0][place]);
            assert_eq!(bits(own) ^ first[place], expected, "{index} {place}");
        }
    }
}

/// A net: of 1024 points each box of 32 by 32 has one.
#[test]
fn points_of_sobol_fill_the_square() {
    let study = unit(Variants::sobol(1024));
    let [k, drive] = columns(&study);
    let mut boxes = vec![0; 1024];
    for (k, drive) in k.iter().zip(&drive) {
        boxes[((k - 1.0) * 32.0) as usize * 32 + (drive * 32.0) as usize] += 1;
    }
    assert!(boxes.iter().all(|&count| count == 1));
}

#[test]
fn normal_distributions_have_their_moments_and_their_cuts() {
    let variants = Variants::sobol(4096).over("k", Spread::normal(10.0, 0.5));
    let study = prepared(variants).expect("a study");
    let values: Vec<f64> = (0..4096).map(|index| study.values(index)[0]).collect();
    let mean = values.iter().sum::<f64>() / 4096.0;
    let variance = values
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum::<f64>()
        / 4096.0;
    assert!((mean - 10.0).abs() < 1e-3, "{mean}");
    assert!((variance.sqrt() - 0.5).abs() < 2e-3, "{variance}");
    let within = values
        .iter()
        .filter(|value| (9.5..10.5).contains(*value))
        .count();
    // Of a normal distribution 68.27 % are within a deviation.
    assert!((within as f64 / 4096.0 - 0.6827).abs() < 1e-3);

    let mut cut = Spread::normal(10.0, 0.5);
    cut.from = Some(10.0);
    let study = prepared(Variants::random(1000).over("k", cut)).expect("a study");
    let values: Vec<f64> = (0..1000).map(|index| study.values(index)[0]).collect();
    assert!(values.iter().all(|value| *value >= 10.0));
    // Its mean is the mean and the deviation times the root of two over pi.
    let mean = values.iter().sum::<f64>() / 1000.0;
    assert!(
        (mean - 10.0 - 0.5 * (2.0 / std::f64::consts::PI).sqrt()).abs() < 0.04,
        "{mean}"
    );
}

#[test]
fn random_variants_follow_from_the_seed() {
    let of = |seed: u64| {
        let variants = Variants::random(10).over("k", Spread::uniform(3.0, 5.0));
        let study = Study::of(&Linear::default()).seed(seed).variants(variants);
        let study = study
            .request(Request::response(0.5, 3.0))
            .prepare()
            .expect("a study");
        (0..10)
            .map(|index| study.values(index)[0])
            .collect::<Vec<_>>()
    };
    assert_eq!(of(7), of(7));
    assert_ne!(of(7), of(8));
}

#[test]
fn a_table_has_a_row_for_each_variant() {
    let of = |text: &str| {
        let study = Study::of(&Linear::default()).table(text);
        study.request(Request::response(0.5, 3.0)).prepare()
    };
    let study = of("drive, k\n1, 3\n# nothing\n2, 4.5\n").expect("a study");
    assert_eq!(study.names(), ["drive", "k"]);
    assert_eq!([study.values(0), study.values(1)], [[1.0, 3.0], [2.0, 4.5]]);
    for (text, said) in [
        ("", "has no rows"),
        ("k\n", "has no rows"),
        ("k\n3\nfour\n", "line 3: `four` is no value for k"),
        ("k,k\n3,4\n", "two columns have the name `k`"),
        ("mass\n3\n", "no parameter `mass`: there are k, drive"),
        ("k\n-1\n", "-1 is outside of the range of k, more than 0"),
        ("k,drive\n3\n", "2 fields"),
    ] {
        let error = of(text).expect_err(text).to_string();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn what_cannot_be_is_said() {
    let k = |spread: Spread| Variants::sobol(10).over("k", spread);
    let mut both = Spread::normal(4.0, 0.1);
    both.percent = Some(5.0);
    let mut logarithmic = Spread::uniform(0.0, 1.0);
    logarithmic.scale = Some(hertzian_study::SpreadScale::Log);
    for (variants, said) in [
        (
            Variants::sobol(0).over("k", Spread::uniform(3.0, 4.0)),
            "0 is not between 1",
        ),
        (
            Variants::latin_hypercube(1 << 26)
                .over("k", Spread::uniform(3.0, 4.0))
                .over("drive", Spread::uniform(0.0, 1.0)),
            "over 2 parameters has 134217728 places, more than 67108864",
        ),
        (Variants::sobol(10), "nothing varies"),
        (k(Spread::list(&[1.0])), "are for a grid"),
        (k(Spread::even(1.0, 2.0, 3)), "`count` here is for a grid"),
        (k(Spread::uniform(4.0, 3.0)), "must be less than"),
        (k(Spread::normal(4.0, 0.0)), "no normal distribution"),
        (k(Spread::default()), "needs `from` and `to`"),
        (k(both), "not both"),
        (k(logarithmic), "has no logarithm"),
        (
            k(Spread::uniform(-1.0, 3.0)),
            "-1 is outside of the range of k, more than 0",
        ),
        (
            Variants::sobol(10).over("omega", Spread::uniform(1.0, 2.0)),
            "varies along each branch",
        ),
        (
            Variants::sobol(10).over("mass", Spread::uniform(1.0, 2.0)),
            "there are k, drive",
        ),
        (
            Variants::grid().over("k", Spread::normal(4.0, 0.1)),
            "no values for a grid",
        ),
        (Variants::grid().over("k", Spread::list(&[])), "no values"),
        (
            Variants::grid().over("k", Spread::list(&[f64::NAN])),
            "not a number",
        ),
    ] {
        let error = prepared(variants).expect_err(said).to_string();
        assert!(error.contains(said), "{error}");
    }
    // A grid of nothing is one variant.
    assert_eq!(prepared(Variants::grid()).expect("a study").count(), 1);
}
