//! The subcommand `work-precision` on one problem, with little patience.

use hertzian::Cancel;
use std::fs;

use clap::Parser;
use hertzian_cli::response::progress::Progress;
use hertzian_cli::work_precision::method::{Family, Reference, Setting};
use hertzian_cli::work_precision::options::Options;
use hertzian_cli::work_precision::{peer, problem, run};

#[test]
fn every_method_is_measured_against_what_is_known() {
    let folder = std::env::temp_dir().join(format!("hertzian-work-{}", std::process::id()));
    let words = [
        "work_precision",
        "--out",
        folder.to_str().unwrap(),
        "--repeats",
        "1",
        "--patience",
        "0.3",
    ];
    let options = Options::try_parse_from(words).unwrap();
    let mut problems = problem::all();
    problems.truncate(1);
    let quiet = &mut Progress::hidden();
    let sections = run(&options, problems, &Cancel::new(), quiet).unwrap();
    let measured = &sections[0].measured;
    for family in Family::ALL {
        assert!(
            measured.iter().any(|one| one.family == family),
            "{family:?}"
        );
    }
    // Values of the balance in the limit of exact integrals, and what closed forms reach.
    let error = |family, setting| {
        let found = measured
            .iter()
            .find(|one| one.family == family && one.setting == setting);
        let found = found.unwrap();
        assert_eq!(found.failure, None);
        found.fold.unwrap()
    };
    let exact = 0.715_119_549_676_419;
    for (harmonics, fold) in [
        (5, 0.713_765_891),
        (10, 0.714_851_667),
        (20, 0.715_089_581),
        (40, 0.715_115_544),
    ] {
        for family in [Family::Switched, Family::Interpreted] {
            let found = error(family, Setting::Harmonics(harmonics));
            assert!(
                (found - (exact - fold)).abs() < 1e-8,
                "{family:?} {harmonics}: {found}"
            );
        }
    }
    assert!(error(Family::Shooting, Setting::Tolerance(1e-10)) < 1e-13);
    assert!(error(Family::ContactEquation, Setting::Tolerance(1e-6)) < 1e-9);
    for file in [
        "index.html",
        "work_precision.csv",
        "multipliers.csv",
        "one-sided-1.svg",
    ] {
        assert!(folder.join(file).exists(), "{file}");
    }
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn every_row_of_other_programs_belongs_to_a_problem_and_is_read() {
    let reference = Reference {
        folds: vec![0.75],
        peak_to_peak: 1.0,
        state: Vec::new(),
        multipliers: Vec::new(),
    };
    let problems = problem::all();
    let read: usize = problems
        .iter()
        .map(|problem| peer::on(problem, &reference).len())
        .sum();
    assert_eq!(read, peer::FILE.lines().count() - 1);
}
