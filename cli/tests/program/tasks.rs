//! What an engineer asks first, of text models alone: each in at most 30 lines of model and command. What is said is compared with the table of
//! `examples/tests/integrated/reference.tsv`, which an integration by scipy has written.

use std::path::Path;
use std::process::Command;

use crate::folder::Folder;

/// What the program says of a model of `examples/models`, in a folder that has its text as `model.txt`.
fn said(folder: &Folder, model: &str, command: &str) -> String {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/models");
    let text = std::fs::read_to_string(models.join(model)).expect("a model");
    let model_lines = text
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.trim().starts_with("//"));
    assert!(model_lines.count() < 30, "{model}");
    std::fs::write(folder.0.join("model.txt"), text).expect("written");
    run(folder, command)
}

/// What the program says in a folder.
fn run(folder: &Folder, command: &str) -> String {
    let [said, _] = told(folder, command);
    said
}

/// The same, and what it complains of.
fn told(folder: &Folder, command: &str) -> [String; 2] {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzian"));
    program
        .current_dir(&folder.0)
        .args(command.split_whitespace());
    let done = program.output().expect("the program");
    let error = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(0), "{command}: {error}");
    [String::from_utf8(done.stdout).expect("text"), error]
}

/// Rows of the table: the number of the orbit, what is said of it, of what the number is, the number.
fn rows(task: &str) -> Vec<[&'static str; 4]> {
    let table = include_str!("../../../examples/tests/integrated/reference.tsv");
    let rows = table
        .lines()
        .map(|line| line.split('\t').collect::<Vec<_>>());
    let rows = rows.filter(|row| row[0] == task);
    // A variant has no orbit but its values.
    let place = if task == "variants" { 1 } else { 2 };
    rows.map(|row| [row[place], row[3], row[4], row[5]])
        .collect()
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("{text}"))
}

/// A number as it is printed, and half a unit of its last digit.
type Printed = [f64; 2];

fn printed(word: &str) -> Option<Printed> {
    let value = word.parse().ok()?;
    let (_, decimals) = word.split_once('.').unwrap_or((word, ""));
    Some([value, 0.5 * 0.1_f64.powi(decimals.len() as i32)])
}

/// Numbers and a verdict from each line `at ...: largest of x 5.02 nm, largest of ball 0.3, stable`, those of the smallest orbit first.
fn solutions(said: &str) -> Vec<(Vec<Printed>, String)> {
    let lines = said.lines().filter(|line| line.starts_with("at  "));
    let mut found: Vec<_> = lines
        .map(|line| {
            let (_, found) = line.split_once(": ").expect(line);
            let mut parts: Vec<&str> = found.split(", ").collect();
            let verdict = parts.pop().expect(line).to_owned();
            let value = |part: &str| part.split(' ').find_map(printed);
            let values = parts.into_iter().map(|part| value(part).expect(line));
            (values.collect::<Vec<Printed>>(), verdict)
        })
        .collect();
    found.sort_by(|a, b| a.0[0][0].abs().total_cmp(&b.0[0][0].abs()));
    found
}

/// From the least to the largest of the signal of a row.
fn extent(rows: &[[&'static str; 4]], row: &[&'static str; 4]) -> f64 {
    let (signal, _) = row[2].split_once(':').expect("a measure");
    let of = |measure: &str| {
        let name = format!("{signal}:{measure}");
        let mut rows = rows.iter();
        let found = rows.find(|other| other[0] == row[0] && other[2] == name);
        number(found.expect("an extreme")[3])
    };
    of("max") - of("min")
}

/// What is said of orbits is what the table has, each of the measures, to this part of how far its signal moves and to the digits that are
/// there.
fn are_those(said: &str, task: &str, measures: &[&str], within: f64) {
    let found = solutions(said);
    let rows = rows(task);
    let orbits = rows.iter().map(|row| row[0]).max().expect("orbits");
    assert_eq!(found.len().to_string(), orbits, "{said}");
    for (index, (values, verdict)) in found.iter().enumerate() {
        for ([value, rounded], measure) in values.iter().zip(measures) {
            let wanted = |row: &&[&str; 4]| row[0] == (index + 1).to_string() && row[2] == *measure;
            let row = rows.iter().find(wanted).expect(measure);
            assert_eq!(verdict, row[1], "{said}");
            let exact = number(row[3]);
            let off = (value - exact).abs();
            assert!(
                off <= within * extent(&rows, row) + rounded,
                "{measure}: {value}, {exact}"
            );
        }
    }
}

#[test]
fn gears() {
    let folder = Folder::new("gears");
    let about = |command: &str| {
        said(
            &folder,
            "gear_mesh.txt",
            &format!("response --model model.txt {command}"),
        )
    };
    let orbits = about("--from 12000 --to 17000 --at 14000 --plot relative:rms");
    // From the largest mean square to the smallest: the teeth part more and more.
    let mut found = solutions(&orbits);
    found.reverse();
    let rows = rows("gear_mesh");
    let exact = rows.iter().filter(|row| row[2] == "relative:rms");
    for ((values, verdict), row) in found.iter().zip(exact) {
        assert_eq!(verdict, row[1]);
        assert!(
            (values[0][0] / number(row[3]) - 1.0).abs() < 1e-6,
            "{orbits}"
        );
    }
    assert!(found.len() == 3 && orbits.contains("at         omega 14000 rad/s: rms of relative"));
    let doublings = about("--from 32000 --to 38000 --one-branch --bifurcations");
    let at = doublings
        .lines()
        .filter_map(|line| line.trim().strip_prefix("period-doubling at "));
    let at: Vec<f64> = at
        .map(|line| number(line.split(' ').next().expect(line)))
        .collect();
    let exact: Vec<f64> = rows
        .iter()
        .filter(|row| row[1] == "doubling")
        .map(|row| number(row[3]))
        .collect();
    assert_eq!(at.len(), exact.len());
    assert!(
        at.iter()
            .zip(exact)
            .all(|(at, exact)| (at - exact).abs() < 1e-8 * exact),
        "{doublings}"
    );
}

/// Over torque and variation, the numbers of motions that integrations settle to.
#[test]
fn map_of_gears() {
    let folder = Folder::new("map");
    let command = "map --model model.txt --sweep load --from 1000 --to 4000 --count 4 --omega 14000 \
        --over variation --low 0.1 --high 0.3 --rows 3 --csv map.csv";
    let text = said(&folder, "gear_mesh.txt", command);
    assert!(
        text.contains("um at load = 4000 N, variation = 0.3"),
        "{text}"
    );
    let table = std::fs::read_to_string(folder.file("map.csv")).expect("a table");
    let cells: Vec<Vec<&str>> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect())
        .collect();
    let stable = |load: f64, variation: f64| {
        let is_there = |cell: &&Vec<&str>| [number(cell[0]), number(cell[1])] == [load, variation];
        cells.iter().find(is_there).expect("a cell")[2]
    };
    let counted = rows("gear_mesh")
        .into_iter()
        .find(|row| row[2] == "count")
        .expect("counts");
    let mut counted = counted[3].split(' ');
    for load in [1e3, 2e3, 4e3] {
        for variation in [0.1, 0.2, 0.3] {
            assert_eq!(
                Some(stable(load, variation)),
                counted.next(),
                "{load}, {variation}"
            );
        }
    }
}

#[test]
fn balls() {
    let folder = Folder::new("balls");
    let command = "response --model model.txt --from 0.502 --to 0.5 --one-branch \
        --at 0.5 --plot y:max,x:max,ball_1:max";
    let text = said(&folder, "ball_bearing.txt", command);
    are_those(&text, "ball_bearing", &["y:max", "x:max", "ball:max"], 1e-6);
    // The cage turns once in five periods of the excitation, and orbits take as many harmonics more.
    let [_, complaint] = told(&folder, &format!("{command} --by balance"));
    let advice = "--by shooting and --by contact-equation find the same orbits without harmonics";
    assert!(complaint.contains(advice), "{complaint}");
    let [_, complaint] = told(&folder, command);
    assert_eq!(complaint, "");
}

/// Both sides find the same three motions, and say which are stable. Forces are in units of the lever, 2 N/m.
#[test]
fn a_tip_from_both_sides() {
    let folder = Folder::new("tip");
    for (from, to) in [(14, -2), (-2, 14)] {
        let command = format!(
            "response --model model.txt --sweep distance --omega 1 --from {from} --to {to} --at 5 --one-branch --plot x:max,x:rms"
        );
        let text = said(&folder, "tip.txt", &command);
        are_those(&text, "approach", &["x:max", "x:rms"], 1e-6);
    }
}

/// In SI units; axes have prefixes.
#[test]
fn a_bolted_joint() {
    let folder = Folder::new("joint");
    let command = "response --model model.txt --from 2000 --to 3000 --at 2500 --plot opening:max,pressing:max";
    let text = said(&folder, "bolted_joint.txt", command);
    are_those(
        &text,
        "bolted_joint",
        &["opening:max", "pressing:max"],
        1e-6,
    );
    assert!(
        text.contains("um, largest of pressing") && text.contains("kN, stable"),
        "{text}"
    );
    let picture = std::fs::read_to_string(folder.0.join("response.svg")).expect("a picture");
    for words in [
        "joint = 1 GN/m^1.5",
        "the joint is open) [um]",
        "faces) [kN]",
    ] {
        assert!(picture.contains(words), "{words}");
    }
    // In the metres of the declaration the part moves by thousandths: the axis has the prefix.
    let command =
        "response --model model.txt --from 2000 --to 3000 --one-branch --plot x:p2p --axis hz";
    run(&folder, command);
    let picture = std::fs::read_to_string(folder.0.join("response.svg")).expect("a picture");
    assert!(picture.contains("aria-label=\"peak-to-peak of x [mm]\""));
    assert!(picture.contains("[Hz]"));
}

#[test]
fn a_cantilever_by_its_tip() {
    let folder = Folder::new("cantilever");
    let command =
        "response --model model.txt --from 500 --to 650 --at 600 --plot tip:max,impact:max";
    let text = said(&folder, "cantilever.txt", command);
    // The tolerance is of the tip, and the force of the stop is as exact as that times its stiffness.
    are_those(&text, "cantilever", &["tip:max", "impact:max"], 2e-6);
}

/// Values at which orbits are asked for stand behind each other with commas, as signals do, or with spaces.
#[test]
fn values_have_commas_or_spaces() {
    let folder = Folder::new("commas");
    let told = |values: &str| {
        let command =
            format!("response --from 0.6 --to 0.8 --harmonics 5 --one-branch --at {values}");
        solutions(&run(&folder, &command))
    };
    let both = told("0.65,0.7");
    assert_eq!(both.len(), 2);
    assert_eq!(both, told("0.65 0.7"));
}

/// The part of the example `variants`.
const PART: &str = "Part(x: mm) {
    param mass: t = 1e-3 > 0;
    param spring: N/mm = 10 > 0;
    param damping: N*s/mm = 2e-3 in 0.0..;
    param play: mm = 0.5 > 0;
    param stop: N/mm^1.5 = 20 in 0.0..;
    param drive: N = 0.4;
    law hertz(gap) { gap > 0 => stop*gap^1.5, else => 0 }
    mass*ddot(x) + damping*dot(x) + spring*x + hertz(x - play) = drive*cos(omega*t);
}";

const REQUEST: &str = "[request]
from = 95
to = 150
tolerance = 1e-3
stability = false
[keep]
events = [\"fold\"]
";

/// Where each variant of a table jumps down, by its number: the largest frequency of a fold, and its error.
fn jumps(table: &str) -> Vec<(f64, f64)> {
    let mut found: Vec<(f64, f64)> = Vec::new();
    for line in table.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let (value, error) = (number(cells[8]), number(cells[9]));
        let variant = number(cells[0]) as usize;
        if variant == found.len() {
            found.push((value, error));
        } else if value > found[variant].0 {
            found[variant] = (value, error);
        }
    }
    found
}

/// Three that were integrated, and a fiftieth of a thousand.
#[test]
fn a_thousand_variants() {
    let folder = Folder::new("variants");
    let write =
        |name: &str, text: &str| std::fs::write(folder.0.join(name), text).expect("written");
    write("part.txt", PART);
    let rows = rows("variants");
    let listed: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    write(
        "three.csv",
        &format!(
            "play,stop,damping\n{}\n",
            listed.join("\n").replace(' ', ",")
        ),
    );
    let variants = "model = \"part.txt\"\n[variants]\n";
    write(
        "three.toml",
        &format!("{variants}design = \"list\"\nfile = \"three.csv\"\n{REQUEST}"),
    );
    let over = "[variants.over]\nplay = { from = 0.4, to = 0.6 }\nstop = { from = 15, to = 25 }\ndamping = { from = 1.6e-3, to = 2.4e-3 }\n";
    let thousand = format!("{variants}design = \"sobol\"\ncount = 1000\n{over}{REQUEST}");
    assert!(PART.lines().count() + thousand.lines().count() < 30);
    write("thousand.toml", &thousand);
    run(&folder, "study three.toml");
    let table =
        std::fs::read_to_string(folder.0.join("three-results/results.csv")).expect("a table");
    let found = jumps(&table);
    assert_eq!(found.len(), rows.len());
    for ((jump, error), row) in found.iter().zip(&rows) {
        let off = (jump - number(row[3])).abs();
        assert!(
            off <= *error && *error < 1e-5 * jump,
            "{jump}, {error}, {row:?}"
        );
    }
    let told = run(&folder, "study thousand.toml --part 1/50");
    assert!(told.contains("of this part"), "{told}");
}
