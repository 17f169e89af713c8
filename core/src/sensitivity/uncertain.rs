//! How uncertain parameters are.

use std::fmt;
use std::str::FromStr;

use super::SensitivityError;

/// A parameter, and its standard uncertainty. It is written as `zeta=0.002`, or `load=5%` of its value.
///
/// ```
/// use hertzian::sensitivity::Uncertain;
///
/// let load: Uncertain = "load=5%".parse()?;
/// assert_eq!((load.name.as_str(), load.of(-20.0)), ("load", 1.0));
/// assert_eq!(load.to_string(), "load=5%");
/// assert!("load=five".parse::<Uncertain>().is_err());
/// # Ok::<(), hertzian::sensitivity::SensitivityError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertain {
    /// Its name, `omega` for the frequency.
    pub name: String,
    /// By how much.
    pub size: Uncertainty,
}

/// How large an uncertainty is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Uncertainty {
    /// In the unit of the parameter.
    Absolute(f64),
    /// As a part of its value.
    Relative(f64),
}

impl Uncertain {
    /// The uncertainty of a value, which is not negative.
    pub fn of(&self, value: f64) -> f64 {
        match self.size {
            Uncertainty::Absolute(size) => size,
            Uncertainty::Relative(part) => part * value.abs(),
        }
    }
}

/// A part in hundredths, without what rounding adds.
fn percent(part: f64) -> f64 {
    (part * 1e14).round() / 1e12
}

impl fmt::Display for Uncertainty {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absolute(size) => write!(f, "{size}"),
            Self::Relative(part) => write!(f, "{}%", percent(*part)),
        }
    }
}

impl fmt::Display for Uncertain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.name, self.size)
    }
}

impl FromStr for Uncertain {
    type Err = SensitivityError;

    fn from_str(text: &str) -> Result<Self, SensitivityError> {
        let wrong = || SensitivityError::Uncertainty {
            text: text.to_owned(),
        };
        let (name, size) = text.split_once('=').ok_or_else(wrong)?;
        let (number, relative) = match size.strip_suffix('%') {
            Some(number) => (number, true),
            None => (size, false),
        };
        let number: f64 = number.trim().parse().map_err(|_| wrong())?;
        if name.trim().is_empty() || !(number.is_finite() && number >= 0.0) {
            return Err(wrong());
        }
        Ok(Self {
            name: name.trim().to_owned(),
            size: if relative {
                Uncertainty::Relative(number / 100.0)
            } else {
                Uncertainty::Absolute(number)
            },
        })
    }
}
