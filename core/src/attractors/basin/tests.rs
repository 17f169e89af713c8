//! Basins of the one-sided oscillator at `A = 1`, `omega = 1`, where orbits of periods 1 to 5 coexist.

use std::path::PathBuf;

use super::*;
use crate::error::{ErrorKind, chain};
use crate::system::Variable;
use crate::testing::one_sided::{OneSided, one_sided};
use crate::time::stroboscope::Stroboscope;
use crate::time::{FlowError, See, Tangent, Work};

const MODEL: OneSided = one_sided(1.0);

fn grid(count: usize) -> Grid {
    let axis = |entry, from, to| Axis::of(entry).from(from).to(to).cells(count);
    Grid::new(vec![0.0; 2], axis(0, -60.0, 10.0), axis(1, -12.0, 12.0))
}

fn basin(count: usize) -> Basin {
    Basin::of(&MODEL).omega(1.0).grid(grid(count))
}

fn compute(count: usize, threads: usize) -> Basins {
    basin(count).threads(threads).run().expect("basins")
}

/// Period, first point, multiplier if it is known, and the error of what is known.
type Known = (usize, [f64; 2], Option<[f64; 2]>, f64);

/// States and multipliers of periods 1 to 3, computed independently from the closed-form flow in 80-bit arithmetic and confirmed
/// with 60 digits. The others were found by plain iteration with a program in C of its own: period 3 of smaller
/// amplitude from -6.358310901, period 4 from -58.39796, period 5 from -99.52834, period 28 from -7.67695951.
#[test]
fn coexisting_orbits_are_told_apart() {
    let basins = compute(48, 2);
    assert!(basins.complete);
    let orbits: [Known; 7] = [
        (
            1,
            [-1.999_776_122_757_642_7, 0.178_235_874_603_685_45],
            Some([-0.655_596_449_627_929_2, 0.615_582_920_279_132_8]),
            1e-12,
        ),
        (
            2,
            [-8.051_070_357_195_234, -2.756_595_228_529_427],
            Some([-0.524_746_191_089_171_2, 0.733_336_154_170_019_1]),
            1e-12,
        ),
        (
            3,
            [-31.334_287_816_436_888, 0.605_360_285_158_400_4],
            Some([-0.380_774_924_593_537_2, 0.817_888_662_584_343_5]),
            1e-12,
        ),
        (3, [-6.358_310_901, -0.023_104_43], None, 1e-7),
        (4, [-58.397_960_379, -2.282_675_409], None, 1e-7),
        (5, [-99.528_341_826, 1.207_306_973], None, 1e-7),
        (28, [-7.676_959_512, -0.661_911_862], None, 1e-7),
    ];
    assert_eq!(
        basins.attractors.len(),
        orbits.len(),
        "{:?}",
        basins.attractors
    );
    for (found, (period, point, multiplier, error)) in basins.attractors.iter().zip(orbits) {
        assert_eq!((found.period, found.points.len()), (period, period));
        let off = (found.points[0][0] - point[0]).hypot(found.points[0][1] - point[1]);
        assert!(
            off < 10.0 * error,
            "{period}: {:?} {off:e}",
            found.points[0]
        );
        assert!(found.multipliers[0].norm() < 1.0);
        if let Some([re, im]) = multiplier {
            let off = (found.multipliers[0].re - re).hypot(found.multipliers[0].im - im);
            assert!(off < 1e-11, "{period}: {:?}", found.multipliers);
        }
    }
    let periodic = |fate: &Fate| matches!(fate, Fate::Periodic(_));
    assert!(basins.fates.iter().all(periodic));
}

/// Where a neighbourhood says that a motion ends, it does end when it is simply followed.
#[test]
fn recognised_motions_end_where_they_are_said_to() {
    let count = 30;
    let (grid, basins) = (grid(count), compute(count, 1));
    let mut map = Stroboscope::of(&MODEL, 1.0).expect("a flow");
    let mut state = [0.0; 2];
    for (cell, fate) in basins.fates.iter().enumerate() {
        grid.state(cell, &mut state);
        for _ in 0..4000 {
            map.map(&mut state).expect("a motion");
        }
        let near = |point: &Vec<f64>| (point[0] - state[0]).hypot(point[1] - state[1]) < 1e-8;
        let ends = basins
            .attractors
            .iter()
            .position(|attractor| attractor.points.iter().any(near));
        assert_eq!(
            ends.map(Fate::Periodic),
            Some(*fate),
            "cell {cell}: {state:?}"
        );
    }
}

/// A single motion, recognised without knowing what others found, gives what it gives in the grid.
#[test]
fn a_cell_does_not_depend_on_the_others() {
    let (whole, grid) = (compute(40, 1), grid(40));
    for cell in (0..1600).step_by(97) {
        let mut state = [0.0; 2];
        grid.state(cell, &mut state);
        let tiny = |entry| {
            Axis::of(entry)
                .from(state[entry] - 1e-13)
                .to(state[entry] + 1e-13)
                .cells(1)
        };
        let tiny = Grid::new(vec![0.0; 2], tiny(0), tiny(1));
        let alone = basin(40).grid(tiny).run().expect("basins");
        let Fate::Periodic(index) = whole.fates[cell] else {
            panic!("{cell}: {:?}", whole.fates[cell]);
        };
        let (one, other) = (&alone.attractors[0], &whole.attractors[index]);
        assert_eq!(one.period, other.period, "cell {cell}");
        for (a, b) in one.points.concat().iter().zip(other.points.concat()) {
            assert!((a - b).abs() < 1e-9, "cell {cell}: {a} {b}");
        }
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let one = compute(40, 1);
    for threads in [2, 3] {
        assert_eq!(compute(40, threads), one);
    }
}

fn log_path(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("hertzian-basin-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(name);
    let _ = std::fs::remove_file(&path);
    path
}

#[test]
fn a_run_that_was_ended_goes_on_and_computes_nothing_twice() {
    let whole = compute(64, 2);
    let path = log_path("ended");
    let mut runs = 0;
    let mut computed = 0;
    loop {
        // Ends after a few blocks.
        let mut left = 5;
        let watch = |progress: Progress<'_>| {
            assert_eq!(progress.total, Some(64 * 64));
            computed += 1;
            left -= 1;
            if left > 0 {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        let part = basin(64).threads(2).resume(&path, "basin", watch);
        let part = part.expect("basins");
        runs += 1;
        if part.complete {
            assert_eq!(part, whole);
            break;
        }
        assert!(part.count(Fate::Unknown) > 0);
    }
    let blocks: usize = grid(64)
        .rounds()
        .iter()
        .map(|round| round.len().div_ceil(256))
        .sum();
    assert!(runs > 2);
    assert_eq!(computed, blocks);
    // A record that was being written when the process ended is computed again.
    let bytes = std::fs::read(&path).expect("readable");
    std::fs::write(&path, &bytes[..bytes.len() - 3]).expect("written");
    let again = |request: Basin| request.resume(&path, "basin", |_| ControlFlow::Continue(()));
    assert_eq!(again(basin(64)).expect("basins"), whole);
    let other = again(basin(64).phase(0.5)).expect_err("another request");
    assert_eq!(other.kind(), ErrorKind::File);
}

/// A cell whose motion was cut short is not looked at, and one that was looked at before has the fate that it has.
#[test]
fn a_cancelled_run_keeps_its_cells() {
    let whole = compute(64, 1);
    let cancel = Cancel::new();
    let mut parts = 0;
    let part = basin(64).cancel(&cancel).run_with(|_| {
        parts += 1;
        if parts == 4 {
            cancel.cancel();
        }
        ControlFlow::Continue(())
    });
    let part = part.expect("basins");
    assert_eq!(parts, 4);
    assert!(!part.complete && part.count(Fate::Unknown) > 0);
    let period = |basins: &Basins, fate: Fate| match fate {
        Fate::Periodic(index) => basins.attractors[index].period,
        _ => 0,
    };
    for (of_part, of_whole) in part.fates.iter().zip(&whole.fates) {
        let same = period(&part, *of_part) == period(&whole, *of_whole);
        assert!(same || *of_part == Fate::Unknown);
    }
}

/// Beyond the interior crisis nothing is periodic; without damping and at resonance everything grows.
#[test]
fn chaos_and_escape_are_classes_of_their_own() {
    let model = OneSided {
        drive: 1.785,
        ..MODEL
    };
    let on = |system: &OneSided| Basin::of(system).omega(1.0).grid(grid(3));
    let chaos = on(&model).patience(500).run().expect("basins");
    assert_eq!(chaos.count(Fate::Chaotic), 9, "{chaos:?}");
    // In intermittency neighbours part by a hundredth in a period: two thousand periods do not tell it from zero.
    let model = OneSided {
        drive: 1.78,
        ..MODEL
    };
    let at = |entry, value| Axis::of(entry).from(value).to(value).cells(1);
    let one = Grid::new(vec![0.0; 2], at(0, -0.35), at(1, 0.335));
    let slow = on(&model).grid(one).run();
    assert_eq!(slow.expect("basins").fates, [Fate::Chaotic]);
    crate::oscillator! {
        Resonance(x) {
            ddot(x) + x = cos(omega*t);
        }
    }
    let resonance = Basin::of(&Resonance {}).omega(1.0).grid(grid(3));
    let escape = resonance.clone().escape(100.0).run().expect("basins");
    assert_eq!(escape.count(Fate::Escaped), 9);
    // Without damping and off resonance motions have two frequencies.
    let long = resonance.omega(2.0_f64.sqrt()).patience(300);
    let long = long.run().expect("basins");
    assert_eq!(long.count(Fate::Long), 9);
}

/// The same states, one by one.
#[test]
fn motions_from_states_settle_as_those_of_a_grid() {
    let plane = grid(4);
    let states = (0..plane.cells()).map(|cell| {
        let mut state = vec![0.0; 2];
        plane.state(cell, &mut state);
        state
    });
    let given = basin(4).grid(Grid::of_states(states.collect())).run();
    let (given, expected) = (given.expect("basins"), basin(4).run().expect("basins"));
    assert_eq!(given.fates, expected.fates);
    assert_eq!(given.attractors.len(), expected.attractors.len());
}

#[test]
fn a_request_that_cannot_be_used_is_refused() {
    let on = |change: &dyn Fn(&mut Grid)| {
        let mut grid = grid(4);
        change(&mut grid);
        basin(4).grid(grid)
    };
    for (request, said) in [
        (on(&|grid| grid.start = vec![0.0; 3]), "entries"),
        (on(&|grid| grid.rows.entry = 0), "different"),
        (on(&|grid| grid.rows.entry = 2), "entries"),
        (on(&|grid| grid.columns.to = f64::NAN), "finite"),
        (on(&|grid| grid.columns.count = 0), "cell"),
        (on(&|grid| grid.columns.count = usize::MAX), "cell"),
        (basin(4).longest(0), "longest"),
        (basin(4).escape(-1.0), "escape"),
        (basin(4).threads(0), "threads"),
        (Basin::of(&MODEL).omega(1.0), "grid is missing"),
        (Basin::of(&MODEL).grid(grid(4)), "omega"),
        (basin(4).grid(Grid::of_states(Vec::new())), "cell"),
        (
            basin(4).grid(Grid::of_states(vec![vec![0.0; 2], vec![0.0; 3]])),
            "entries",
        ),
        (
            basin(4).grid(Grid::of_states(vec![vec![0.0, f64::NAN]])),
            "finite",
        ),
    ] {
        let error = request.run().expect_err("a refusal");
        assert_eq!(error.kind(), ErrorKind::Request);
        assert!(error.to_string().contains(said), "{error}");
    }
}

/// A flow none of whose motions can be computed.
struct Stuck;

impl Flow for Stuck {
    fn coordinates(&self) -> usize {
        1
    }

    fn admits(&self, _: Variable, _: f64) -> bool {
        true
    }

    fn set(&mut self, _: Variable, _: f64) -> Result<(), FlowError> {
        Ok(())
    }

    fn until(&mut self, _: &Cancel) {}

    fn advance(
        &mut self,
        from: f64,
        _: f64,
        _: &mut [f64],
        _: Option<&mut Tangent>,
        _: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        Err(FlowError::Rests { phase: from })
    }

    fn work(&self) -> Work {
        Work::default()
    }
}

#[test]
fn a_basin_without_a_motion_is_an_error() {
    let moving = Moving {
        flows: vec![Box::new(Stuck)],
        parameters: Vec::new(),
        omega: 1.0,
    };
    let found = basin(4).compute(moving, None, &mut |_| ControlFlow::Continue(()));
    let reason = FlowError::Rests { phase: 0.0 };
    assert_eq!(found, Err(BasinError::Motion { reason }));
    let said = chain(&BasinError::Motion { reason }).to_string();
    assert!(said.starts_with("no motion of the grid can be computed: the motion rests"));
}
