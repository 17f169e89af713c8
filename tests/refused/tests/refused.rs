//! What `rustc` shows of faulty declarations: all cases of `tests/tests/compile_fail` in a few files, since it takes a second to start and
//! reports everything that is wrong with a file.
//!
//! Dependencies of this package are few: trybuild checks all of them, twice, with and without a width of messages.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

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

/// Each case is a module of its own, so that their names do not meet.
#[test]
fn the_compiler_shows_these_messages_and_no_others() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("refused");
    fs::create_dir_all(&folder).expect("a folder for files of tests");
    let cases = cases();
    let compiled = trybuild::TestCases::new();
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
        fs::write(path.with_extension("stderr"), messages).expect("the folder is writable");
        compiled.compile_fail(path);
    }
}
