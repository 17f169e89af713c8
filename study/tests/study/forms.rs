//! The table as other programs read it, and pictures of it.

use std::fs;
use std::ops::ControlFlow;

use hertzian::Cancel;
use hertzian_study::{
    Folder, Format, Picture, Prepared, Request, Runner, Shown, Spread, Study, Variants, Which,
};

use crate::common::{Folder as Temporary, unprepared};

hertzian::oscillator! {
    /// One-sided contact with a linear spring.
    OneSided(x) {
        param zeta = 0.032 in 0.0..;
        param drive = 0.1;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

fn computed(study: &Prepared, folder: &std::path::Path) -> Folder {
    let folder = Folder::open(folder, study).expect("a folder");
    let runner = Runner::new(study, &folder).threads(1);
    runner
        .run(&mut |_| ControlFlow::Continue(()))
        .expect("a run");
    folder
}

#[test]
fn a_structured_array_has_the_bytes_that_its_header_says() {
    let temporary = Temporary::new("forms");
    let study = unprepared(3).formats([Format::Csv, Format::Jsonl, Format::Npy]);
    let study = study.prepare().expect("a study");
    let folder = computed(&study, &temporary.join("results"));
    let merged = study.merge(&[folder]).expect("tables");
    assert_eq!(merged.rows, 6);
    let array = fs::read(temporary.join("results/results.npy")).expect("an array");
    assert_eq!(&array[..8], b"\x93NUMPY\x02\x00");
    let length = u32::from_le_bytes(array[8..12].try_into().expect("four bytes")) as usize;
    assert_eq!((length + 12) % 64, 0);
    let header = String::from_utf8_lossy(&array[12..12 + length]).into_owned();
    assert!(
        header.starts_with(
            "{'descr': [('variant', '<i8'), ('k', '<f8'), ('drive', '<f8'), ('row', '|S2'), "
        ),
        "{header}"
    );
    assert!(
        header.contains("'shape': (6,)") && header.ends_with('\n'),
        "{header}"
    );
    // variant, k, drive, "at", kind, branch, period, value, error, x:p2p, size_error, verdict, ended
    let row =
        8 * 3 + 2 + 1 + 8 * 2 + 8 * 4 + "undecided".len() + "reached the end of the range".len();
    assert_eq!(array.len() - 12 - length, 6 * row);
    let second = &array[12 + length + row..];
    assert_eq!(
        f64::from_le_bytes(second[8..16].try_into().expect("eight bytes")),
        study.values(0)[0]
    );
    let lines = fs::read_to_string(temporary.join("results/results.jsonl")).expect("lines");
    let last: serde_json::Value =
        serde_json::from_str(lines.lines().last().expect("a line")).expect("JSON");
    assert_eq!(
        (last["variant"].as_u64(), last["value"].as_f64()),
        (Some(2), Some(2.5))
    );
    assert_eq!(last["k"].as_f64(), Some(study.values(2)[0]));
    assert!(last.get("error").is_none());
}

/// The contact is never lost at the smaller drive; at the larger one the response bends, with folds at 0.7151 and 0.9602 (Wang et al.,
/// 2021, figure 5a): two stable orbits between them, one elsewhere.
#[test]
fn a_map_has_the_cells_of_the_rows() {
    let temporary = Temporary::new("map");
    let variants = Variants::grid().over("drive", Spread::list(&[0.02, 0.1]));
    let request = Request::solutions(0.65, 1.05, &[0.68, 0.8, 0.9, 1.0]);
    let picture = |of: &str| Picture::map(of).tracks(of == "stable");
    let study = Study::of(&OneSided::default())
        .variants(variants)
        .request(request);
    let study = study.pictures([picture("stable"), picture("largest"), picture("verdict")]);
    let study = study.prepare().expect("a study");
    let folder = computed(&study, &temporary.join("results"));
    let files = study.draw(&[folder], &Cancel::new()).expect("pictures");
    assert_eq!(files.len(), 3);
    let text = fs::read_to_string(&files[0]).expect("a picture");
    for said in ["1 stable orbit", "2 stable orbits", "folds"] {
        assert!(text.contains(said), "{said}");
    }
    assert!(
        fs::read_to_string(&files[2])
            .expect("a picture")
            .contains("stable and unstable")
    );
}

#[test]
fn histograms_and_fans_say_their_quantiles() {
    let temporary = Temporary::new("fan");
    let fan = Picture::fan();
    let study = unprepared(8).pictures([fan, Picture::histogram("fold", Which::Lowest)]);
    let study = study.prepare().expect("a study");
    let folder = computed(&study, &temporary.join("results"));
    let files = study.draw(&[folder], &Cancel::new()).expect("pictures");
    let text = fs::read_to_string(&files[0]).expect("a picture");
    assert!(text.contains("median") && text.contains("95 %"));
    let text = fs::read_to_string(&files[1]).expect("a picture");
    assert!(text.contains("no variant has an event of kind fold"));
    let refused = Study::of(&OneSided::default())
        .variants(Variants::sobol(8).over("drive", Spread::uniform(0.1, 0.2)))
        .request(Request::response(0.65, 1.05));
    for shown in [Shown::Map, Shown::Fan] {
        let mut picture = Picture::fan();
        picture.what = shown;
        assert!(refused.clone().pictures([picture]).prepare().is_err());
    }
}

#[test]
fn a_map_of_too_many_cells_is_refused_before_anything_is_computed() {
    let at: Vec<f64> = (0..1000).map(|n| 0.65 + 4e-4 * f64::from(n)).collect();
    let study = Study::of(&OneSided::default())
        .variants(Variants::grid().over("drive", Spread::even(0.02, 0.1, 1000)))
        .request(Request::solutions(0.65, 1.05, &at));
    assert!(study.prepare().is_ok());
    let study = study.pictures([Picture::map("stable")]);
    let error = study.prepare().expect_err("a map").to_string();
    assert!(
        error.contains("a map of 1000000 cells: at most 262144"),
        "{error}"
    );
}
