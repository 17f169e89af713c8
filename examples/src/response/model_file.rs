//! An oscillator read from a file, in the language of `hertzian::oscillator!`.

use std::path::Path;

use hertzian::generic::{Declaration, DeclarationError};

/// Why a file gives no oscillator.
#[derive(Debug)]
#[non_exhaustive]
pub enum ModelError {
    /// The file cannot be read.
    Unreadable(std::io::Error),
    /// What it says is no declaration.
    Faulty(DeclarationError),
    /// A parameter to be set does not exist, or one that exists has no value.
    Parameter(String),
}

impl ModelError {
    /// The message, every fault with its place in the file.
    pub fn describe(&self, path: &Path) -> String {
        let path = path.display();
        match self {
            Self::Unreadable(error) => format!("cannot read {path}: {error}"),
            Self::Faulty(error) => {
                let faults = error.faults.iter();
                let lines =
                    faults.map(|f| format!("{path}:{}:{}: {}", f.line, f.column, f.message));
                lines.collect::<Vec<_>>().join("\n")
            }
            Self::Parameter(message) => format!("{path}: {message}"),
        }
    }
}

/// Reads the oscillator and sets its parameters. `varied` needs no value: the range gives it one.
///
/// # Errors
/// See [`ModelError`].
pub fn read(
    path: &Path,
    settings: &[(String, f64)],
    varied: (&str, f64),
) -> Result<Declaration, ModelError> {
    let text = std::fs::read_to_string(path).map_err(ModelError::Unreadable)?;
    let mut model = Declaration::parse(&text).map_err(ModelError::Faulty)?;
    // An unknown name is reported by the run itself.
    let _ = model.set(varied.0, varied.1);
    for (name, value) in settings {
        model
            .set(name, *value)
            .map_err(|error| ModelError::Parameter(error.to_string()))?;
    }
    let values = model.parameters();
    let missing = values
        .into_iter()
        .filter(|(_, value)| value.is_nan())
        .map(|(name, _)| name);
    match missing.collect::<Vec<_>>() {
        names if names.is_empty() => Ok(model),
        names => {
            let hint = names
                .iter()
                .map(|name| format!("--set {name}=VALUE"))
                .collect::<Vec<_>>();
            Err(ModelError::Parameter(format!(
                "parameters without a value: {}",
                hint.join(" ")
            )))
        }
    }
}
