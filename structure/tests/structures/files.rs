//! Descriptions in files: what is read, and what is said of faults.

use std::fs;
use std::path::{Path, PathBuf};

use hertzian::system::System;
use hertzian_structure::{Reduction, file};
use proptest::prelude::*;

/// A folder that is gone afterwards.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("hertzian-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, text).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

const MASS: &str = "%%MatrixMarket matrix coordinate integer symmetric\n2 2 2\n1 1 1\n2 2 1\n";
const STIFFNESS: &str =
    "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 1\n2 1 -1\n2 2 2\n";
const TWO: &str = r#"name = "two masses"

[matrices]
mass = "mass.mtx"
stiffness = "stiffness.mtx"

[units]
length = "mm"
force = "N"

[damping]
stiffness = 0.03

[parameters]
drive = 0.1
gap = { value = 1, unit = "mm", min = 0.0, about = "distance of the stop" }

[[load]]
direction = { coordinates = [1] }
amplitude = "drive"

[[contact]]
name = "stop"
law = """
Stop(gap, k > 0) {
    gap > 0 => k*gap,
    else => 0,
}"""
arguments = { k = 100 }
direction = { coordinates = [0] }
offset = "gap"

[[output]]
name = "x1"
direction = { coordinates = [0], weights = [1e0] }

[[output]]
name = "closing"
kind = "rate"
direction = { coordinates = [0, 1], weights = [-1, 1] }
about = "how fast the masses come together"

[[output]]
name = "shaking"
kind = "acceleration"
direction = { coordinates = [1] }

[[output]]
name = "felt"
kind = "acceleration"
direction = { coordinates = [1], weights = [1e-3] }
unit = "m/s^2"
"#;

fn two(folder: &Folder) -> PathBuf {
    folder.write("mass.mtx", MASS);
    folder.write("stiffness.mtx", STIFFNESS);
    folder.write("two.toml", TWO)
}

#[test]
fn a_description_gives_parameters_outputs_and_units() {
    let folder = Folder::new("described");
    let structure = file::read(two(&folder)).unwrap();
    let reduced = Reduction::to(1.0).run(&structure).unwrap();
    assert_eq!(reduced.vectors(), 2);
    let model = reduced.structure(&structure).unwrap();
    let facts = model.facts();
    let names: Vec<_> = facts
        .outputs
        .iter()
        .map(|o| (o.name.as_ref(), o.unit.as_ref()))
        .collect();
    let expected = [
        ("x1", "mm"),
        ("closing", "mm/s"),
        ("shaking", "mm/s^2"),
        ("felt", "m/s^2"),
        ("stop", "N"),
    ];
    assert_eq!(names, expected);
    let about = facts.outputs[1].documentation.as_ref();
    assert_eq!(about, "how fast the masses come together");
    let gap = facts.parameters.iter().find(|p| p.name == "gap").unwrap();
    assert_eq!(
        (gap.unit.as_ref(), gap.documentation.as_ref()),
        ("mm", "distance of the stop")
    );
    assert!(!gap.admits(-1.0));
}

fn said(folder: &Folder, from: &str, to: &str) -> String {
    assert!(TWO.contains(from), "{from}");
    let path = folder.write("two.toml", TWO.replacen(from, to, 1));
    let error = file::read(&path).expect_err(to).to_string();
    assert!(!error.contains('\n'), "{error}");
    error.replace(&format!("{}", path.display()), "two.toml")
}

#[test]
fn faults_are_said_in_one_sentence_with_file_and_line() {
    let folder = Folder::new("faults");
    two(&folder);
    let said = |from, to| said(&folder, from, to);
    assert!(said("name = \"two", "name = two").starts_with("two.toml:1:"));
    assert!(said("[units]", "[unit]").starts_with("two.toml:7:"));
    assert!(
        said("\"drive\"", "\"drove\"").starts_with(
            "two.toml:20: `drove` is no parameter: those of [parameters] are drive, gap"
        )
    );
    assert!(
        said("k*gap", "q*gap").starts_with("two.toml:26: column 16 of the law: unknown name `q`")
    );
    assert!(said("{ k = 100 }", "{ c = 100 }").contains("has no argument `c`; it has k"));
    assert!(said("{ k = 100 }", "{ }").contains("needs a value of `k`"));
    assert!(
        said("[1] }", "[2] }")
            .starts_with("two.toml:19: coordinate 2, counted from zero; there are 2")
    );
    assert!(said("[1e0]", "[1, 2]").starts_with("two.toml:35: 2 weights of 1 coordinates"));
    assert!(
        said("name = \"x1\"", "name = \"stop\"")
            .starts_with("two.toml:34: the name `stop` is taken")
    );
    assert!(
        said("unit = \"mm\", min", "unit = \"s\", min")
            .contains("`gap` is in s; here stands a value in mm")
    );
    assert!(
        said("stiffness = 0.03", "stiffness = 0.03\nratio = 0.1")
            .contains("damping is a matrix, or one of")
    );
    assert!(
        said("stiffness = 0.03", "stiffness = -1.0").contains("must be finite and not negative")
    );
    assert!(said("drive = 0.1", "drive = nan").starts_with("two.toml:15:"));
    assert!(said("drive = 0.1", "omega = 0.1").contains("the name `omega` is taken"));
    assert!(said("\"mass.mtx\"", "\"none.mtx\"").contains("none.mtx"));
    assert!(
        said("kind = \"rate\"", "kind = \"speed\"")
            .starts_with("two.toml:39: unknown variant `speed`, expected one of")
    );
    let coordinates = "direction = { coordinates = [0] }";
    assert!(said(coordinates, "direction = { }").contains("a direction has `coordinates`"));
}

#[test]
fn faults_of_matrices_are_said_too() {
    let folder = Folder::new("matrices");
    let path = two(&folder);
    let said = |name: &str, text: &str, ok: &str| {
        folder.write(name, text);
        let error = file::read(&path).expect_err(text).to_string();
        folder.write(name, ok);
        error
    };
    assert!(said("mass.mtx", &MASS.replace("2 2 1", "2 2 nan"), MASS).contains("mass.mtx: line 4"));
    let larger = "%%MatrixMarket matrix coordinate real general\n3 3 3\n1 1 1\n2 2 1\n3 3 1\n";
    assert!(said("stiffness.mtx", larger, STIFFNESS).contains("the stiffness matrix is 3 by 3"));
    let general = STIFFNESS.replace("symmetric", "general");
    let text = said("stiffness.mtx", &general, STIFFNESS);
    assert!(
        text.contains("not symmetric: -1 in row 1 and column 0, 0 the other way round"),
        "{text}"
    );
    let negative = MASS.replace("1 1 1", "1 1 -1");
    assert!(said("mass.mtx", &negative, MASS).contains("mass of coordinate 0 is -1"));
}

#[test]
fn directions_may_be_arrays() {
    let folder = Folder::new("arrays");
    two(&folder);
    let mut array = b"\x93NUMPY\x01\x00".to_vec();
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }\n";
    array.extend((header.len() as u16).to_le_bytes());
    array.extend(header.as_bytes());
    array.extend([0.5_f64, -0.5].iter().flat_map(|x| x.to_le_bytes()));
    folder.write("both.npy", &array);
    let text = TWO.replace(
        "{ coordinates = [0], weights = [1e0] }",
        "{ file = \"both.npy\" }",
    );
    let structure = file::read(folder.write("two.toml", &text)).unwrap();
    assert!(Reduction::to(1.0).run(&structure).is_ok());
    // What claims rows without numbers has none.
    let empty = |shape: &str| {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
        let mut array = b"\x93NUMPY\x01\x00".to_vec();
        array.extend((header.len() as u16).to_le_bytes());
        array.extend(header.as_bytes());
        folder.write("mass.npy", array);
        let text = TWO.replace("mass.mtx", "mass.npy");
        let path = folder.write("two.toml", text);
        file::read(path).unwrap_err().to_string()
    };
    for shape in ["(0, 99999999999)", "(99999999999, 0)"] {
        assert!(empty(shape).contains("a row and a column at least"));
    }
    folder.write("two.toml", &text);
    folder.write("both.npy", &array[..array.len() - 1]);
    let error = file::read(Path::new(&folder.0).join("two.toml")).unwrap_err();
    assert!(error.to_string().contains("after 1 of 2 numbers"));
}

/// By its first words, which MATLAB and scipy write, or by the end of its name, as one of version 4 has no such words.
#[test]
fn files_of_matlab_are_refused_with_what_to_do() {
    let folder = Folder::new("matlab");
    two(&folder);
    let said = |name: &str, bytes: &[u8], from: &str, to: &str| {
        let path = folder.write(name, bytes);
        let text = TWO.replacen(from, &to.replace("FILE", name), 1);
        let error = file::read(folder.write("two.toml", text)).unwrap_err();
        let said = error.to_string();
        let place = path.display().to_string();
        assert!(said.starts_with(&place), "{said}");
        said[place.len()..].to_owned()
    };
    let by_matlab = b"MATLAB 5.0 MAT-file, Platform: GLNXA64, Created on: Mon Jan  5 10:00:00 2026";
    let by_scipy = b"MATLAB 5.0 MAT-file Platform: posix, Created on: Mon Jan  5 10:00:00 2026";
    let files: [(&str, &[u8]); 4] = [
        ("K.mat", by_matlab),
        ("K.dat", by_scipy),
        ("K.MAT", b"\0\0\0\0\x01\0\0\0"),
        ("empty.mat", b""),
    ];
    let matrix = ": files of MATLAB are not read: what `scipy.io.loadmat`, or `h5py` of version 7.3, reads of it is written as it is taken here by `scipy.io.mmwrite`";
    let array = matrix.replace("scipy.io.mmwrite", "numpy.save");
    for (name, bytes) in files {
        assert_eq!(said(name, bytes, "stiffness.mtx", "FILE"), matrix);
        let direction = "{ coordinates = [0], weights = [1e0] }";
        assert_eq!(said(name, bytes, direction, "{ file = \"FILE\" }"), array);
    }
    folder.write("K.mat", STIFFNESS);
    let text = TWO.replace("stiffness.mtx", "K.mat");
    assert!(file::read(folder.write("two.toml", text)).is_ok());
}

/// What stands in place of a part of a text: characters of the format, and numbers that are too large.
fn put() -> impl Strategy<Value = String> {
    let parts = prop::sample::select(vec![
        "",
        "-",
        "0",
        "1e400",
        "nan",
        "[",
        "]",
        "{",
        "}",
        "=",
        "\"",
        "\n",
        "9999999999",
        "18446744073709551616",
        "omega",
        "first = 0",
        "[[contact]]",
        "[[load]]",
        "\u{fffd}",
        "%",
        "gap",
        "-drive",
        "../",
        ".npy",
        ".mat",
        "MATLAB ",
    ]);
    prop::collection::vec(parts, 0..3).prop_map(|parts| parts.concat())
}

fn damaged(text: &str, at: usize, cut: usize, put: &str) -> String {
    let boundary = |place: usize| {
        (0..=place.min(text.len()))
            .rev()
            .find(|&i| text.is_char_boundary(i))
    };
    let (begin, end) = (boundary(at).unwrap_or(0), boundary(at + cut).unwrap_or(0));
    format!("{}{put}{}", &text[..begin], &text[end..])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// A description or a matrix that is cut, changed or put into is read, and reduced, or refused in one sentence that begins with its file.
    #[test]
    fn damaged_descriptions_are_read_or_refused(which in 0..3_usize, at in 0..TWO.len(), cut in 0..30_usize, put in put()) {
        let folder = Folder::new("damaged");
        let path = two(&folder);
        let (name, text) = [("two.toml", TWO), ("mass.mtx", MASS), ("stiffness.mtx", STIFFNESS)][which];
        folder.write(name, damaged(text, at % text.len(), cut, &put));
        let said = match file::read(&path) {
            Ok(structure) => Reduction::to(1.0).run(&structure).err().map(|error| error.to_string()),
            Err(error) => {
                let said = error.to_string();
                let place = said.trim_start_matches("cannot read ");
                prop_assert!(place.starts_with(&folder.0.display().to_string()), "{}", said);
                Some(said)
            }
        };
        if let Some(said) = said {
            prop_assert!(!said.contains('\n') && !said.is_empty(), "{}", said);
        }
    }
}
