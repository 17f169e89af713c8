//! The page with all figures: one file, without scripts, fonts or anything from elsewhere.

use std::fmt::Write;
use std::time::Duration;

use super::figure::{Drawing, Value};
use super::run::Drawn;

const STYLE: &str = "\
:root { color-scheme: light dark; --text: #1a1a1a; --ground: #ffffff; --line: #c8c8c8; --soft: #5a5a5a; }
@media (prefers-color-scheme: dark) { :root { --text: #e8e8e8; --ground: #16181c; --line: #44484f; --soft: #a8adb5; } }
body { margin: 0 auto; max-width: 62rem; padding: 1rem 1.25rem 4rem; font: 1rem/1.5 system-ui, sans-serif; color: var(--text); background: var(--ground); }
h1 { font-size: 1.6rem; line-height: 1.25; } h2 { margin: 3rem 0 0.25rem; font-size: 1.2rem; }
nav a { display: inline-block; margin-right: 0.75rem; } a { color: inherit; }
.parameters, .time, footer { color: var(--soft); }
img { display: block; width: 100%; height: auto; margin: 0.75rem 0; background: #ffffff; border: 1px solid var(--line); border-radius: 4px; }
.table { overflow-x: auto; } table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.15rem 0.9rem 0.15rem 0; text-align: left; border-bottom: 1px solid var(--line); white-space: nowrap; }
th { font-weight: 600; }";

/// The page.
pub fn html(drawn: &[Drawn], elapsed: Duration, threads: usize) -> String {
    let mut text =
        String::from("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    // Writing to a string does not fail, here and below.
    let _ = write!(
        text,
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Nonlinear spring systems in power-form order, computed anew</title>\n<style>\n{STYLE}\n</style>\n</head>\n<body>\n"
    );
    text.push_str(INTRODUCTION);
    text.push_str("<nav>");
    for one in drawn {
        let _ = write!(
            text,
            "<a href=\"#{}\">{}</a>",
            one.figure.id, one.figure.name
        );
    }
    text.push_str("</nav>\n");
    for one in drawn {
        section(&mut text, one);
    }
    let _ = write!(
        text,
        "<footer><p>{} figures in {:.1} s, {threads} at a time, by hertzian {}.</p></footer>\n</body>\n</html>\n",
        drawn.len(),
        elapsed.as_secs_f64(),
        env!("CARGO_PKG_VERSION")
    );
    text
}

const INTRODUCTION: &str = "\
<h1>Nonlinear spring systems in power-form order, computed anew</h1>
<p>The figures and the table of Q. Wang, Z. Zhang, Y. Ying and Z. Pang (2021), <cite>Analysis of the Dynamic Stiffness, Hysteresis \
Resonances and Complex Responses for Nonlinear Spring Systems in Power-Form Order</cite>, Appl. Sci. 11, 7722, of the oscillator</p>
<p>x″ + 2 ζ H(x) x′ + H(x) sgn(x) |x|<sup>α</sup> = A cos ωt + W,</p>
<p>with H = 1 (continuous), or H(x) = 1 for x &gt; 0 and 0 otherwise (one-sided: a contact that opens). Stable orbits are solid, \
unstable ones dashed, undecided ones dotted. References were computed independently of this \
project, in higher precision, and are exact to more digits than are shown, but for the Lyapunov exponents, which are means with a standard error. \
Each error that is stated is the program’s own estimate, made without them. Fig. 1 of the paper, a sketch of the oscillator, is left out.</p>
";

fn section(text: &mut String, drawn: &Drawn) {
    let figure = drawn.figure;
    let _ = write!(
        text,
        "<section id=\"{}\">\n<h2>{}</h2>\n<p class=\"parameters\">{}</p>\n<p>{}</p>\n",
        figure.id,
        escaped(figure.name),
        escaped(figure.parameters),
        escaped(figure.shows)
    );
    match &drawn.drawing {
        Ok(drawing) => {
            let _ = writeln!(
                text,
                "<img alt=\"{}: {}\" src=\"data:image/svg+xml,{}\">",
                escaped(figure.name),
                escaped(figure.shows),
                encoded(&drawing.svg)
            );
            values(text, drawing);
        }
        Err(error) => {
            let _ = writeln!(
                text,
                "<p><strong>Not drawn: {}.</strong></p>",
                escaped(error)
            );
        }
    }
    let _ = write!(
        text,
        "<p class=\"time\">{:.2} s. Data: <a href=\"{id}.csv\">{id}.csv</a>. Picture: <a href=\"{id}.svg\">{id}.svg</a>.</p>\n</section>\n",
        drawn.elapsed.as_secs_f64(),
        id = figure.id
    );
}

fn values(text: &mut String, drawing: &Drawing) {
    if !drawing.note.trim().is_empty() {
        let _ = writeln!(text, "<p>{}</p>", escaped(drawing.note.trim()));
    }
    if drawing.values.is_empty() {
        return;
    }
    let printed = drawing.values.iter().any(|value| value.printed.is_some());
    text.push_str("<div class=\"table\"><table>\n<tr><th></th><th>ours</th><th>error stated</th><th>reference</th><th>difference</th>");
    text.push_str(if printed {
        "<th>the paper</th></tr>\n"
    } else {
        "</tr>\n"
    });
    for value in &drawing.values {
        row(text, value, printed);
    }
    text.push_str("</table></div>\n");
}

fn row(text: &mut String, value: &Value, printed: bool) {
    let number =
        |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.10}"));
    let small = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.0e}"));
    let ours = value
        .ours
        .map_or_else(|| "not found".to_owned(), |value| format!("{value:.10}"));
    let _ = write!(
        text,
        "<tr><td>{}</td><td>{ours}</td><td>{}</td><td>{}</td><td>{}</td>",
        escaped(&value.what),
        small(value.stated),
        number(value.exact),
        small(value.error())
    );
    if printed {
        let _ = write!(
            text,
            "<td>{}</td>",
            escaped(value.printed.unwrap_or_default())
        );
    }
    text.push_str("</tr>\n");
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// A picture as part of a `data:` address between double quotes (RFC 3986, 2.1).
fn encoded(svg: &str) -> String {
    let mut text = String::with_capacity(svg.len() + svg.len() / 4);
    for c in svg.chars() {
        match c {
            '%' => text.push_str("%25"),
            '#' => text.push_str("%23"),
            '"' => text.push_str("%22"),
            '<' => text.push_str("%3C"),
            '>' => text.push_str("%3E"),
            '&' => text.push_str("%26"),
            '\n' => text.push(' '),
            _ => text.push(c),
        }
    }
    text
}
