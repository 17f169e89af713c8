//! Diagrams and basins that are written and read: equal to the last bit, and what is none of them is refused in a sentence.

use std::ops::ControlFlow;
use std::path::PathBuf;

use hertzian::attractors::basin::{Axis, Basin, Basins, Fate, Grid};
use hertzian::bifurcation::{Bifurcations, Diagram, Origin};
use hertzian::{Branch, ContactEquation, Error, HarmonicBalance, OrbitMethod, Shooting, Stop};

use super::resumed::{Linear, texts};

/// A file that is gone afterwards.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let name = format!("hertzian-whole-{name}-{}.json", std::process::id());
        Self(std::env::temp_dir().join(name))
    }

    fn text(&self) -> String {
        std::fs::read_to_string(&self.0).expect("a file")
    }

    /// What is said of a changed text, in one line.
    fn said<T: std::fmt::Debug>(
        &self,
        text: &str,
        read: impl Fn(&PathBuf) -> Result<T, Error>,
    ) -> String {
        std::fs::write(&self.0, text).expect("written");
        let said = read(&self.0).expect_err(text).to_string();
        assert_eq!(said.lines().count(), 1, "{said}");
        said.replace(&self.0.display().to_string(), "FILE")
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

const MODEL: Linear = Linear {
    zeta: 0.032,
    drive: 1.0,
};

/// Period one, what begins where it doubles, and what begins there.
fn cascade<M: OrbitMethod>(method: M) -> Bifurcations<M> {
    let request = Bifurcations::of(&MODEL).vary("drive").omega(1.0);
    let request = request.from(1.0).to(1.6).margin(0.0).max_period(4);
    request.by(method)
}

/// Ended where so many orbits were seen.
fn part_of<M: OrbitMethod>(request: &Bifurcations<M>, orbits: usize) -> Diagram {
    let mut seen = 0;
    let part = request.run_with(|_| {
        seen += 1;
        if seen < orbits {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    part.expect("a diagram")
}

/// A diagram is equal to the last bit when it is read; the branch that was being followed when it ended is resumed from the file, to the
/// same bits as without an end, those that begin at bifurcations too.
fn is_kept<M: OrbitMethod>(method: M, name: &str) {
    let scratch = Scratch::new(name);
    let request = cascade(method);
    let whole = request.run().expect("a diagram");
    assert!(
        whole.branches.len() >= 3,
        "{name}: {}",
        whole.branches.len()
    );
    let is_event = |origin: Origin| matches!(origin, Origin::Event { .. });
    assert!(whole.branches.iter().any(|found| is_event(found.origin)));
    let mut orbits = 0;
    for (number, found) in whole.branches.iter().enumerate() {
        let part = part_of(&request, orbits + found.branch.points.len() / 2);
        orbits += found.branch.points.len();
        part.write(&scratch.0).expect("written");
        let mut read = Diagram::read(&scratch.0).expect("read");
        assert!(read == part, "{name}: {number}");
        for (read, found) in read.branches.iter().zip(&whole.branches).take(number) {
            assert_eq!(texts(&read.branch), texts(&found.branch));
        }
        let last = &mut read.branches.last_mut().expect("a branch").branch;
        assert_eq!(last.stopped, Stop::Interrupted);
        last.attach(&MODEL).expect("its model");
        let resumed = last.resume().run().expect("a branch");
        assert!(texts(&resumed) == texts(&found.branch), "{name}: {number}");
    }
    whole.write(&scratch.0).expect("written");
    let read = Diagram::read(&scratch.0).expect("read");
    assert!(read == whole, "{name}");
    // Who reads branches reads these; of branches alone nothing is known of what connects them.
    let branches = Branch::read_all(&scratch.0).expect("branches");
    assert!(
        branches
            .iter()
            .eq(whole.branches.iter().map(|found| &found.branch))
    );
    // What is written again is the same to the letter.
    let text = scratch.text();
    read.write(&scratch.0).expect("written");
    assert!(scratch.text() == text);
    branches[0].write(&scratch.0).expect("written");
    let alone = Diagram::read(&scratch.0).expect("read");
    assert!(alone == vec![branches[0].clone()].into());
}

#[test]
fn a_diagram_by_the_balance() {
    is_kept(HarmonicBalance::new(), "balance");
}

#[test]
fn a_diagram_by_shooting() {
    is_kept(Shooting::new(), "shooting");
}

#[test]
fn a_diagram_by_the_contact_equation() {
    is_kept(ContactEquation::new(), "contact-equation");
}

const OLDER: &str = "FILE is of version 1, and files of version 2 are read";

#[test]
fn what_is_no_diagram_is_refused() {
    let scratch = Scratch::new("no-diagram");
    let request = Bifurcations::of(&MODEL).vary("drive").omega(1.0);
    let request = request.from(1.2).to(1.6).margin(0.0).depth(1);
    let searching = Basin::of(&MODEL).grid(grid(3)).longest(4);
    let diagram = request.search(1.4, searching).run().expect("a diagram");
    diagram.write(&scratch.0).expect("written");
    let text = scratch.text();
    let said = |text: &str| scratch.said(text, |path| Diagram::read(path));
    assert_eq!(
        said(&text.replacen("\"version\":2", "\"version\":1", 1)),
        OLDER
    );
    // The first version wrote none.
    assert_eq!(said("{\"branches\":[]}"), OLDER);
    assert!(said(&text[..text.len() / 2]).contains("ends early"));
    assert!(said("{\"version\":2,\"diagram\":{}}").contains("missing field `branches`"));
    let file = || serde_json::from_str::<serde_json::Value>(&text).expect("text");
    let mut begun = diagram.branches.iter();
    let begun = begun.position(|found| matches!(found.origin, Origin::Event { .. }));
    let begun = begun.expect("what begins at a doubling");
    let event = format!("/diagram/found/{begun}/origin/event");
    for (place, value, says) in [
        (format!("{event}/branch"), 99, "are not there"),
        (format!("{event}/event"), 99, "are not there"),
        ("/diagram/omitted/0/branch".into(), 99, "are not there"),
        (
            "/branches/0/events/0/after".into(),
            9999,
            "does not belong together",
        ),
    ] {
        let mut file = file();
        *file.pointer_mut(&place).expect(&place) = value.into();
        assert!(said(&file.to_string()).contains(says), "{place}");
    }
}

fn grid(cells: usize) -> Grid {
    let axis = |entry, from, to| Axis::of(entry).from(from).to(to).cells(cells);
    Grid::new(vec![0.0; 2], axis(0, -60.0, 10.0), axis(1, -12.0, 12.0))
}

#[test]
fn basins_say_what_they_are_of_and_are_read_back() {
    let scratch = Scratch::new("basins");
    let request = Basin::of(&MODEL).omega(1.0).parameter("drive", 1.1);
    let basins = request.grid(grid(12)).run().expect("basins");
    assert!(basins.attractors.len() > 1 && basins.complete);
    assert_eq!(basins.model.name, "Linear");
    assert!(
        basins
            .model
            .equation
            .contains("ddot(x) + contact(x) = drive*cos(omega*t) + 1")
    );
    assert_eq!(
        (&basins.parameters[..], basins.omega),
        (&[0.032, 1.1][..], 1.0)
    );
    let states = Grid::of_states(vec![vec![-2.5, 0.5], vec![1.0, f64::MIN_POSITIVE]]);
    let request = Basin::of(&MODEL).omega(1.0).phase(-0.0).grid(states);
    // Ended before anything was looked at.
    let cancel = hertzian::Cancel::new();
    cancel.cancel();
    let none = request.clone().cancel(&cancel).run().expect("basins");
    assert!(!none.complete && none.count(Fate::Unknown) == 2);
    for basins in [basins, request.run().expect("basins"), none] {
        basins.write(&scratch.0).expect("written");
        let read = Basins::read(&scratch.0).expect("read");
        // The same bits, and the sign of zero.
        assert!(format!("{read:?}") == format!("{basins:?}") && read == basins);
        let text = scratch.text();
        read.write(&scratch.0).expect("written");
        assert!(scratch.text() == text);
    }
}

#[test]
fn what_are_no_basins_is_refused() {
    let scratch = Scratch::new("no-basins");
    let basins = Basin::of(&MODEL).omega(1.0).grid(grid(4)).run();
    basins.expect("basins").write(&scratch.0).expect("written");
    let text = scratch.text();
    let said = |text: &str| scratch.said(text, |path| Basins::read(path));
    assert_eq!(
        said(&text.replacen("\"version\":2", "\"version\":1", 1)),
        OLDER
    );
    assert_eq!(said("{\"fates\":[]}"), OLDER);
    assert!(said(&text[..text.len() / 2]).contains("ends early"));
    let all = [
        ("/basins/grid/columns/count", "5"),
        ("/basins/grid/columns/count", "18446744073709551615"),
        ("/basins/grid/rows/entry", "2"),
        ("/basins/grid/start", "[0.0]"),
        ("/basins/parameters", "[1.0]"),
        ("/basins/fates/0", "{\"periodic\": 99}"),
        ("/basins/attractors/0/period", "99"),
        ("/basins/attractors/0/points/0", "[1.0]"),
    ];
    for (place, value) in all {
        let mut file: serde_json::Value = serde_json::from_str(&text).expect("text");
        *file.pointer_mut(place).expect(place) = serde_json::from_str(value).expect("a value");
        let said = said(&file.to_string());
        assert!(said.contains("do not belong together"), "{place}: {said}");
    }
}
