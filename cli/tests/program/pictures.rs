//! Charts by the program: scales, events by choice, harmonics upon each other, several files, waterfalls, panels.

use std::process::Command;

use crate::folder::Folder;

/// What the program prints, and what it complains of.
fn run(args: &[&str]) -> (bool, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_hertzian"))
        .args(args)
        .output()
        .expect("it runs");
    let said = [output.stdout, output.stderr].concat();
    (
        output.status.success(),
        String::from_utf8(said).expect("text"),
    )
}

fn done(args: &[&str]) -> String {
    let (success, said) = run(args);
    assert!(success, "{said}");
    said
}

fn refused(args: &[&str]) -> String {
    let (success, said) = run(args);
    assert!(!success, "{said}");
    said
}

/// A curve for each value of a parameter from files, upon each other and above each other; of two models by their names.
#[test]
fn files_of_several_values_are_drawn_in_one_chart() {
    let folder = Folder::new("pictures");
    let [svg, other] = ["a.svg", "d.json"].map(|name| folder.file(name));
    let base = [
        "response",
        "--harmonics",
        "5",
        "--one-branch",
        "--svg",
        &svg,
    ];
    let files = [("0.05", "a.json"), ("0.1", "b.json"), ("0.15", "c.json")].map(|(drive, name)| {
        let path = folder.file(name);
        let own = [
            "--alpha",
            "1.5",
            "--continuous",
            "--drive",
            drive,
            "--json",
            &path,
        ];
        done(&[&base[..], &own].concat());
        path
    });
    let show = ["show", &files[2], &files[0], &files[1], "--svg", &svg];
    let said = done(&show);
    assert!(said.contains("c.json: branch 1\n"), "{said}");
    let read = || std::fs::read_to_string(&svg).expect("a picture");
    let picture = read();
    for part in [
        "drive = 0.05",
        "drive = 0.1",
        "drive = 0.15",
        "zeta = 0.032, load = 1",
    ] {
        assert!(picture.contains(part), "{part}");
    }
    done(&[&show[..], &["--waterfall", "drive"]].concat());
    assert!(read().contains("above the last"));
    done(&[&show[..], &["--waterfall", "drive", "--scale", "db"]].concat());
    assert!(read().contains("dB above the last"));
    let said = refused(&[&show[..], &["--waterfall", "omega"]].concat());
    assert!(
        said.contains("must be another one than the parameter"),
        "{said}"
    );
    let said = refused(&[&show[..], &["--waterfall", "force"]].concat());
    assert!(said.contains("there is no parameter force"), "{said}");
    // Over another axis they do not go together.
    let drive = [
        "--sweep", "drive", "--from", "0.05", "--to", "0.1", "--omega", "0.9", "--json", &other,
    ];
    done(&[&base[..], &["--continuous"], &drive].concat());
    let said = refused(&["show", &files[0], &other, "--svg", &svg]);
    assert!(said.contains("branch 2 has drive without a unit"), "{said}");
}

#[test]
fn panels_and_scales_are_drawn_or_refused_in_a_sentence() {
    let folder = Folder::new("panels");
    let [svg, page] = ["a.svg", "b.svg"].map(|name| folder.file(name));
    let base = [
        "response", "--alpha", "1", "--from", "0.9", "--to", "1.2", "--svg", &svg,
    ];
    done(
        &[
            &base[..],
            &["--at", "1", "--panels", &page, "--scale", "log"],
        ]
        .concat(),
    );
    let picture = std::fs::read_to_string(&page).expect("a page");
    for part in [
        "spectrum of x at ω = 1",
        "x over the period at ω = 1",
        "force of contact",
    ] {
        assert!(picture.contains(part), "{part}");
    }
    let said = refused(&[&base[..], &["--panels", &page]].concat());
    assert!(said.contains("--at"), "{said}");
    let said = refused(&[&base[..], &["--plot", "x:min", "--scale", "db"]].concat());
    assert!(
        said.contains("which has no place on a logarithmic axis"),
        "{said}"
    );
    let said = refused(&[&base[..], &["--events", "folds"]].concat());
    assert!(said.contains("there are fold, period-doubling"), "{said}");
    let said = refused(&[&base[..], &["--stack", "2", "--plot", "x:rms"]].concat());
    assert!(
        said.contains("are shown by their amplitudes: ask for x alone, not for its rms"),
        "{said}"
    );
    let said = refused(&[&base[..], &["--stack", "2", "--backbone"]].concat());
    assert!(said.contains("leave one out"), "{said}");
}
