//! An oscillator read from a text, in the language of `hertzian::oscillator!`: a file, or one that has a name.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use hertzian::generic::{Declaration, DeclarationError};

use crate::built_in::{self, BuiltIn};

/// A declaration is a page; a file that is longer than this many bytes is something else, as a device without end.
const LONGEST: u64 = 4_000_000;

/// Why a file gives no oscillator.
#[derive(Debug)]
#[non_exhaustive]
pub enum ModelError {
    /// The file cannot be read.
    Unreadable(io::Error),
    /// What it says is no declaration.
    Faulty(DeclarationError),
    /// A parameter to be set does not exist, or one that exists has no value.
    Parameter(String),
}

impl ModelError {
    /// The message, every fault with its place in the file.
    pub fn describe(&self, path: &Path) -> String {
        let is_word = path.components().count() == 1 && path.extension().is_none();
        let path = path.display();
        match self {
            Self::Unreadable(error) => {
                let text = format!("cannot read {path}: {error}");
                // A word is more likely a name.
                let is_word = error.kind() == io::ErrorKind::NotFound && is_word;
                let names = is_word.then(|| format!("; names of models: {}", built_in::names()));
                text + &names.unwrap_or_default()
            }
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

/// The text of a model with a name, or of a file, which may be a pipe, unless it is longer than any declaration.
///
/// # Errors
/// What the system says, and if the text is too long.
pub fn text(path: &Path) -> io::Result<String> {
    if let Some(model) = BuiltIn::named(path) {
        return Ok(model.text.to_owned());
    }
    let mut bytes = Vec::new();
    File::open(path)?
        .take(LONGEST + 1)
        .read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LONGEST {
        let message = format!("it is longer than {LONGEST} bytes, and no declaration");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    String::from_utf8(bytes)
        .map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "it is no text in UTF-8"))
}

/// What is varied, and its first value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Varied<'v> {
    /// A parameter, or `omega`.
    pub name: &'v str,
    /// Where the range begins.
    pub value: f64,
}

/// Reads the oscillator and sets its parameters. `varied` needs no value: the range gives it one.
///
/// # Errors
/// See [`ModelError`].
pub fn read(
    path: &Path,
    settings: &[(String, f64)],
    varied: Varied<'_>,
) -> Result<Declaration, ModelError> {
    let text = text(path).map_err(ModelError::Unreadable)?;
    let model = Declaration::parse(&text).map_err(ModelError::Faulty)?;
    valued(model, settings, varied)
}

/// A declaration with its parameters set. `varied` needs no value: the range gives it one.
///
/// # Errors
/// If a parameter to be set does not exist, or one has no value.
pub fn valued(
    mut model: Declaration,
    settings: &[(String, f64)],
    varied: Varied<'_>,
) -> Result<Declaration, ModelError> {
    // An unknown name is reported by the run itself.
    let _ = model.set(varied.name, varied.value);
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
