//! What was interrupted or killed goes on to the same bytes.

use hertzian::Cancel;
use hertzian_cli::attractors::options::Options;
use hertzian_cli::attractors::run::{Failure, Outcome, run};
use hertzian_cli::response::progress::Progress;

use super::{options, rows, run_in};
use crate::cancels::CancelsWhereWritten;
use crate::folder::Folder;

/// What the run that is killed computes, and where it keeps it.
const TO_BE_KILLED: [&str; 7] = ["--basin", "--alpha", "1", "--drive", "1", "--grid", "128"];

/// A run that is cancelled when it says for the first time how far it is.
fn cancelled_at_once(options: &Options) -> Result<Outcome, Failure> {
    let now = Cancel::new();
    let mut progress = Progress::to(CancelsWhereWritten(now.clone()));
    run(options, &now, &mut progress)
}

const CHECKPOINT: &str = "HERTZIAN_TEST_CHECKPOINT";

/// Ended by Ctrl-C and started again, with another number of threads: the same bytes as without.
#[test]
fn a_basin_that_was_interrupted_goes_on_to_the_same_bytes() {
    let folder = Folder::new("resumed");
    let (checkpoint, out) = (folder.file("checkpoint"), folder.file("part"));
    let task = ["--basin", "--alpha", "1", "--drive", "1", "--grid", "40"];
    run_in(&folder, "whole", &task).expect("basins");
    let kept = ["--checkpoint", &checkpoint, "--out", &out];
    let part = options(&[&task[..], &kept, &["--threads", "1"]].concat());
    let outcome = cancelled_at_once(&part).expect("part of it");
    assert!(!outcome.complete);
    assert!(
        outcome.summary.contains("not looked at"),
        "{}",
        outcome.summary
    );
    let outcome = run_in(
        &folder,
        "part",
        &[&task[..], &kept[..2], &["--threads", "2"]].concat(),
    );
    assert!(outcome.expect("the rest").complete);
    assert_eq!(folder.results("part"), folder.results("whole"));
    // The checkpoint belongs to this request, and to this law.
    for change in [["--grid", "41"], ["--alpha", "1.5"]] {
        let other = [&task[..], &change, &kept[..2]].concat();
        let failure = run_in(&folder, "other", &other).expect_err("a refusal");
        assert!(
            failure.to_string().contains("another computation"),
            "{failure}"
        );
    }
}

/// The other process of the next test; alone it does nothing.
#[test]
fn a_run_that_is_killed() {
    if let Ok(checkpoint) = std::env::var(CHECKPOINT) {
        let out = format!("{checkpoint}-unwanted");
        let kept = ["--checkpoint", &checkpoint, "--out", &out];
        let task = [&TO_BE_KILLED[..], &kept].concat();
        let never = Cancel::new();
        run(&options(&task), &never, &mut Progress::hidden()).expect("basins");
    }
}

/// Killed at half of its work, without a word, and started again: the same bytes as without.
#[test]
fn a_basin_that_was_killed_goes_on_to_the_same_bytes() {
    let folder = Folder::new("killed");
    let file = |name: &str| folder.0.join(name);
    let size = |name: &str| std::fs::metadata(file(name)).map_or(0, |data| data.len());
    let logs = ["whole.log", "part.log"].map(|name| folder.file(name));
    let whole = [&TO_BE_KILLED[..], &["--checkpoint", &logs[0]]].concat();
    run_in(&folder, "whole", &whole).expect("basins");
    let test = std::env::current_exe().expect("this program");
    let mut child = std::process::Command::new(test)
        .args(["--exact", "attractors::resumed::a_run_that_is_killed"])
        .env(CHECKPOINT, file("part.log"))
        .stdout(std::process::Stdio::null())
        .spawn()
        .expect("another process");
    while size("part.log") < size("whole.log") / 2 {
        assert!(
            child.try_wait().expect("a child").is_none(),
            "it ended by itself"
        );
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child.kill().expect("it is killed");
    child.wait().expect("it ends");
    let kept = size("part.log");
    assert!(kept < size("whole.log"), "it was killed too late");
    let part = [&TO_BE_KILLED[..], &["--checkpoint", &logs[1]]].concat();
    run_in(&folder, "part", &part).expect("the rest");
    assert_eq!(folder.results("part"), folder.results("whole"));
    assert_eq!(size("part.log"), size("whole.log"));
}

#[test]
fn a_sweep_that_was_interrupted_goes_on_to_the_same_bytes() {
    let folder = Folder::new("sweep");
    let checkpoint = folder.file("checkpoint");
    let task = [
        "--sweep",
        "omega",
        "--alpha",
        "1",
        "--drive",
        "0.5",
        "--from",
        "0.9",
        "--to",
        "1.1",
        "--values",
        "5",
        "--up",
        "--down",
        "--transient",
        "50",
        "--periods",
        "5",
    ];
    run_in(&folder, "whole", &task).expect("rows");
    let kept = [&task[..], &["--checkpoint", &checkpoint]].concat();
    let out = folder.file("part");
    let part = options(&[&kept[..], &["--out", &out]].concat());
    for _ in 0..3 {
        let outcome = cancelled_at_once(&part).expect("a row more");
        assert!(!outcome.complete);
    }
    assert_eq!(rows(&folder.text("part.csv")).len(), 3 * 5);
    assert!(run_in(&folder, "part", &kept).expect("the rest").complete);
    assert_eq!(folder.results("part"), folder.results("whole"));
}
