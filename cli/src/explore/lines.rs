//! The lines of Rust that make a curve.

use std::fmt::Write;

use hertzian::System;

use super::asked::Asked;
use crate::response::options::By;

/// A program, to be copied into `main.rs` of a package that depends on `hertzian`; of several branches if it takes several to cover the range.
pub fn of(asked: &Asked, declared: &dyn System, values: &[f64], by: By, several: bool) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write(&mut text, asked, declared, values, by, several);
    text
}

fn write(
    text: &mut String,
    asked: &Asked,
    declared: &dyn System,
    values: &[f64],
    by: By,
    several: bool,
) -> std::fmt::Result {
    let facts = declared.facts();
    let named = |line: &str| line.trim_start().starts_with("hertzian::oscillator!");
    if asked.text.lines().any(named) {
        writeln!(text, "{}\n", asked.text.trim_end())?;
    } else if let Some(bare) = asked.text.trim_start().strip_prefix("oscillator!") {
        writeln!(text, "hertzian::oscillator!{}\n", bare.trim_end())?;
    } else {
        writeln!(text, "hertzian::oscillator! {{")?;
        for line in asked.text.trim_end().lines() {
            let indent = if line.is_empty() { "" } else { "    " };
            writeln!(text, "{indent}{line}")?;
        }
        writeln!(text, "}}\n")?;
    }
    writeln!(text, "fn main() -> Result<(), hertzian::Error> {{")?;
    writeln!(text, "    let model = {} {{", facts.name)?;
    for (parameter, value) in facts.parameters.iter().zip(values) {
        writeln!(text, "        {}: {value:?},", parameter.name)?;
    }
    writeln!(text, "    }};")?;
    request(text, asked, by)?;
    if asked.depth.is_some() || several {
        covered(text, asked)?;
        writeln!(text, "    let diagram = request.run()?;")?;
        writeln!(text, "    for found in &diagram.branches {{")?;
        writeln!(text, "        for event in &found.branch.events {{")?;
        let said = "println!(\"{}\", found.branch.describe(event));";
        writeln!(text, "            {said}\n        }}\n    }}")?;
        writeln!(text, "    diagram.plot(\"response.svg\")\n}}")
    } else {
        writeln!(text, "    let branch = request.run()?;")?;
        writeln!(text, "    for event in &branch.events {{")?;
        let said = "println!(\"{}\", branch.describe(event));";
        writeln!(text, "        {said}\n    }}")?;
        writeln!(text, "    branch.plot(\"response.svg\")\n}}")
    }
}

/// What is asked for, an option in each line.
fn request(text: &mut String, asked: &Asked, by: By) -> std::fmt::Result {
    let mut options = vec!["let request = hertzian::FrequencyResponse::of(&model)".to_owned()];
    if asked.varied != "omega" {
        options.push(format!(".vary({:?})", asked.varied));
        options.push(format!(".omega({:?})", asked.omega));
    }
    options.push(format!(".from({:?})", asked.from));
    options.push(format!(".to({:?})", asked.to));
    if asked.period != 1 {
        options.push(format!(".period({})", asked.period));
    }
    // What begins at bifurcations is followed by shooting.
    let by = if asked.depth.is_some() {
        By::Shooting
    } else {
        by
    };
    let method = match by {
        By::Balance => "HarmonicBalance",
        By::Shooting => "Shooting",
        By::ContactEquation => "ContactEquation",
    };
    options.push(format!(".by(hertzian::{method}::new())"));
    writeln!(text, "    {};", options.join("\n        "))
}

/// All that covers the range, as `hertzian response` looks for it.
fn covered(text: &mut String, asked: &Asked) -> std::fmt::Result {
    writeln!(text, "    let patience = request.transient_periods()?;")?;
    writeln!(
        text,
        "    let settling = hertzian::bifurcation::Settling::new().patience(patience);"
    )?;
    writeln!(
        text,
        "    let request = hertzian::Bifurcations::starting_with(request)"
    )?;
    match asked.depth {
        Some(depth) => writeln!(text, "        .max_points(50_000)\n        .depth({depth})")?,
        None => writeln!(text, "        .depth(0)\n        .margin(0.0)")?,
    }
    writeln!(text, "        .cover(settling);")
}
