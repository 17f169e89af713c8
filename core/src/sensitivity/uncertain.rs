//! How uncertain parameters are.

use std::fmt;
use std::str::FromStr;

use super::error::SensitivityError;
use crate::error::Error;
use crate::model::validate;

/// A parameter, and its standard uncertainty: [in its unit](Self::new), or [as a part](Self::relative) of its value. It is written as
/// `zeta=0.002`, or `load=5%` of its value.
///
/// ```
/// use hertzian::sensitivity::Uncertain;
///
/// let load: Uncertain = "load=5%".parse()?;
/// assert_eq!((load.name(), load.of(-20.0)), ("load", 1.0));
/// assert_eq!(load, Uncertain::relative("load", 0.05)?);
/// assert_eq!(load.to_string(), "load=5%");
/// assert_eq!(Uncertain::new("zeta", 0.002)?.of(-20.0), 0.002);
/// assert!("load=five".parse::<Uncertain>().is_err());
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertain {
    name: String,
    size: f64,
    /// Whether the size is a part of the value.
    is_relative: bool,
}

impl Uncertain {
    /// Of a parameter by its name, or of the frequency, `omega`: so much in its own unit.
    ///
    /// # Errors
    /// If the size is negative or not finite, or there is no name.
    pub fn new(name: impl Into<String>, size: f64) -> Result<Self, Error> {
        Self::checked(name.into(), size, false)
    }

    /// The same, as a part of its value: `0.05` for five per cent.
    ///
    /// # Errors
    /// As of [`new`](Self::new).
    pub fn relative(name: impl Into<String>, part: f64) -> Result<Self, Error> {
        Self::checked(name.into(), part, true)
    }

    fn checked(name: String, size: f64, is_relative: bool) -> Result<Self, Error> {
        let most = 0.0..=f64::MAX;
        validate::option("size", size, most, "must be finite and not negative")?;
        let own = Self {
            name,
            size,
            is_relative,
        };
        if own.name.is_empty() {
            let text = own.to_string();
            return Err(SensitivityError::Uncertainty { text }.into());
        }
        Ok(own)
    }

    /// Name of the parameter, `omega` for the frequency.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether it is a part of the value.
    pub fn is_relative(&self) -> bool {
        self.is_relative
    }

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
        let size = if is_relative { number / 100.0 } else { number };
        Self::checked(name.trim().to_owned(), size, is_relative).map_err(|_| wrong().into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No size is there that is none, however it is made.
    #[test]
    fn a_size_is_finite_and_not_negative() {
        for size in [-0.1, f64::NAN, f64::INFINITY] {
            for made in [Uncertain::new("k", size), Uncertain::relative("k", size)] {
                let error = made.expect_err("no size");
                assert_eq!(error.variant(), "Option");
                assert_eq!(error.values()[0].1.to_bits(), size.to_bits());
            }
        }
        for text in ["k=-1", "k=NaN", "k=inf%", "=1", " =5%", "k", "k=5 percent"] {
            let error = text.parse::<Uncertain>().expect_err(text);
            let said =
                format!("{text} is no uncertainty: write zeta=0.002, or load=5% of its value");
            assert_eq!(error.to_string(), said);
        }
        assert!(Uncertain::new("", 0.1).is_err());
    }

    /// What is written is read, in per cent as in the unit.
    #[test]
    fn what_is_written_is_read() {
        for (text, expected) in [
            ("k=7%", Uncertain::relative("k", 0.07)),
            ("k=0.002", Uncertain::new("k", 0.002)),
            ("k=0", Uncertain::new("k", 0.0)),
        ] {
            let expected = expected.expect("an uncertainty");
            assert_eq!(text.parse(), Ok(expected.clone()));
            assert_eq!(expected.to_string(), text);
        }
    }
}
