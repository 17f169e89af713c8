//! Charts as text: what is in them, and that nothing is where it should not be.

use super::*;

fn run(line: Line, points: &[[f64; 2]]) -> Run {
    Run {
        line,
        points: points.to_vec(),
    }
}

/// A resonance that leans to the left, `w = sqrt(1 - y) +- c`, with its folds and a boundary.
fn response() -> Chart {
    let branch = |sign: f64, from: f64, to: f64| -> Vec<[f64; 2]> {
        let at = |i: i32| from + (to - from) * f64::from(i) / 300.0;
        let point = |y: f64| {
            [
                1.2 - 0.25 * y + sign * (0.05 / (y * y) - 0.012).max(0.0).sqrt(),
                y,
            ]
        };
        (0..=300).map(|i| point(at(i))).collect()
    };
    let lower = branch(-1.0, 0.3, 1.4);
    let upper = branch(-1.0, 1.4, 2.0);
    let unstable = branch(1.0, 2.0, 1.1);
    let tail = branch(1.0, 1.1, 0.3);
    let folds = vec![unstable[0], tail[0]];
    Chart::new("One-sided contact, α = 3/2, ζ = 0.032, load 1, drive 0.1")
        .x("excitation frequency ω")
        .y("peak-to-peak displacement")
        .curve(Curve {
            label: String::new(),
            runs: vec![
                run(Line::Stable, &lower),
                run(Line::Undecided, &upper),
                run(Line::Unstable, &unstable),
                run(Line::Stable, &tail),
            ],
        })
        .reference(Series {
            label: "loss of contact".into(),
            points: (0..50)
                .map(|i| [0.3 + 0.04 * f64::from(i), 1.6 - 0.1 * f64::from(i)])
                .collect(),
        })
        .markers(Series {
            label: "fold".into(),
            points: folds,
        })
}

/// All coordinates of paths.
fn coordinates(svg: &str) -> impl Iterator<Item = f64> {
    let paths = svg.split("<path d=\"").skip(1);
    let paths = paths.filter_map(|rest| rest.split('"').next());
    paths.flat_map(|path| {
        path.split(['M', 'L', 'Z', ' '])
            .filter(|token| !token.is_empty())
            .map(|token| token.parse().expect("a number"))
    })
}

#[test]
fn a_response_has_all_its_parts() {
    let svg = response().to_svg();
    for part in [
        "stable",
        "unstable",
        "undecided",
        "loss of contact",
        "fold",
        "ω",
        "12 4 2 4",
        "8 4",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    assert!(coordinates(&svg).count() > 200);
    assert!(coordinates(&svg).all(|u| (0.0..=900.0).contains(&u)));
}

#[test]
fn a_long_title_has_two_lines() {
    let values: Vec<String> = (1..=16).map(|k| format!("value {k} = {k} N/m")).collect();
    let title = format!("Machine: {}", values.join(", "));
    let svg = Chart::new(&title).to_svg();
    let [one, other] = [&values[..8], &values[8..]].map(|values| values.join(", "));
    assert!(svg.contains(&format!("<title>{title}</title>")));
    assert!(
        svg.contains(&format!("aria-label=\"Machine: {one},\"")),
        "{svg}"
    );
    assert!(svg.contains(&format!("aria-label=\"{other}\"")));
    let word = "a".repeat(300);
    assert!(
        Chart::new(&word)
            .to_svg()
            .contains(&format!("aria-label=\"{word}\""))
    );
}

#[test]
fn an_empty_chart_is_a_frame() {
    let svg = Chart::default().to_svg();
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn points_that_cannot_be_drawn_interrupt_the_line() {
    let points = [
        [0.0, 1.0],
        [1.0, 2.0],
        [2.0, f64::NAN],
        [3.0, f64::INFINITY],
        [4.0, 1.0],
        [5.0, 2.0],
    ];
    let chart = Chart::new("").curve(Curve {
        label: String::new(),
        runs: vec![run(Line::Stable, &points)],
    });
    for (scale, parts) in [(Scale::Linear, 2), (Scale::Logarithmic, 1)] {
        let svg = chart.clone().scales(scale, scale).to_svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        let curve = svg.lines().find(|line| line.contains("#0b4f8a"));
        let curve = curve.expect("the curve");
        assert_eq!(curve.matches('M').count(), parts);
    }
}

#[test]
fn text_is_escaped() {
    let svg = Chart::new("a < b & \"c\"\u{0}").to_svg();
    assert!(svg.contains("a &lt; b &amp; &quot;c&quot; "));
}

#[test]
fn many_points_make_a_small_file() {
    let points = (0..100_000)
        .map(|i| f64::from(i) * 1e-5)
        .map(|t| [t, (40.0 * t).sin()]);
    let chart = Chart::new("").curve(Curve {
        label: String::new(),
        runs: vec![run(Line::Stable, &points.collect::<Vec<_>>())],
    });
    let length = chart.to_svg().len();
    assert!(length < 40_000, "{length} bytes");
}

#[test]
fn a_file_that_cannot_be_written_is_named() {
    let error = Chart::default().write("no such folder/chart.svg");
    let text = error.expect_err("the folder is missing").to_string();
    assert!(text.contains("no such folder"), "{text}");
}

#[test]
fn motions_dots_and_cells_have_their_place_and_legend() {
    let circle = |r: f64| {
        let at = move |i: i32| [r * f64::from(i).cos(), r * f64::from(i).sin()];
        (0..30).map(at).collect::<Vec<_>>()
    };
    let chart = Chart::new("phase portrait")
        .trace(Series {
            label: "period 1".into(),
            points: circle(1.0),
        })
        .trace(Series {
            label: String::new(),
            points: circle(2.0),
        })
        .cloud(Series {
            label: "up".into(),
            points: circle(0.5),
        })
        .cloud(Series {
            label: "down".into(),
            points: vec![[0.0, f64::NAN]],
        })
        .raster(Raster {
            x: [-3.0, 3.0],
            y: [-2.0, 2.0],
            columns: 2,
            cells: vec![0, 1, 1, 0],
            classes: vec![
                ("basin of period 1".into(), Colour::Class(0)),
                ("escape".into(), Colour::None),
            ],
        });
    let svg = chart.to_svg();
    for part in [
        "period 1",
        "up",
        "down",
        "basin of period 1",
        "escape",
        "crispEdges",
        "h0",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    assert!(!svg.contains("NaN"));
    // Behind each motion a line in white: on dark cells a dark line would not be seen.
    let white = "stroke=\"#ffffff\" stroke-width=\"4\"";
    assert_eq!(svg.matches(white).count(), 2);
    let page = Page::new(2)
        .chart(chart.clone())
        .chart(chart)
        .chart(Chart::default());
    let svg = page.to_svg();
    assert_eq!(svg.matches("<svg ").count(), 4);
    assert!(
        svg.contains("<svg x=\"900\" y=\"0\" xmlns")
            && svg.contains("<svg x=\"0\" y=\"600\" xmlns")
    );
}

#[test]
fn dashed_lines_upon_each_other_stay_dashed() {
    // One line twice, from both ends, as two methods follow one branch.
    let there: Vec<[f64; 2]> = (0..=20).map(|i| [f64::from(i), 1.0]).collect();
    let back = there.iter().rev().copied().collect();
    let curve = |points| Curve {
        label: "period 1".into(),
        runs: vec![Run {
            line: Line::Unstable,
            points,
        }],
    };
    let solid = Curve {
        label: "period 2".into(),
        runs: vec![run(Line::Stable, &[[0.0, 0.5], [20.0, 1.5]])],
    };
    let chart = Chart::new("")
        .curve(solid)
        .curve(curve(there))
        .curve(curve(back));
    let svg = chart.to_svg();
    let all: Vec<&str> = svg.lines().collect();
    let places = |mark: &str| -> Vec<usize> {
        let found = all
            .iter()
            .enumerate()
            .filter(|(_, line)| line.contains(mark));
        found.map(|(index, _)| index).collect()
    };
    let (covers, dashes) = (
        places("stroke=\"#ffffff\""),
        places("stroke-dasharray=\"8 4\""),
    );
    assert_eq!((covers.len(), dashes[..2].len()), (2, 2));
    assert!(covers[0] < dashes[0] && dashes[0] < covers[1] && covers[1] < dashes[1]);
    // A solid line is cut by none of them.
    assert!(places("stroke=\"#0b4f8a\" stroke-width=\"2.2\"")[0] > dashes[1]);
}

#[test]
fn marks_upon_each_other_are_counted_and_markers_are_not() {
    let points = vec![[0.0, 0.0], [1.0, 1.0], [1.0 + 1e-6, 1.0]];
    let series = |label: &str| Series {
        label: label.into(),
        points: points.clone(),
    };
    let marked = Chart::new("").marks(series("fold")).to_svg();
    assert!(marked.contains("aria-label=\"×2\""));
    // Two at their places, and one in the legend.
    assert_eq!(marked.matches("<circle").count(), 3);
    let plain = Chart::new("").markers(series("fold")).to_svg();
    assert_eq!(plain.matches("<circle").count(), 4);
    assert!(!plain.contains('×'));
    // What is said below the chart, and beside a point.
    let note = Note {
        label: "drive = 2".into(),
        point: [0.5, 0.5],
    };
    let said = Chart::new("")
        .marks(series("fold"))
        .text(note)
        .remark("not marked: 3 grazing");
    let svg = said.to_svg();
    assert!(svg.contains("not marked: 3 grazing") && svg.contains("drive = 2"));
    assert_eq!(svg.matches("<circle").count(), 3);
}

#[test]
fn pieces_that_marks_cover_are_said_below() {
    let piece = |line, from: f64, to: f64| run(line, &[[from, 1.0], [to, 1.0]]);
    // A range of 0 to 100 takes some 800 pixels: a piece of two is below its marks, one of ten is not.
    let curve = |label: &str| Curve {
        label: label.into(),
        runs: vec![
            piece(Line::Stable, 0.0, 40.0),
            piece(Line::Unstable, 40.0, 42.0),
            piece(Line::Stable, 42.0, 52.0),
            piece(Line::Unstable, 52.0, 54.0),
            piece(Line::Stable, 54.0, 100.0),
        ],
    };
    let marks = Series::new("fold", [[40.0, 1.0], [42.0, 1.0], [52.0, 1.0], [54.0, 1.0]]);
    let chart = Chart::new("").curve(curve("")).marks(marks);
    let below = "short pieces: unstable between 40.0 and 42.0, unstable between 52.0 and 54.0";
    assert!(chart.to_svg().contains(below));
    // With the names of curves where there are several; digits follow the axis, as its prefix does.
    let several = chart.clone().curve(curve("period 2")).to_svg();
    assert!(several.contains(&format!("{below}; period 2 unstable between 40.0")));
    let lines = chart.curves[0].runs.iter().flat_map(|run| &run.points);
    assert_eq!(lines.count(), 10);
    let plain = Chart::new("").curve(Curve {
        label: String::new(),
        runs: vec![
            piece(Line::Stable, 0.0, 40.0),
            piece(Line::Unstable, 40.0, 100.0),
        ],
    });
    assert!(!plain.to_svg().contains("short pieces"));
}

#[test]
fn points_outside_of_the_cells_are_counted() {
    let cells = Raster {
        x: [0.0, 1.0],
        y: [0.0, 1.0],
        columns: 1,
        cells: vec![0],
        classes: vec![("a, period 2".into(), Colour::Class(0))],
    };
    let chart = Chart::new("")
        .raster(cells)
        .letters(Series::new("a", [[0.5, 0.5], [0.5, 2.0]]))
        .letters(Series::new("b", [[0.25, 0.25]]));
    let svg = chart.to_svg();
    assert!(svg.contains("outside of the frame: 1 of the 2 points a\""));
    assert_eq!(svg.matches("aria-label=\"a\"").count(), 1);
    assert_eq!(svg.matches("aria-label=\"b\"").count(), 1);
}

#[test]
fn joined_points_have_their_line_in_the_legend() {
    let points = [
        [0.0, 1.0],
        [1.0, 2.0],
        [f64::NAN, 0.0],
        [2.0, 1.0],
        [3.0, 2.0],
    ];
    let svg = Chart::new("")
        .joined(Series::new("shooting", points))
        .to_svg();
    // The lines of two pieces, and that of the legend; four points, and that of the legend.
    let lines: Vec<&str> = svg
        .lines()
        .filter(|line| line.contains("stroke=\"#0b4f8a\""))
        .collect();
    assert_eq!(lines.len(), 2);
    assert_eq!(lines[0].matches('M').count(), 2);
    assert_eq!(svg.matches("<circle").count(), 5);
    assert!(svg.contains("aria-label=\"shooting\""));
}

#[test]
fn events_are_white_inside_and_points_dark() {
    let at = |x: f64| Series::new("mark", [[x, 0.0]]);
    let filled = |svg: &str, colour: &str| {
        let circles = svg.lines().filter(|line| line.starts_with("<circle"));
        circles
            .filter(|line| line.contains(&format!("fill=\"{colour}\"")))
            .count()
    };
    let event = Chart::new("").marks(at(1.0)).to_svg();
    assert_eq!(
        (filled(&event, "#ffffff"), filled(&event, svg::INK)),
        (2, 0)
    );
    let point = Chart::new("").markers(at(1.0)).to_svg();
    assert_eq!(
        (filled(&point, "#ffffff"), filled(&point, svg::INK)),
        (0, 2)
    );
}

#[test]
fn what_is_said_of_axes_goes_with_their_labels() {
    let chart = Chart::new("")
        .x("omega")
        .y("x")
        .remark_on_axes("plain numbers");
    assert!(chart.to_svg().contains("plain numbers"));
    let one = chart.x("frequency / resonance");
    assert!(one.to_svg().contains("plain numbers"));
    assert!(!one.y("x / gap").to_svg().contains("plain numbers"));
}

#[test]
fn short_remarks_share_a_line_and_letters_upon_each_other_are_counted() {
    let letters = Series::new("f", [[0.0, 0.0], [1e-6, 0.0], [1.0, 1.0]]);
    let long = "a remark that takes most of a line ".repeat(3);
    let chart = Chart::new("").letters(letters).remark("one").remark("two");
    let svg = chart.remark(long.trim()).to_svg();
    assert!(svg.contains("\"upon each other: 3 points f at 2 places; one; two\""));
    assert!(svg.contains(&format!("\"{}\"", long.trim())));
}
