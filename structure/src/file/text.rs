//! The file of a structure as it is written.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

/// The whole of it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Text {
    pub name: Option<String>,
    pub matrices: Matrices,
    #[serde(default)]
    pub units: Units,
    pub damping: Option<Spanned<DampingText>>,
    #[serde(default)]
    pub parameters: BTreeMap<Spanned<String>, ParameterText>,
    #[serde(default)]
    pub gyroscopic: Vec<GyroscopicText>,
    #[serde(default)]
    pub load: Vec<LoadText>,
    #[serde(default)]
    pub contact: Vec<ContactText>,
    #[serde(default)]
    pub output: Vec<OutputText>,
}

/// Paths of the matrices.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Matrices {
    pub mass: String,
    pub stiffness: String,
    pub damping: Option<String>,
}

/// Units of what the structure is read by; time is in seconds.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Units {
    #[serde(default)]
    pub length: String,
    #[serde(default)]
    pub force: String,
}

/// One of the ways to damp.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DampingText {
    pub ratio: Option<f64>,
    pub ratios: Option<Vec<f64>>,
    pub table: Option<Vec<[f64; 2]>>,
    pub mass: Option<f64>,
    pub stiffness: Option<f64>,
}

/// A value, or a value with what is known of it.
#[derive(Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a number, or a table as { value = 1.0, unit = \"N\" }"
)]
pub enum ParameterText {
    Plain(f64),
    Known(KnownText),
}

/// A parameter.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KnownText {
    pub value: f64,
    #[serde(default)]
    pub unit: String,
    #[serde(default)]
    pub about: String,
    pub min: Option<f64>,
    pub max: Option<f64>,
}

/// A number, or the name of a parameter.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "expected a number, or the name of a parameter")]
pub enum ValueText {
    Number(f64),
    Name(String),
}

/// A direction.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DirectionText {
    pub file: Option<String>,
    pub coordinates: Option<Vec<usize>>,
    pub weights: Option<Vec<f64>>,
    pub first: Option<usize>,
    pub every: Option<usize>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GyroscopicText {
    pub matrix: String,
    pub speed: Spanned<ValueText>,
}

/// What a load is proportional to.
#[derive(Debug, Default, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum KindText {
    #[default]
    Force,
    Unbalance,
    Base,
    Acceleration,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadText {
    #[serde(default)]
    pub kind: KindText,
    pub direction: Spanned<DirectionText>,
    pub amplitude: Spanned<ValueText>,
    #[serde(default = "one")]
    pub harmonic: u32,
    #[serde(default)]
    pub phase: f64,
}

fn one() -> u32 {
    1
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactText {
    pub name: Spanned<String>,
    pub law: Option<Spanned<String>>,
    pub law_file: Option<Spanned<String>>,
    #[serde(default)]
    pub arguments: BTreeMap<Spanned<String>, Spanned<ValueText>>,
    pub direction: Spanned<DirectionText>,
    pub force_direction: Option<Spanned<DirectionText>>,
    pub turning: Option<Spanned<TurningText>>,
    pub offset: Option<Spanned<ValueText>>,
}

/// How the direction of a contact turns: towards which, by what fraction of the frequency, from which angle on.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TurningText {
    pub towards: Spanned<DirectionText>,
    pub by: [u32; 2],
    #[serde(default)]
    pub from: f64,
}

/// What an output takes along its direction.
#[derive(Debug, Default, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TakenText {
    #[default]
    Displacement,
    Rate,
    Acceleration,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutputText {
    pub name: Spanned<String>,
    #[serde(default)]
    pub kind: TakenText,
    pub direction: Spanned<DirectionText>,
    pub unit: Option<String>,
    #[serde(default)]
    pub about: String,
}
