//! The subcommand `multipliers` with few harmonics.

use hertzian::Cancel;
use std::fs;

use clap::Parser;
use hertzian::stability::Method;
use hertzian_cli::multipliers::study::{METHODS, Measured, measure, orders, oscillators};
use hertzian_cli::multipliers::{Options, run};
use hertzian_cli::response::progress::Progress;

#[test]
fn writes_a_table_and_two_pictures() {
    let folder = std::env::temp_dir().join(format!("hertzian-multipliers-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let words = ["multipliers", "--harmonics", "4", "7", "--folder"];
    let words = words.into_iter().chain([folder.to_str().unwrap()]);
    let options = Options::try_parse_from(words).unwrap();
    let quiet = &mut Progress::hidden();
    let ended = run(&options, &Cancel::new(), quiet).unwrap();
    let summary = ended.summary;
    for (method, _) in METHODS {
        assert!(summary.contains(&format!(", {method}: ")), "{method}");
    }
    let table = fs::read_to_string(folder.join("multipliers.csv")).unwrap();
    let rows = oscillators().len() * METHODS.len() * 2;
    assert_eq!(table.lines().count(), 1 + rows);
    for picture in ["multipliers-harmonics.svg", "multipliers-time.svg"] {
        let svg = fs::read_to_string(folder.join(picture)).unwrap();
        assert!(
            METHODS
                .iter()
                .all(|(method, _)| svg.contains(&method.to_string()))
        );
    }
    fs::remove_dir_all(&folder).unwrap();
}

/// The tail of the displacement falls as `k^-3` where the damping force jumps; it moves the time of a switch by its value there,
/// `K^-3`. Two real negative multipliers: two of the sortings take the copies of one.
#[test]
fn orders_are_those_of_theory_and_a_wrong_sorting_stays_wrong() {
    let all = oscillators();
    let of = |method: Method, measured: &[Measured]| {
        let found = orders(measured).into_iter().find(|(m, _)| *m == method);
        found.unwrap().1
    };
    let linear = measure(&all[0], &[5, 10, 20]).unwrap();
    let order = of(Method::Monodromy, &linear);
    assert!((order - 3.0).abs() < 0.3, "{order}");
    let continuous = measure(&all[2], &[5, 10]).unwrap();
    let worst = |method| {
        let by_it = continuous.iter().filter(|m| m.method == method);
        by_it.map(|m| m.error).fold(0.0, f64::max)
    };
    let others = [Method::HillImaginaryPart, Method::HillWeightedMean].map(worst);
    assert!(others.iter().all(|worst| *worst > 0.1));
    assert!(worst(Method::Hill) < 1e-3);
}
