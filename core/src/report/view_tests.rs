//! What stands on the axes of charts, against closed forms.

use hertzian_chart::{Chart, Scale};

use super::view::{Frequency, View};
use crate::branches::branch::Branch;
use crate::branches::point::{Event, Point};
use crate::event::EventKind;
use crate::report::error::ViewError;
use crate::response::FrequencyResponse;

hertzian::oscillator! {
    Linear(x: mm) {
        param drive: mm/s^2 = 1;
        param c: 1/s = 0.2;
        param k: 1/s^2 = 1;
        ddot(x) + c*dot(x) + k*x = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    Duffing(x) {
        param drive = 0.2;
        ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
    }
}

/// Colours of the first two curves of a chart.
const COLOURS: [&str; 2] = ["#0b4f8a", "#d55e00"];

/// Pixels of the first curve of a chart, as parts of the frame.
fn curve(chart: &Chart) -> Vec<[f64; 2]> {
    curve_in(chart, COLOURS[0])
}

/// Pixels of the first line of a colour.
fn curve_in(chart: &Chart, colour: &str) -> Vec<[f64; 2]> {
    let svg = chart.to_svg();
    let numbers = |path: &str| -> Vec<[f64; 2]> {
        let tokens = path.split(['M', 'L', 'Z', ' ']).filter(|t| !t.is_empty());
        let all: Vec<f64> = tokens.map(|t| t.parse().unwrap()).collect();
        all.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
    };
    let path = |mark: &str| {
        let line = svg.lines().find(|line| line.contains(mark)).expect(mark);
        let path = line.split("d=\"").nth(1).unwrap();
        numbers(path.split('"').next().unwrap())
    };
    // The border is drawn from the lower left corner on.
    let frame = path("Z\" fill=\"none\"");
    let ([left, bottom], [right, top]) = (frame[0], frame[2]);
    let part = |[x, y]: [f64; 2]| [(x - left) / (right - left), (y - bottom) / (top - bottom)];
    path(&format!("fill=\"none\" stroke=\"{colour}\""))
        .into_iter()
        .map(part)
        .collect()
}

/// `1/|1 - w^2 + 0.2 i w|`.
fn amplitude(omega: f64) -> f64 {
    1.0 / (1.0 - omega * omega).hypot(0.2 * omega)
}

fn linear() -> Branch {
    let system = Linear::default();
    FrequencyResponse::of(&system)
        .from(0.5)
        .to(1.5)
        .run()
        .unwrap()
}

#[test]
fn decibels_of_a_linear_oscillator_are_those_of_its_receptance() {
    let branch = linear();
    let view = View::new().of("x:h1".parse().unwrap());
    let hertz = [0.05, 0.25];
    for (scale, place) in [
        (Scale::Linear, (|y| y / 8.0) as fn(f64) -> f64),
        (Scale::Logarithmic, |y| (y.log10() + 2.0) / 3.0),
        // From 0.01, -40 dB, to 10, 20 dB.
        (Scale::Decibel, |y| (20.0 * y.log10() + 40.0) / 60.0),
    ] {
        let view = view.clone().scale(scale).frequency(Frequency::Hertz);
        let chart = branch.chart_of(&view).unwrap();
        let ends = if scale == Scale::Linear {
            [0.0, 8.0]
        } else {
            [0.01, 10.0]
        };
        let points = curve(&chart.limits(hertz, ends));
        assert!(points.len() > 20);
        for [x, y] in points {
            let omega = std::f64::consts::TAU * (hertz[0] + x * (hertz[1] - hertz[0]));
            let expected = place(amplitude(omega));
            assert!(
                (y - expected).abs() < 1.5e-3,
                "{scale:?} {omega}: {y}, {expected}"
            );
        }
    }
    let svg = branch
        .chart_of(&view.scale(Scale::Decibel))
        .unwrap()
        .to_svg();
    assert!(svg.contains("amplitude of harmonic 1 of x [dB over 1 mm]"));
}

#[test]
fn what_has_no_place_is_refused_with_its_value() {
    let branch = linear();
    let refused = |wanted: &str, scale| {
        let view = View::new().of(wanted.parse().unwrap()).scale(scale);
        branch.chart_of(&view).map(|_| ()).unwrap_err()
    };
    let error = refused("x:min", Scale::Decibel);
    let Some(ViewError::NotPositive {
        name, value, at, ..
    }) = error.downcast_ref()
    else {
        panic!("{error}");
    };
    assert_eq!(name, "smallest of x");
    assert!((value + amplitude(*at)).abs() < 1e-6);
    let error = refused("x:phase1", Scale::Logarithmic);
    let expected = "the phase of harmonic 1 of x is an angle: take a linear axis";
    assert_eq!(error.to_string(), expected);
    // The second harmonic of a linear oscillator is nothing at all.
    let view = View::new().of("x:h1".parse().unwrap()).harmonics(2);
    let error = branch.chart_of(&view).unwrap_err();
    let expected = "harmonics 1 to 2 of x are shown by their amplitudes: ask for x alone, not for its amplitude of harmonic 1";
    assert_eq!(error.to_string(), expected);
    let view = View::new().of("x".parse().unwrap()).harmonics(400);
    let error = branch.chart_of(&view).unwrap_err().to_string();
    assert!(
        error.starts_with("harmonic 400 of x was not computed"),
        "{error}"
    );
}

#[test]
fn events_are_marked_by_choice_and_the_others_counted() {
    let request = FrequencyResponse::of(&Duffing::default()).from(0.5).to(2.0);
    let branch = request.harmonics(5).run().unwrap();
    let folds = branch.folds().count();
    assert_eq!(folds, 2);
    let legend = "aria-label=\"fold\"";
    let all = branch.chart_of(&View::new()).unwrap().to_svg();
    assert!(all.contains(legend) && !all.contains("not marked"));
    let view = View::new().events([EventKind::PeriodDoubling]);
    let none = branch.chart_of(&view).unwrap().to_svg();
    assert!(!none.contains(legend) && none.contains("\"not marked: 2 folds; plain numbers"));
    let mut one = branch.clone();
    one.events.truncate(1);
    let fold = one.events[0].clone();
    for kind in [EventKind::NeimarkSacker, EventKind::BranchPoint] {
        let event = Event {
            kind,
            ..fold.clone()
        };
        one.events.extend([event.clone(), event]);
    }
    let counted = one.chart_of(&view).unwrap().to_svg();
    let expected = "not marked: 1 fold, 2 branch points, 2 Neimark-Sacker bifurcations;";
    assert!(counted.contains(expected));
    assert_eq!("fold".parse(), Ok(EventKind::Fold));
    let error = "folds".parse::<EventKind>().unwrap_err().to_string();
    assert!(error.contains("there are fold, period-doubling"), "{error}");
}

/// One harmonic of the Duffing oscillator has the closed form `((1 - w^2 + 3/4 A^2)^2 + (0.1 w)^2) A^2 = 0.2^2`.
#[test]
fn a_drawn_line_follows_the_curve_where_it_folds() {
    let request = FrequencyResponse::of(&Duffing::default()).from(0.5).to(2.0);
    let branch = request.harmonics(1).run().unwrap();
    let view = View::new().of("x:h1".parse().unwrap());
    let limits = [[0.5, 2.0], [0.0, 2.0]];
    let chart = branch.chart_of(&view).unwrap().limits(limits[0], limits[1]);
    let value = |[x, y]: [f64; 2]| {
        let [omega, a] = [0.5 + 1.5 * x, 2.0 * y];
        let elastic = 1.0 - omega * omega + 0.75 * a * a;
        let damped = (0.1 * omega).powi(2);
        let residual = (elastic * elastic + damped) * a * a - 0.04;
        // Over its gradient in parts of the frame: a distance in the picture.
        let by_a = 2.0 * a * (elastic * elastic + damped) + 2.0 * elastic * 1.5 * a * a * a;
        let by_omega = (-4.0 * elastic * omega + 0.02 * omega) * a * a;
        residual.abs() / (1.5 * by_omega).hypot(2.0 * by_a)
    };
    let pixels = curve(&chart);
    let off = pixels
        .windows(2)
        .map(|pair| value([0, 1].map(|k| 0.5 * (pair[0][k] + pair[1][k]))));
    let off = off.fold(0.0, f64::max);
    // A pixel is 1/800 of the frame.
    assert!(off < 4e-4, "{off}");
}

#[test]
fn amplitudes_are_stacked_at_multiples_of_the_frequency() {
    let request = FrequencyResponse::of(&Duffing::default()).from(0.3).to(0.6);
    let branch = request.harmonics(7).run().unwrap();
    let view = View::new().harmonics(3);
    let limits = [[0.3, 0.6], [0.0, 0.5]];
    let chart = branch.chart_of(&view).unwrap().limits(limits[0], limits[1]);
    let points = curve(&chart);
    // The first one is the first curve; the orbits say what it is.
    for [x, y] in points {
        let omega = 0.3 + 0.3 * x;
        let pair = branch.points.windows(2);
        let mut pair = pair.filter(|p| p[0].value <= omega && omega <= p[1].value);
        let Some([a, b]) = pair.next() else { continue };
        let size = |k: usize| {
            branch
                .measured(&"x:h1".parse().unwrap(), [a, b][k])
                .unwrap()
        };
        let part = (omega - a.value) / (b.value - a.value);
        let known = size(0).unwrap() + part * (size(1).unwrap() - size(0).unwrap());
        assert!((0.5 * y - known).abs() < 2e-3, "{omega}: {y} {known}");
    }
    let svg = chart.to_svg();
    for part in [
        "amplitude at ω",
        "amplitude at 3 ω",
        "amplitudes of x at multiples of ω",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    assert_eq!(svg.matches("fill-opacity").count(), 3);
    // The second is zero by symmetry: on a logarithmic axis it is left out, and said.
    let chart = branch.chart_of(&view.scale(Scale::Logarithmic)).unwrap();
    let count = branch.points.len();
    let said = format!("amplitude at 2 ω: zero, to rounding, at {count} of {count} orbits");
    assert!(chart.to_svg().contains(&said));
}

#[test]
fn curves_of_a_waterfall_are_their_own_higher_by_a_step() {
    let request = |drive: f64| {
        let system = Linear {
            drive,
            ..Linear::default()
        };
        FrequencyResponse::of(&system)
            .from(0.5)
            .to(1.5)
            .run()
            .unwrap()
    };
    // In any order: by their values.
    let branches = [request(2.0), request(1.0)];
    let view = View::new();
    let chart = view.waterfall("drive", &branches).unwrap();
    let svg = chart.to_svg();
    // The largest peak-to-peak is 4 * 5.025; two fifths of it are 8.04, and the next round number is ten.
    for part in [
        "peak-to-peak of x [mm], each curve 10 mm above the last",
        "drive = 2 mm/s^2",
        "Linear: c = 0.2 1/s, k = 1 1/s^2",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    let chart = chart.limits([0.5, 1.5], [0.0, 40.0]);
    for (index, colour) in COLOURS.into_iter().enumerate() {
        let rank = index as f64;
        for [x, y] in curve_in(&chart, colour) {
            let expected = 2.0 * (1.0 + rank) * amplitude(0.5 + x) + 10.0 * rank;
            assert!(
                (40.0 * y - expected).abs() < 0.08,
                "{x}: {} {expected}",
                40.0 * y
            );
        }
    }
    // Upon each other instead.
    let chart = view.together(&branches).unwrap();
    assert!(chart.to_svg().contains("drive = 1 mm/s^2"));
    let chart = chart.limits([0.5, 1.5], [0.0, 40.0]);
    for [x, y] in curve_in(&chart, COLOURS[1]) {
        assert!((40.0 * y - 2.0 * amplitude(0.5 + x)).abs() < 0.08);
    }
}

#[test]
fn branches_that_do_not_go_together_are_refused() {
    let branch = linear();
    let view = View::new();
    let request = FrequencyResponse::of(&Duffing::default()).harmonics(5);
    let other = request.clone().from(0.5).to(0.6).run().unwrap();
    // One coordinate is in millimetres, the other is a number.
    let error = view.together([&branch, &other]).unwrap_err().to_string();
    assert!(
        error.contains("omega in rad/s, and branch 2 has omega without a unit"),
        "{error}"
    );
    let drive = request
        .vary("drive")
        .omega(0.7)
        .from(0.1)
        .to(0.2)
        .run()
        .unwrap();
    let error = view.together([&other, &drive]).unwrap_err();
    let expected =
        "an axis of the chart is omega without a unit, and branch 2 has drive without a unit";
    assert_eq!(error.to_string(), expected);
    let error = view.waterfall("drive", [&drive]).unwrap_err().to_string();
    assert!(error.contains("what is varied is drive"), "{error}");
    let error = view.waterfall("force", [&other]).unwrap_err().to_string();
    assert!(
        error.contains("no parameter force; there are drive"),
        "{error}"
    );
    let error = view.together(&[]).unwrap_err().to_string();
    assert_eq!(error, "none of the 0 branches has an orbit");
    let error = view.harmonics(3).waterfall("drive", [&other]).unwrap_err();
    assert!(error.to_string().contains("3 harmonics were asked for"));
}

hertzian::oscillator! {
    Stopped(x) {
        law stop(gap) { gap > 0 => 10*gap, else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - 1) = 0.3*cos(omega*t);
    }
}

#[test]
fn a_waveform_is_the_motion_over_the_period() {
    let branch = linear();
    let orbit = &branch.points[3];
    let omega = orbit.value;
    let samples = branch.waveform("x", orbit).unwrap();
    let lag = (0.2 * omega).atan2(1.0 - omega * omega);
    for [t, x] in &samples {
        assert!((x - amplitude(omega) * (omega * t - lag).cos()).abs() < 1e-9);
    }
    let period = std::f64::consts::TAU / omega;
    assert!(samples[0][0] == 0.0 && (samples.last().unwrap()[0] - period).abs() < 1e-12);
    // A force that is there for a part of the period: its integral by trapezia is the impulse, and its largest value is the largest.
    let request = FrequencyResponse::of(&Stopped {}).from(0.8).to(1.2);
    let branch = request.run().unwrap();
    let orbit = branch.nearest([1.1, 3.0], &View::new()).unwrap().unwrap();
    let force = branch.waveform("stop", orbit).unwrap();
    assert!(force.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
    let area = force.windows(2);
    let area = area.map(|pair| 0.5 * (pair[1][0] - pair[0][0]) * (pair[0][1] + pair[1][1]));
    let measured = |what: &str| {
        branch
            .measured(&what.parse().unwrap(), orbit)
            .unwrap()
            .unwrap()
    };
    let (area, impulse) = (area.sum::<f64>(), measured("stop:impulse"));
    assert!(
        impulse > 0.1 && (area - impulse).abs() < 1e-3 * impulse,
        "{area} {impulse}"
    );
    let largest = force.iter().fold(0.0, |m: f64, [_, y]| m.max(*y));
    assert!((largest - measured("stop:max")).abs() < 1e-3 * largest);
}

#[test]
fn a_page_has_response_spectrum_motion_and_force() {
    let branch = FrequencyResponse::of(&Stopped {})
        .from(0.8)
        .to(1.2)
        .run()
        .unwrap();
    let view = View::new().scale(Scale::Logarithmic);
    let place = [1.0, branch.at(1.0).unwrap()[0].peak_to_peak()];
    let orbit = branch.nearest(place, &view).unwrap().unwrap();
    let nearest = branch.points.iter().map(|point| (point.value - 1.0).abs());
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    assert!((orbit.value - 1.0).abs() <= 2.0 * nearest);
    let svg = branch.panels(orbit, &view).unwrap().to_svg();
    for part in [
        "spectrum of x at ω = ",
        "amplitude of x",
        "x over the period at ω = ",
        "force of stop over the period",
        "mean ",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    assert_eq!(svg.matches("<svg ").count(), 5);
    // A linear oscillator has neither contacts nor higher harmonics.
    let branch = linear();
    let page = branch
        .panels(&branch.points[0], &View::new())
        .unwrap()
        .to_svg();
    assert_eq!(page.matches("<svg ").count(), 4);
    assert!(page.contains(" of the largest, and not drawn"));
    assert!(page.contains("time [s]") && page.contains("frequency ω [rad/s]"));
}

/// Amplitudes are as the drive: an uncertainty of a fiftieth is one of the logarithm too. Where three times the drive is uncertain the lower edge would be
/// below zero; on an axis of logarithms it has a place.
#[test]
fn a_band_on_a_logarithmic_axis_is_above_zero() {
    let model = Linear {
        c: 0.8,
        ..Linear::default()
    };
    let edges = |[from, to]: [f64; 2], uncertain: &str, scale: Scale| {
        let request = FrequencyResponse::of(&model).from(from).to(to);
        let branch = request.largest_step(0.01).run().unwrap();
        let view = View::new().scale(scale);
        let band = branch.band(&view, &[uncertain.parse().unwrap()]).unwrap();
        let [above, below] = band.edges;
        let lower = |(a, b): ([f64; 2], [f64; 2])| a[1].min(b[1]);
        let edge: Vec<f64> = above.into_iter().zip(below).map(lower).collect();
        (branch, edge)
    };
    let lowest = |scale: Scale| {
        let (_, edge) = edges([3.5, 4.0], "drive=300%", scale);
        edge.iter().copied().fold(f64::INFINITY, f64::min)
    };
    assert!(lowest(Scale::Linear) < 0.0);
    assert!(lowest(Scale::Logarithmic) > 0.0);
    // Where the curve is highest it is level, and moves straight up.
    let (branch, edge) = edges([0.5, 1.5], "drive=2%", Scale::Decibel);
    let sizes = branch.points.iter().map(Point::peak_to_peak).enumerate();
    let (top, size) = sizes.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    let ratio = edge[top] / size;
    assert!((ratio * 0.02_f64.exp() - 1.0).abs() < 2e-4, "{ratio}");
}
