//! How numbers stand in files, with feature `serde`, so that they read back to the same bits. Files of branches are written in `report/export`.
//!
//! JSON has no infinity and no NaN: they are the texts `"inf"`, `"-inf"` and `"NaN"`, and `null` is a number that is not known. Complex
//! numbers are pairs of real and imaginary part, times are seconds.

use std::time::Duration;

use nalgebra::Complex;
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::system::Variable;

/// For `serde(with = "...")`.
pub(crate) fn serialize<N: Numbers, S: Serializer>(numbers: &N, to: S) -> Result<S::Ok, S::Error> {
    numbers.written().serialize(to)
}

/// For `serde(with = "...")`.
pub(crate) fn deserialize<'de, N: Numbers, D: Deserializer<'de>>(from: D) -> Result<N, D::Error> {
    let written = N::Written::deserialize(from)?;
    N::read(written).ok_or_else(|| D::Error::custom("a number out of its range"))
}

/// What is written in another form than that of serde.
pub(crate) trait Numbers: Sized {
    type Written: Serialize + DeserializeOwned;

    fn written(&self) -> Self::Written;

    fn read(written: Self::Written) -> Option<Self>;
}

/// A number, or the name of one that is not finite.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
pub(crate) enum Number {
    Finite(f64),
    Other(Name),
}

#[derive(Serialize, Deserialize)]
pub(crate) enum Name {
    #[serde(rename = "inf")]
    Infinity,
    #[serde(rename = "-inf")]
    MinusInfinity,
    #[serde(rename = "NaN")]
    Nan,
}

impl Numbers for f64 {
    type Written = Number;

    fn written(&self) -> Number {
        Number::Other(match *self {
            number if number.is_finite() => return Number::Finite(number),
            Self::INFINITY => Name::Infinity,
            Self::NEG_INFINITY => Name::MinusInfinity,
            _ => Name::Nan,
        })
    }

    fn read(written: Number) -> Option<Self> {
        Some(match written {
            Number::Finite(number) => number,
            Number::Other(Name::Infinity) => Self::INFINITY,
            Number::Other(Name::MinusInfinity) => Self::NEG_INFINITY,
            Number::Other(Name::Nan) => Self::NAN,
        })
    }
}

impl Numbers for Complex<f64> {
    type Written = (Number, Number);

    fn written(&self) -> Self::Written {
        (self.re.written(), self.im.written())
    }

    fn read(written: Self::Written) -> Option<Self> {
        let (re, im) = written;
        Some(Self::new(f64::read(re)?, f64::read(im)?))
    }
}

impl Numbers for Duration {
    type Written = f64;

    fn written(&self) -> f64 {
        self.as_secs_f64()
    }

    fn read(written: f64) -> Option<Self> {
        Self::try_from_secs_f64(written).ok()
    }
}

impl<N: Numbers> Numbers for Option<N> {
    type Written = Option<N::Written>;

    fn written(&self) -> Self::Written {
        self.as_ref().map(N::written)
    }

    fn read(written: Self::Written) -> Option<Self> {
        written.map_or(Some(None), |written| N::read(written).map(Some))
    }
}

impl<N: Numbers> Numbers for Vec<N> {
    type Written = Vec<N::Written>;

    fn written(&self) -> Self::Written {
        self.iter().map(N::written).collect()
    }

    fn read(written: Self::Written) -> Option<Self> {
        written.into_iter().map(N::read).collect()
    }
}

impl<N: Numbers> Numbers for [N; 2] {
    type Written = (N::Written, N::Written);

    fn written(&self) -> Self::Written {
        (self[0].written(), self[1].written())
    }

    fn read(written: Self::Written) -> Option<Self> {
        let (first, second) = written;
        Some([N::read(first)?, N::read(second)?])
    }
}

/// A number beside what has none.
impl<N: Numbers, T: Clone + Serialize + DeserializeOwned> Numbers for (N, T) {
    type Written = (N::Written, T);

    fn written(&self) -> Self::Written {
        (self.0.written(), self.1.clone())
    }

    fn read(written: Self::Written) -> Option<Self> {
        let (number, beside) = written;
        Some((N::read(number)?, beside))
    }
}

/// What varies: `null` is the frequency, a number the position of a parameter.
impl Numbers for Variable {
    type Written = Option<usize>;

    fn written(&self) -> Self::Written {
        match *self {
            Self::Omega => None,
            Self::Parameter(index) => Some(index),
        }
    }

    fn read(written: Self::Written) -> Option<Self> {
        Some(written.map_or(Self::Omega, Self::Parameter))
    }
}
