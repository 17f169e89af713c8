//! The programs `response` and `attractors`: what does not go together is refused, and what takes long can be ended.

use hertzian::Cancel;
use std::path::Path;
use std::sync::Mutex;

use clap::Parser;
use hertzian_cli::attractors;
use hertzian_cli::response;
use hertzian_cli::response::progress::Progress;

use crate::folder::Folder;

fn response_options(command: &str) -> Result<response::options::Options, clap::Error> {
    let words = std::iter::once("response").chain(command.split_whitespace());
    response::options::Options::try_parse_from(words)
}

fn attractors_options(command: &str) -> attractors::options::Options {
    let words = std::iter::once("attractors").chain(command.split_whitespace());
    attractors::options::Options::try_parse_from(words).expect("arguments that can be parsed")
}

/// What the run of a command says that is refused.
fn refused_by_response(command: &str) -> String {
    let options = response_options(command).expect("arguments that can be parsed");
    let never = Cancel::new();
    let failure = response::run::run(&options, &never, &mut Progress::hidden());
    let failure = failure.expect_err(command);
    assert_eq!(failure.exit_code(), 2);
    failure.to_string()
}

fn run_attractors(
    command: &str,
    cancelled: bool,
) -> Result<attractors::run::Outcome, attractors::run::Failure> {
    let cancel = Cancel::new();
    if cancelled {
        cancel.cancel();
    }
    let options = attractors_options(command);
    attractors::run::run(&options, &cancel, &mut Progress::hidden())
}

#[test]
fn options_that_would_be_ignored_are_refused() {
    let folder = Folder::new("ignored");
    let svg = folder.file("a.svg");
    for (command, message) in [
        ("--omega 2", "--omega"),
        ("--sweep omega --omega 1", "--omega"),
        (
            "--bifurcations --track fold --in omega,drive --within 0.03",
            "--within takes two",
        ),
        (
            "--bifurcations --track fold --in omega,drive --within 0.03,0.1,0.5",
            "--within takes two",
        ),
        (
            "--bifurcations --track fold --in omega,drive,load",
            "--in takes two",
        ),
    ] {
        let text = refused_by_response(&format!("{command} --svg {svg}"));
        assert!(text.contains(message), "{command}: {text}");
    }
    // A backbone is over the peak-to-peak, and a plane is not.
    let both = "--bifurcations --track fold --in omega,drive --backbone";
    let error = response_options(both).expect_err("a refusal");
    assert_eq!(error.exit_code(), 2);
    let (out, checkpoint) = (folder.file("a"), folder.file("checkpoint"));
    for (command, message) in [
        ("--sweep omega --from 0.9 --omega 1", "--omega"),
        ("--lyapunov --checkpoint FILE", "--checkpoint"),
        ("--phase --checkpoint FILE", "--checkpoint"),
        ("--history --checkpoint FILE", "--checkpoint"),
        ("--lyapunov --batches 1", "--batches must be at least 2"),
        ("--lyapunov --batches 0", "--batches must be at least 2"),
        (
            "--sweep drive --values 18446744073709551615",
            "at most 2^24",
        ),
        ("--sweep drive --values 16777217", "at most 2^24"),
    ] {
        let command = command.replace("FILE", &checkpoint);
        let failure = run_attractors(&format!("{command} --out {out}"), false);
        let text = failure.expect_err("a refusal").to_string();
        assert!(text.contains(message), "{command}: {text}");
    }
    assert!(!Path::new(&checkpoint).exists());
}

/// Nothing is written over something else, neither a result nor what was read.
#[test]
fn one_file_for_two_things_is_refused() {
    let folder = Folder::new("files");
    let (x, model) = (folder.file("x"), folder.file("model.txt"));
    let text = "A(x) { ddot(x) + 0.1*dot(x) + x = cos(omega*t); }";
    std::fs::write(&model, text).expect("written");
    let name = folder.0.file_name().expect("a name").to_string_lossy();
    let again = folder.file(&format!("../{name}/x"));
    for command in [
        format!("--svg {x} --csv {x}"),
        format!("--svg {x} --json {again}"),
        format!("--svg {x} --csv {x}.csv --json {x}.csv"),
        format!("--model {model} --svg {model}"),
    ] {
        let text = refused_by_response(&command);
        assert!(text.contains("more than once"), "{command}: {text}");
    }
    assert!(!Path::new(&x).exists());
    for command in [
        format!("--basin --grid 2 --out {x} --checkpoint {x}.npy"),
        format!("--history --model {x}.csv --out {x}"),
    ] {
        let failure = run_attractors(&command, false).expect_err("a refusal");
        let text = failure.to_string();
        assert!(text.contains("more than once"), "{command}: {text}");
    }
    assert_eq!(std::fs::read_to_string(&model).expect("the model"), text);
}

/// A transient that would take days ends at once.
#[test]
fn transients_can_be_ended() {
    let folder = Folder::new("ended");
    let out = folder.file("a");
    for task in ["--history", "--lyapunov"] {
        let command = format!("{task} --alpha 1 --transient 1000000000000 --out {out}");
        let outcome = run_attractors(&command, true).expect("nothing, written");
        assert!(!outcome.complete);
        let picture = std::fs::read_to_string(folder.file("a.svg")).expect("a picture");
        assert!(
            picture.starts_with("<svg") && !picture.contains("NaN"),
            "{task}"
        );
    }
    let options = attractors_options("--phase --alpha 1");
    let model = response::models::declared(&options.model);
    let mut progress = Progress::hidden();
    let cancel = Cancel::new();
    cancel.cancel();
    let task = attractors::run::Task {
        options: &options,
        system: &*model,
        cancel: &cancel,
        progress: Mutex::new(&mut progress),
    };
    let mut map = task.map(None).expect("a map");
    let mut state = [0.0, 0.0];
    let ended = task.settle(&mut map, &mut state, usize::MAX);
    assert_eq!((ended, state), (Ok(false), [0.0, 0.0]));
}

/// One row for each class of what cannot be used. Nothing is computed or written before it is refused.
#[test]
fn curves_that_cannot_be_followed_are_refused_before_any_work() {
    let folder = Folder::new("curves");
    let track = "--bifurcations --track fold --in";
    let commands = [
        (
            format!("{track} omega,drive --within nan,1"),
            "--within NaN: must be finite",
        ),
        (
            format!("{track} omega,drive --within 0.1,inf"),
            "--within inf: must be finite",
        ),
        (
            format!("{track} omega,drive --within 1,1"),
            "--within: the range from 1 to 1 is empty",
        ),
        (
            format!("{track} omega,drive --within 2,1"),
            "--within: the range from 2 to 1 is empty",
        ),
        (
            format!("{track} omega,drive --within 0.2,1"),
            "--within must hold drive = 0.1",
        ),
        (
            format!("{track} omega,zeta --within=-1,1"),
            "zeta cannot vary from -1 to 1",
        ),
        (
            format!("{track} omega,load --load 0"),
            "load cannot vary from 0 to 0",
        ),
        (format!("{track} omega,amplitude"), "no parameter amplitude"),
        (
            format!("{track} omega,omega"),
            "--in names omega more than once",
        ),
        (format!("{track} load,drive"), "load,drive"),
    ];
    all_are_refused(&folder, commands);
}

#[test]
fn branches_that_cannot_be_followed_are_refused_before_any_work() {
    let folder = Folder::new("table");
    let commands = [
        (
            "--bifurcations --search nan".to_owned(),
            "--search NaN: must be between",
        ),
        (
            "--bifurcations --search 9".to_owned(),
            "--search 9: must be between",
        ),
        (
            "--max-points 18446744073709551615".to_owned(),
            "must be from 2 to 1e9",
        ),
        (
            "--set k=1 --alpha 2".to_owned(),
            "--set k belongs to --model",
        ),
        (
            format!("--json {}", folder.file("none/a")),
            "its folder does not exist",
        ),
        (format!("--csv {}", folder.0.display()), "is a directory"),
        (format!("--model {}", folder.0.display()), "cannot read"),
        (format!("--model {}", folder.file("none")), "none: "),
    ];
    all_are_refused(&folder, commands);
}

fn all_are_refused<const N: usize>(folder: &Folder, commands: [(String, &str); N]) {
    let svg = folder.file("a.svg");
    for (command, message) in commands {
        let text = refused_by_response(&format!("{command} --svg {svg}"));
        assert!(text.contains(message), "{command}: {text}");
        assert!(text.lines().count() == 1 && text.len() < 250, "{text}");
    }
    assert_empty(folder);
}

fn assert_empty(folder: &Folder) {
    let left = std::fs::read_dir(&folder.0).expect("a folder").count();
    assert_eq!(left, 0, "nothing is written");
}

#[test]
fn motions_that_cannot_be_followed_are_refused_before_any_work() {
    let folder = Folder::new("motions");
    let (out, start) = (folder.file("a"), "--phase --starts 2");
    for (command, message) in [
        ("--basin --escape nan", "--escape NaN: must be positive"),
        ("--basin --escape -1", "--escape -1: must be positive"),
        (
            "--sweep drive --escape inf",
            "--escape inf: must be positive",
        ),
        (
            "--sweep drive --section nan",
            "--section NaN: must be finite",
        ),
        ("START --zoom nan 1 1 1", "--zoom NaN: must be finite"),
        (
            "START --zoom 1 1 1 1",
            "--zoom: the range from 1 to 1 is empty",
        ),
        (
            "START --zoom 0 1 2 1",
            "--zoom: the range from 2 to 1 is empty",
        ),
        ("START --mark inf", "--mark inf: must be finite"),
        ("START --drives 1 nan", "--drives NaN: must be finite"),
        ("--lyapunov --drives 1 nan", "--drives NaN: must be finite"),
        ("--basin --x-range nan 1", "--x-range NaN: must be finite"),
        (
            "--basin --v-range 2 1",
            "--v-range: the range from 2 to 1 is empty",
        ),
        ("--basin --start 1 2", "--start would do nothing"),
        (
            "--basin --threads 1000000",
            "--threads 1000000: must be from 1 to 1024",
        ),
        (
            "--history --periods 100000000000",
            "--periods 100000000000: must be from 0 to",
        ),
        (
            "--sweep drive --values 1000 --periods 100000",
            "must be from 0 to 10000",
        ),
        (
            "--lyapunov --batches 1000000000000",
            "--batches 1000000000000: must be from 2 to",
        ),
        ("--basin --checkpoint FOLDER", "is no checkpoint"),
        ("--basin --set k=1 --alpha 2", "--set k belongs to --model"),
    ] {
        let command = command.replace("START", start);
        let command = command.replace("FOLDER", &folder.0.display().to_string());
        let failure = run_attractors(&format!("{command} --out {out}"), false);
        let text = failure.expect_err(&command).to_string();
        assert!(text.contains(message), "{command}: {text}");
        assert!(text.lines().count() == 1 && text.len() < 250, "{text}");
    }
    let failure = run_attractors(&format!("--history --out {}/", folder.0.display()), false);
    assert!(failure.expect_err("a folder").to_string().contains("--out"));
    assert_empty(&folder);
}

/// A device without end, and a text that is too long to be a declaration.
#[cfg(target_os = "linux")]
#[test]
fn what_has_no_end_is_not_read_to_it() {
    let folder = Folder::new("endless");
    let (svg, out) = (folder.file("a.svg"), folder.file("a"));
    let text = refused_by_response(&format!("--model /dev/zero --svg {svg}"));
    assert!(text.contains("/dev/zero: it is longer than"), "{text}");
    let failure = run_attractors(
        &format!("--basin --checkpoint /dev/zero --out {out}"),
        false,
    );
    let text = failure.expect_err("a refusal").to_string();
    assert!(text.contains("/dev/zero is no checkpoint"), "{text}");
    let text = "A(x) { ddot(x) + 0.1*dot(x) + x = cos(omega*t); }";
    let long = folder.file("long.txt");
    std::fs::write(&long, text.to_owned() + &" ".repeat(4_000_000)).expect("written");
    let text = refused_by_response(&format!("--model {long} --svg {svg}"));
    assert!(text.contains("long.txt: it is longer than"), "{text}");
}

/// Without room the pictures and tables that were there stay, and nothing of new ones is left.
#[cfg(target_os = "linux")]
#[test]
fn a_device_without_room_is_an_error() {
    let folder = Folder::new("full");
    let svg = folder.file("a.svg");
    let text = refused_by_response(&format!("--to 0.65 --svg {svg} --json /dev/full"));
    assert!(
        text.contains("cannot write /dev/full: No space left"),
        "{text}"
    );
}

/// Numbers of the other programs.
#[test]
fn other_programs_refuse_before_any_work_too() {
    use hertzian_cli::{multipliers, work_precision};
    let never = Cancel::new();
    let folder = Folder::new("others");
    for (words, message) in [
        (["--patience", "nan"], "--patience NaN: must be positive"),
        (["--patience", "0"], "--patience 0: must be positive"),
        (["--budget", "inf"], "--budget inf: must be positive"),
    ] {
        let out = folder.file("a");
        let words = ["work_precision", "--out", &out].into_iter().chain(words);
        let options = work_precision::options::Options::try_parse_from(words).expect("a command");
        let quiet = &mut Progress::hidden();
        let failure = work_precision::run(&options, Vec::new(), &never, quiet);
        let text = failure.err().expect("a refusal").to_string();
        assert!(text.contains(message), "{text}");
    }
    std::fs::write(folder.file("file"), "").expect("written");
    for (words, message) in [
        (["--harmonics", "0"], "--harmonics 0: must be from 1"),
        (
            ["--harmonics", "1000000"],
            "--harmonics 1000000: must be from 1",
        ),
        (["--folder", "FILE"], "cannot write"),
    ] {
        let file = folder.file("file");
        let words = words.map(|word| if word == "FILE" { &file } else { word });
        let words = ["multipliers"].into_iter().chain(words);
        let options = multipliers::Options::try_parse_from(words).expect("a command");
        let failure = multipliers::run(&options, &never, &mut Progress::hidden());
        let text = failure.expect_err("a refusal").to_string();
        assert!(text.contains(message), "{text}");
    }
    let left = std::fs::read_dir(&folder.0).expect("a folder").count();
    assert_eq!(left, 1, "only what was there");
}
