//! What the accuracy that is asked for, and the error that is stated, are of.

use crate::branches::branch::{Model, Source};
use crate::branches::observed::{Motion, Observed};
use crate::error::Error;
use crate::model::request::RequestError;

/// The signal whose peak-to-peak has the tolerance and the stated error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Accuracy {
    /// All coordinates.
    #[default]
    Coordinates,
    /// One of them.
    Coordinate(usize),
    /// An output.
    Output(usize),
}

impl Accuracy {
    /// Of the signal with a name.
    ///
    /// # Errors
    /// If neither an output nor a coordinate has that name.
    pub(crate) fn of(model: &Model, name: &str) -> Result<Self, Error> {
        match model.source(name) {
            Ok(Source::Output(index)) => Ok(Self::Output(index)),
            Ok(Source::Coordinate(index)) => Ok(Self::Coordinate(index)),
            // The force of a contact is an output where it is declared as one.
            Ok(Source::Contact(_)) | Err(_) => Err(RequestError::NoAccuracy {
                name: name.to_owned(),
                known: (model.outputs.iter().map(|output| output.name.clone()))
                    .chain(model.coordinates.iter().cloned())
                    .collect(),
            }
            .into()),
        }
    }

    /// The name of the signal, if it is one of the model; it may have been read from a file.
    pub(crate) fn name(self, model: &Model) -> Option<&str> {
        match self {
            Self::Coordinates => None,
            Self::Coordinate(index) => model.coordinates.get(index).map(String::as_str),
            Self::Output(index) => model.outputs.get(index).map(|output| output.name.as_str()),
        }
    }

    /// Whether a model has it.
    #[cfg(feature = "serde")]
    pub(crate) fn is_of(self, model: &Model) -> bool {
        self == Self::Coordinates || self.name(model).is_some()
    }

    /// Peak-to-peak of the signal; of all coordinates the largest.
    pub(crate) fn peak_to_peak(self, observed: &Observed) -> f64 {
        let one = |motions: &[Motion], index: usize| {
            let motion = motions.get(index);
            motion.map_or(f64::NAN, Motion::peak_to_peak)
        };
        match self {
            Self::Coordinates => {
                let sizes = observed.motions.iter().map(Motion::peak_to_peak);
                sizes.fold(0.0, f64::max)
            }
            Self::Coordinate(index) => one(&observed.motions, index),
            Self::Output(index) => one(&observed.outputs, index),
        }
    }
}
