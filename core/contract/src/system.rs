//! The contract of a system: its equations of motion.
//!
//! For coordinates `q`, the phase `tau = omega t / divisor` and parameters `p`:
//!
//! ```text
//! M q'' + C q' + K(tau) q + sum_c e_c(tau) phi_c(g_c, g_c'; a_c) = sum_h ( a_h cos h tau + b_h sin h tau )      (1)
//! g_c  = d_c(tau) . q - delta_c(tau)                                                                          (2)
//! g_c' = the total derivative of g_c with respect to time                                                      (3)
//! ```
//!
//! A prime is a derivative with respect to *time*, not phase. Everything but the laws is a list of scalar
//! *coefficients*: functions of the parameters and of `omega`, each with a [`Place`] in the equations. Two methods
//! evaluate the whole list and its derivative; nothing else of a system needs code.

use std::borrow::Cow;
use std::sync::Arc;

pub use crate::law::Bound;
use crate::law::{Law, is_within};
pub use crate::output::{OutputFacts, Signal};

/// A system of oscillators as the runtime sees it; object safe, so that the engine is compiled once.
///
/// Slices have the lengths that [`SystemFacts`] says; implementations may panic otherwise (the runtime upholds it).
pub trait System: Send + Sync {
    /// What is known of the system without evaluating it.
    fn facts(&self) -> &SystemFacts;

    /// Writes the present value of every parameter.
    fn values(&self, values: &mut [f64]);

    /// Writes every coefficient of [`SystemFacts::places`].
    fn coefficients(&self, parameters: &[f64], omega: f64, coefficients: &mut [f64]);

    /// Writes the derivative of every coefficient with respect to one variable.
    fn coefficients_by(
        &self,
        variable: Variable,
        parameters: &[f64],
        omega: f64,
        derivatives: &mut [f64],
    );

    /// The law of the contacts whose [`ContactFacts::law`] is `index`.
    fn law(&self, index: usize) -> &dyn Law;

    /// A copy with the present values, for whoever keeps the system: requests and results own one, so that they can be returned and
    /// sent to other threads. Of a type that is `Clone` it is `Arc::new(self.clone())`.
    fn shared(&self) -> Arc<dyn System>;
}

impl std::fmt::Debug for dyn System + '_ {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "System({})", self.facts().name)
    }
}

/// What is shared already is not copied again.
impl System for Arc<dyn System> {
    #[inline]
    fn facts(&self) -> &SystemFacts {
        self.as_ref().facts()
    }

    #[inline]
    fn values(&self, values: &mut [f64]) {
        self.as_ref().values(values);
    }

    #[inline]
    fn coefficients(&self, parameters: &[f64], omega: f64, coefficients: &mut [f64]) {
        self.as_ref().coefficients(parameters, omega, coefficients);
    }

    #[inline]
    fn coefficients_by(
        &self,
        variable: Variable,
        parameters: &[f64],
        omega: f64,
        derivatives: &mut [f64],
    ) {
        self.as_ref()
            .coefficients_by(variable, parameters, omega, derivatives);
    }

    #[inline]
    fn law(&self, index: usize) -> &dyn Law {
        self.as_ref().law(index)
    }

    #[inline]
    fn shared(&self) -> Self {
        Self::clone(self)
    }
}

/// What a derivative is taken by, and what a continuation varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Variable {
    /// The excitation frequency `omega`, in radians per unit of time.
    Omega,
    /// A parameter, by position in [`SystemFacts::parameters`].
    Parameter(usize),
}

/// What is known of a system without evaluating it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SystemFacts {
    /// Name of the declared type.
    pub name: Cow<'static, str>,
    /// The equations of motion, as written, and the constants and laws that are in them; one in each line.
    pub equation: Cow<'static, str>,
    /// Names of the coordinates.
    pub coordinates: Cow<'static, [Cow<'static, str>]>,
    /// Units of the coordinates, empty for plain numbers; none at all where the system has no units. Time is in seconds where it has.
    pub units: Cow<'static, [Cow<'static, str>]>,
    /// Parameters, in the order of the value slice.
    pub parameters: Cow<'static, [ParameterFacts]>,
    /// The base frequency is `omega / divisor`, so that every harmonic in the declaration is a whole one.
    pub divisor: u32,
    /// Number of laws.
    pub laws: usize,
    /// The contacts: the terms `e_c phi_c` of (1).
    pub contacts: Cow<'static, [ContactFacts]>,
    /// Where each coefficient stands. Several coefficients at one place add up.
    pub places: Cow<'static, [Place]>,
    /// What the system is read by.
    pub outputs: Cow<'static, [OutputFacts]>,
}

impl SystemFacts {
    /// A system of this name without coordinates, with a divisor of one.
    pub fn new(name: impl Into<Cow<'static, str>>) -> Self {
        Self {
            name: name.into(),
            equation: Cow::Borrowed(""),
            coordinates: Cow::Borrowed(&[]),
            units: Cow::Borrowed(&[]),
            parameters: Cow::Borrowed(&[]),
            divisor: 1,
            laws: 0,
            contacts: Cow::Borrowed(&[]),
            places: Cow::Borrowed(&[]),
            outputs: Cow::Borrowed(&[]),
        }
    }

    /// The equations of motion, for whoever reads them.
    #[must_use]
    pub fn equation(mut self, equation: impl Into<Cow<'static, str>>) -> Self {
        self.equation = equation.into();
        self
    }

    /// Names of the coordinates.
    #[must_use]
    pub fn coordinates<N: Into<Cow<'static, str>>>(
        mut self,
        names: impl IntoIterator<Item = N>,
    ) -> Self {
        self.coordinates = names.into_iter().map(Into::into).collect();
        self
    }

    /// Units of the coordinates, empty for plain numbers.
    #[must_use]
    pub fn units<N: Into<Cow<'static, str>>>(mut self, units: impl IntoIterator<Item = N>) -> Self {
        self.units = units.into_iter().map(Into::into).collect();
        self
    }

    crate::setters! { self:
        /// The parameters, in the order of the value slice.
        parameters(parameters: impl IntoIterator<Item = ParameterFacts>) {
            self.parameters = parameters.into_iter().collect();
        }

        /// By what `omega` is divided in the base frequency.
        divisor(divisor: u32) { self.divisor = divisor }

        /// The number of laws, and the contacts that they act in.
        contacts(laws: usize, contacts: impl IntoIterator<Item = ContactFacts>) {
            self.laws = laws;
            self.contacts = contacts.into_iter().collect();
        }

        /// Where each coefficient stands.
        places(places: impl IntoIterator<Item = Place>) { self.places = places.into_iter().collect() }

        /// What the system is read by.
        outputs(outputs: impl IntoIterator<Item = OutputFacts>) {
            self.outputs = outputs.into_iter().collect();
        }
    }
}

/// What is known of a parameter.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ParameterFacts {
    /// Name of the field.
    pub name: Cow<'static, str>,
    /// Its documentation.
    pub documentation: Cow<'static, str>,
    /// The unit of its values; empty where the system has none, and for plain numbers.
    pub unit: Cow<'static, str>,
    /// Lower end of the range.
    pub minimum: Bound,
    /// Upper end of the range.
    pub maximum: Bound,
}

impl ParameterFacts {
    /// A parameter that may have any value.
    pub fn new(name: impl Into<Cow<'static, str>>) -> Self {
        Self {
            name: name.into(),
            documentation: Cow::Borrowed(""),
            unit: Cow::Borrowed(""),
            minimum: Bound::Unbounded,
            maximum: Bound::Unbounded,
        }
    }

    crate::setters! { self:
        /// What it is; the first line is what charts say of it.
        documentation(documentation: impl Into<Cow<'static, str>>) {
            self.documentation = documentation.into();
        }

        /// The unit of its values.
        unit(unit: impl Into<Cow<'static, str>>) { self.unit = unit.into() }

        /// The range that its values must be in.
        range(minimum: Bound, maximum: Bound) {
            self.minimum = minimum;
            self.maximum = maximum;
        }
    }

    /// Whether a value is finite and within the range.
    #[inline]
    pub fn admits(&self, value: f64) -> bool {
        is_within(self.minimum, self.maximum, value)
    }
}

/// A term `e_c phi_c(g_c, g_c')` of (1).
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ContactFacts {
    /// Index of its law.
    pub law: usize,
    /// The unit of what its law gives, without factors outside of it; empty where it is not known, and for plain numbers.
    pub unit: Cow<'static, str>,
}

impl ContactFacts {
    /// A contact with the law of this index.
    #[inline]
    pub const fn new(law: usize) -> Self {
        Self {
            law,
            unit: Cow::Borrowed(""),
        }
    }

    /// The same with the unit of what its law gives.
    #[must_use]
    pub fn unit(mut self, unit: impl Into<Cow<'static, str>>) -> Self {
        self.unit = unit.into();
        self
    }
}

/// A function of the phase: one of `1`, `cos h tau`, `sin h tau`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Wave {
    /// `h`; zero for the constant.
    pub harmonic: u32,
    /// Cosine or sine. A harmonic of zero is a cosine.
    pub part: Part,
}

impl Wave {
    /// The constant function.
    pub const CONSTANT: Self = Self::cosine(0);

    /// `cos h tau`
    #[inline]
    pub const fn cosine(harmonic: u32) -> Self {
        Self {
            harmonic,
            part: Part::Cosine,
        }
    }

    /// `sin h tau`
    #[inline]
    pub const fn sine(harmonic: u32) -> Self {
        Self {
            harmonic,
            part: Part::Sine,
        }
    }

    /// The wave that the phase derivative is `harmonic` times, and its sign: `-sin` for a cosine, `cos` for a sine.
    #[inline]
    pub const fn derivative(self) -> (Self, f64) {
        match self.part {
            Part::Cosine => (Self::sine(self.harmonic), -1.0),
            Part::Sine => (Self::cosine(self.harmonic), 1.0),
        }
    }
}

/// Cosine or sine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Part {
    /// `cos h tau`
    Cosine,
    /// `sin h tau`
    Sine,
}

/// Where a coefficient stands in equations (1) and (2), and in outputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Place {
    /// An entry of `M`.
    Mass {
        /// Equation.
        row: usize,
        /// Coordinate.
        column: usize,
    },
    /// An entry of `C`.
    Damping {
        /// Equation.
        row: usize,
        /// Coordinate.
        column: usize,
    },
    /// An entry of `K`, times a wave.
    Stiffness {
        /// Equation.
        row: usize,
        /// Coordinate.
        column: usize,
        /// Its dependence on the phase.
        wave: Wave,
    },
    /// A term of the right-hand side of (1).
    Load {
        /// Equation.
        row: usize,
        /// Its dependence on the phase.
        wave: Wave,
    },
    /// An entry of the force direction `e_c`.
    ForceDirection {
        /// Contact.
        contact: usize,
        /// Equation.
        row: usize,
        /// Its dependence on the phase.
        wave: Wave,
    },
    /// An entry of the gap direction `d_c`.
    GapDirection {
        /// Contact.
        contact: usize,
        /// Coordinate.
        column: usize,
        /// Its dependence on the phase.
        wave: Wave,
    },
    /// A term of the offset `delta_c`, subtracted in (2).
    Offset {
        /// Contact.
        contact: usize,
        /// Its dependence on the phase.
        wave: Wave,
    },
    /// An argument of the law of a contact.
    Argument {
        /// Contact.
        contact: usize,
        /// Position in [`LawFacts::arguments`](crate::law::LawFacts::arguments).
        index: usize,
    },
    /// A coefficient of an output (4).
    Output {
        /// Output, by position in [`SystemFacts::outputs`].
        output: usize,
        /// What it is a coefficient of.
        of: Signal,
        /// Its dependence on the phase.
        wave: Wave,
    },
}
