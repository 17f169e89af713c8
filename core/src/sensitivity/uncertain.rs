//! How uncertain parameters are.

use std::fmt;
use std::str::FromStr;

use super::error::SensitivityError;
use crate::error::Error;

/// A parameter, and its standard uncertainty. It is written as `zeta=0.002`, or `load=5%` of its value.
///
/// ```
/// use hertzian::sensitivity::Uncertain;
///
/// let load: Uncertain = "load=5%".parse()?;
/// assert_eq!((load.name.as_str(), load.of(-20.0)), ("load", 1.0));
/// assert_eq!(load.to_string(), "load=5%");
/// assert!("load=five".parse::<Uncertain>().is_err());
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertain {
    /// Its name, `omega` for the frequency.
    pub name: String,
    /// By how much: in the unit of the parameter, or as a part of its value.
    pub size: f64,
    /// Whether the size is a part of the value.
    pub is_relative: bool,
}

impl Uncertain {
    /// The uncertainty of a value, which is not negative.
    pub fn of(&self, value: f64) -> f64 {
        if self.is_relative {
            self.size * value.abs()
        } else {
            self.size
        }
    }

    /// The size alone, as it is written behind the name.
    pub(crate) fn written_size(&self) -> String {
        if self.is_relative {
            format!("{}%", percent(self.size))
        } else {
            self.size.to_string()
        }
    }
}

/// A part in hundredths, without what rounding adds.
fn percent(part: f64) -> f64 {
    (part * 1e14).round() / 1e12
}

impl fmt::Display for Uncertain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.name, self.written_size())
    }
}

impl FromStr for Uncertain {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let wrong = || SensitivityError::Uncertainty {
            text: text.to_owned(),
        };
        let (name, size) = text.split_once('=').ok_or_else(wrong)?;
        let (number, is_relative) = match size.strip_suffix('%') {
            Some(number) => (number, true),
            None => (size, false),
        };
        let number: f64 = number.trim().parse().map_err(|_| wrong())?;
        if name.trim().is_empty() || !(number.is_finite() && number >= 0.0) {
            return Err(wrong().into());
        }
        Ok(Self {
            name: name.trim().to_owned(),
            size: if is_relative { number / 100.0 } else { number },
            is_relative,
        })
    }
}
