//! What a system says that it is read by: outputs with names and units.

use std::borrow::Cow;

/// What is known of an output. Its coefficients are those at [`Place::Output`](crate::system::Place::Output).
///
/// ```text
/// y = sum_k c_k w_k(tau) s_k                                                                                  (4)
/// ```
///
/// with coefficients `c_k`, waves `w_k` and [signals](Signal) `s_k` of the motion.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct OutputFacts {
    /// Its name.
    pub name: Cow<'static, str>,
    /// Its documentation.
    pub documentation: Cow<'static, str>,
    /// The unit of its values; empty where the system has none, and of plain numbers.
    pub unit: Cow<'static, str>,
}

impl OutputFacts {
    /// An output of this name, without a unit.
    pub fn new(name: impl Into<Cow<'static, str>>) -> Self {
        Self {
            name: name.into(),
            documentation: Cow::Borrowed(""),
            unit: Cow::Borrowed(""),
        }
    }

    crate::setters! { self:
        /// What it is; the first line is what charts say of it.
        documentation(documentation: impl Into<Cow<'static, str>>) {
            self.documentation = documentation.into();
        }

        /// The unit of its values.
        unit(unit: impl Into<Cow<'static, str>>) { self.unit = unit.into() }
    }
}

/// What a term of an output is a multiple of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Signal {
    /// One.
    Constant,
    /// A coordinate.
    Coordinate(usize),
    /// Its derivative by time.
    Rate(usize),
    /// Its second derivative by time, as the equations of motion give it.
    Acceleration(usize),
    /// The law of a contact.
    Force(usize),
}
