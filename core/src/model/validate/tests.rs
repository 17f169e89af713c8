//! One row for each thing that can be asked for and cannot be: it is refused with a sentence, before any work.

use crate::attractors::basin::{Axis, Basin, Grid};
use crate::attractors::lyapunov::Lyapunov;
use crate::attractors::sweep::Sweep;
use crate::bifurcation::Bifurcations;
use crate::bifurcation::backbone::{FreeOscillation, PhaseResonance};
use crate::error::{Error, chain};
use crate::response::FrequencyResponse;
use crate::shooting::Shooting;
use crate::time;
use crate::time::poincare::Section;
use crate::time::stroboscope::Stroboscope;

crate::oscillator! {
    Duffing(x) {
        param bend in 0.0..10.0;
        param drive;
        ddot(x) + 0.1*dot(x) + x + bend*x^3 = drive*cos(omega*t);
    }
}

const MODEL: Duffing = Duffing {
    bend: 0.2,
    drive: 0.2,
};

const NAN: f64 = f64::NAN;
const INFINITY: f64 = f64::INFINITY;

/// What is said of requests none of which can be used.
fn refused<R, A>(request: R, rows: &[(A, &str)])
where
    R: Fn(&A) -> Result<(), Error>,
    A: std::fmt::Debug,
{
    for (asked, sentence) in rows {
        let error = request(asked).expect_err(&format!("{asked:?}"));
        let text = chain(&error).to_string();
        assert!(text.contains(sentence), "{asked:?}: {text}");
        assert!(text.lines().count() == 1 && text.len() < 200, "{text}");
    }
}

#[test]
fn ends_of_ranges() {
    let model = MODEL;
    let rows = [
        ([NAN, 1.0], "omega = NaN"),
        ([1.0, INFINITY], "omega = inf"),
        ([-1.0, 1.0], "omega = -1"),
        ([1.0, 0.0], "omega = 0"),
        ([1.0, 1.0], "range is empty"),
    ];
    let response = || FrequencyResponse::of(&model);
    refused(|&[a, b]| response().from(a).to(b).run().map(drop), &rows);
    let shooting = || FrequencyResponse::of(&model).by(Shooting::new());
    refused(|&[a, b]| shooting().from(a).to(b).run().map(drop), &rows);
    let all = || Bifurcations::of(&model);
    refused(|&[a, b]| all().from(a).to(b).run().map(drop), &rows);
    let rows = [
        ([NAN, 1.0], "bend = NaN"),
        ([-1.0, 1.0], "bend = -1 is outside"),
        ([0.1, 11.0], "bend = 11 is outside"),
        ([0.1, 0.1], "range is empty"),
    ];
    let response = || FrequencyResponse::of(&model).vary("bend").omega(0.8);
    refused(|&[a, b]| response().from(a).to(b).run().map(drop), &rows);
    let shooting = || {
        FrequencyResponse::of(&model)
            .by(Shooting::new())
            .vary("bend")
            .omega(0.8)
    };
    refused(|&[a, b]| shooting().from(a).to(b).run().map(drop), &rows);
    let rows = [
        ([NAN, 1.0], "from = NaN"),
        ([0.1, INFINITY], "to = inf"),
        ([0.1, 0.1], "range is empty"),
    ];
    let free = || FreeOscillation::of(&model);
    refused(|&[a, b]| free().from(a).to(b).run().map(drop), &rows);
    let rows = [
        ([NAN, 1.0], "omega = NaN"),
        ([0.5, -2.0], "omega = -2"),
        ([0.5, 0.5], "range is empty"),
    ];
    let resonance = || PhaseResonance::of(&model).vary("drive").to(0.1);
    refused(|&[a, b]| resonance().between(a, b).run().map(drop), &rows);
}

#[test]
fn values_within_a_range() {
    let model = MODEL;
    let branch = FrequencyResponse::of(&model).from(0.5).to(0.6).run();
    let branch = branch.expect("a branch");
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .from(0.5)
        .to(0.6);
    let by_shooting = shooting.run().expect("a branch");
    let single = [(NAN, "NaN"), (INFINITY, "inf")];
    refused(|&value| branch.at(value).map(drop), &single);
    refused(|&value| by_shooting.at(value).map(drop), &single);
    refused(|&value| shooting.orbit(value).map(drop), &single);
    let response = FrequencyResponse::of(&model);
    refused(|&value| response.orbit(value).map(drop), &single);
    refused(|&value| shooting.through(value).map(drop), &single);
    let near = |&value: &f64| {
        shooting
            .clone()
            .near_state(&[value, 0.0])
            .orbit(0.5)
            .map(drop)
    };
    refused(near, &single);
    let basin = |escape| Basin::of(&model).grid(grid(1.0)).escape(escape);
    let all = || Bifurcations::of(&model).from(0.5).to(0.6);
    let rows = [(NAN, "search = NaN"), (9.0, "must be in the range")];
    refused(|&v| all().search(v, basin(1.0)).run().map(drop), &rows);
    let rows = [(NAN, "escape must be"), (-1.0, "escape must be")];
    refused(|&v| all().search(0.55, basin(v)).run().map(drop), &rows);
}

#[test]
fn numbers_of_a_request() {
    let model = MODEL;
    let response = || FrequencyResponse::of(&model).from(0.5).to(0.6);
    let shooting = || {
        FrequencyResponse::of(&model)
            .by(Shooting::new())
            .from(0.5)
            .to(0.6)
    };
    let tolerances = [
        (NAN, "tolerance = NaN"),
        (0.0, "tolerance = 0"),
        (-1.0, "tolerance = -1"),
    ];
    refused(|&v| response().tolerance(v).run().map(drop), &tolerances);
    refused(|&v| shooting().tolerance(v).run().map(drop), &tolerances);
    let flow = |&v: &f64| time::of(&model, 0.5, v).map(drop);
    refused(flow, &tolerances);
    let steps = [(NAN, "largest_step = NaN"), (0.0, "largest_step = 0")];
    refused(|&v| response().largest_step(v).run().map(drop), &steps);
    refused(|&v| shooting().largest_step(v).run().map(drop), &steps);
    let counts = [(0, "must be from"), (usize::MAX, "must be from")];
    refused(|&n| response().period(n).run().map(drop), &counts);
    refused(|&n| shooting().period(n).run().map(drop), &counts);
    refused(|&n| response().max_points(n).run().map(drop), &counts);
    refused(|&n| response().harmonics(n).run().map(drop), &counts);
    let counts = [(0, "must be at least 1"), (usize::MAX, "3000 at most")];
    let parted = |&n: &usize| shooting().by(Shooting::new().segments(n)).run().map(drop);
    refused(parted, &counts);
    let flows = |&v: &f64| shooting().by(Shooting::new().tolerance(v)).run().map(drop);
    let tolerances = [
        (NAN, "the flow = NaN"),
        (0.0, "the flow = 0"),
        (-1.0, "the flow = -1"),
    ];
    refused(flows, &tolerances);
    let names = [("omego", "no parameter omego; there are bend, drive")];
    let vary = |&name: &&str| response().vary(name).run().map(drop);
    refused(vary, &names);
}

fn grid(high: f64) -> Grid {
    let axis = |entry| Axis::of(entry).from(-1.0).to(high).cells(2);
    Grid::new(vec![0.0, 0.0], axis(0), axis(1))
}

#[test]
fn motions() {
    let model = MODEL;
    let map = || Stroboscope::of(&model, 0.5).expect("a map");
    let sweep = |escape, start| {
        let sweep = Sweep::of(&model).from(0.5).to(0.5).values(1);
        let sweep = sweep.start(&[start, 0.0]).escape(escape);
        sweep.transient(1).periods(1)
    };
    let rows = [
        ([NAN, 0.0], "escape = NaN"),
        ([0.0, 0.0], "escape = 0"),
        ([-1.0, 0.0], "escape = -1"),
        ([1e6, NAN], "start = NaN"),
    ];
    let run = |&[escape, start]: &[f64; 2]| sweep(escape, start).run().map(drop);
    refused(run, &rows);
    let section = |&value: &f64| {
        let section = Section::entry(0, value);
        let follow = section.follow(&mut map(), &mut [0.0, 0.0], 1, &mut |_| {});
        follow.map_err(Error::from)
    };
    refused(section, &[(NAN, "the section is not a number")]);
    let batch = |&periods: &usize| {
        let mut map = map();
        let mut motion = Lyapunov::new(&mut map, &[0.0, 0.0]);
        motion.batch(periods).map(drop).map_err(Error::from)
    };
    refused(batch, &[(0, "no mean over no periods")]);
    let start = |&entry: &f64| map().map(&mut [entry, 0.0]).map_err(Error::from);
    refused(start, &[(NAN, "not finite"), (INFINITY, "not finite")]);
    let phase = |&phase: &f64| map().phase(phase).map(&mut [0.0, 0.0]).map_err(Error::from);
    refused(phase, &[(NAN, "phase NaN")]);
}

#[test]
fn basins() {
    let model = MODEL;
    let basin = || Basin::of(&model).omega(0.5).grid(grid(1.0));
    let rows = [
        (basin().threads(0), "threads must be from 1 to 1024"),
        (basin().threads(1025), "threads must be from 1 to 1024"),
        (basin().escape(NAN), "escape must be positive"),
        (basin().longest(0), "longest and patience"),
        (basin().grid(grid(NAN)), "grid must be finite"),
        (basin().tolerance(NAN), "tolerance = NaN"),
        (basin().omega(-1.0), "omega = -1"),
    ];
    refused(|basin: &Basin| basin.run().map(drop), &rows);
}
