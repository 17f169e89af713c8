//! Documentation of the emitted type: what was declared, and what the compiler made of it.

use proc_macro2::Ident;

use crate::dag::{Dag, Variable};
use crate::ir::{Law, Model};

/// Documentation of the type: the user's own, the equation, and the pieces of every law.
pub fn of_model(model: &Model) -> String {
    let own = model.documentation.trim();
    let mut text = if own.is_empty() {
        format!("The oscillator `{}`.", model.name)
    } else {
        own.to_owned()
    };
    text.push_str("\n\n# Equation\n\n```text\n");
    text.push_str(model.equation.trim());
    text.push_str("\n```\n");
    if !model.laws.is_empty() {
        text.push_str("\n# Laws\n\nForce by piece, as the compiler resolved it.\n\n```text\n");
        for law in &model.laws {
            text.push_str(&of_law(&model.dag, law));
        }
        text.push_str("```\n");
    }
    text
}

/// Documentation of a law that stands alone.
pub fn of_law_alone(own: &str, dag: &Dag, law: &Law) -> String {
    let own = own.trim();
    let mut text = if own.is_empty() {
        format!("The law `{}`.", law.name)
    } else {
        own.to_owned()
    };
    text.push_str("\n\n# Force by piece\n\n```text\n");
    text.push_str(&of_law(dag, law));
    text.push_str("```\n");
    if !law.arguments.is_empty() {
        let arguments = law.arguments.join("`, `");
        text.extend(["\nArguments: `", &arguments, "`.\n"]);
    }
    text
}

/// Documentation of a field.
pub fn of_field(name: &Ident, documentation: &str) -> String {
    let own = documentation.trim();
    if own.is_empty() {
        format!("Parameter `{name}`.")
    } else {
        own.to_owned()
    }
}

fn of_law(dag: &Dag, law: &Law) -> String {
    let name = |variable: Variable| match variable {
        Variable::Gap => "gap".to_owned(),
        Variable::Rate => "rate".to_owned(),
        Variable::Argument(index) => law.arguments[index].clone(),
        other => format!("{other:?}"),
    };
    let mut text = format!("{}:\n", law.name);
    for (index, &piece) in law.pieces.iter().enumerate() {
        let lower = index.checked_sub(1).map(|below| {
            let level = law.levels[below];
            let sign = if level.belongs_above { ">=" } else { ">" };
            format!("gap {sign} {}", dag.display(level.value, &name))
        });
        let upper = law.levels.get(index).map(|level| {
            let sign = if level.belongs_above { "<" } else { "<=" };
            format!("gap {sign} {}", dag.display(level.value, &name))
        });
        let condition: Vec<String> = lower.into_iter().chain(upper).collect();
        let condition = if condition.is_empty() {
            "everywhere".to_owned()
        } else {
            condition.join(", ")
        };
        let force = dag.display(piece, &name);
        text.extend(["    ", &condition, " => ", &force, "\n"]);
    }
    text
}
