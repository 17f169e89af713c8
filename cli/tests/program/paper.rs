//! The subcommand `paper` on some of its figures.

use hertzian::Cancel;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Parser;
use hertzian_cli::paper::complaints;
use hertzian_cli::paper::figure::Value;
use hertzian_cli::paper::figures::FIGURES;
use hertzian_cli::paper::options::Options;
use hertzian_cli::paper::run::{Drawn, run};
use hertzian_cli::response::progress::Progress;

/// A folder that is removed in the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = format!("hertzian-paper-{name}-{}", std::process::id());
        Self(std::env::temp_dir().join(folder))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn draw(folder: &Path, figures: &[&str]) -> Vec<Drawn> {
    let folder = folder.to_str().unwrap();
    let words = [&["paper", "--out", folder, "--only"], figures].concat();
    let options = Options::try_parse_from(words).unwrap();
    run(&options, &Cancel::new(), &mut Progress::hidden()).unwrap()
}

/// Every value that is known is found, and is the exact one.
fn assert_exact(drawn: &[Drawn]) {
    assert!(drawn.iter().all(|one| one.drawing.is_ok()));
    assert_eq!(complaints(drawn, false), Vec::<String>::new());
}

#[test]
fn figures_become_pictures_data_and_a_page() {
    let folder = Folder::new("files");
    let drawn = draw(&folder.0, &["fig5a", "fig9b", "table1"]);
    assert_eq!(drawn.len(), 3);
    assert_exact(&drawn);
    for one in &drawn {
        let id = one.figure.id;
        let svg = fs::read_to_string(folder.0.join(id).with_extension("svg")).unwrap();
        assert!(
            svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"),
            "{id}"
        );
        let csv = fs::read_to_string(folder.0.join(id).with_extension("csv")).unwrap();
        assert!(csv.lines().count() > 2, "{id}");
    }
    let page = fs::read_to_string(folder.0.join("index.html")).unwrap();
    assert_eq!(page.matches("data:image/svg+xml,").count(), 3);
    assert!(page.contains("1.0020 and 0.1833: there is no orbit"));
    assert!(!page.contains("not found"));
}

#[test]
fn orbits_of_every_period_are_exact() {
    let folder = Folder::new("periods");
    let drawn = draw(&folder.0, &["fig8a", "fig9a"]);
    assert_exact(&drawn);
    assert_eq!(drawn[0].drawing.as_ref().unwrap().values.len(), 6);
}

/// What is missing or wrong is said by name, and only where all was computed.
#[test]
fn a_value_that_is_not_the_exact_one_is_a_complaint() {
    let folder = Folder::new("complaints");
    let mut drawn = draw(&folder.0, &["fig5a"]);
    let drawing = drawn[0].drawing.as_mut().unwrap();
    // Beyond what is stated, and beyond rounding.
    let stated = drawing.values[0].stated.unwrap();
    *drawing.values[0].ours.as_mut().unwrap() += 5.0 * stated.max(1e-9);
    drawing.values[1].ours = None;
    let found = complaints(&drawn, false);
    assert_eq!(found.len(), 2);
    assert!(found[0].starts_with("fig5a: one-sided: fold, ω: 0."));
    assert!(found[1].starts_with("fig5a: one-sided: fold, ω: not found"));
    assert!(complaints(&drawn, true).is_empty());
    drawn[0].drawing = Err("no orbit".to_owned());
    assert_eq!(complaints(&drawn, true), ["fig5a: no orbit"]);
}

#[test]
fn a_difference_is_explained_by_both_errors() {
    let value = |ours: f64| Value::of("a mean", ours).exact(Some(1.0));
    // Three times the root of the sum of squares.
    let errors = |ours| value(ours).stated(0.03).uncertain(0.04).fault();
    assert_eq!((errors(1.149), errors(0.851)), (None, None));
    assert!(errors(1.151).is_some() && errors(f64::NAN).is_some());
    assert!(value(1.0 + 1e-10).fault().is_some() && value(1.0 + 1e-12).fault().is_none());
    assert_eq!(Value::of("ours alone", 1.0).fault(), None);
}

#[test]
fn an_interrupted_run_writes_its_page() {
    let folder = Folder::new("interrupted");
    let options = ["paper", "--out", folder.0.to_str().unwrap()];
    let options = Options::try_parse_from(options).unwrap();
    let now = Cancel::new();
    now.cancel();
    let drawn = run(&options, &now, &mut Progress::hidden()).unwrap();
    assert!(drawn.is_empty());
    assert!(folder.0.join("index.html").exists());
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let folder = Folder::new("file");
    fs::write(&folder.0, "").unwrap();
    let options = Options::try_parse_from(["paper", "--out", folder.0.to_str().unwrap()]).unwrap();
    let failure = run(&options, &Cancel::new(), &mut Progress::hidden());
    assert!(
        failure
            .err()
            .unwrap()
            .to_string()
            .contains("hertzian-paper-file")
    );
    fs::remove_file(&folder.0).unwrap();
}

#[test]
fn figures_have_names_of_their_own() {
    for (index, figure) in FIGURES.iter().enumerate() {
        assert!(FIGURES[..index].iter().all(|other| other.id != figure.id));
        assert!(figure.shows.ends_with('.'));
    }
    assert!(Options::try_parse_from(["paper", "--only", "fig12"]).is_err());
}
