//! A law at work in a structure, and where.

use std::sync::Arc;

use super::Value;
use crate::law::Law;

/// How a direction turns with time: by a fraction of the frequency of the excitation, from an angle on.
///
/// ```
/// use hertzian::structure::Turn;
///
/// // The third of eight balls of a bearing whose cage turns two fifths as fast as the shaft.
/// let ball = Turn::by(2, 5).from(2.0 * std::f64::consts::TAU / 8.0);
/// assert_eq!(ball.fraction(), [2, 5]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    numerator: u32,
    denominator: u32,
    angle: f64,
}

impl Turn {
    /// By `numerator/denominator` of the frequency of the excitation.
    pub const fn by(numerator: u32, denominator: u32) -> Self {
        Self {
            numerator,
            denominator,
            angle: 0.0,
        }
    }

    /// From this angle on, in radians.
    #[must_use]
    pub const fn from(mut self, angle: f64) -> Self {
        self.angle = angle;
        self
    }

    /// Numerator and denominator, as they were given.
    pub const fn fraction(self) -> [u32; 2] {
        [self.numerator, self.denominator]
    }

    /// The angle at time zero, in radians.
    pub const fn angle(self) -> f64 {
        self.angle
    }

    /// The denominator in lowest terms; one where it does not turn.
    pub(super) fn lowest(self) -> u32 {
        self.denominator / common(self.numerator, self.denominator).max(1)
    }
}

/// The greatest common divisor (Euclid).
pub(super) fn common(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { common(b, a % b) }
}

/// A law at work in a structure.
///
/// The gap is `direction . q - offset`, and the force acts along the same direction unless another is given. A direction may turn with time.
#[derive(Debug)]
pub struct Contact {
    pub(super) law: Arc<dyn Law>,
    pub(super) arguments: Vec<Value>,
    pub(super) gap: Vec<f64>,
    pub(super) force: Option<Vec<f64>>,
    pub(super) turning: Option<(Vec<f64>, Turn)>,
    pub(super) offset: Value,
    pub(super) unit: String,
}

impl Contact {
    /// A contact that follows a law.
    pub fn new(law: impl Law + 'static) -> Self {
        Self::of(Arc::new(law))
    }

    /// A contact that follows a law which others may share.
    pub fn of(law: Arc<dyn Law>) -> Self {
        Self {
            law,
            arguments: Vec::new(),
            gap: Vec::new(),
            force: None,
            turning: None,
            offset: 0.0.into(),
            unit: String::new(),
        }
    }

    hertzian_contract::setters! { self:
        /// The arguments of the law, in its order. Where the law declares a range of one, the structure checks it.
        arguments(arguments: impl IntoIterator<Item = impl Into<Value>>) {
            self.arguments = arguments.into_iter().map(Into::into).collect();
        }

        /// The direction of gap and force, one entry per coordinate.
        direction(direction: impl Into<Vec<f64>>) { self.gap = direction.into() }

        /// A direction of the force that differs from that of the gap.
        force_direction(direction: impl Into<Vec<f64>>) { self.force = Some(direction.into()) }

        /// The direction of gap and force turns from that of [`direction`](Self::direction) towards this one: it is
        /// `cos(angle) direction + sin(angle) across`, with the angle that a [`Turn`] has. No other direction of the force can be given then.
        ///
        /// ```
        /// use hertzian::FrequencyResponse;
        /// use hertzian::structure::{Contact, DMatrix, Structure, Turn};
        ///
        /// hertzian::law! {
        ///     Ball(gap) { gap > 0 => gap^1.5, else => 0 }
        /// }
        ///
        /// // A shaft on eight balls that pass under its load.
        /// let (one, none) = (DMatrix::identity(2, 2), DMatrix::zeros(2, 2));
        /// let mut shaft = Structure::of(&one, &(0.05 * &one), &none).constant(0, 1.0);
        /// for ball in 0..8 {
        ///     let turn = Turn::by(2, 5).from(std::f64::consts::TAU / 8.0 * f64::from(ball));
        ///     let ball = Contact::new(Ball).direction([1.0, 0.0]).turning([0.0, 1.0], turn);
        ///     shaft = shaft.contact(ball.offset(0.1));
        /// }
        /// let orbit = FrequencyResponse::of(&shaft.build()?).orbit(1.0)?;
        /// // It hardly moves: another ball is under the load soon.
        /// assert!((orbit.peak_to_peak() - 0.002384).abs() < 1e-6);
        /// # Ok::<(), Box<dyn std::error::Error>>(())
        /// ```
        turning(across: impl Into<Vec<f64>>, turn: Turn) { self.turning = Some((across.into(), turn)) }

        /// What is subtracted from `direction . q`.
        offset(offset: impl Into<Value>) { self.offset = offset.into() }

        /// The unit of its force, for reports and pictures.
        unit(unit: impl Into<String>) { self.unit = unit.into() }
    }
}
