//! The lines of Rust that make a curve.

use std::fmt::Write;

use hertzian::System;

use super::asked::Asked;
use crate::response::options::By;

/// A program, to be copied into `main.rs` of a package that depends on `hertzian`.
pub fn of(asked: &Asked, declared: &dyn System, values: &[f64], by: By) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write(&mut text, asked, declared, values, by);
    text
}

fn write(
    text: &mut String,
    asked: &Asked,
    declared: &dyn System,
    values: &[f64],
    by: By,
) -> std::fmt::Result {
    let facts = declared.facts();
    if asked.text.contains("oscillator!") {
        writeln!(text, "{}\n", asked.text.trim_end())?;
    } else {
        writeln!(text, "hertzian::oscillator! {{")?;
        for line in asked.text.trim_end().lines() {
            let indent = if line.is_empty() { "" } else { "    " };
            writeln!(text, "{indent}{line}")?;
        }
        writeln!(text, "}}\n")?;
    }
    writeln!(text, "fn main() -> Result<(), hertzian::Error> {{")?;
    let fields = facts.parameters.iter().zip(values);
    let fields = fields.map(|(parameter, value)| format!("{}: {value:?}", parameter.name));
    let fields: Vec<String> = fields.collect();
    writeln!(
        text,
        "    let model = {} {{ {} }};",
        facts.name,
        fields.join(", ")
    )?;
    let request = match asked.depth {
        Some(_) => "hertzian::Bifurcations::of(&model)",
        None => "hertzian::FrequencyResponse::of(&model)",
    };
    writeln!(text, "    let request = {request}")?;
    if asked.varied != "omega" {
        writeln!(
            text,
            "        .vary(\"{}\").omega({:?})",
            asked.varied, asked.omega
        )?;
    }
    write!(text, "        .from({:?}).to({:?})", asked.from, asked.to)?;
    if asked.period != 1 {
        write!(text, "\n        .period({})", asked.period)?;
    }
    match (asked.depth, by) {
        (Some(depth), _) => write!(text, "\n        .depth({depth})")?,
        (None, By::Balance) => {}
        (None, By::Shooting) => write!(text, "\n        .by(hertzian::Shooting::new())")?,
        (None, By::ContactEquation) => {
            write!(text, "\n        .by(hertzian::ContactEquation::new())")?;
        }
    }
    writeln!(text, ";")?;
    if asked.depth.is_some() {
        writeln!(text, "    let diagram = request.run()?;")?;
        writeln!(text, "    for found in &diagram.branches {{")?;
        writeln!(text, "        let branch = &found.branch;")?;
        writeln!(
            text,
            "        branch.events.iter().for_each(|event| println!(\"{{}}\", branch.describe(event)));"
        )?;
        writeln!(text, "    }}\n    diagram.plot(\"response.svg\")\n}}")
    } else {
        writeln!(text, "    let branch = request.run()?;")?;
        writeln!(
            text,
            "    branch.events.iter().for_each(|event| println!(\"{{}}\", branch.describe(event)));"
        )?;
        writeln!(text, "    branch.plot(\"response.svg\")\n}}")
    }
}
