//! What is asked of a signal, by name: `tip:rms`, `mesh:impacts`, `x:h3`.

use std::fmt;
use std::str::FromStr;

use super::Motion;
use crate::model::request::RequestError;

/// A quantity that is read off a signal over the period of an orbit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Measure {
    /// Largest less smallest value: `p2p`.
    #[default]
    PeakToPeak,
    /// Largest value: `max`.
    Maximum,
    /// Smallest value: `min`.
    Minimum,
    /// Mean: `mean`.
    Mean,
    /// Root of the mean square, mean included: `rms`.
    Rms,
    /// Largest value by size over the root of the mean square: `crest`.
    CrestFactor,
    /// Amplitude of a harmonic of the orbit: `h1`, `h2` and so on.
    Amplitude(usize),
    /// Phase lag of a harmonic in radians: `phase1` and so on.
    Phase(usize),
    /// Integral of a contact's force over the period of the orbit: `impulse`.
    Impulse,
    /// How often contact begins in the period of the orbit: `impacts`.
    Impacts,
    /// Part of the period on a piece of a contact's law, from one on, lowest gaps first: `piece1` and so on.
    OnPiece(usize),
}

impl Measure {
    /// What is read of every signal where nothing is asked for by name.
    pub(crate) const USUAL: [Self; 6] = [
        Self::PeakToPeak,
        Self::Maximum,
        Self::Minimum,
        Self::Mean,
        Self::Rms,
        Self::CrestFactor,
    ];

    /// Whether it is one of a contact alone.
    pub(crate) fn is_of_contact(self) -> bool {
        matches!(self, Self::Impulse | Self::Impacts | Self::OnPiece(_))
    }

    /// What extremes, mean and root of the mean square say of it.
    pub(crate) fn of(self, motion: &Motion) -> Option<f64> {
        match self {
            Self::PeakToPeak => Some(motion.peak_to_peak()),
            Self::Maximum => Some(motion.maximum),
            Self::Minimum => Some(motion.minimum),
            Self::Mean => motion.mean,
            Self::Rms => motion.rms,
            Self::CrestFactor => motion.crest_factor(),
            _ => None,
        }
    }

    /// In words: `rms` for rms, `largest` for `max`.
    pub fn in_words(self) -> String {
        match self {
            Self::PeakToPeak => "peak-to-peak".to_owned(),
            Self::Maximum => "largest".to_owned(),
            Self::Minimum => "smallest".to_owned(),
            Self::Mean => "mean".to_owned(),
            Self::Rms => "rms".to_owned(),
            Self::CrestFactor => "crest factor".to_owned(),
            Self::Amplitude(harmonic) => format!("amplitude of harmonic {harmonic}"),
            Self::Phase(harmonic) => format!("phase of harmonic {harmonic}"),
            Self::Impulse => "impulse per period".to_owned(),
            Self::Impacts => "impacts per period".to_owned(),
            Self::OnPiece(piece) => format!("part of the period on piece {piece}"),
        }
    }

    /// Its unit where the signal has one.
    pub fn unit(self, of_signal: &str) -> String {
        match self {
            Self::Phase(_) => "rad".to_owned(),
            Self::CrestFactor | Self::Impacts | Self::OnPiece(_) => String::new(),
            Self::Impulse if !of_signal.is_empty() => format!("{of_signal}*s"),
            _ => of_signal.to_owned(),
        }
    }
}

impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PeakToPeak => f.write_str("p2p"),
            Self::Maximum => f.write_str("max"),
            Self::Minimum => f.write_str("min"),
            Self::Mean => f.write_str("mean"),
            Self::Rms => f.write_str("rms"),
            Self::CrestFactor => f.write_str("crest"),
            Self::Amplitude(harmonic) => write!(f, "h{harmonic}"),
            Self::Phase(harmonic) => write!(f, "phase{harmonic}"),
            Self::Impulse => f.write_str("impulse"),
            Self::Impacts => f.write_str("impacts"),
            Self::OnPiece(piece) => write!(f, "piece{piece}"),
        }
    }
}

impl FromStr for Measure {
    type Err = RequestError;

    fn from_str(text: &str) -> Result<Self, RequestError> {
        let numbered = |word: &str| -> Option<usize> {
            let digits = text.strip_prefix(word)?;
            let number: usize = digits.parse().ok()?;
            (number > 0 && digits == number.to_string()).then_some(number)
        };
        Ok(match text {
            "p2p" => Self::PeakToPeak,
            "max" => Self::Maximum,
            "min" => Self::Minimum,
            "mean" => Self::Mean,
            "rms" => Self::Rms,
            "crest" => Self::CrestFactor,
            "impulse" => Self::Impulse,
            "impacts" => Self::Impacts,
            _ => {
                let amplitude = numbered("h").map(Self::Amplitude);
                let phase = numbered("phase").map(Self::Phase);
                let piece = numbered("piece").map(Self::OnPiece);
                let found = amplitude.or(phase).or(piece);
                found.ok_or_else(|| RequestError::UnknownMeasure {
                    name: text.to_owned(),
                })?
            }
        })
    }
}

/// A signal by its name, that of an output, a coordinate or a contact, and what is asked of it.
///
/// ```
/// use hertzian::observe::{Measure, Wanted};
///
/// let wanted: Wanted = "tip:rms".parse()?;
/// assert_eq!((wanted.name.as_str(), wanted.measure), ("tip", Measure::Rms));
/// let size: Wanted = "x[3]".parse()?;
/// assert_eq!(size.measure, Measure::PeakToPeak);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Wanted {
    /// The name of the signal.
    pub name: String,
    /// What is asked of it.
    pub measure: Measure,
}

impl FromStr for Wanted {
    type Err = RequestError;

    fn from_str(text: &str) -> Result<Self, RequestError> {
        let (name, measure) = text.split_once(':').unwrap_or((text, "p2p"));
        Ok(Self {
            name: name.to_owned(),
            measure: measure.parse()?,
        })
    }
}

impl fmt::Display for Wanted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.name, self.measure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        for text in [
            "tip:p2p",
            "tip:max",
            "tip:min",
            "x[3]:mean",
            "x:rms",
            "x:crest",
            "x:h1",
            "x:h12",
            "x:phase3",
            "mesh:impulse",
            "mesh:impacts",
            "mesh:piece2",
        ] {
            let wanted: Wanted = text.parse().expect(text);
            assert_eq!(wanted.to_string(), text);
        }
        for text in ["x:", "x:h0", "x:h01", "x:hh", "x:RMS", "x:h", "x:rms:max"] {
            assert!(text.parse::<Wanted>().is_err(), "{text}");
        }
    }
}
