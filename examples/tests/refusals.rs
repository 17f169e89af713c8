//! The programs `response` and `attractors`: what does not go together is refused, and what takes long can be ended.

mod folder;

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use clap::Parser;
use hertzian_examples::attractors;
use hertzian_examples::response;
use hertzian_examples::response::progress::Progress;

use folder::Folder;

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
    let never = AtomicBool::new(false);
    let failure = response::run::run(&options, &never, &mut Progress::new(false));
    let failure = failure.expect_err(command);
    assert_eq!(failure.exit_code(), 2);
    failure.to_string()
}

fn run_attractors(
    command: &str,
    interrupted: bool,
) -> Result<attractors::run::Outcome, attractors::run::Failure> {
    let interrupted = AtomicBool::new(interrupted);
    let options = attractors_options(command);
    attractors::run::run(&options, &interrupted, &mut Progress::new(false))
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
    let mut progress = Progress::new(false);
    let task = attractors::run::Task {
        options: &options,
        system: &*model,
        interrupted: &AtomicBool::new(true),
        progress: Mutex::new(&mut progress),
    };
    let mut map = task.map(None).expect("a map");
    let mut state = [0.0, 0.0];
    let ended = task.settle(&mut map, &mut state, usize::MAX);
    assert_eq!((ended, state), (Ok(false), [0.0, 0.0]));
}
