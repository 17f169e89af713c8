//! Documentation of the emitted type: what was declared, and what the compiler made of it.

use hertzian_contract::law::{LawFacts, LevelFacts, RateDependence};
use proc_macro2::Ident;

use crate::dag::{Dag, Variable};
use crate::facts::{Piece, derive};
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
    if !model.outputs.is_empty() {
        text.push_str("\n# Outputs\n\n");
        for output in &model.outputs {
            let said = documented(&output.documentation, &output.unit);
            let said = said.lines().collect::<Vec<_>>().join(" ");
            text.extend(["- `", &output.name, " = ", &output.written, "`"]);
            if !said.is_empty() {
                text.extend([": ", &said]);
            }
            text.push('\n');
        }
    }
    if !model.laws.is_empty() {
        text.push_str("\n# Laws\n\nForce by piece, as the compiler resolved it, and what follows.\n\n```text\n");
        let mut dag = model.dag.clone();
        for law in &model.laws {
            text.push_str(&of_law(&mut dag, law));
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
    text.push_str(&of_law(&mut dag.clone(), law));
    text.push_str("```\n");
    if !law.arguments.is_empty() {
        let arguments = law.arguments.join("`, `");
        text.extend(["\nArguments: `", &arguments, "`.\n"]);
    }
    text
}

/// Documentation of a field, with its unit.
pub fn of_field(name: &Ident, documentation: &str, unit: &str) -> String {
    let own = documented(documentation, unit);
    if own.is_empty() {
        format!("Parameter `{name}`.")
    } else {
        own
    }
}

/// What is said of something, with its unit.
fn documented(documentation: &str, unit: &str) -> String {
    let own = documentation.trim();
    match (own, unit) {
        (_, "") => own.to_owned(),
        ("", _) => format!("[{unit}]"),
        _ => format!("{own} [{unit}]"),
    }
}

fn of_law(dag: &mut Dag, law: &Law) -> String {
    let mut text = format!("{}:\n", law.name);
    for index in 0..law.pieces.len() {
        text.extend(["    ", &of_piece(dag, law, index), "\n"]);
    }
    let count = law.arguments.len();
    let pieces: Vec<Piece> = law
        .pieces
        .iter()
        .map(|&force| Piece::of(dag, force, count))
        .collect();
    let facts = derive(dag, law, &pieces);
    for fact in facts_of(&facts) {
        text.extend(["  ", fact, "\n"]);
    }
    for (level, facts) in law.levels.iter().zip(facts.levels.iter()) {
        let value = dag.display(level.value, &|variable| name(law, variable));
        text.extend(["  at gap = ", &value, ": ", &of_level(*facts), "\n"]);
    }
    text
}

/// What holds for a law as a whole.
fn facts_of(facts: &LawFacts) -> Vec<&'static str> {
    let rate = match facts.rate {
        RateDependence::None => "does not depend on the rate",
        RateDependence::Linear => "linear in the rate",
        _ => "not linear in the rate",
    };
    let affine = facts.pieces.iter().all(|piece| piece.affine);
    let mut text = vec![rate];
    text.extend(affine.then_some("a straight line on every piece"));
    text.extend(facts.odd.then_some("odd in gap and rate"));
    text
}

/// What happens where two pieces meet.
fn of_level(facts: LevelFacts) -> String {
    let stiffness = match (facts.unbounded_by_gap, facts.by_gap_jumps) {
        (true, _) => Some("the stiffness is or may be unbounded"),
        (false, true) => Some("the stiffness jumps"),
        (false, false) => None,
    };
    let force = facts.force_jumps.then_some("the force jumps");
    let damping = facts.by_rate_jumps.then_some("the damping jumps");
    let all: Vec<&str> = force.into_iter().chain(stiffness).chain(damping).collect();
    if all.is_empty() {
        "force, stiffness and damping are continuous".to_owned()
    } else {
        all.join(", ")
    }
}

fn name(law: &Law, variable: Variable) -> String {
    match variable {
        Variable::Gap => "gap".to_owned(),
        Variable::Rate => "rate".to_owned(),
        Variable::Argument(index) => law.arguments[index].clone(),
        other => format!("{other:?}"),
    }
}

/// The condition of a piece, and its force.
fn of_piece(dag: &Dag, law: &Law, index: usize) -> String {
    let name = |variable| name(law, variable);
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
    format!("{condition} => {}", dag.display(law.pieces[index], &name))
}
