//! Faulty declarations and the messages they get: each case is one file in `tests/compile_fail`, with its messages beside it.
//!
//! What the macros emit for a case is turned into the text that `rustc` shows, which takes no time. That `rustc` shows just that is
//! checked in `tests/refused`, a package that depends on little.
//!
//!     UPDATE_MESSAGES=1 cargo test -p hertzian-tests --test all declarations::refused
//!
//! rewrites the messages of the cases.

use std::fs;
use std::path::{Path, PathBuf};

use crate::declarations::shown;

/// The cases in alphabetical order, each with the path that `rustc` shows.
fn cases() -> Vec<(PathBuf, String)> {
    let folder = Path::new("tests/compile_fail");
    let inside = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder));
    let mut cases: Vec<(PathBuf, String)> = inside
        .expect("the folder of the cases")
        .map(|entry| entry.expect("a file of the folder").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .map(|path| {
            let name = path.file_name().expect("the name of a file");
            let shown = folder.join(name).display().to_string();
            (path, shown)
        })
        .collect();
    cases.sort();
    cases
}

#[test]
fn faulty_declarations_are_refused_where_they_are_wrong() {
    let update = std::env::var_os("UPDATE_MESSAGES").is_some();
    let cases = cases();
    assert!(!cases.is_empty());
    for (path, name) in cases {
        let text = fs::read_to_string(&path).expect("a case");
        let messages = shown::of(&text, &name);
        assert!(!messages.is_empty(), "{name} is not refused");
        let beside = path.with_extension("stderr");
        if update {
            fs::write(&beside, &messages).expect("the folder is writable");
        }
        let expected = fs::read_to_string(&beside).unwrap_or_default();
        assert!(
            messages == expected,
            "{name} has other messages:\n\n{messages}\ninstead of\n\n{expected}"
        );
    }
}
