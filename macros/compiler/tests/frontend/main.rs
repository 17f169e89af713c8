//! From declarations to checked models.

mod extrema;
mod fuzz;
mod in_place;
mod loops;
mod masses;
mod messages;
mod models;
mod outputs;
mod units;

use std::str::FromStr;

use hertzian_compiler::dag::{Id, Variable};
use hertzian_compiler::ir::Model;
use hertzian_contract::system::{Part, Place, Wave};
use proc_macro2::TokenStream;

fn compile(text: &str) -> Result<Model, String> {
    let tokens = TokenStream::from_str(text).map_err(|fault| fault.to_string())?;
    hertzian_compiler::compile(tokens).map_err(|errors| errors.to_string())
}

fn model(text: &str) -> Model {
    compile(text).unwrap_or_else(|errors| panic!("{errors}\nin {text}"))
}

/// A coefficient with its place.
fn coefficient(place: &Place, value: &str) -> String {
    let wave = |wave: &Wave| {
        let name = if wave.part == Part::Sine {
            "sin"
        } else {
            "cos"
        };
        if wave.harmonic == 0 {
            String::new()
        } else {
            format!(" {name}{}", wave.harmonic)
        }
    };
    match place {
        Place::Mass { row, column } => format!("M{row}{column} = {value}"),
        Place::Damping { row, column } => format!("C{row}{column} = {value}"),
        Place::Stiffness {
            row,
            column,
            wave: w,
        } => format!("K{row}{column}{} = {value}", wave(w)),
        Place::Load { row, wave: w } => format!("f{row}{} = {value}", wave(w)),
        Place::ForceDirection {
            contact,
            row,
            wave: w,
        } => format!("e{contact} row {row}{} = {value}", wave(w)),
        Place::GapDirection {
            contact,
            column,
            wave: w,
        } => {
            format!("d{contact} column {column}{} = {value}", wave(w))
        }
        Place::Offset { contact, wave: w } => format!("delta{contact}{} = {value}", wave(w)),
        Place::Argument { contact, index } => format!("a{contact} {index} = {value}"),
        Place::Output {
            output,
            of,
            wave: w,
        } => format!("y{output} {of:?}{} = {value}", wave(w)),
        other => panic!("{other:?}"),
    }
}

/// Everything lowered, one line each.
fn summary(model: &Model) -> Vec<String> {
    let parameter = |variable: Variable| match variable {
        Variable::Parameter(index) => model.parameters[index].name.to_string(),
        Variable::Omega => "omega".to_owned(),
        other => format!("{other:?}"),
    };
    let coefficients = model.coefficients.iter();
    let coefficients =
        coefficients.map(|(place, id)| coefficient(place, &model.dag.display(*id, &parameter)));
    let mut lines: Vec<String> = coefficients.collect();
    for law in &model.laws {
        let argument = |variable: Variable| match variable {
            Variable::Gap => "g".to_owned(),
            Variable::Rate => "r".to_owned(),
            Variable::Argument(index) => law.arguments[index].clone(),
            other => format!("{other:?}"),
        };
        let show = |id: Id| model.dag.display(id, &argument);
        let mut line = format!("{}: {}", law.name, show(law.pieces[0]));
        for (level, &piece) in law.levels.iter().zip(&law.pieces[1..]) {
            let relation = if level.belongs_above { ">=" } else { ">" };
            let (value, force) = (show(level.value), show(piece));
            line = format!("{line} | {relation} {value} | {force}");
        }
        lines.push(line);
    }
    lines
}

fn assert_model(text: &str, expected: &[&str]) {
    let lines = summary(&model(text));
    assert_eq!(lines, expected, "in {text}");
}

fn faults(text: &str) -> String {
    compile(text)
        .err()
        .unwrap_or_else(|| panic!("no fault in {text}"))
}
