//! Options that say which oscillator a program is about.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::built_in::{self, BuiltIn};
use crate::misplaced::Given;
use crate::values;

/// An oscillator on a power-law contact, or one by its name or from a file.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct ModelOptions {
    /// Exponent of the force, positive
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 1.5,
        allow_hyphen_values = true
    )]
    pub alpha: f64,

    /// Contact that can be lost: force and damping act for x > 0 only (the default)
    #[arg(long, conflicts_with = "continuous")]
    pub one_sided: bool,

    /// Contact that cannot be lost: force and damping act everywhere
    #[arg(long)]
    pub continuous: bool,

    /// The oscillator by its name, or a file that declares it in the language of `hertzian::oscillator!`
    #[arg(
        long = "model",
        value_name = "NAME|FILE",
        long_help = built_in::help()
    )]
    pub file: Option<PathBuf>,

    /// Value of a parameter of that oscillator; --alpha, --zeta, --load and --drive are short for it
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub set: Vec<(String, f64)>,

    /// Damping ratio, not negative
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 0.032,
        allow_hyphen_values = true
    )]
    pub zeta: f64,

    /// Constant load W
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 1.0,
        allow_hyphen_values = true
    )]
    pub load: f64,

    /// Amplitude A of the excitation; with --sweep drive, the range takes its place
    #[arg(
        long,
        value_name = "VALUE",
        default_value_t = 0.1,
        allow_hyphen_values = true
    )]
    pub drive: f64,

    /// Frequency of the excitation, positive, where it is not what varies [default: 1]
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub omega: Option<f64>,
}

/// Said where a frequency is given, and a range of it too.
pub const FREQUENCY_VARIES: &str = "--omega cannot be used where omega varies: the range gives it";

impl ModelOptions {
    /// Whether every parameter is set once, to a number, and of an oscillator that has it.
    ///
    /// # Errors
    /// If one is not.
    pub fn check(&self) -> Result<(), String> {
        if let (Some((name, _)), None) = (self.set.first(), &self.file) {
            return Err(format!(
                "--set {name} belongs to --model and would do nothing here"
            ));
        }
        for (name, value) in &self.set {
            values::finite(&format!("--set {name}"), *value)?;
        }
        values::once("--set", self.set.iter().map(|(name, _)| name.as_str()))
    }

    /// Whether contact can be lost, where the oscillator is called by the name of one that is compiled too.
    fn contact(&self) -> Option<bool> {
        match BuiltIn::named(self.file.as_deref()?)?.name {
            "one-sided" => Some(true),
            "continuous" => Some(false),
            _ => None,
        }
    }

    /// Whether the oscillator is read from a text, and not one on a power-law contact.
    pub fn is_read(&self) -> bool {
        self.file.is_some() && self.contact().is_none()
    }

    /// The file of the oscillator, if it comes from one.
    pub fn path(&self) -> Option<&Path> {
        let path = self.file.as_deref()?;
        BuiltIn::named(path).is_none().then_some(path)
    }

    /// The same oscillator by its own options, where it is called by the name of one that has them.
    ///
    /// # Errors
    /// If something is set that it does not have, or that is no number.
    pub fn resolved(&self) -> Result<Self, String> {
        let Some(opens) = self.contact() else {
            return Ok(self.clone());
        };
        self.check()?;
        let mut resolved = Self {
            file: None,
            set: Vec::new(),
            one_sided: opens,
            continuous: !opens,
            ..self.clone()
        };
        for (name, value) in &self.set {
            let parameter = match name.as_str() {
                "alpha" => &mut resolved.alpha,
                "zeta" => &mut resolved.zeta,
                "load" => &mut resolved.load,
                "drive" => &mut resolved.drive,
                _ => {
                    return Err(format!(
                        "no parameter {name}: there are alpha, zeta, load, drive"
                    ));
                }
            };
            *parameter = *value;
        }
        Ok(resolved)
    }

    /// What was given besides --model and would do nothing.
    pub fn fault(&self, given: &Given<'_>) -> Option<String> {
        let path = self.file.as_ref()?.display();
        if let Some(kind) = ["one_sided", "continuous"].iter().find(|id| given.has(id)) {
            let kind = kind.replace('_', "-");
            return Some(format!("--{kind} would do nothing beside --model {path}"));
        }
        let mut short = ["alpha", "zeta", "load", "drive"].into_iter();
        if self.is_read() {
            let name = short.find(|id| given.has(id))?;
            return Some(format!(
                "--{name} is for one-sided and continuous contact; with --model {path} write --set {name}=VALUE"
            ));
        }
        let is_set = |id: &&str| given.has(id) && self.set.iter().any(|(name, _)| name == id);
        let name = short.find(is_set)?;
        Some(format!("--{name} and --set {name} are the same: give one"))
    }

    /// Whether contact can be lost.
    pub fn loses_contact(&self) -> bool {
        self.file.is_none() && !self.continuous
    }

    /// Frequency of the excitation where it does not vary.
    pub fn frequency(&self) -> f64 {
        self.omega.unwrap_or(1.0)
    }
}

/// Reads `NAME=VALUE`.
pub(crate) fn setting(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
    let value = value
        .trim()
        .parse()
        .map_err(|_| format!("`{value}` is not a number"))?;
    Ok((name.trim().to_owned(), value))
}
