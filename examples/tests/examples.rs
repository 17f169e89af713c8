//! Every example runs, draws a picture, prints what the README shows, and can be copied as it stands.

use std::fmt::Debug;
use std::path::Path;
use std::process::Command;
use std::sync::Once;

const FOLDER: &str = env!("CARGO_MANIFEST_DIR");
const README: &str = include_str!("../../README.md");

/// An example is read within a minute or two.
const MOST_LINES: usize = 100;

/// Each example as a module, a test that runs it, and the names of all.
macro_rules! examples {
    ($($file:literal $name:ident)*) => {
        $(
            #[path = $file]
            mod $name;
        )*

        const NAMES: &[&str] = &[$(stringify!($name)),*];

        mod runs {
            $(
                #[test]
                fn $name() {
                    super::draws(stringify!($name), super::$name::main);
                }
            )*
        }
    };
}

examples! {
    "../adhesion.rs" adhesion
    "../backbone.rs" backbone
    "../ball_bearing.rs" ball_bearing
    "../basin.rs" basin
    "../beam.rs" beam
    "../bifurcations.rs" bifurcations
    "../chaos.rs" chaos
    "../contact_resonance.rs" contact_resonance
    "../gear_pair.rs" gear_pair
    "../own_law.rs" own_law
    "../preloaded_stop.rs" preloaded_stop
    "../response.rs" response
    "../two_masses.rs" two_masses
}

/// Examples write into the current folder; here that is one for all of them, which none shares a name in.
fn enter_folder() -> &'static Path {
    static ENTER: Once = Once::new();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    ENTER.call_once(|| std::env::set_current_dir(folder).expect("a folder"));
    folder
}

/// Runs an example and looks at its picture: complete, titled, with both axes labelled, and every number a number.
fn draws<E: Debug>(name: &str, main: fn() -> Result<(), E>) {
    let picture = enter_folder().join(name).with_extension("svg");
    let _ = std::fs::remove_file(&picture);
    main().expect("a picture");
    let svg = std::fs::read_to_string(&picture).expect("a picture");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    assert!(!svg.contains("NaN") && !svg.contains("inf\""));
    let labels = svg.split("aria-label=\"").skip(1);
    let labels = labels.filter_map(|rest| rest.split('"').next());
    let mut words: Vec<&str> = labels
        .filter(|text| text.contains(char::is_alphabetic))
        .collect();
    words.sort_unstable();
    words.dedup();
    assert!(words.len() >= 3, "a title and two axes: {words:?}");
}

/// What an example prints: this program again, with the one test that runs it.
fn printed(name: &str) -> String {
    let test = format!("runs::{name}");
    let arguments = ["--exact", &test, "--nocapture", "--quiet"];
    let program = std::env::current_exe().expect("this program");
    let ran = Command::new(program).args(arguments).output();
    let ran = ran.expect("what it printed");
    assert!(ran.status.success());
    String::from_utf8(ran.stdout).expect("text")
}

/// Lines of the README that show what is printed, but for how long it took.
#[test]
fn the_readme_shows_what_is_printed() {
    let shown = README
        .lines()
        .skip_while(|line| !line.contains("It prints"))
        .skip_while(|line| *line != "```text")
        .skip(1)
        .take_while(|line| *line != "```");
    let printed = printed("response");
    let timeless = |line: &str| match line.split_once(" ms; ") {
        Some((_, counts)) => counts.to_owned(),
        None => line.to_owned(),
    };
    let printed: Vec<String> = printed.lines().map(timeless).collect();
    let mut count = 0;
    for line in shown.map(timeless) {
        assert!(printed.contains(&line), "{line}\nis not in\n{printed:#?}");
        count += 1;
    }
    assert!(count > 5);
}

/// Each is listed here, is an example of the package by that name, is in the table of the README, and is short.
#[test]
fn every_example_is_known_and_short() {
    let manifest = std::fs::read_to_string(Path::new(FOLDER).join("Cargo.toml"));
    let manifest = manifest.expect("a manifest");
    let mut found = Vec::new();
    for file in std::fs::read_dir(FOLDER).expect("a folder") {
        let path = file.expect("a file").path();
        if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.file_stem().expect("a name").to_string_lossy();
            let lines = std::fs::read_to_string(&path)
                .expect("text")
                .lines()
                .count();
            assert!(lines <= MOST_LINES, "{name}: {lines} lines");
            assert!(manifest.contains(&format!("name = \"{name}\"")), "{name}");
            assert!(README.contains(&format!("| `{name}` |")), "{name}");
            found.push(name.into_owned());
        }
    }
    found.sort();
    assert_eq!(found, NAMES);
}
