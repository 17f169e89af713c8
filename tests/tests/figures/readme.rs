//! The numbers in the README are those of the present code, and true.

use hertzian::FrequencyResponse;

use crate::models::OneSided;

const README: &str = include_str!("../../../README.md");

/// What the twenty lines print.
#[test]
fn the_folds_of_the_readme_are_found() {
    let model = OneSided {
        alpha: 1.5,
        zeta: 0.032,
        load: 1.0,
        drive: 0.1,
    };
    let branch = FrequencyResponse::of(&model).from(0.6).to(1.6).run();
    let branch = branch.expect("a branch");
    let printed = README.lines().filter(|line| line.starts_with("fold at "));
    let printed: Vec<&str> = printed.collect();
    assert_eq!(printed.len(), branch.folds().count());
    for (line, fold) in printed.iter().zip(branch.folds()) {
        let value = number(&line["fold at ".len()..]);
        let size = number(line.split("peak-to-peak ").nth(1).expect("a size"));
        assert!((value - fold.point.value).abs() < 2e-9, "{line}: {fold}");
        assert!(
            (size - fold.point.peak_to_peak()).abs() < 2e-6,
            "{line}: {fold}"
        );
    }
}

/// `| figure | command | found (error stated), ... | exact, ... |`: in the same order, no further off than stated and rounded.
#[test]
fn the_table_of_the_readme_is_true() {
    let table = README
        .lines()
        .skip_while(|line| !line.starts_with("| figure |"));
    let rows: Vec<&str> = table
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .collect();
    assert_eq!(rows.len(), 5);
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let (found, exact) = (cells[3].split("), "), cells[4].split(", "));
        for (found, exact) in found.zip(exact) {
            let (value, stated) = found.split_once(" (").expect("an error");
            let (value, stated) = (number(value), number(stated));
            // Rounded to one digit, an error may be half as large again.
            let allowed = (1.5 * stated).max(1e-9);
            assert!((value - number(exact)).abs() <= allowed, "{row}");
        }
    }
}

/// The number that a text begins with.
fn number(text: &str) -> f64 {
    let end = text.find(|c: char| !(c.is_ascii_digit() || ".-e".contains(c)));
    text[..end.unwrap_or(text.len())].parse().expect("a number")
}
