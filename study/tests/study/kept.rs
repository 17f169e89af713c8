//! What is kept: the same bytes for any number of threads and parts, after interruptions and damage.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use crate::common::{Folder as Temporary, study, unprepared};
use hertzian::{Cancel, OrbitMethodKind};
use hertzian_study::{
    Folder, Keep, Part, Plan, Prepared, Ran, Request, Runner, Spread, Study, Variants,
};

const COUNT: usize = 30;

fn run(study: &Prepared, path: &Path, part: Part, threads: usize) -> Ran {
    let folder = Folder::open(path, study).expect("a folder");
    let runner = Runner::new(study, &folder).part(part).threads(threads);
    runner
        .run(&mut |_| ControlFlow::Continue(()))
        .expect("a run")
}

fn merged(study: &Prepared, paths: &[&Path]) -> Vec<u8> {
    let folders = paths
        .iter()
        .map(|path| Folder::existing(path, study).expect("a folder"));
    let merged = study.merge(&folders.collect::<Vec<_>>()).expect("a table");
    assert_eq!((merged.variants, merged.lost()), (COUNT, 0));
    fs::read(paths[0].join("results.csv")).expect("a table")
}

/// The table as it is without files and threads.
fn expected(study: &Prepared) -> Vec<u8> {
    let mut text = study
        .columns()
        .iter()
        .map(|column| column.name.as_str())
        .collect::<Vec<_>>()
        .join(",");
    for row in (0..COUNT).flat_map(|index| study.rows(index)) {
        let values: Vec<String> = row
            .iter()
            .map(|value| match value {
                hertzian_study::Value::Missing => String::new(),
                hertzian_study::Value::Whole(value) => value.to_string(),
                hertzian_study::Value::Number(value) => format!("{value:?}"),
                hertzian_study::Value::Text(text) => text.clone(),
                other => panic!("{other:?}"),
            })
            .collect();
        text.push('\n');
        text += &values.join(",");
    }
    (text + "\n").into_bytes()
}

#[test]
fn threads_and_parts_give_the_same_bytes() {
    let (study, folder) = (study(COUNT), Temporary::new("same"));
    let expected = expected(&study);
    for threads in [1, 2, 5] {
        let path = folder.join(&format!("threads{threads}"));
        let ran = run(&study, &path, Part::WHOLE, threads);
        assert_eq!((ran.computed, ran.before, ran.asked), (COUNT, 0, COUNT));
        assert_eq!(merged(&study, &[&path]), expected);
    }
    // Parts in one folder, and in folders of their own.
    let one = folder.join("one");
    let several: Vec<_> = (1..=3)
        .map(|number| folder.join(&format!("part{number}")))
        .collect();
    for number in 1..=3 {
        let part = Part::new(number, 3).expect("a part");
        let in_one = run(&study, &one, part, 1);
        let alone = run(&study, &several[number - 1], part, 2);
        assert_eq!(
            [in_one.computed, in_one.before],
            [alone.computed, alone.before]
        );
    }
    assert_eq!(merged(&study, &[&one]), expected);
    let paths: Vec<&Path> = several.iter().map(std::path::PathBuf::as_path).collect();
    assert_eq!(merged(&study, &paths), expected);
    assert!(Part::new(0, 3).is_err() && Part::new(4, 3).is_err());
}

#[test]
fn an_interrupted_run_goes_on_and_computes_nothing_twice() {
    let (study, folder) = (study(COUNT), Temporary::new("resumed"));
    let expected = expected(&study);
    let path = folder.join("results");
    let mut before = 0;
    for stop in [1, 5, 9, 6] {
        let kept = Folder::open(&path, &study).expect("a folder");
        let mut told = 0;
        let cancel = Cancel::new();
        let runner = Runner::new(&study, &kept).threads(1).cancel(&cancel);
        let ran = runner.run(&mut |progress| {
            told += 1;
            assert_eq!(progress.total, Some(COUNT));
            if told == stop {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        let ran = ran.expect("a run");
        assert!(ran.interrupted);
        // The token is the caller's: it goes on with other things.
        assert!(!cancel.is_cancelled());
        assert_eq!(ran.before, before);
        // Whole blocks of four.
        assert_eq!(ran.computed, stop / 4 * 4);
        before += ran.computed;
    }
    let ran = run(&study, &path, Part::WHOLE, 2);
    assert_eq!((ran.computed, ran.before), (COUNT - before, before));
    assert_eq!(merged(&study, &[&path]), expected);
}

#[test]
fn a_run_ends_with_the_token_of_its_caller() {
    let (study, folder) = (study(COUNT), Temporary::new("cancelled"));
    let kept = Folder::open(folder.join("results"), &study).expect("a folder");
    let cancel = Cancel::new();
    let runner = Runner::new(&study, &kept).threads(1).cancel(&cancel);
    let mut told = 0;
    let ran = runner.run(&mut |_| {
        told += 1;
        if told == 6 {
            cancel.cancel();
        }
        ControlFlow::Continue(())
    });
    let ran = ran.expect("a run");
    assert!(ran.interrupted);
    assert_eq!((ran.computed, told), (4, 6));
}

#[test]
fn damaged_blocks_are_said_and_computed_once_more() {
    let (study, folder) = (study(COUNT), Temporary::new("damaged"));
    let path = folder.join("results");
    run(&study, &path, Part::WHOLE, 2);
    let good = merged(&study, &[&path]);
    let block = |number: usize| path.join(format!("blocks/{number:08}.csv"));
    // Cut short, changed in one digit, of another place, and gone.
    let text = fs::read_to_string(block(1)).expect("a block");
    fs::write(block(1), &text[..text.len() / 2]).expect("written");
    let text = fs::read_to_string(block(2)).expect("a block");
    fs::write(block(2), text.replacen("0.", "1.", 1)).expect("written");
    fs::copy(block(3), block(4)).expect("a copy");
    fs::remove_file(block(5)).expect("removed");
    fs::write(block(6), [0xff, 0xfe]).expect("written");
    let kept = Folder::existing(&path, &study).expect("a folder");
    let merged_before = study.merge(&[kept]).expect("a table");
    assert_eq!(merged_before.missing, [[4, 11], [16, 27]]);
    assert_eq!((merged_before.lost(), merged_before.damaged.len()), (20, 4));
    let ran = run(&study, &path, Part::WHOLE, 2);
    assert_eq!((ran.computed, ran.before, ran.damaged.len()), (20, 10, 4));
    assert_eq!(merged(&study, &[&path]), good);
}

#[test]
fn a_folder_of_another_study_or_that_cannot_be_written_is_said() {
    let (one, other, folder) = (study(COUNT), study(COUNT + 1), Temporary::new("other"));
    let path = folder.join("results");
    Folder::open(&path, &one).expect("a folder");
    let error = Folder::open(&path, &other)
        .expect_err("another study")
        .to_string();
    assert!(
        error.contains("`count = 30` there, and `count = 31` here"),
        "{error}"
    );
    assert!(Folder::existing(folder.join("nowhere"), &one).is_err());
    fs::write(folder.join("file"), "").expect("written");
    let error = Folder::open(folder.join("file"), &one).expect_err("a file");
    assert!(format!("{error:?}").starts_with("cannot use "), "{error:?}");
}

/// Seeds beyond 2^63 - 1, up to which the format of the file promises whole numbers, are written and read too.
#[test]
fn studies_of_the_largest_seeds_are_told_apart() {
    let folder = Temporary::new("seeds");
    let of = |seed: u64| unprepared(COUNT).seed(seed).prepare().expect("a study");
    let path = folder.join("results");
    Folder::open(&path, &of(u64::MAX)).expect("a folder");
    let text = fs::read_to_string(path.join("study.toml")).expect("a study");
    let plan = Plan::parse(&text, Path::new("study.toml")).expect("a plan");
    assert_eq!(plan.seed, u64::MAX);
    assert!(Folder::open(&path, &of(u64::MAX - 1)).is_err());
}

/// A block that cannot be written ends the run; those that were written stay.
#[test]
fn what_cannot_be_written_loses_nothing_else() {
    let (study, folder) = (study(COUNT), Temporary::new("unwritable"));
    let path = folder.join("results");
    let kept = Folder::open(&path, &study).expect("a folder");
    // A folder stands where the file of block 3 is to be.
    fs::create_dir(path.join("blocks/00000003.csv")).expect("a folder");
    let cancel = Cancel::new();
    let runner = Runner::new(&study, &kept).threads(1).cancel(&cancel);
    let error = runner
        .run(&mut |_| ControlFlow::Continue(()))
        .expect_err("no file");
    assert!(!cancel.is_cancelled());
    assert!(format!("{error:?}").contains("00000003.csv"), "{error:?}");
    fs::remove_dir(path.join("blocks/00000003.csv")).expect("removed");
    let ran = run(&study, &path, Part::WHOLE, 1);
    assert_eq!((ran.before, ran.computed), (12, COUNT - 12));
}

hertzian::oscillator! {
    /// It is followed by the contact equation, which has no means.
    Stopped(x) {
        param k = 10 > 0;
        law stop(gap) { gap > 0 => k*gap, else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - 1) = 0.3*cos(omega*t);
    }
}

/// Who reads a branch that was kept has no model that it could be completed with.
#[test]
fn branches_that_are_kept_have_everything() {
    let folder = Temporary::new("branches");
    let mut keep = Keep::new();
    keep.branches = true;
    let study = Study::of(&Stopped::default())
        .variants(Variants::sobol(2).over("k", Spread::uniform(8.0, 12.0)))
        .request(Request::response(0.8, 0.9))
        .keep(keep)
        .prepare()
        .expect("a study");
    let path = folder.join("kept");
    run(&study, &path, Part::WHOLE, 1);
    for variant in 0..2 {
        let file = path.join(format!("branches/{variant:08}-0.json"));
        let branch = hertzian::Branch::read(file).expect("a branch");
        assert_eq!(branch.method(), Some(OrbitMethodKind::ContactEquation));
        for point in &branch.points {
            assert!(point.motion().rms.is_some() && point.observed.contacts.len() == 1);
        }
    }
}
