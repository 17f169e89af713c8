//! What the page asks for, and the same as options of `hertzian response`: so both compute the same numbers.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::OnceLock;

use clap::{Parser, ValueEnum};
use hertzian::generic::Declaration;
use hertzian::{OrbitMethodKind, System};
use serde::{Deserialize, Serialize};

use super::declared::Texts;
use super::fault::{Fault, Kind};
use crate::built_in::{BuiltIn, MODELS};
use crate::range::RangeOptions;
use crate::response::model_file::{self, Varied};
use crate::response::models;
use crate::response::options::{By, Options};
use crate::response::run;

/// Longer periods than this are seldom followed from nothing, and take long.
const LONGEST_PERIOD: usize = 64;
/// Bifurcations between a branch and the first one; each may double what there is.
const DEEPEST: usize = 4;
/// What a model is called that has no name: where the command line of `hertzian response` has its file.
const NO_NAME: &str = "FILE";

/// A curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Asked {
    /// The declaration.
    pub text: String,
    /// Values of parameters; that of what varies is not used.
    #[serde(default)]
    pub values: BTreeMap<String, f64>,
    /// What varies: `omega`, or a parameter.
    pub varied: String,
    /// Where its range begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// The frequency of the excitation, where that does not vary.
    #[serde(default = "one")]
    pub omega: f64,
    /// Period of the orbits, in periods of the excitation.
    #[serde(default = "once")]
    pub period: usize,
    /// How orbits are computed.
    #[serde(default)]
    pub by: Method,
    /// All branches from bifurcations, to this depth.
    #[serde(default)]
    pub depth: Option<usize>,
}

fn one() -> f64 {
    1.0
}

fn once() -> usize {
    1
}

/// How orbits are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// As [`FrequencyResponse::choice`](hertzian::FrequencyResponse::choice) has it: by the contact equation where a law opens or has a corner in the range,
    /// by shooting where a stiffness is unbounded on both sides of a level, else by the balance.
    #[default]
    Automatic,
    /// Harmonic balance.
    Balance,
    /// Shooting.
    Shooting,
    /// The contact equation.
    ContactEquation,
}

/// How exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Effort {
    /// As exactly as a screen shows it: while a slider is dragged.
    Screen,
    /// As exactly as `hertzian response`.
    Full,
}

impl Asked {
    /// Whether the numbers make sense before any work.
    ///
    /// # Errors
    /// Which does not.
    pub fn check(&self) -> Result<(), Fault> {
        let value =
            |field: &str, must: &str| Fault::new(Kind::Value, format!("{field} {must}")).of(field);
        if !(1..=LONGEST_PERIOD).contains(&self.period) {
            let must = format!("must be from 1 to {LONGEST_PERIOD}");
            return Err(value("period", &must));
        }
        if self.depth.is_some_and(|depth| depth > DEEPEST) {
            return Err(value("depth", &format!("must be at most {DEEPEST}")));
        }
        Ok(())
    }

    /// The model that is built in with this text.
    pub fn built_in(&self) -> Option<&'static BuiltIn> {
        MODELS.iter().find(|model| model.text == self.text)
    }

    /// What `hertzian response` has for it, with the method that is meant.
    ///
    /// # Errors
    /// If a parameter is not one of the model.
    pub fn options(&self, by: By) -> Result<Options, Fault> {
        let mut options = usual()?;
        let name = self.built_in().map_or(NO_NAME, |model| model.name);
        options.model.file = Some(PathBuf::from(name));
        options.model.set = self.settings();
        options.range = RangeOptions {
            sweep: self.varied.clone(),
            from: self.from,
            to: self.to,
        };
        if !options.over_frequency() {
            options.model.omega = Some(self.omega);
        }
        options.period = self.period;
        options.by = Some(by);
        options.bifurcations = self.depth.is_some();
        options.follow = self.depth;
        options.model = options
            .model
            .resolved()
            .map_err(|message| Fault::new(Kind::Value, message))?;
        Ok(options)
    }

    fn settings(&self) -> Vec<(String, f64)> {
        let given = self.values.iter();
        let given = given.filter(|(name, _)| **name != self.varied);
        given.map(|(name, value)| (name.clone(), *value)).collect()
    }

    /// The model at these values: the one that is compiled, where the text is that of one.
    ///
    /// # Errors
    /// Faults of the declaration, and parameters that it does not have.
    pub fn model(&self, texts: &Texts) -> Result<Box<dyn System>, Fault> {
        if self.built_in().is_some() {
            let options = self.options(By::Balance)?;
            let varied = Varied {
                name: &self.varied,
                value: self.from,
            };
            if options.model.file.is_none() {
                return Ok(models::model(&options.model, varied)?);
            }
        }
        Ok(Box::new(self.declared(texts)?))
    }

    /// The model at these values as it is declared, whether it is compiled or not.
    ///
    /// # Errors
    /// As of [`model`](Self::model).
    pub fn declared(&self, texts: &Texts) -> Result<Declaration, Fault> {
        let varied = Varied {
            name: &self.varied,
            value: self.from,
        };
        let declaration = texts.parse(&self.text)?;
        let mut without = declaration
            .parameters()
            .into_iter()
            .filter(|(name, value)| {
                value.is_nan() && *name != self.varied && !self.values.contains_key(*name)
            });
        if let Some((name, _)) = without.next() {
            let message = format!("{name} has no default: give it a value");
            return Err(Fault::new(Kind::Value, message).of(name));
        }
        drop(without);
        Ok(model_file::valued(declaration, &self.settings(), varied)?)
    }

    /// The method that is meant.
    ///
    /// # Errors
    /// If it makes no options.
    pub fn method(&self, model: &dyn System) -> Result<By, Fault> {
        Ok(match self.by {
            Method::Automatic => match run::request(&self.options(By::Balance)?, model).choice() {
                OrbitMethodKind::HarmonicBalance => By::Balance,
                OrbitMethodKind::Shooting => By::Shooting,
                _ => By::ContactEquation,
            },
            Method::Balance => By::Balance,
            Method::Shooting => By::Shooting,
            Method::ContactEquation => By::ContactEquation,
        })
    }

    /// The command line that computes the same.
    pub fn command(&self, by: By) -> String {
        let mut words = vec!["hertzian response --model".to_owned()];
        words.push(match self.built_in() {
            Some(model) => model.name.to_owned(),
            None => NO_NAME.to_owned(),
        });
        let settings = self.settings().into_iter();
        words.extend(settings.map(|(name, value)| format!("--set {name}={value}")));
        if self.varied != "omega" {
            words.push(format!("--sweep {} --omega {}", self.varied, self.omega));
        }
        words.push(format!("--from {} --to {}", self.from, self.to));
        if self.period != 1 {
            words.push(format!("--period {}", self.period));
        }
        let name = by.to_possible_value();
        words.extend(name.map(|name| format!("--by {}", name.get_name())));
        if let Some(depth) = self.depth {
            words.push(format!("--bifurcations --follow {depth}"));
        }
        words.join(" ")
    }
}

/// The options of a command line without any.
fn usual() -> Result<Options, Fault> {
    static USUAL: OnceLock<Options> = OnceLock::new();
    if let Some(known) = USUAL.get() {
        return Ok(known.clone());
    }
    let read = Options::try_parse_from(["response"]);
    let read = read.map_err(|error| Fault::request(error.to_string()))?;
    Ok(USUAL.get_or_init(|| read).clone())
}
