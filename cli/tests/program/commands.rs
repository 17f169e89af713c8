//! The program as a whole: its subcommands, what belongs to an installation, and models by their names.

use std::process::{Command, Output};

use clap::CommandFactory;
use hertzian::FrequencyResponse;
use hertzian::generic::Declaration;
use hertzian_cli::built_in::MODELS;
use hertzian_cli::command::Program;
use hertzian_cli::response::models::OneSidedHertz;

use crate::folder::Folder;

fn hertzian(arguments: &str) -> Output {
    let words = arguments.split_whitespace();
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzian"));
    program.args(words).output().expect("the program")
}

/// What is printed on standard output by a command that succeeds.
fn printed(arguments: &str) -> String {
    let Output { status, stdout, .. } = hertzian(arguments);
    assert_eq!(status.code(), Some(0), "{arguments}");
    String::from_utf8(stdout).expect("text")
}

/// What is said on standard error by a command that is refused.
fn refused(arguments: &str) -> String {
    let Output { status, stderr, .. } = hertzian(arguments);
    assert_eq!(status.code(), Some(2), "{arguments}");
    String::from_utf8(stderr).expect("text")
}

#[test]
fn every_subcommand_has_examples_in_its_help() {
    let program = Program::command();
    program.clone().debug_assert();
    let names = program.get_subcommands().map(clap::Command::get_name);
    for name in names {
        let help = printed(&format!("{name} --help"));
        let (_, examples) = help.split_once("\nExamples:\n").expect("examples");
        let example = examples.lines().next().expect("a line").trim();
        assert!(example.starts_with(&format!("hertzian {name}")), "{help}");
        assert!(printed("--help").contains(&format!("\n  {name}")), "{name}");
    }
}

#[test]
fn what_belongs_to_an_installation_is_printed() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = printed(&format!("completions {shell}"));
        for word in ["work-precision", "bifurcations"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    assert!(printed("man").contains(".TH hertzian 1"));
    let page = printed("man response");
    assert!(page.contains(".TH hertzian-response 1") && page.contains("Exit codes"));
    assert_eq!(
        printed("--version").trim(),
        concat!("hertzian ", env!("CARGO_PKG_VERSION"))
    );
}

#[test]
fn what_is_no_command_is_refused() {
    assert!(refused("").contains("Usage: hertzian"));
    assert!(refused("respond").contains("unrecognized subcommand"));
    assert!(refused("man respond").contains("possible values"));
    // Usage is that of the subcommand.
    let text = refused("attractors --basin --up");
    assert!(text.contains("--up belongs to --sweep"), "{text}");
    assert!(text.contains("Usage: hertzian attractors"), "{text}");
}

/// Every model is a declaration with values, and what is printed of it is its text.
#[test]
fn every_name_is_a_declaration() {
    let listed = printed("models");
    assert_eq!(listed.lines().count(), MODELS.len());
    for model in MODELS {
        let parsed = Declaration::parse(model.text).expect(model.name);
        let values = parsed.parameters();
        assert!(values.iter().all(|(_, value)| value.is_finite()));
        assert!(!model.described().is_empty() && listed.contains(model.described()));
        assert!(printed("response --help").contains(model.described()));
        assert_eq!(printed(&format!("models {}", model.name)), model.text);
    }
}

/// The options of the two oscillators that are compiled are short forms.
#[test]
fn a_name_is_the_same_as_options() {
    let folder = Folder::new("names");
    let (csv, svg) = (folder.file("a.csv"), folder.file("a.svg"));
    let table = |options: &str| {
        printed(&format!(
            "response --harmonics 5 --quiet --csv {csv} --svg {svg} {options}"
        ));
        let read = |path: &str| std::fs::read_to_string(path).expect("a file");
        (read(&csv), read(&svg))
    };
    let short = table("--one-sided --alpha 1 --zeta 0.1");
    assert_eq!(
        short,
        table("--model one-sided --set alpha=1 --set zeta=0.1")
    );
    assert_eq!(short, table("--model one-sided --alpha 1 --set zeta=0.1"));
    let short = table("--continuous --load 0");
    assert_eq!(short, table("--model continuous --set load=0"));
    let motions = |model: &str| {
        let out = folder.file("m");
        printed(&format!("attractors --history --quiet --out {out} {model}"));
        std::fs::read(folder.file("m.npy")).expect("an array")
    };
    assert_eq!(
        motions("--alpha 1 --drive 0.2"),
        motions("--model one-sided --set alpha=1 --set drive=0.2")
    );
}

/// The text that is printed of an oscillator that is compiled too is the same oscillator.
#[test]
fn a_text_is_the_same_as_what_is_compiled() {
    let compiled = OneSidedHertz {
        zeta: 0.032,
        load: 1.0,
        drive: 0.1,
    };
    let folds = |system: &dyn hertzian::System| -> Vec<f64> {
        let branch = FrequencyResponse::of(system).from(0.9).to(1.6).run();
        let branch = branch.expect("a branch");
        branch.folds().map(|fold| fold.point.value).collect()
    };
    let text = Declaration::parse(MODELS[0].text).expect("a declaration");
    let (ours, of_text) = (folds(&compiled), folds(&text));
    assert_eq!(ours.len(), 1);
    assert_eq!(of_text.len(), 1);
    assert!((ours[0] - of_text[0]).abs() < 1e-8);
}

#[test]
fn what_does_not_fit_a_name_is_refused() {
    let folder = Folder::new("misfits");
    let svg = folder.file("a.svg");
    for (options, message) in [
        (
            "--model two-masses --alpha 1",
            "with --model two-masses write --set alpha=VALUE",
        ),
        (
            "--model one-sided --continuous",
            "--continuous would do nothing beside --model one-sided",
        ),
        (
            "--model one-sided --zeta 0.1 --set zeta=0.2",
            "--zeta and --set zeta are the same",
        ),
        ("--model one-sided --set k=1", "no parameter k"),
        ("--model one-sided --set zeta=nan", "must be finite"),
        ("--model two-masses --set k=1", "k"),
        ("--model two-mases", "names of models: one-sided, "),
        (
            "--model one-sided --set drive=1 --sweep drive",
            "--sweep drive takes the place",
        ),
    ] {
        let text = refused(&format!("response {options} --svg {svg}"));
        assert!(text.contains(message), "{options}: {text}");
    }
    let left = std::fs::read_dir(&folder.0).expect("a folder").count();
    assert_eq!(left, 0, "nothing is written");
}
