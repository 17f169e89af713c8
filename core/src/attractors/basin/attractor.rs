//! What motions settle to.

use nalgebra::Complex;

use super::ball::Ball;
use crate::attractors::log::{Reader, Writer};

/// A stable periodic orbit.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Attractor {
    /// Its shortest period, in periods of the declaration.
    pub period: usize,
    /// Its states at the phase of the basin, in the order in which it visits them, from the one with the smallest first entry.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub points: Vec<Vec<f64>>,
    /// Floquet multipliers over its period, largest modulus first.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub multipliers: Vec<Complex<f64>>,
    /// Where motions are known to end on it.
    pub(super) balls: Vec<Ball>,
}

/// What becomes of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Fate {
    /// It settles to a periodic orbit, by its number.
    Periodic(usize),
    /// No period was found, and neighbouring motions part: the largest Lyapunov exponent is positive, beyond three standard
    /// errors.
    Chaotic,
    /// No period was found, and it is not chaotic: a period that is longer than those looked for, several frequencies, or a
    /// transient longer than the patience.
    Long,
    /// It grew beyond the bound.
    Escaped,
    /// It could not be computed.
    Failed,
    /// Not looked at.
    Unknown,
}

impl Fate {
    /// A number for files: that of the orbit, or a negative one.
    pub fn label(self) -> i16 {
        match self {
            Self::Periodic(index) => i16::try_from(index).unwrap_or(i16::MAX),
            Self::Chaotic => -1,
            Self::Long => -2,
            Self::Escaped => -3,
            Self::Failed => -4,
            Self::Unknown => -5,
        }
    }

    pub(super) fn written(self, writer: &mut Writer) {
        let (kind, index) = match self {
            Self::Periodic(index) => (0, index),
            other => (other.label().unsigned_abs() as usize, 0),
        };
        writer.whole(kind);
        writer.whole(index);
    }

    pub(super) fn read(reader: &mut Reader<'_>) -> Option<Self> {
        let (kind, index) = (reader.whole()?, reader.whole()?);
        Some(match kind {
            0 => Self::Periodic(index),
            1 => Self::Chaotic,
            2 => Self::Long,
            3 => Self::Escaped,
            4 => Self::Failed,
            5 => Self::Unknown,
            _ => return None,
        })
    }
}

impl Attractor {
    /// Whether motions from a state are known to end on it.
    pub(super) fn holds(&self, state: &[f64]) -> bool {
        self.balls.iter().any(|ball| ball.contains(state))
    }

    /// The order in which attractors are numbered: by period, then by the first point.
    pub(super) fn before(&self, other: &Self) -> std::cmp::Ordering {
        let points = self.points[0].iter().zip(&other.points[0]);
        let by_point = points
            .map(|(a, b)| a.total_cmp(b))
            .find(|order| order.is_ne());
        self.period
            .cmp(&other.period)
            .then(by_point.unwrap_or(std::cmp::Ordering::Equal))
    }

    pub(super) fn written(&self, writer: &mut Writer) {
        writer.whole(self.period);
        for point in &self.points {
            writer.numbers(point);
        }
        let parts = self.multipliers.iter().flat_map(|m| [m.re, m.im]);
        writer.numbers(&parts.collect::<Vec<_>>());
        writer.whole(self.balls.len());
        for ball in &self.balls {
            ball.written(writer);
        }
    }

    pub(super) fn read(reader: &mut Reader<'_>) -> Option<Self> {
        let period = reader.whole()?;
        let points = (0..period)
            .map(|_| reader.numbers())
            .collect::<Option<_>>()?;
        let parts = reader.numbers()?;
        let pairs = parts.chunks_exact(2);
        let multipliers = pairs.map(|part| Complex::new(part[0], part[1])).collect();
        let count = reader.whole()?;
        Some(Self {
            period,
            points,
            multipliers,
            balls: (0..count)
                .map(|_| Ball::read(reader))
                .collect::<Option<_>>()?,
        })
    }
}
