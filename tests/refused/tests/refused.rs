//! What `rustc` shows of faulty declarations: all cases of `tests/tests/compile_fail` in a few files, since it takes a second to start and
//! reports everything that is wrong with a file.
//!
//! The runtime that it is given is checked in the target folder of the tests, so that nothing else that is there is checked again.

use std::env;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

#[path = "../../tests/all/declarations/shown.rs"]
mod shown;

/// How many files hold all cases.
const FILES: usize = 4;

/// The cases in alphabetical order.
fn cases() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/compile_fail");
    let inside = fs::read_dir(folder).expect("the folder of the cases");
    let mut cases: Vec<PathBuf> = inside
        .map(|entry| entry.expect("a file of the folder").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .collect();
    cases.sort();
    cases
}

/// The file of metadata of the runtime, as cargo says that it has checked it.
fn runtime() -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent();
    let checked = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["check", "--quiet", "--offline"])
        .args(["--package", "hertzian-refused", "--test", "refused"])
        .args(["--message-format", "json", "--target-dir"])
        .arg(target.expect("the target folder"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    let shown = String::from_utf8_lossy(&checked.stderr);
    assert!(checked.status.success(), "{shown}");
    String::from_utf8_lossy(&checked.stdout)
        .lines()
        .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
        .filter(|message| message["target"]["name"] == "hertzian")
        .find_map(|message| {
            let files = message["filenames"].as_array()?;
            let files = files.iter().filter_map(serde_json::Value::as_str);
            files.map(PathBuf::from).find(|file| {
                file.extension()
                    .is_some_and(|extension| extension == "rmeta")
            })
        })
        .expect("the runtime is among what is checked")
}

/// What `rustc` shows of a file, without the sum of it.
fn compiled(path: &Path, runtime: &Path) -> String {
    let output = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
        .args(["--edition", "2024", "--emit", "metadata"])
        .arg("--diagnostic-width=140")
        .arg("-L")
        .arg(format!(
            "dependency={}",
            runtime.parent().expect("a folder").display()
        ))
        .arg("--extern")
        .arg(format!("hertzian={}", runtime.display()))
        .arg("--out-dir")
        .arg(path.parent().expect("a folder"))
        .arg(path)
        .output()
        .expect("rustc runs");
    assert!(!output.status.success(), "{} is compiled", path.display());
    let shown = String::from_utf8_lossy(&output.stderr);
    let (messages, _) = shown
        .split_once("error: aborting due to")
        .expect("a sum of the errors");
    let lines: Vec<&str> = messages.lines().map(str::trim_end).collect();
    lines.join("\n")
}

/// Each case is a module of its own, so that their names do not meet.
#[test]
fn the_compiler_shows_these_messages_and_no_others() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("refused");
    fs::create_dir_all(&folder).expect("a folder for files of tests");
    let runtime = runtime();
    let cases = cases();
    for (index, some) in cases.chunks(cases.len().div_ceil(FILES)).enumerate() {
        let mut together = "fn main() {}\n".to_owned();
        for path in some {
            let name = path.file_stem().expect("the name of a case");
            let text = fs::read_to_string(path).expect("a case");
            let name = name.display();
            let _ = write!(together, "mod {name} {{\n{text}}}\n");
        }
        let path = folder.join(format!("some_{index}.rs"));
        let messages = shown::of(&together, &path.display().to_string());
        fs::write(&path, together).expect("the folder is writable");
        assert_eq!(compiled(&path, &runtime).trim_end(), messages.trim_end());
    }
}
