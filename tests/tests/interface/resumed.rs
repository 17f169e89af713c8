//! Branches that are interrupted, written, read and resumed: equal to the last bit to those that were not.

use std::ops::ControlFlow;

use hertzian::{Branch, ContactEquation, FrequencyResponse, OrbitMethod, Shooting, Stop};

hertzian::oscillator! {
    pub OneSided(x) {
        param zeta in 0.0..;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

hertzian::oscillator! {
    pub Linear(x) {
        param zeta in 0.0..;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

hertzian::oscillator! {
    Two(x, y) {
        param drive;
        law stop(gap) { gap > 0 => 0.1*dot(gap) + 3*gap, else => 0 }
        ddot(x) + 0.06*dot(x) + 2*x - y + stop(x - 1) = drive*cos(omega*t);
        ddot(y) + 0.06*dot(y) + 2*y - x + 0.3*y^3 = 0;
    }
}

/// The texts of what a branch has: the same bits, and NaN is NaN.
pub fn texts(branch: &Branch) -> [String; 4] {
    let stopped = format!("{:?} {:?}", branch.begin, branch.stopped);
    [
        serde_json::to_string(&branch.points).expect("text"),
        serde_json::to_string(&branch.events).expect("text"),
        serde_json::to_string(&branch.turns).expect("text"),
        stopped,
    ]
}

pub fn written_and_read(branch: &Branch, name: &str) -> Branch {
    let name = format!("hertzian-resumed-{name}-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    branch.write(&path).expect("written");
    let read = Branch::read(&path).expect("read");
    std::fs::remove_file(path).expect("removed");
    read
}

/// Stopped at so many points.
fn part_of<M: OrbitMethod>(request: &FrequencyResponse<M>, points: usize) -> Branch {
    let mut seen = 0;
    let part = request.run_with(|_| {
        seen += 1;
        if seen < points {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    part.expect("a part")
}

/// Stopped at every so many points, and at each time written, read and resumed.
fn resumes<M: OrbitMethod>(
    request: &FrequencyResponse<M>,
    model: &dyn hertzian::System,
    name: &str,
    stride: usize,
) {
    let whole = request.run().expect("a branch");
    let count = whole.points.len();
    assert!(count > 20, "{count}");
    for points in (2..count).step_by(stride) {
        let part = part_of(request, points);
        let mut read = written_and_read(&part, name);
        assert_eq!(read.stopped, Stop::Interrupted);
        assert_eq!(read.points.len(), points);
        read.attach(model).expect("its model");
        let resumed = read.resume().run().expect("a branch");
        let (resumed, whole) = (texts(&resumed), texts(&whole));
        for (resumed, whole) in resumed.iter().zip(&whole) {
            assert!(resumed == whole, "{name} from point {points}");
        }
    }
}

pub const ONE: OneSided = OneSided {
    zeta: 0.032,
    drive: 0.1,
};

#[test]
fn by_the_balance() {
    let request = FrequencyResponse::of(&ONE).from(0.6).to(1.2);
    resumes(&request, &ONE, "balance", 31);
}

#[test]
fn by_the_balance_with_all_bifurcations() {
    let request = FrequencyResponse::of(&ONE).vary("drive").omega(1.0);
    let request = request.from(1.0).to(1.4).bifurcations(true);
    resumes(&request, &ONE, "bifurcations", 13);
}

#[test]
fn by_the_balance_with_several_coordinates() {
    let model = Two { drive: 0.3 };
    let request = FrequencyResponse::of(&model).from(0.8).to(2.2);
    resumes(&request, &model, "two", 34);
}

#[test]
fn by_shooting_in_closed_form() {
    let model = Linear {
        zeta: 0.032,
        drive: 1.0,
    };
    let request = FrequencyResponse::of(&model).by(Shooting::new());
    let request = request.vary("drive").omega(1.0).from(1.0).to(1.5);
    resumes(&request, &model, "closed", 13);
}

#[test]
fn by_shooting_with_integration() {
    let request = FrequencyResponse::of(&ONE).by(Shooting::new());
    resumes(&request.from(0.6).to(0.9), &ONE, "integrated", 29);
}

#[test]
fn by_the_contact_equation() {
    let model = Linear {
        zeta: 0.032,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model).by(ContactEquation::new());
    resumes(&request.from(0.6).to(1.2), &model, "contact", 17);
    let request = FrequencyResponse::of(&ONE).by(ContactEquation::new());
    resumes(&request.from(0.6).to(1.2), &ONE, "curved", 9);
}

hertzian::oscillator! {
    /// A spring of two stiffnesses.
    Bilinear(x) {
        law spring(gap) { gap > 0 => 25.5*gap, else => gap }
        ddot(x) + 0.1*dot(x) + spring(x) = 0.324*cos(omega*t) + 0.4;
    }
}

hertzian::oscillator! {
    /// Between two stops whose forces begin with a jump.
    Preloads(x) {
        law stop(gap) { gap >= 0 => 0.164 + 4*gap, else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - 1) - stop(-x - 1.2) = 0.6031*cos(omega*t);
    }
}

/// Whether what is left of a branch that is stopped at one of its points says something.
fn says<M: OrbitMethod>(request: &FrequencyResponse<M>, name: &str, what: &str) -> bool {
    let file = format!("hertzian-resumed-{name}-{}.json", std::process::id());
    let path = std::env::temp_dir().join(file);
    let count = request.run().expect("a branch").points.len();
    let found = (2..count).any(|points| {
        part_of(request, points).write(&path).expect("written");
        let text = std::fs::read_to_string(&path).expect("a file");
        text.contains(what)
    });
    std::fs::remove_file(path).expect("removed");
    found
}

/// At 2.4858 a level is touched, and behind that the contact equation goes over to other unknowns, in which the touch has no place: it is known by its
/// multipliers alone.
#[test]
fn behind_a_touch_and_other_unknowns() {
    let model = Bilinear {};
    let request = FrequencyResponse::of(&model).by(ContactEquation::new());
    let request = request.from(2.5).to(2.3);
    assert!(says(&request, "displaced", "\"displaced\":true"));
    resumes(&request, &model, "displaced", 1);
}

/// The branch has a corner where the stop is touched, at 0.83012, and doublings at 0.8422 and 0.8564 behind it: from points on either side of all of them.
#[test]
fn around_a_corner() {
    let model = Preloads {};
    let request = FrequencyResponse::of(&model);
    let doublings = |branch: &Branch| {
        let found = branch.events(hertzian::EventKind::PeriodDoubling);
        let values = found.map(|event| event.point.value);
        values.filter(|value| (0.83..0.86).contains(value)).count()
    };
    for [from, to] in [[0.7, 0.95], [0.95, 0.7]] {
        let request = request.clone().from(from).to(to);
        let moved = request.clone().by(Shooting::new());
        let solved = request.by(ContactEquation::new());
        let corner = "\"bend\":\"corner\"";
        assert!(says(&moved, "corner", corner) && says(&solved, "corner", corner));
        resumes(&moved, &model, "corner", 1);
        resumes(&solved, &model, "corner", 1);
        let found = [moved.run(), solved.run()].map(|found| doublings(&found.expect("a branch")));
        assert_eq!(found, [2, 2]);
    }
}

/// What is in the file at any moment is what a killed program leaves; a line that is not whole does not count.
#[test]
fn from_a_file_that_was_kept() {
    let name = format!("hertzian-kept-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    let request = FrequencyResponse::of(&ONE).vary("drive").omega(1.0);
    let request = request.from(1.0).to(1.4).bifurcations(true);
    let whole = request.run().expect("a branch");
    let kept = request.clone().keep(&path);
    let ended = kept.run().expect("a branch");
    assert_eq!(texts(&ended), texts(&whole));
    assert_eq!(Branch::read(&path).expect("read"), ended);
    let part = part_of(&kept, 40);
    assert_eq!(Branch::read(&path).expect("read"), part);
    let text = std::fs::read(&path).expect("a file");
    let breaks = text.iter().enumerate().filter(|(_, byte)| **byte == b'\n');
    let second = breaks.map(|(at, _)| at).nth(1).expect("two lines");
    let mut tried = 0;
    for length in [second + 1, second + 900, text.len() - 1] {
        std::fs::write(&path, &text[..length.min(text.len())]).expect("written");
        let mut read = Branch::read(&path).expect("read");
        assert_eq!(read.stopped, Stop::Interrupted);
        read.attach(&ONE).expect("its model");
        let resumed = read.resume().keep(&path).run().expect("a branch");
        assert_eq!(texts(&resumed), texts(&whole), "{length}");
        assert_eq!(Branch::read(&path).expect("read"), resumed);
        tried += 1;
    }
    assert_eq!(tried, 3);
    // What has ended is told so, whether it is kept or not; what goes on beyond the range does not belong into the file.
    let mut read = Branch::read(&path).expect("read");
    read.attach(&ONE).expect("its model");
    for resume in [read.resume(), read.resume().keep(&path)] {
        let said = resume.run().expect_err("it has ended").to_string();
        assert!(said.contains("has reached the end of its range"), "{said}");
    }
    let longer = read.resume().to(1.5).keep(&path);
    let said = longer.run().expect_err("it is longer").to_string();
    assert!(said.contains("beyond what is kept in its file"), "{said}");
    assert_eq!(Branch::read(&path).expect("read"), read);
    std::fs::remove_file(path).expect("removed");
}

/// What a file says a branch goes on from may be anything.
#[test]
fn what_cannot_be_gone_on_from_is_refused() {
    let name = format!("hertzian-changed-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    let by_balance = FrequencyResponse::of(&ONE).from(0.6).to(1.2);
    let by_shooting = by_balance.clone().by(Shooting::new());
    let by_contact = by_balance.clone().by(ContactEquation::new());
    let all = [
        ("\"contraction\":", "\"contraction\":\"NaN\",\"was\":"),
        (
            "\"max_points\":20000,",
            "\"max_points\":18446744073709551615,",
        ),
        ("\"period\":null,", "\"period\":1000000000000,"),
        ("\"tangent\":[", "\"tangent\":[1.0,"),
        ("\"kept\":{\"events\":[]", "\"kept\":{\"events\":[7]"),
    ];
    let of_balance = [
        ("\"harmonics\":5,", "\"harmonics\":1000000000,"),
        ("\"mantissa\":", "\"mantissa\":[],\"was\":"),
    ];
    let of_shooting = [
        ("\"segments\":1}", "\"segments\":1000000000}"),
        ("\"reference\":[", "\"reference\":[1.0,"),
    ];
    let of_contact = [
        ("\"pieces\":[", "\"pieces\":[7,"),
        ("\"nodes\":", "\"nodes\":1000000000,\"were\":"),
        ("\"reference\":[", "\"reference\":[1.0,"),
    ];
    for (part, own) in [
        (part_of(&by_balance.bifurcations(true), 12), &of_balance[..]),
        (part_of(&by_shooting, 12), &of_shooting),
        (part_of(&by_contact, 12), &of_contact),
    ] {
        part.write(&path).expect("written");
        let text = std::fs::read_to_string(&path).expect("a file");
        for (from, to) in all.iter().chain(own) {
            let at = text.find("\"request\":").expect("it goes on from that");
            let (before, request) = text.split_at(at);
            assert!(request.contains(from), "{from}");
            let changed = format!("{before}{}", request.replacen(from, to, 1));
            std::fs::write(&path, changed).expect("written");
            is_refused(&path, to);
        }
    }
    std::fs::remove_file(path).expect("removed");
}

/// A branch in a file is not read or not resumed, and one sentence says so.
fn is_refused(path: &std::path::Path, what: &str) {
    let resumed = Branch::read(path).and_then(|mut read| {
        read.attach(&ONE)?;
        read.resume().run()
    });
    let error = resumed.expect_err(what);
    assert_eq!(error.to_string().lines().count(), 1, "{what}: {error}");
}

/// Where in what is left of a branch by the contact equation, and what cannot be there: `FIRST` and `SECOND` are the places of two switches
/// that name each other, `LAST` that of the last one.
const NONSENSE: [(&str, &str); 26] = [
    ("/placement/placed/0/phase", "6.28"),
    ("/placement/placed/0/phase", "\"NaN\""),
    ("/placement/placed/LAST/phase", "0.001"),
    ("/placement/placed/FIRST/switch/told/first/other", "0"),
    ("/placement/placed/FIRST/switch/told/first/other", "1000"),
    ("/placement/placed/FIRST/switch/told/first/bend", "\"NaN\""),
    ("/placement/placed/FIRST/switch/told", "\"alone\""),
    ("/placement/placed/FIRST/switch/contact", "7"),
    ("/placement/placed/SECOND/switch/told/second/other", "1000"),
    ("/placement/placed/SECOND/switch/told", "\"alone\""),
    ("/placement/placed/SECOND/switch/level", "7"),
    ("/placement/beginning/phase", "1e300"),
    ("/placement/beginning/recurrence/parts", "7"),
    ("/placement/beginning/recurrence/parts", "0"),
    ("/placement/beginning/recurrence/period", "2"),
    ("/last/map", "[0.5]"),
    ("/made", "\"NaN\""),
    ("/size", "-1.0"),
    ("/finer", "\"inf\""),
    ("/screened/apart", "-1.0"),
    ("/screened/error", "\"NaN\""),
    ("/screened/tails", "[0.0]"),
    ("/screened/left", "18446744073709551615"),
    ("/refused", "18446744073709551615"),
    ("/held", "18446744073709551615"),
    ("/known", "[[1.0], []]"),
];

/// The file of a branch by the contact equation, at an orbit where two switches name each other and an error was seen.
fn with_a_pair(path: &std::path::Path) -> serde_json::Value {
    let request = FrequencyResponse::of(&ONE).from(0.9).to(1.2);
    let request = request.by(ContactEquation::new());
    let count = request.run().expect("a branch").points.len();
    let mut texts = (3..count).map(|points| {
        part_of(&request, points).write(path).expect("written");
        std::fs::read_to_string(path).expect("a file")
    });
    let text = texts.find(|text| {
        let has = |what| text.contains(what);
        has("\"told\":{\"first\":") && has("\"screened\":{")
    });
    serde_json::from_str(&text.expect("a pair")).expect("a branch")
}

/// What a file says of switches that name each other, of their order and of errors may be anything.
#[test]
fn contacts_that_make_no_sense_are_refused() {
    let name = format!("hertzian-contacts-changed-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    let file = with_a_pair(&path);
    let rest = "/branches/0/request/by/contact-equation/rest";
    let placed = file.pointer(&format!("{rest}/placement/placed"));
    let placed = placed.and_then(|placed| placed.as_array());
    let placed = placed.expect("switches");
    let of = |place: &str| {
        let is = |one: &serde_json::Value| one["switch"]["told"].get(place).is_some();
        let found = placed.iter().position(is);
        found.expect("one of two").to_string()
    };
    for (place, value) in NONSENSE {
        let place = place.replace("FIRST", &of("first"));
        let place = place.replace("SECOND", &of("second"));
        let place = place.replace("LAST", &(placed.len() - 1).to_string());
        let mut changed = file.clone();
        let at = changed.pointer_mut(&format!("{rest}{place}"));
        *at.expect(&place) = serde_json::from_str(value).expect("a value");
        let changed = serde_json::to_string(&changed).expect("text");
        std::fs::write(&path, changed).expect("written");
        is_refused(&path, &format!("{place} {value}"));
    }
    std::fs::remove_file(path).expect("removed");
}

/// A file of another version is refused, whatever else it has.
#[test]
fn what_another_version_has_kept_is_refused() {
    let name = format!("hertzian-kept-version-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    let request = FrequencyResponse::of(&ONE).from(0.6).to(0.62);
    request.keep(&path).run().expect("a branch");
    let text = std::fs::read_to_string(&path).expect("a file");
    for version in ["1", "3"] {
        let changed = text.replacen("\"version\":2", &format!("\"version\":{version}"), 1);
        assert!(changed != text && changed.contains("\"varied\":"));
        std::fs::write(&path, &changed).expect("written");
        let error = Branch::read(&path).expect_err("another version");
        let said = format!("is of version {version}, and files of version 2 are read");
        assert!(error.to_string().contains(&said), "{error}");
        // What such a branch is said to be may have another form.
        let other = changed.replacen("\"varied\":", "\"name_of_what_varies\":", 1);
        std::fs::write(&path, other).expect("written");
        let error = Branch::read(&path).expect_err("another version");
        assert!(error.to_string().contains(&said), "{error}");
    }
    std::fs::remove_file(path).expect("removed");
}

/// Reads what is in a file and does with it what one does; what cannot be is said in one line.
fn used(path: &std::path::Path) -> Result<(), hertzian::Error> {
    let mut branch = Branch::read(path)?;
    let _ = (branch.to_csv(), branch.chart().to_svg(), branch.leading());
    branch.attach(&ONE)?;
    let points = branch.points.len() + 1;
    branch.resume().max_points(points).run()?;
    Ok(())
}

/// A number between zero and this one, the next one of a sequence.
fn next(seed: &mut u64, below: usize) -> usize {
    // Knuth (1997), The Art of Computer Programming 2, section 3.3.4, line 26.
    *seed = seed
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    ((*seed >> 33) as usize) % below
}

/// Files that end anywhere, or in which something has another value, are read or refused in a sentence.
#[test]
fn a_damaged_file_is_refused_in_a_sentence() {
    let name = format!("hertzian-damaged-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    let mut seed = 7;
    let (mut refused, mut tried) = (0, 0);
    let by_balance = FrequencyResponse::of(&ONE).from(0.6).to(1.2);
    let by_balance = by_balance.harmonics(3).bifurcations(true);
    let by_shooting = FrequencyResponse::of(&ONE).by(Shooting::new());
    let by_shooting = by_shooting.from(0.6).to(1.2).tolerance(1e-4);
    for kept in [false, true] {
        let parts = if kept {
            let both = (
                by_balance.clone().keep(&path),
                by_shooting.clone().keep(&path),
            );
            part_of(&both.0, 5);
            let text = std::fs::read_to_string(&path).expect("a file");
            part_of(&both.1, 5);
            [text, std::fs::read_to_string(&path).expect("a file")]
        } else {
            [part_of(&by_balance, 5), part_of(&by_shooting, 5)].map(|part| {
                part.write(&path).expect("written");
                std::fs::read_to_string(&path).expect("a file")
            })
        };
        for text in parts {
            let numbers = text.match_indices([':', '[', ',']).map(|(at, _)| at + 1);
            let numbers: Vec<usize> = numbers.collect();
            let mut try_text = |changed: &str| {
                std::fs::write(&path, changed).expect("written");
                tried += 1;
                if let Err(error) = used(&path) {
                    let said = error.to_string();
                    assert!(!said.is_empty() && said.lines().count() == 1, "{said}");
                    refused += 1;
                }
            };
            for _ in 0..40 {
                try_text(&text[..next(&mut seed, text.len())]);
            }
            for other in ["", "null,", "-1,", "7,", "1e9,", "[],", "\"NaN\","] {
                for _ in 0..10 {
                    let at = numbers[next(&mut seed, numbers.len())];
                    try_text(&format!("{}{other}{}", &text[..at], &text[at..]));
                    // In place of what was there.
                    let end = text[at..]
                        .find([',', ']', '}'])
                        .map_or(text.len(), |end| at + end);
                    let value = other.trim_end_matches(',');
                    try_text(&format!("{}{value}{}", &text[..at], &text[end..]));
                }
            }
        }
    }
    std::fs::remove_file(path).expect("removed");
    assert!(refused > tried / 2, "{refused} of {tried}");
}

/// What is behind where a branch begins is not on its way.
#[test]
fn a_branch_does_not_go_on_backwards() {
    let request = FrequencyResponse::of(&ONE).from(0.6).to(0.65);
    let branch = request.run().expect("a branch");
    let refused = |resume: hertzian::Resume<'_>| {
        let error = resume.run().expect_err("it is behind");
        error.to_string()
    };
    for to in [0.5, 0.6] {
        let said = refused(branch.resume().tolerance(1e-8).to(to));
        assert!(said.contains("must be ahead of the first orbit"), "{said}");
    }
    let said = refused(branch.resume().to(0.62));
    assert!(said.contains("must be ahead of the last orbit"), "{said}");
    let finer = branch.resume().tolerance(1e-8).to(0.62).run();
    let finer = finer.expect("a branch");
    assert_eq!(finer.stopped, Stop::ReachedEnd);
    assert_eq!(finer.points.last().map(|point| point.value), Some(0.62));
    let count = branch.points.len();
    let said = refused(branch.resume().to(0.7).max_points(count));
    assert!(
        said.contains("must be more than the points that the branch has"),
        "{said}"
    );
}
