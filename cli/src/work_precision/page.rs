//! The page with the charts, and what they say.

use std::fmt::Write;

use super::Section;
use super::measure::Measured;
use super::method::Family;
use super::multipliers::name;
use super::peer::Peer;

const STYLE: &str = "\
:root { color-scheme: light dark; --text: #1a1a1a; --ground: #ffffff; --line: #c8c8c8; }
@media (prefers-color-scheme: dark) { :root { --text: #e8e8e8; --ground: #16181c; --line: #44484f; } }
body { margin: 0 auto; max-width: 62rem; padding: 1rem 1.25rem 4rem; font: 1rem/1.5 system-ui, sans-serif; color: var(--text); background: var(--ground); }
img { display: block; width: 100%; height: auto; margin: 0.75rem 0; background: #ffffff; border: 1px solid var(--line); }
.table { overflow-x: auto; } table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.15rem 0.9rem 0.15rem 0; text-align: left; border-bottom: 1px solid var(--line); white-space: nowrap; }";

/// The page.
pub fn html(sections: &[Section], machine: &str) -> String {
    let mut text = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Error against time</title>\n<style>\n{STYLE}\n</style>\n</head>\n<body>\n<h1>Error against time</h1>\n\
         <p>{machine}. Every method traces the same curve, without multipliers, which have a chart of their own. Errors are those of the fold of largest amplitude, and of \
         peak-to-peak of one orbit on the branch to it, against exact values. Times are those of the processor, medians of repeats in turns. A method that finds other folds than there are, \
         or does not end, has failed, whatever the error of one of its folds.</p>\n"
    );
    for section in sections {
        let problem = &section.problem;
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "<h2>{}</h2>\n<img alt=\"Errors of the fold, of peak-to-peak and of multipliers over time\" src=\"{}.svg\">\n<p>{}</p>\n",
            problem.title,
            problem.id.replace('.', "_"),
            verdict(section)
        );
        peers(&mut text, &section.peers);
        table(&mut text, &section.measured);
    }
    text.push_str("</body>\n</html>\n");
    text
}

/// What to use when, as the figures have it.
pub fn verdict(section: &Section) -> String {
    let Section {
        reference,
        measured,
        answers,
        ..
    } = section;
    let fold = !reference.folds.is_empty();
    let what = if fold { "a fold" } else { "peak-to-peak" };
    let mut sentences = Vec::new();
    for asked in [1e-3, 1e-6, 1e-9] {
        let fastest = |families: &[Family]| {
            let right = measured
                .iter()
                .filter(|one| one.failure.is_none() && families.contains(&one.family));
            let error = |one: &&Measured| if fold { one.fold } else { one.peak_to_peak };
            let enough = right.filter(|one| error(one).is_some_and(|error| error <= asked));
            let times = enough.filter_map(|one| Some((1e3 * one.median()?, one)));
            times.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let groups = [
            ("switched", fastest(&[Family::Switched, Family::Adaptive])),
            ("sampled", fastest(&[Family::Classical, Family::Primitive])),
            ("shooting", fastest(&[Family::Shooting])),
            ("contact equation", fastest(&[Family::ContactEquation])),
        ];
        let parts = groups.map(|(name, found)| match found {
            Some((time, one)) => format!("{name} {time:.2} ms ({})", one.setting),
            None => format!("{name} never"),
        });
        sentences.push(format!("For {what} to {asked:.0e}: {}.", parts.join(", ")));
    }
    let times = |family| {
        let of = measured.iter().filter(move |one| one.family == family);
        of.filter_map(Measured::median).sum::<f64>()
    };
    sentences.push(format!(
        "Interpreted laws take {:.2} times as long as generated ones.",
        times(Family::Interpreted) / times(Family::Switched)
    ));
    let sampled = |one: &&Measured| one.family.is_sampled();
    let all = measured.iter().filter(sampled).count();
    let failed = measured.iter().filter(sampled);
    let failed = failed.filter(|one| one.failure.is_some()).count();
    sentences.push(format!("Of the {all} sampled settings {failed} failed."));
    let right = answers.iter().filter(|one| one.error <= 1e-4);
    if let Some(best) = right.min_by(|a, b| a.seconds.total_cmp(&b.seconds)) {
        sentences.push(format!(
            "Multipliers to 1e-4 come soonest by {} with {}, in {:.3} ms.",
            name(best.method),
            best.setting,
            1e3 * best.seconds
        ));
    }
    sentences.join(" ")
}

fn peers(text: &mut String, peers: &[Peer]) {
    for peer in peers {
        let [median, least, most] = peer.seconds;
        let failure = peer.failure.as_ref();
        let failure = failure.map_or_else(String::new, |failure| format!(" {failure};"));
        let _ = writeln!(
            text,
            "<p>{} {}, measured {}: {median} s for {} points (from {least} to {most});{failure} {}.</p>",
            peer.name, peer.setting, peer.measured, peer.points, peer.note
        );
    }
}

fn table(text: &mut String, measured: &[Measured]) {
    text.push_str(
        "<div class=\"table\"><table>\n<tr><th>method</th><th>setting</th><th>ms, median</th><th>least</th><th>most</th>\
         <th>error of the fold</th><th>of peak-to-peak</th><th>failure</th></tr>\n",
    );
    for one in measured {
        let time =
            |seconds: Option<&f64>| seconds.map_or_else(String::new, |s| format!("{:.3}", 1e3 * s));
        let small =
            |error: Option<f64>| error.map_or_else(String::new, |error| format!("{error:.1e}"));
        let _ = writeln!(
            text,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            one.family.name(),
            one.setting,
            time(one.median().as_ref()),
            time(one.seconds.first()),
            time(one.seconds.last()),
            small(one.fold),
            small(one.peak_to_peak),
            one.failure.as_deref().unwrap_or_default()
        );
    }
    text.push_str("</table></div>\n");
}
