//! Every example runs, draws a picture, prints what the README shows, and can be copied as it stands.

mod integrated;
mod linear;

use std::fmt::Debug;
use std::path::Path;
use std::process::Command;
use std::sync::Once;

const FOLDER: &str = env!("CARGO_MANIFEST_DIR");
const README: &str = include_str!("../../README.md");

/// An example is read within a minute or two.
const MOST_LINES: usize = 100;

/// What an engineer asks in the beginning takes so many lines, those apart that are empty or a comment.
const MOST_OF_A_TASK: usize = 30;
const TASKS: [&str; 6] = [
    "approach",
    "ball_bearing",
    "beam",
    "bolted_joint",
    "gear_mesh",
    "variants",
];

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
    "../approach.rs" approach
    "../backbone.rs" backbone
    "../ball_bearing.rs" ball_bearing
    "../basin.rs" basin
    "../beam.rs" beam
    "../bifurcations.rs" bifurcations
    "../bolted_joint.rs" bolted_joint
    "../casing.rs" casing
    "../chain_of_beads.rs" chain_of_beads
    "../chaos.rs" chaos
    "../contact_resonance.rs" contact_resonance
    "../gear_mesh.rs" gear_mesh
    "../gear_pair.rs" gear_pair
    "../gear_train.rs" gear_train
    "../microscope.rs" microscope
    "../own_law.rs" own_law
    "../preloaded_stop.rs" preloaded_stop
    "../response.rs" response
    "../rotor.rs" rotor
    "../two_masses.rs" two_masses
    "../variants.rs" variants
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
    let mut words = attributes(&svg, "aria-label");
    words.retain(|text| text.contains(char::is_alphabetic));
    words.sort_unstable();
    words.dedup();
    assert!(words.len() >= 3, "a title and two axes: {words:?}");
    let stored = Path::new(FOLDER).join("../docs/pictures");
    let stored = stored.join(name).with_extension("svg");
    if let Ok(stored) = std::fs::read_to_string(stored) {
        is_drawn_like(&stored, &svg, name);
    }
}

/// Values of an attribute, in their order.
fn attributes<'s>(svg: &'s str, name: &str) -> Vec<&'s str> {
    let begins = format!("{name}=\"");
    let values = svg.split(&begins).skip(1);
    values.filter_map(|rest| rest.split('"').next()).collect()
}

/// The picture in the documentation has the words and the colours of the one that is drawn. Digits of places may depend on the machine.
fn is_drawn_like(stored: &str, drawn: &str, name: &str) {
    for attribute in [
        "viewBox",
        "aria-label",
        "fill",
        "stroke",
        "stroke-dasharray",
    ] {
        let [mut stored, mut drawn] = [stored, drawn].map(|svg| attributes(svg, attribute));
        for values in [&mut stored, &mut drawn] {
            values.sort_unstable();
            values.dedup();
        }
        assert_eq!(
            stored, drawn,
            "docs/pictures/{name}.svg is to be drawn again"
        );
    }
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

/// The lines of a text between the line that begins a block, after one with these words, and the end of the block.
fn block<'t>(text: &'t str, words: &str) -> Vec<&'t str> {
    let lines = text.lines().skip_while(|line| !line.contains(words));
    let lines = lines.skip_while(|line| *line != "```text").skip(1);
    lines.take_while(|line| *line != "```").collect()
}

/// A line without how long it took.
fn timeless(line: &str) -> &str {
    line.split_once(" ms; ").map_or(line, |(_, counts)| counts)
}

#[test]
fn what_is_printed_is_what_is_shown() {
    const CHAPTER: &str = include_str!("../../docs/book/src/measured-contact.md");
    for (name, shown) in [
        ("response", block(README, "It prints")),
        (
            "contact_resonance",
            block(CHAPTER, "at four excitations and draws"),
        ),
    ] {
        let printed = printed(name);
        let printed: Vec<&str> = printed.lines().map(timeless).collect();
        assert!(shown.len() > 5);
        for line in shown.into_iter().map(timeless) {
            assert!(printed.contains(&line), "{line}\nis not in\n{printed:#?}");
        }
    }
}

/// Up to the touch the motion is linear: where its amplitude is that of the distance is known in closed form,
/// `(1 - w^2)^2 + (2 zeta w)^2 = drive^2` for the stop, and with `profile w^2 / torque` on the right for the gears.
#[test]
fn motions_begin_to_touch_where_they_must() {
    // Of `w^4 (1 - a) + w^2 (4 zeta^2 - 2) + 1 = b`.
    let roots = |a: f64, b: f64, zeta: f64| {
        let (two, half) = (1.0 - a, 1.0 - 2.0 * zeta * zeta);
        let root = (half * half - two * (1.0 - b)).sqrt();
        [-root, root].map(|root| ((half + root) / two).sqrt())
    };
    let stop = roots(0.0, 0.1_f64.powi(2), 0.02);
    let gears = [0.02, 0.05].map(|profile: f64| roots((profile / 0.1).powi(2), 0.0, 0.05));
    // As `grazing at 0.952651559953 (error 2e-12), peak-to-peak 2.000000` says.
    let touches = |name: &str| -> Vec<[f64; 2]> {
        let printed = printed(name);
        let lines = printed.lines();
        let said = lines.filter_map(|line| line.trim().strip_prefix("grazing at "));
        let numbers = said.map(|line| line.split([' ', ')']));
        let numbers = numbers.map(|mut words| [words.next(), words.nth(1)]);
        numbers
            .map(|words| {
                words.map(|word| word.and_then(|word| word.parse().ok()).expect("a number"))
            })
            .collect()
    };
    let are = |touches: &[[f64; 2]], exact: &[f64]| {
        assert_eq!(touches.len(), exact.len());
        for ([value, error], exact) in touches.iter().zip(exact) {
            assert!(*error < 1e-8, "{value} (error {error})");
            assert!(
                (value - exact).abs() <= *error,
                "{value} (error {error}), {exact}"
            );
        }
    };
    are(&touches("preloaded_stop"), &[stop, stop, stop].concat());
    are(&touches("gear_pair")[..4], &gears.concat());
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
            let text = std::fs::read_to_string(&path).expect("text");
            let lines = text.lines().count();
            assert!(lines <= MOST_LINES, "{name}: {lines} lines");
            let code = text.lines().map(str::trim_start);
            let code = code.filter(|line| !line.is_empty() && !line.starts_with("//"));
            let code = code.count();
            let is_task = TASKS.contains(&&*name);
            assert!(!is_task || code <= MOST_OF_A_TASK, "{name}: {code} lines");
            assert!(manifest.contains(&format!("name = \"{name}\"")), "{name}");
            assert!(README.contains(&format!("| `{name}` |")), "{name}");
            found.push(name.into_owned());
        }
    }
    found.sort();
    assert_eq!(found, NAMES);
}
