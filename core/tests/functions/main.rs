//! Functions fit a screen, and take their parameters one by one: counted over the tokens of the runtime, of the packages below it and of
//! the compiler. A longer function says why it is one thing, by `#[expect(clippy::too_many_lines, reason = "..")]`.

mod reader;

use std::fs;
use std::path::{Path, PathBuf};

use reader::{Function, functions};

/// Lines of code in a body, without comments: as clippy counts them, by `clippy.toml`.
const SCREEN: usize = 60;

/// What is read, from the package of the runtime.
const FOLDERS: &[&str] = &[
    "src",
    "contract/src",
    "chart/src",
    "../macros/src",
    "../macros/compiler/src",
    "../macros/compiler/tests",
];

/// All files of Rust in a folder and those in it.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Fails if there is a function of which something is wrong, or if so few are read that something must have been passed over.
fn assert_none(wrong: impl Fn(&Function) -> Option<String>) {
    let runtime = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    for folder in FOLDERS {
        files(&runtime.join(folder), &mut paths);
    }
    let mut count = 0;
    let mut found = Vec::new();
    for path in paths {
        let text = fs::read_to_string(&path).expect("a file");
        for function in functions(&text) {
            count += 1;
            if let Some(wrong) = wrong(&function) {
                let Function { name, line, .. } = function;
                found.push(format!("{}:{line} {name}: {wrong}", path.display()));
            }
        }
    }
    assert!(count > 3000, "{count} functions are read");
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn functions_fit_a_screen() {
    assert_none(|function| {
        let long = function.lines > SCREEN && !function.may_be_long;
        long.then(|| format!("{} lines", function.lines))
    });
}

#[test]
fn parameters_are_not_packed_into_tuples() {
    assert_none(|function| {
        let tuple = function.tuples.first();
        tuple.map(|tuple| format!("takes {tuple}"))
    });
}

#[test]
fn planted_tuples_are_found() {
    for text in [
        "fn f((a, b): (f64, f64)) {}",
        "fn f(a: (f64, f64)) {}",
        "fn f<'a, T: A<B>>(&'a self, x: f64, (a, b): &(f64, &T)) {}",
        "impl A { pub(crate) const fn f(x: &'a mut (f64, Vec<(f64, f64)>)) -> f64 { 0.0 } }",
        "trait A { fn f(x: (f64, f64)); }",
        "mod a { fn f() { fn g((x, y): B) {} } }",
        "fn f(a: fn(A, B) -> C, b: (A, B)) {}",
    ] {
        let found = functions(text);
        assert!(found.iter().any(|f| !f.tuples.is_empty()), "{text}");
    }
}

#[test]
fn what_is_no_tuple_is_not_reported() {
    for text in [
        "fn f(a: f64, b: Vec<(f64, f64)>) -> (f64, f64) { (a, b) }",
        "fn f(range: [f64; 2], a: &[(f64, f64)], [(x, p), (y, q)]: [(f64, f64); 2]) {}",
        "fn f(a: impl Fn(f64, f64) -> (f64, f64), b: (), c: (f64)) {}",
        "fn f(A { a, b }: A, B(c, d): B) { let g = |(x, y): (f64, f64)| x; }",
        "type F = fn((f64, f64)) -> f64;",
    ] {
        let found = functions(text);
        assert!(found.iter().all(|f| f.tuples.is_empty()), "{text}");
    }
}

#[test]
fn lines_of_code_are_counted() {
    let body = "    // Why.\n\n    f(\n    ); /* a\n    b */\n".repeat(30);
    let text = format!("/// A\n#[test]\nfn a(\n) {{\n{body}}}\nfn b() {{ f() }}\nfn c();\n");
    let found = functions(&text);
    let lines: Vec<usize> = found.iter().map(|function| function.lines).collect();
    assert_eq!(lines, [60, 1, 0]);
    assert_eq!((found[0].line, found[0].may_be_long), (3, false));
    let inner = "fn a() { fn b() { /// A\n /// B\n struct C;\n }\n let x = \"\n\n\"; }";
    assert_eq!(functions(inner)[0].lines, 6);
}

#[test]
fn a_long_function_says_why() {
    let text = "#[expect(clippy::too_many_lines, reason = \"a table\")]
        #[test]
        pub(crate) fn a() {}
        #[expect(clippy::too_many_lines)]
        fn b() {}
        fn c() {}";
    let found = functions(text);
    let may_be_long: Vec<bool> = found.iter().map(|function| function.may_be_long).collect();
    assert_eq!(may_be_long, [true, false, false]);
}
