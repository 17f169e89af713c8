//! The subcommand `study`: a file of a model of one's own, in parts, merged, and what is said of faults.

use std::fs;
use std::path::Path;

use crate::folder::Folder;
use clap::Parser;
use hertzian::Cancel;
use hertzian_cli::program::Ended;
use hertzian_cli::response::progress::Progress;
use hertzian_cli::study::{options::Options, run::run};

const MODEL: &str = "Linear(x) {
    param k = 4 > 0;
    param drive = 1;
    ddot(x) + 0.2*dot(x) + k*x = drive*cos(omega*t);
}";

const STUDY: &str = "model = \"mine.txt\"
[variants]
design = \"sobol\"
count = 20
[variants.over]
k = { from = 3, to = 5 }
[request]
from = 0.5
to = 3
stability = false
[keep]
at = { values = [1.0] }
";

fn study(words: &[&str], file: &Path) -> Result<Ended, String> {
    let file = file.to_str().expect("a path");
    let words = [&["study", file], words].concat();
    let options = Options::try_parse_from(words).map_err(|error| error.to_string())?;
    run(&options, &Cancel::new(), &mut Progress::hidden()).map_err(|failure| failure.to_string())
}

#[test]
fn a_study_of_ones_own_model_in_parts_is_the_whole() {
    let folder = Folder::new("study");
    fs::write(folder.0.join("mine.txt"), MODEL).expect("written");
    let file = folder.0.join("stiff.toml");
    fs::write(&file, STUDY).expect("written");
    let ended = study(&[], &file).expect("a study");
    assert!(ended.complete && ended.complaints.is_empty(), "{ended:?}");
    let whole = fs::read(folder.0.join("stiff-results/results.csv")).expect("a table");
    // The displacement of a linear oscillator at omega = 1: k - 1 and the damping 0.2 are the sides of a triangle.
    let text = String::from_utf8_lossy(&whole).into_owned();
    for line in text.lines().skip(1) {
        let values: Vec<&str> = line.split(',').collect();
        let number = |place: usize| values[place].parse::<f64>().expect(line);
        let expected = 2.0 / (number(1) - 1.0).hypot(0.2);
        assert!((number(8) / expected - 1.0).abs() < 1e-9, "{line}");
    }
    assert_eq!(text.lines().count(), 21);
    let out = folder.file("parts");
    let out = out.as_str();
    for part in ["1/2", "2/2"] {
        let ended = study(&["--out", out, "--part", part, "--threads", "1"], &file).expect(part);
        assert!(ended.summary.contains("of this part"), "{ended:?}");
    }
    study(&["--merge", out], &file).expect("a table");
    assert_eq!(
        fs::read(folder.0.join("parts/results.csv")).expect("a table"),
        whole
    );
    // The folder has all that it takes to run it again.
    study(
        &["--out", &folder.file("again")],
        &folder.0.join("parts/study.toml"),
    )
    .expect("a study");
    assert_eq!(
        fs::read(folder.0.join("again/results.csv")).expect("a table"),
        whole
    );
}

#[test]
fn faults_are_said_with_their_places() {
    let folder = Folder::new("study-faults");
    fs::write(folder.0.join("mine.txt"), MODEL).expect("written");
    let file = folder.0.join("stiff.toml");
    for (from, to, said) in [
        (
            "k = {",
            "m = {",
            "variants.over.m: no parameter `m`: there are k, drive",
        ),
        ("design", "scheme", "stiff.toml:3:1: unknown field `scheme`"),
        (
            "from = 3",
            "from = -3",
            "-3 is outside of the range of k, more than 0",
        ),
        ("mine.txt", "yours.txt", "yours.txt: No such file"),
        (
            "[1.0]",
            "[4.0]",
            "keep.at: 4 is not between from = 0.5 and to = 3",
        ),
        (
            "count = 20",
            "count = 0",
            "variants.count: 0 is not between 1",
        ),
    ] {
        fs::write(&file, STUDY.replace(from, to)).expect("written");
        let error = study(&[], &file).expect_err(said);
        assert!(error.contains(said), "{error}");
    }
    assert!(
        study(&["--part", "3/2"], &file)
            .expect_err("no part")
            .contains("no part 3 of 2")
    );
    fs::write(&file, STUDY).expect("written");
    let error = study(&["--merge"], &file).expect_err("nothing there");
    assert!(error.contains("cannot use"), "{error}");
}

/// The table is worth more than its picture.
#[test]
fn a_picture_that_cannot_be_written_costs_no_summary() {
    let folder = Folder::new("study-picture");
    fs::write(folder.0.join("mine.txt"), MODEL).expect("written");
    let file = folder.0.join("stiff.toml");
    let picture = "[[pictures]]\nwhat = \"histogram\"\nfile = \"nowhere/fold.svg\"\n";
    fs::write(&file, format!("{STUDY}{picture}")).expect("written");
    let ended = study(&[], &file).expect("a study");
    assert!(ended.summary.contains("rows       20"), "{ended:?}");
    assert!(!ended.complete);
    let said = &ended.complaints[..];
    assert!(
        said.len() == 1
            && said[0].starts_with("pictures: cannot use ")
            && said[0].contains("nowhere"),
        "{said:?}"
    );
}
