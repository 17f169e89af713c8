//! What is stated of the error of an event, and of an orbit, against the true error.

use hertzian::{Event, EventKind, FrequencyResponse, Point};
use hertzian_tests::nearest;

use super::curves::{CURVE_2B, CURVE_5A};
use super::direct::PowerForm;
use super::exact::{Exact, FIGURE_2A_BREAKS, FIGURE_2B_BREAKS, FIGURE_2B_UNLISTED, PERIOD_2_FOLDS};
use super::models::{
    FIGURE_2A, FIGURE_2A_BELOW, FIGURE_2B, FIGURE_2B_BELOW, FIGURE_4A_LOAD_1, FIGURE_4A_LOAD_5,
    FIGURE_5A, FIGURE_5B, FIGURE_5C, Figure, OneSided,
};

/// The tolerance alone, and given harmonics.
const HARMONICS: [Option<usize>; 5] = [None, Some(5), Some(10), Some(20), Some(40)];
/// What is stated, times this, is to hold the true error of 95 % of the events.
const MARGIN: f64 = 3.0;

/// An event that was found: where, how many harmonics were asked for, true and stated error.
struct Row {
    curve: &'static str,
    exact: f64,
    harmonics: Option<usize>,
    error: f64,
    stated: f64,
}

impl Row {
    fn holds(&self) -> bool {
        self.error <= MARGIN * self.stated
    }
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let harmonics = self
            .harmonics
            .map_or("-".to_owned(), |harmonics| harmonics.to_string());
        write!(
            f,
            "{:10} {:.9} {harmonics:>4} {:9.1e} {:9.1e} {:7.2}",
            self.curve,
            self.exact,
            self.error,
            self.stated,
            self.error / self.stated
        )
    }
}

/// The fold that is meant by an exact one: the nearest in value, of the same size within a tenth, and within 0.01 in value.
/// `None` if there is none, as where harmonics are too few to know it.
fn meant<'e>(folds: &'e [Event], exact: &Exact) -> Option<&'e Event> {
    let far = |fold: &Event| (fold.point.value - exact.omega).abs();
    let alike = folds
        .iter()
        .filter(|fold| (fold.point.peak_to_peak() / exact.peak_to_peak - 1.0).abs() < 0.1)
        .filter(|fold| far(fold) < 0.01);
    nearest(alike, exact.omega, |fold| fold.point.value)
}

/// Rows of one figure, and how many folds were missed.
fn of_figure(figure: &Figure) -> (Vec<Row>, usize) {
    let (mut rows, mut missed) = (Vec::new(), 0);
    for harmonics in HARMONICS {
        let folds = figure.folds_with(harmonics);
        for exact in figure.folds {
            let Some(fold) = meant(&folds, exact) else {
                println!(
                    "{}: nothing at {} with {harmonics:?}",
                    figure.name, exact.omega
                );
                // Seven oscillations of the orbit per period are more than five harmonics tell.
                assert_eq!(harmonics, Some(5), "{} {exact:?} {folds:?}", figure.name);
                missed += 1;
                continue;
            };
            rows.push(Row {
                curve: figure.name,
                exact: exact.omega,
                harmonics,
                error: (fold.point.value - exact.omega).abs(),
                stated: fold.error,
            });
        }
    }
    (rows, missed)
}

/// The folds of the orbits of period two in drive, each from the side that reaches it first.
fn of_period_2() -> Vec<Row> {
    let model = OneSided {
        zeta: 0.032,
        alpha: 1.0,
        load: 1.0,
        drive: 1.0,
    };
    let mut rows = Vec::new();
    for harmonics in HARMONICS {
        for (exact, from, to) in [(PERIOD_2_FOLDS[0], 1.0, 0.1), (PERIOD_2_FOLDS[1], 1.6, 2.2)] {
            let request = FrequencyResponse::of(&model).vary("drive").omega(1.0);
            let request = request.period(2).from(from).to(to).stability(false);
            let request = match harmonics {
                Some(harmonics) => request.harmonics(harmonics),
                None => request,
            };
            let branch = request.run().unwrap();
            let folds: Vec<_> = branch.folds().collect();
            let [fold] = folds.as_slice() else {
                panic!("{exact} at {harmonics:?}: {folds:?}");
            };
            rows.push(Row {
                curve: "period 2",
                exact,
                harmonics,
                error: (fold.point.value - exact).abs(),
                stated: fold.error,
            });
        }
    }
    rows
}

/// Where symmetry is lost: every place once, however many harmonics.
fn of_symmetry() -> Vec<Row> {
    let upper = Figure {
        from: 0.8,
        to: 1.1,
        ..FIGURE_2B
    };
    let mut rows = Vec::new();
    for (figure, breaks) in [
        (FIGURE_2A_BELOW, FIGURE_2A_BREAKS),
        (upper, FIGURE_2B_BREAKS),
    ] {
        let model = figure.model();
        for harmonics in HARMONICS {
            let request = figure.request(&*model).stability(false);
            let request = match harmonics {
                Some(harmonics) => request.harmonics(harmonics),
                None => request,
            };
            let branch = request.run().unwrap();
            let mut found: Vec<&Event> = branch
                .events
                .iter()
                .filter(|event| event.kind == EventKind::SymmetryBreaking)
                .collect();
            found.sort_by(|a, b| a.point.value.total_cmp(&b.point.value));
            assert_eq!(found.len(), breaks.len(), "{harmonics:?} {found:?}");
            rows.extend(found.iter().zip(breaks).map(|(event, exact)| Row {
                curve: "symmetry",
                exact,
                harmonics,
                error: (event.point.value - exact).abs(),
                stated: event.error,
            }));
        }
    }
    rows
}

/// Orbits of 5 and 10 harmonics along curves, each the nearest in size to one that is known. Where none is within a tenth of it, as
/// where few harmonics have a fold elsewhere, what is stated does not hold either.
#[test]
fn the_true_error_of_orbits_is_at_most_three_times_the_stated_one() {
    let (mut all, mut holding, mut missed) = (0, 0, 0);
    for (figure, known) in [(FIGURE_5A, &CURVE_5A[..]), (FIGURE_2B, &CURVE_2B[..])] {
        let model = figure.model();
        for few in [5, 10] {
            let request = figure.request(&*model).harmonics(few);
            let branch = request.run().unwrap();
            for &[omega, exact] in known {
                let orbits = branch.at(omega).unwrap();
                let error = |orbit: &Point| (orbit.peak_to_peak() / exact - 1.0).abs();
                let nearest = orbits.iter().min_by(|a, b| error(a).total_cmp(&error(b)));
                let Some(orbit) = nearest.filter(|orbit| error(orbit) < 0.1) else {
                    println!("{}: nothing at {omega} with {few}", figure.name);
                    missed += 1;
                    continue;
                };
                let (error, stated) = (error(orbit), orbit.error.unwrap());
                // Below, the rounding of what is known would count.
                if stated > 1e-5 {
                    all += 1;
                    holding += usize::from(error <= MARGIN * stated);
                }
            }
        }
    }
    println!("{holding} of {all} hold, {missed} missed");
    assert!(all > 60, "{all}");
    let part = holding as f64 / f64::from(all + missed);
    assert!(part >= 0.95, "{holding} of {all}, {missed} missed");
}

#[test]
fn the_true_error_is_at_most_three_times_the_stated_one() {
    let figures = [
        FIGURE_2B_BELOW,
        FIGURE_2B,
        FIGURE_2A,
        FIGURE_2A_BELOW,
        FIGURE_4A_LOAD_1,
        FIGURE_4A_LOAD_5,
        FIGURE_5A,
        FIGURE_5B,
        FIGURE_5C,
    ];
    let (first, others) = figures.split_at(1);
    let (mut rows, missed) = std::thread::scope(|scope| {
        let slowest = scope.spawn(|| of_figure(&first[0]));
        let (mut rows, mut missed) = (of_period_2(), 0);
        rows.extend(of_symmetry());
        for figure in others {
            let (more, misses) = of_figure(figure);
            rows.extend(more);
            missed += misses;
        }
        let (more, misses) = slowest.join().unwrap();
        rows.extend(more);
        (rows, missed + misses)
    });
    rows.sort_by(|a, b| a.curve.cmp(b.curve).then(a.exact.total_cmp(&b.exact)));
    println!("curve      fold           K      true    stated   ratio");
    for row in &rows {
        println!("{row}");
    }
    let holding = rows.iter().filter(|row| row.holds()).count();
    println!("{holding} of {} hold, {missed} missed", rows.len());
    // An event that is missed does not hold either.
    let all = rows.len() + missed;
    assert!(
        holding as f64 >= 0.95 * all as f64,
        "{holding} of {all}, {missed} missed"
    );
}

hertzian::oscillator! {
    /// A linear mode, lightly damped, with a weak spring on one side.
    Mode(x) {
        param damping >= 0;
        law side(gap) { gap > 0 => 0.01*gap, else => 0 }
        ddot(x) + damping*dot(x) + x + side(x) = cos(omega*t);
    }
}

/// Ten times the frequency meets the resonance: the tenth harmonic is large, although five are asked for.
#[test]
fn a_linear_mode_among_the_harmonics_left_out_is_in_the_stated_error() {
    let model = Mode { damping: 0.01 };
    let orbit = |harmonics| {
        let request = FrequencyResponse::of(&model).from(0.09).to(0.11);
        let branch = request.harmonics(harmonics).run().unwrap();
        let mut orbits = branch.at(0.100_249_69).unwrap();
        assert_eq!(orbits.len(), 1);
        orbits.remove(0)
    };
    let many = orbit(40);
    // With three and four harmonics the tenth is beyond those of the correction, and is bounded by extrapolation.
    for (harmonics, most) in [(5, 10.0), (4, 100.0), (3, 100.0)] {
        let few = orbit(harmonics);
        let error = (few.peak_to_peak() / many.peak_to_peak() - 1.0).abs();
        let stated = few.error.unwrap();
        assert!(error > 1e-3, "{harmonics}: {error:e}");
        assert!(
            error < MARGIN * stated && stated < most * error,
            "{harmonics}: {error:e} {stated:e}"
        );
    }
}

/// A pair of folds of Fig. 2b, 0.0007 apart, that the exact values do not list: found, and confirmed by direct
/// integration of the three orbits in between.
#[test]
fn figure_2b_has_another_pair_of_folds() {
    let narrow = Figure {
        from: 0.66,
        to: 0.62,
        ..FIGURE_2B
    };
    let model = narrow.model();
    let request = narrow.request(&*model).stability(false).harmonics(40);
    let branch = request.run().unwrap();
    let folds: Vec<_> = branch.folds().map(|fold| fold.point.value).collect();
    assert_eq!(folds.len(), 2, "{folds:?}");
    for (found, value) in folds.iter().zip(FIGURE_2B_UNLISTED) {
        assert!((found - value).abs() < 1e-5, "{folds:?}");
    }
    let omega = 0.6398;
    let orbits = branch.at(omega).unwrap();
    assert_eq!(orbits.len(), 3);
    let system = PowerForm {
        alpha: narrow.alpha,
        zeta: narrow.zeta(),
        drive: 0.1,
        load: 0.0,
        omega,
    };
    for orbit in &orbits {
        let (x, v) = orbit.orbit.state_at(0, 0.0).unwrap();
        let (exact_x, exact_v) = system.periodic(x, v);
        let (again_x, again_v) = system.periodic(exact_x, exact_v);
        assert!((again_x - exact_x).hypot(again_v - exact_v) < 1e-8);
        // The unbounded stiffness costs the integration digits, near folds even more: what counts is that there are three.
        let far = (x - exact_x).hypot(v - exact_v);
        for other in &orbits {
            let (other_x, other_v) = other.orbit.state_at(0, 0.0).unwrap();
            let apart = (x - other_x).hypot(v - other_v);
            assert!(std::ptr::eq(orbit, other) || apart > 10.0 * far);
        }
    }
}
