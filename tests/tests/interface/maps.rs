//! All solutions over two parameters.

use std::ops::ControlFlow;

use hertzian::bifurcation::{Cell, CellVerdict, Map, Reason};
use hertzian::error::ErrorKind;
use hertzian::{Cancel, Error, FrequencyResponse, Shooting, Stage};

hertzian::oscillator! {
    /// Load and drive in a ratio: with a linear spring every length is in proportion to the load.
    OneSided(x) {
        param load;
        param ratio in 0.0..;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = load*(1 + ratio*cos(omega*t));
    }
}

const MODEL: OneSided = OneSided {
    load: 1.0,
    ratio: 0.1,
};

fn request() -> FrequencyResponse<Shooting> {
    let request = FrequencyResponse::of(&MODEL).by(Shooting::new());
    request.from(0.65).to(1.05)
}

fn counts(map: &Map) -> Vec<[usize; 3]> {
    let cells = map.cells.iter();
    cells
        .map(|cell| [cell.stable, cell.unstable, cell.undecided])
        .collect()
}

/// Figure 5a of Wang et al. (2021): frequencies with the exact peak-to-peak of the largest stable orbit where it is known (reference
/// values, by the closed-form flow), and the counts on each side of the exact folds at 0.715119549676419 and 0.96016367187857.
const FIGURE_5A: [(f64, Option<f64>, [usize; 3]); 8] = [
    (0.679_393_161, Some(0.370_248_485), [1, 0, 0]),
    (0.7150, None, [1, 0, 0]),
    (0.7152, None, [2, 1, 0]),
    (0.741_036_629, Some(6.072_264_039), [2, 1, 0]),
    (0.891_168_279, Some(3.674_354_905), [2, 1, 0]),
    (0.9601, None, [2, 1, 0]),
    (0.9602, None, [1, 0, 0]),
    (0.998_491_763, Some(2.471_567_956), [1, 0, 0]),
];

#[test]
fn counts_change_at_exact_folds_and_sizes_scale_with_the_load() {
    let values = FIGURE_5A.map(|known| known.0);
    let loads = [0.5, 3.0];
    let map = request().map(&values, "load", &loads).expect("a map");
    assert_eq!(map.rows().count(), 2);
    for (row, load) in map.rows().zip(loads) {
        for (cell, (value, size, counts)) in row.iter().zip(FIGURE_5A) {
            let found = [cell.stable, cell.unstable, cell.undecided];
            assert_eq!(found, counts, "{value}, {load}");
            assert_eq!(cell.periods, vec![1; counts[0]]);
            assert_eq!((cell.restless, cell.missed), (0, 0));
            assert!(cell.motions == 18 && cell.reason.is_none());
            let bistable = CellVerdict::SomeStable;
            let verdict = [CellVerdict::AllStable, bistable][counts[1]];
            assert_eq!(cell.verdict(), verdict);
            if let Some(size) = size {
                let found = cell.largest.expect("a size") / load;
                assert!((found / size - 1.0).abs() < 2e-6, "{value}: {found} {size}");
            }
        }
    }
    assert_eq!(map.lost, [0, 0]);
    assert!(map.to_string().starts_with(
        "8 values of omega, 2 of load\n1 stable orbit in 8 cells\n2 stable orbits in 8 cells\n"
    ));
}

/// Figure 4a of Wang et al. (2021): the response bends one way and then the other. Exact folds (reference values, by integration to
/// 30 digits) at 1.09502860674539, 1.136461722203842, 1.158212487926707, 1.337227934760159 for a load of 1, and at 1.484450028723123,
/// 1.56555114602055 for one of 5. Between the first two, and the next two, there are three orbits.
#[test]
fn every_row_has_its_own_folds() {
    hertzian::oscillator! {
        Continuous(x) {
            param load;
            ddot(x) + 0.02*dot(x) + sgn(x)*|x|^1.5 = 0.1*cos(omega*t) + load;
        }
    }
    let values = [
        1.0945, 1.0955, 1.1360, 1.1370, 1.1577, 1.1587, 1.3367, 1.3377, 1.4840, 1.4849, 1.5651,
        1.5660,
    ];
    let model = Continuous { load: 1.0 };
    let request = FrequencyResponse::of(&model).by(Shooting::new());
    let map = request.from(1.0).to(1.8).map(&values, "load", &[1.0, 5.0]);
    let map = map.expect("a map");
    let (one, three) = ([1, 0, 0], [2, 1, 0]);
    let rows = [
        [
            one, three, three, one, one, three, three, one, one, one, one, one,
        ],
        [
            one, one, one, one, one, one, one, one, one, three, three, one,
        ],
    ];
    assert_eq!(counts(&map), rows.concat());
}

/// Figure 8 of Wang et al. (2021), at frequency one: the orbit of period 1 doubles at 1.28258416766376766, that of period 2 at
/// 1.53104413549998304 (exact reference values).
#[test]
fn periods_double_at_exact_values() {
    hertzian::oscillator! {
        Driven(x) {
            param drive;
            law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
            ddot(x) + contact(x) = drive*cos(omega*t) + 1;
        }
    }
    let request = FrequencyResponse::of(&Driven { drive: 1.2 }).by(Shooting::new());
    let request = request.vary("drive").from(1.2).to(1.56);
    let values = [1.2820, 1.2832, 1.5305, 1.5316];
    let map = request.map(&values, "omega", &[1.0]).expect("a map");
    let stable = |cell: usize, period| map.cells[cell].periods.contains(&period);
    assert!(stable(0, 1) && !stable(1, 1), "{:?}", map.cells);
    assert!(
        stable(1, 2) && stable(2, 2) && stable(3, 4),
        "{:?}",
        map.cells
    );
    assert_eq!((map.omega, map.names[1].as_str()), (None, "omega"));
}

/// A small drive does not open the contact, and the response is that of the linear oscillator.
#[test]
fn without_loss_of_contact_there_is_the_linear_response_alone() {
    let values = [0.7, 0.9, 1.0];
    let ratios = [0.02, 0.05];
    let request = FrequencyResponse::of(&MODEL).from(0.65).to(1.05);
    let map = request.map(&values, "ratio", &ratios).expect("a map");
    for (place, cell) in map.cells.iter().enumerate() {
        let [omega, ratio] = map.at(place).expect("a cell");
        let size = 2.0 * ratio / (1.0 - omega * omega).hypot(0.064 * omega);
        assert_eq!([cell.stable, cell.unstable, cell.undecided], [1, 0, 0]);
        let found = cell.largest.expect("a size");
        assert!((found / size - 1.0).abs() < 1e-6, "{found} {size}");
    }
    assert_eq!(map.at(6), None);
}

/// Along rows or across, the same pair of values has the same solutions.
#[test]
fn the_frequency_may_be_either() {
    let along = request().map(&[0.9], "ratio", &[0.1]).expect("a map");
    let across = request().vary("ratio").from(0.02).to(0.12);
    let across = across.map(&[0.1], "omega", &[0.9]).expect("a map");
    assert_eq!(counts(&along), [[2, 1, 0]]);
    assert_eq!(counts(&across), [[2, 1, 0]]);
    let [a, b] = [&along, &across].map(|map| map.cells[0].largest.expect("a size"));
    assert!((a / b - 1.0).abs() < 2e-6, "{a} {b}");
    assert_eq!((along.omega, across.omega), (None, None));
}

/// A load that pulls away: nothing comes back.
#[test]
fn a_row_without_orbits_says_why() {
    let model = OneSided {
        ratio: 0.02,
        ..MODEL
    };
    let request = FrequencyResponse::of(&model).from(0.65).to(1.05);
    let map = request.map(&[0.7, 1.0], "load", &[-1.0, 1.0]);
    let map = map.expect("a map");
    let reasons: Vec<bool> = map.cells.iter().map(|cell| cell.reason.is_some()).collect();
    assert_eq!(reasons, [true, true, false, false]);
    let Some(Reason::Failed(error)) = &map.cells[0].reason else {
        panic!("{:?}", map.cells[0]);
    };
    assert_ne!(error.kind(), ErrorKind::Request);
    assert_eq!(map.cells[2].stable, 1);
    let said = map.to_string();
    assert!(said.contains("nothing in 2 cells, first: "), "{said}");
    let table = map.to_csv();
    let row = table.lines().nth(1).expect("a row");
    assert!(row.starts_with("0.7,-1.0,,,,,,,,,not computable,"), "{row}");
}

#[test]
fn what_was_not_looked_at_says_so() {
    let values = [0.7, 1.0];
    let rows = [0.5, 1.0, 2.0];
    // The contact is never lost.
    let model = OneSided {
        ratio: 0.02,
        ..MODEL
    };
    let request = || FrequencyResponse::of(&model).from(0.65).to(1.05);
    let whole = request().map(&values, "load", &rows).expect("a map");
    let stop_at = |row: usize, stage: Stage| {
        let mut rows_done = 0;
        request().map_with(&values, "load", &rows, |progress| {
            rows_done = if progress.stage == Stage::Map {
                progress.done
            } else {
                rows_done
            };
            if rows_done == row && progress.stage == stage {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        })
    };
    // After the first row, and within the second.
    for stage in [Stage::Map, Stage::Branch, Stage::Settling] {
        let part = stop_at(1, stage).expect("a map");
        assert_eq!(part.cells[..2], whole.cells[..2]);
        let rest = part.cells[2..].iter();
        assert!(
            rest.clone()
                .all(|cell| cell.reason == Some(Reason::Interrupted))
        );
        assert_eq!(rest.count(), 4);
        assert_eq!(part.branches[1..], [0, 0]);
        assert!(part.to_string().contains("not looked at: 4 cells"));
    }
    let cancel = Cancel::new();
    cancel.cancel();
    let none = request().cancel(&cancel).map(&values, "load", &rows);
    let none = none.expect("a map of nothing");
    let mut cells = none.cells.iter();
    assert!(cells.all(|cell| cell.reason == Some(Reason::Interrupted)));
}

/// Values of what varies, a parameter with its values, and what is said.
const REFUSED: [(&[f64], &str, &[f64], &str); 10] = [
    (
        &[],
        "load",
        &[1.0],
        "values = 0: there must be at least one",
    ),
    (
        &[0.9],
        "load",
        &[],
        "others = 0: there must be at least one",
    ),
    (
        &[0.9],
        "force",
        &[1.0],
        "there is no parameter force; there are load, ratio",
    ),
    (
        &[0.9],
        "omega",
        &[1.0],
        "what is varied is omega: it must be another one",
    ),
    (
        &[0.9],
        "ratio",
        &[0.1, -0.1],
        "parameter ratio = -0.1 is outside its range [0, inf)",
    ),
    (
        &[0.9],
        "load",
        &[f64::NAN],
        "parameter load = NaN is outside its range",
    ),
    (
        &[0.9, 2.0],
        "load",
        &[1.0],
        "map = 2: must be between from and to",
    ),
    (
        &[f64::NAN],
        "load",
        &[1.0],
        "map = NaN: must be between from and to",
    ),
    (
        &[0.9, 0.8, 0.9],
        "load",
        &[1.0],
        "values = 0.9: must not be there twice",
    ),
    (
        &[0.9],
        "load",
        &[1.0, 1.0],
        "others = 1: must not be there twice",
    ),
];

#[test]
fn what_cannot_be_asked_is_refused() {
    let refused = |values: &[f64], parameter: &str, others: &[f64]| -> String {
        let error: Error = request()
            .map(values, parameter, others)
            .expect_err("refused");
        assert_eq!(error.kind(), ErrorKind::Request);
        error.to_string()
    };
    for (values, parameter, others, message) in REFUSED {
        let said = refused(values, parameter, others);
        assert!(said.starts_with(message), "{said}");
    }
}

#[test]
fn maps_need_another_parameter_and_both_ends() {
    let over_load = || FrequencyResponse::of(&MODEL).vary("load").from(0.5).to(1.5);
    let said = |found: Result<Map, Error>| found.expect_err("refused").to_string();
    let at = over_load().omega(0.9);
    assert!(said(at.map(&[1.0], "load", &[1.0])).contains("another one"));
    assert!(said(over_load().map(&[1.0], "ratio", &[0.1])).contains("`omega(...)`"));
    assert!(said(over_load().map(&[1.0], "omega", &[-1.0])).contains("positive"));
    let no_end = FrequencyResponse::of(&MODEL).from(0.6);
    assert!(said(no_end.map(&[0.6], "load", &[1.0])).contains("`to(...)`"));
}

/// Names, units and signals as a model with units has them.
#[test]
fn tables_and_charts_have_units() {
    hertzian::oscillator! {
        Mount(x: mm) {
            /// mass
            param m: t = 1e-3 > 0;
            param c: N*s/mm = 0.02;
            param k: N/mm = 40;
            /// shaking force
            param drive: N = 2;
            m*ddot(x) + c*dot(x) + k*x = drive*cos(omega*t);
            output twice: um = 2*x;
        }
    }
    let request = FrequencyResponse::of(&Mount::default())
        .from(100.0)
        .to(300.0);
    let map = request.map(&[150.0, 250.0], "drive", &[1.0, 2.0]);
    let map = map.expect("a map");
    assert_eq!(map.signal, "twice");
    for (place, cell) in map.cells.iter().enumerate() {
        let [omega, drive] = map.at(place).expect("a cell");
        let size = 4e3 * drive / (40.0 - 1e-3 * omega * omega).hypot(0.02 * omega);
        let found = cell.largest.expect("a size");
        assert!((found / size - 1.0).abs() < 1e-6, "{found} {size}");
    }
    let table = map.to_csv();
    assert!(table.starts_with(
        "omega [rad/s],drive [N],stable,unstable,undecided,missed,motions,restless,largest [um],periods,verdict,reason\n\
         150.0,1.0,1,0,0,0,18,0,"
    ), "{table}");
    assert!(
        table
            .lines()
            .skip(1)
            .all(|line| line.ends_with(",1,all stable,"))
    );
    let [svg, sizes, verdicts] = [
        map.chart_of_stable(),
        map.chart_of_largest(),
        map.chart_of_verdicts(),
    ]
    .map(|chart| chart.to_svg());
    for svg in [&svg, &sizes, &verdicts] {
        assert!(svg.contains("excitation frequency ω [rad/s]"));
        assert!(svg.contains("drive (shaking force) [N]"));
        assert!(svg.contains("Mount: m = 0.001 t, "), "{svg}");
    }
    assert!(svg.contains("\"1 stable orbit\"") && verdicts.contains("\"all stable\""));
    assert!(sizes.contains("largest peak-to-peak of twice of stable orbits"));
    assert!(sizes.contains(" um to "), "{sizes}");
}

#[test]
fn what_is_read_is_what_was_written() {
    let name = format!("hertzian-map-{}", std::process::id());
    let path = std::env::temp_dir().join(name);
    let model = OneSided {
        ratio: 0.02,
        ..MODEL
    };
    let request = FrequencyResponse::of(&model).from(0.65).to(1.05);
    let map = request.map(&[0.7, 0.9], "load", &[-1.0, 1.0]);
    let map = map.expect("a map");
    map.write(&path).expect("written");
    assert_eq!(Map::read(&path).expect("read"), map);
    let text = std::fs::read_to_string(&path).expect("text");
    let refused = |text: String| {
        std::fs::write(&path, text).expect("written");
        Map::read(&path).expect_err("refused").to_string()
    };
    assert!(refused(text.replace("\"version\":2", "\"version\":1")).contains("of version 1"));
    assert!(refused(text[..text.len() / 2].to_owned()).contains("ends early"));
    assert!(refused(text.replace("[0.7,0.9]", "[0.7]")).contains("4 cells for 1 values"));
    assert!(refused("{\"version\":2,\"branches\":[]}".to_owned()).contains("no file of this kind"));
    std::fs::remove_file(&path).expect("removed");
}

hertzian::oscillator! {
    /// Gears that turn freely, whose mesh is now stiffer and now softer.
    Gears(pinion, wheel) {
        param load;
        param variation in 0.0..1.0;
        law teeth(gap) { gap > 1 => gap - 1, -1 <= gap <= 1 => 0, gap < -1 => gap + 1 }
        let force = (1 + variation*cos(omega*t))*teeth(pinion - wheel) + 1500/3e8^(1/2)*(dot(pinion) - dot(wheel));
        1.5*ddot(pinion) + force = load;
        3*ddot(wheel) - force = -load;
        output relative = pinion - wheel;
    }
}

hertzian::oscillator! {
    /// The same by the displacement of one against the other: their masses make a reduced one of `1.5 3/(1.5 + 3)`.
    Mesh(relative) {
        param load;
        param variation in 0.0..1.0;
        law teeth(gap) { gap > 1 => gap - 1, -1 <= gap <= 1 => 0, gap < -1 => gap + 1 }
        ddot(relative) + (1 + variation*cos(omega*t))*teeth(relative) + 1500/3e8^(1/2)*dot(relative) = load;
    }
}

/// Torque and variation of the mesh where the resonance bends. How many orbits are stable is also known by integration from forty states by
/// scipy (`examples/tests/integrated/reference.py`: its gears at 14000 rad/s, with lengths in units of the play and the resonance at one).
#[test]
fn gears_that_turn_freely_have_the_map_of_their_relative_motion() {
    let of = |system: &dyn hertzian::System| {
        let request = FrequencyResponse::of(system).by(Shooting::new());
        let request = request
            .vary("load")
            .from(0.08)
            .to(0.42)
            .omega(1.4e4 / 3e8_f64.sqrt());
        let map = request.map(&[0.1, 0.2, 0.4], "variation", &[0.1, 0.2, 0.3]);
        map.unwrap()
    };
    let (load, variation) = (0.1, 0.1);
    let gears = of(&Gears { load, variation });
    let mesh = of(&Mesh { load, variation });
    assert_eq!([&gears.signal, &mesh.signal], ["relative", "relative"]);
    let stable: Vec<usize> = gears.cells.iter().map(|cell| cell.stable).collect();
    assert_eq!(stable, [1, 1, 1, 2, 2, 2, 2, 2, 2]);
    for (free, held) in gears.cells.iter().zip(&mesh.cells) {
        let counts = |cell: &Cell| (cell.stable, cell.unstable, cell.undecided, cell.missed);
        assert_eq!(counts(free), counts(held));
        assert_eq!(free.periods, held.periods);
        let (free, held) = (free.largest.unwrap(), held.largest.unwrap());
        assert!((free - held).abs() < 1e-9 * held, "{free} {held}");
    }
}
