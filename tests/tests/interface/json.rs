//! Branches that are written, read, and given their model back.

use std::path::PathBuf;

use hertzian::attractors::basin::{Axis, Basin, Basins, Grid};
use hertzian::attractors::sweep::{Sweep, Swept};
use hertzian::error::ErrorKind;
use hertzian::stability::Method;
use hertzian::{
    Branch, Error, EventKind, FrequencyResponse, RequestError, Shooting, Side, Verdict,
};

hertzian::oscillator! {
    OneSided(x) {
        param zeta in 0.0..;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

mod other {
    hertzian::oscillator! {
        pub OneSided(x) {
            param zeta in 0.0..;
            param drive;
            law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
            ddot(x) + contact(x) = drive*cos(omega*t) + 2;
        }
    }
}

const MODEL: OneSided = OneSided {
    zeta: 0.032,
    drive: 0.1,
};

/// A file of its own for each test.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let name = format!("hertzian-json-{name}-{}", std::process::id());
        Self(std::env::temp_dir().join(name))
    }

    fn read(&self, text: &str) -> Error {
        std::fs::write(&self.0, text).expect("written");
        Branch::read(&self.0).expect_err("it is none")
    }

    fn exchanged(&self, branch: &Branch) -> Branch {
        branch.write(&self.0).expect("written");
        Branch::read(&self.0).expect("read")
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

fn by_balance() -> Branch {
    let request = FrequencyResponse::of(&MODEL).from(0.6).to(1.2);
    request.run().expect("a branch")
}

fn by_shooting() -> Branch {
    let request = FrequencyResponse::of(&MODEL).by(Shooting::new());
    request.from(0.6).to(1.2).run().expect("a branch")
}

#[test]
fn what_is_read_is_what_was_written() {
    let scratch = Scratch::new("equal");
    for branch in [by_balance(), by_shooting()] {
        assert!(branch.points.len() > 10 && branch.folds().count() > 0);
        let read = scratch.exchanged(&branch);
        assert_eq!(read, branch);
        assert_eq!(read.to_csv(), branch.to_csv());
    }
}

#[test]
fn numbers_that_json_does_not_have_are_not_lost() {
    let scratch = Scratch::new("numbers");
    let request = FrequencyResponse::of(&MODEL).from(0.6).to(0.7);
    let mut branch = request.stability(false).run().expect("a branch");
    branch.points[0].value = -0.0;
    branch.points[1].error = Some(f64::NAN);
    branch.points[2].error = Some(f64::NEG_INFINITY);
    branch.points[3].error = None;
    let read = scratch.exchanged(&branch);
    assert_eq!(read.points[0].value.to_bits(), (-0.0_f64).to_bits());
    assert!(read.points[1].error.is_some_and(f64::is_nan));
    assert_eq!(read.points[2].error, Some(f64::NEG_INFINITY));
    assert_eq!(read.points[3].error, None);
    assert_eq!(read.points[0].stability.error, f64::INFINITY);
}

#[test]
fn a_branch_without_its_model_computes_nothing() {
    let scratch = Scratch::new("detached");
    for branch in [by_balance(), by_shooting()] {
        let read = scratch.exchanged(&branch);
        assert!(read.system().is_none());
        let fold = read.folds().next().expect("a fold");
        let refused = [
            read.at(1.0).err(),
            read.switch(fold, Side::One).err(),
            read.track(fold, "drive", [0.05, 0.2]).err(),
        ];
        for error in refused {
            let error = error.expect("there is no model");
            assert_eq!(error.downcast_ref(), Some(&RequestError::Detached));
        }
    }
}

#[test]
fn with_its_model_it_computes_the_same_orbits() {
    let scratch = Scratch::new("attached");
    for branch in [by_balance(), by_shooting()] {
        let mut read = scratch.exchanged(&branch);
        read.attach(&MODEL).expect("it is its own");
        for value in [0.7, 0.95, 1.1] {
            let (before, after) = (branch.at(value), read.at(value));
            let (before, after) = (before.expect("orbits"), after.expect("orbits"));
            assert!(!before.is_empty());
            assert_eq!(before.len(), after.len());
            for (before, after) in before.iter().zip(&after) {
                let stated = |point: &hertzian::Point| point.error.expect("an estimate");
                let allowed = (stated(before) + stated(after)) * before.peak_to_peak();
                let apart = (before.peak_to_peak() - after.peak_to_peak()).abs();
                assert!(apart <= allowed, "{value}: {apart:e} {allowed:e}");
                assert_eq!(before.stability.verdict, after.stability.verdict);
            }
        }
    }
}

/// Places of the doublings: reference values computed independently of this project, with 60 digits.
#[test]
fn with_its_model_it_is_left_at_a_doubling() {
    let scratch = Scratch::new("doubling");
    let request = || {
        let request = FrequencyResponse::of(&MODEL).vary("drive").omega(1.0);
        request.from(1.2).to(1.6)
    };
    for branch in [
        request().bifurcations(true).run(),
        request().by(Shooting::new()).run(),
    ] {
        let mut read = scratch.exchanged(&branch.expect("a branch"));
        read.attach(&MODEL).expect("it is its own");
        let doubling = read.events(EventKind::PeriodDoubling).next();
        let doubling = doubling.expect("a doubling");
        let off = (doubling.point.value - 1.282_584_167_663_767).abs();
        assert!(off <= doubling.error, "{off:e}");
        let longer = read.switch(doubling, Side::One).expect("a branch");
        assert_eq!(longer.period(), 2);
        let next = longer.events(EventKind::PeriodDoubling).next();
        let next = next.expect("a second doubling");
        let off = (next.point.value - 1.531_044_135_499_983).abs();
        assert!(off <= next.error, "{off:e}");
    }
}

#[test]
fn another_model_is_refused() {
    let scratch = Scratch::new("other");
    for branch in [by_balance(), by_shooting()] {
        let mut read = scratch.exchanged(&branch);
        let other = other::OneSided {
            zeta: 0.032,
            drive: 0.1,
        };
        let error = read.attach(&other).expect_err("it has another load");
        let RequestError::OtherModel { expected, found } = error.downcast_ref().expect("a request")
        else {
            panic!("{error}");
        };
        assert_eq!([expected, found], ["OneSided", "OneSided"]);
        for (zeta, drive, named) in [(0.03, 0.1, "zeta"), (0.032, 0.2, "drive")] {
            let error = read.attach(&OneSided { zeta, drive });
            let error = error.expect_err("it has other values");
            let Some(RequestError::Parameter { name, .. }) = error.downcast_ref() else {
                panic!("{error}");
            };
            assert_eq!(name, named);
        }
        assert!(read.at(1.0).is_err());
    }
}

/// As they are written since there are files.
#[test]
fn methods_of_multipliers_have_their_names_in_files() {
    for (method, written) in [
        (Method::Default, r#""default""#),
        (Method::Monodromy, r#""monodromy""#),
        (Method::Hill, r#"{"hill":"symmetry"}"#),
        (Method::HillImaginaryPart, r#"{"hill":"imaginary-part"}"#),
        (Method::HillWeightedMean, r#"{"hill":"weighted-mean"}"#),
        (Method::KoopmanHill, r#"{"koopman-hill":"direct"}"#),
        (
            Method::KoopmanHillSubharmonic,
            r#"{"koopman-hill":"subharmonic"}"#,
        ),
    ] {
        assert_eq!(serde_json::to_string(&method).expect("text"), written);
        let read: Method = serde_json::from_str(written).expect("a method");
        assert_eq!(read, method);
    }
}

/// Whether it says that what was read is no file of branches.
fn is_none_of_ours(error: &Error) -> bool {
    error.kind() == ErrorKind::File && error.to_string().contains(" is no file of this kind: ")
}

#[test]
fn what_is_no_file_of_branches_is_refused() {
    let scratch = Scratch::new("refused");
    let path = &scratch.0;
    let missing = Branch::read(path).expect_err("there is none");
    assert_eq!(missing.kind(), ErrorKind::File);
    assert!(missing.to_string().starts_with("cannot read "));
    let branch = by_balance();
    branch.write(path).expect("written");
    let text = std::fs::read_to_string(path).expect("read");
    for part in [0, 1, 20, text.len() / 2, text.len() - 2] {
        let error = scratch.read(&text[..part]);
        let expected = format!("{} ends early: it is a part of a file", path.display());
        assert_eq!(error.to_string(), expected);
    }
    let error = scratch.read(&text.replacen("\"version\":2", "\"version\":1", 1));
    let expected = format!(
        "{} is of version 1, and files of version 2 are read",
        path.display()
    );
    assert_eq!(error.to_string(), expected);
    assert_eq!(error.values(), [("version", 1.0), ("expected", 2.0)]);
    // Before there were versions, none was written.
    let error = scratch.read("{\"points\": []}");
    assert_eq!(error.to_string(), expected);
    let first = &branch.points[0];
    for (from, to) in [
        ("\"coordinates\":1,".to_owned(), "\"coordinates\":0,"),
        ("\"coordinates\":1,".to_owned(), "\"coordinates\":2,"),
        (format!("\"value\":{:?},", first.value), "\"value\":\"a\","),
        (
            format!("\"parameters\":{:?},", first.parameters),
            "\"parameters\":[1.0],",
        ),
        ("\"parts\":1,".to_owned(), "\"parts\":0,"),
        ("\"entries\":[]".to_owned(), "\"entries\":[[5,1]]"),
        ("\"kind\":\"fold\"".to_owned(), "\"kind\":\"sold\""),
    ] {
        let from = from.replace(' ', "");
        assert!(text.contains(&from), "{from}");
        let error = scratch.read(&text.replacen(&from, to, 1));
        assert!(is_none_of_ours(&error), "{to}: {error}");
    }
    for text in [
        "omega,max\n0.5,1\n",
        "[1, 2]",
        "{\"version\":2,\"branches\":[]}",
    ] {
        let error = scratch.read(text);
        assert!(is_none_of_ours(&error), "{text}: {error}");
        assert_eq!(error.to_string().lines().count(), 1);
    }
}

#[test]
fn what_motions_settle_to_is_read_back() {
    let model = OneSided {
        zeta: 0.032,
        drive: 1.0,
    };
    let axis = |entry, from, to| Axis::of(entry).from(from).to(to).cells(6);
    let grid = Grid::new(vec![0.0; 2], axis(0, -60.0, 10.0), axis(1, -12.0, 12.0));
    let basins = Basin::of(&model).omega(1.0).grid(grid).run();
    let basins = basins.expect("basins");
    assert!(!basins.attractors.is_empty());
    let text = serde_json::to_string(&basins).expect("text");
    assert_eq!(
        serde_json::from_str::<Basins>(&text).expect("basins"),
        basins
    );
    let sweep = Sweep::of(&model).vary("drive").omega(1.0);
    let swept = sweep.from(0.2).to(1.4).values(3).run().expect("rows");
    assert_eq!(swept.rows.len(), 3);
    let text = serde_json::to_string(&swept).expect("text");
    assert_eq!(serde_json::from_str::<Swept>(&text).expect("rows"), swept);
}

/// The response of the one-sided contact bends over: between its folds there are three orbits, of which the middle one is not stable.
#[test]
fn all_solutions_are_counted() {
    let request = FrequencyResponse::of(&MODEL).from(0.6).to(1.2);
    let branch = request.run().expect("a branch");
    let folds: Vec<f64> = branch.folds().map(|fold| fold.point.value).collect();
    let [upper, lower] = folds[..] else {
        panic!("{folds:?}");
    };
    assert!(lower < 0.9 && upper > 0.9, "{folds:?}");
    let solutions = request.solutions(&[0.9, 1.19]).expect("solutions");
    let [between, outside] = &solutions.at[..] else {
        panic!("{solutions}");
    };
    assert_eq!(between.orbits.len(), 3);
    let of = |verdict| between.count(verdict);
    assert_eq!([of(Verdict::Stable), of(Verdict::Unstable)], [2, 1]);
    let largest = between
        .orbits
        .iter()
        .map(|found| found.point.peak_to_peak());
    let largest = largest.fold(0.0, f64::max);
    assert_eq!(between.largest(), Some(largest));
    assert_eq!(
        (outside.orbits.len(), outside.count(Verdict::Stable)),
        (1, 1)
    );
    let said = solutions.to_string();
    assert!(
        said.starts_with("omega = 0.9: 3 orbits, 2 stable, 1 unstable\n"),
        "{said}"
    );
    assert!(said.contains("motions at 2 values of omega"), "{said}");
    assert!(request.solutions(&[2.0]).is_err());
}

mod softer {
    hertzian::oscillator! {
        pub OneSided(x) {
            param zeta in 0.0..;
            param drive;
            law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap/2, else => 0 }
            ddot(x) + contact(x) = drive*cos(omega*t) + 1;
        }
    }
}

/// The equations are the same to the letter, and the law is another one.
#[test]
fn a_model_with_another_law_is_another_model() {
    let scratch = Scratch::new("law");
    let mut read = scratch.exchanged(&by_balance());
    let equation = &read.model.equation;
    assert!(
        equation.contains("law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }"),
        "{equation}"
    );
    let other = softer::OneSided {
        zeta: 0.032,
        drive: 0.1,
    };
    let refused = read.attach(&other).expect_err("another law");
    assert!(
        matches!(
            refused.downcast_ref(),
            Some(RequestError::OtherModel { .. })
        ),
        "{refused}"
    );
    read.attach(&MODEL).expect("its own");
}
