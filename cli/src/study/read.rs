//! A study file with the model and the table that it names.

use std::fs;
use std::path::{Path, PathBuf};

use hertzian::generic::Declaration;
use hertzian_study::{Plan, Study};

use crate::built_in::BuiltIn;
use crate::model::ModelOptions;
use crate::response::model_file::{self, ModelError};
use crate::response::models;

/// The study of a file, and what it says.
///
/// # Errors
/// What is wrong, in a sentence.
pub(super) fn study(path: &Path) -> Result<(Study, Plan), String> {
    let text = fs::read_to_string(path)
        .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    let plan = Plan::parse(&text, path).map_err(|error| error.to_string())?;
    let table = plan.variants.file.as_ref().map(|file| {
        let file = beside(path, file);
        let text = fs::read_to_string(&file);
        text.map_err(|error| format!("cannot read {}: {error}", file.display()))
    });
    let table = table.transpose()?;
    let name = Path::new(&plan.model);
    if let Some(model) = BuiltIn::named(name) {
        let opens = match model.name {
            "one-sided" => true,
            "continuous" => false,
            _ => return read(&plan, name, table),
        };
        // They are compiled, too: with the exponent written into the force, unless it varies.
        let varies = alpha_varies(&plan, table.as_deref());
        let options = power_law(&plan, opens);
        let system = if varies {
            models::of_any_exponent(&options)
        } else {
            models::declared(&options)
        };
        let study = Study::planned(&*system, plan.clone(), model.text, table);
        let has = system
            .facts()
            .parameters
            .iter()
            .any(|facts| facts.name == "alpha");
        let constants: &[&str] = if has { &[] } else { &["alpha"] };
        return Ok((study.constants(constants), plan));
    }
    let file = beside(path, name);
    read(&plan, &file, table)
}

/// A study of a model that is read from a text.
fn read(plan: &Plan, path: &Path, table: Option<String>) -> Result<(Study, Plan), String> {
    let described = |error: ModelError| error.describe(path);
    let text = model_file::text(path).map_err(|error| described(ModelError::Unreadable(error)))?;
    let model = Declaration::parse(&text).map_err(|error| described(ModelError::Faulty(error)))?;
    Ok((
        Study::planned(&model, plan.clone(), &text, table),
        plan.clone(),
    ))
}

/// Whether the exponent has several values.
fn alpha_varies(plan: &Plan, table: Option<&str>) -> bool {
    let header = table.and_then(|table| table.lines().find(|line| !line.starts_with('#')));
    let mut columns = header.into_iter().flat_map(|header| header.split(','));
    plan.request.vary == "alpha"
        || plan.variants.over.contains_key("alpha")
        || columns.any(|name| name.trim() == "alpha")
}

/// The oscillator on a power-law contact with the values of a study file.
fn power_law(plan: &Plan, opens: bool) -> ModelOptions {
    let value = |name: &str, default: f64| plan.parameters.get(name).copied().unwrap_or(default);
    ModelOptions {
        alpha: value("alpha", 1.5),
        one_sided: opens,
        continuous: !opens,
        file: None,
        set: Vec::new(),
        zeta: value("zeta", 0.032),
        load: value("load", 1.0),
        drive: value("drive", 0.1),
        omega: None,
    }
}

/// The path of something that a study file names: beside it.
pub(super) fn beside(study: &Path, path: &Path) -> PathBuf {
    study.parent().unwrap_or(Path::new("")).join(path)
}
