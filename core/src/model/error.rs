//! What can be wrong with a system at values of its parameters.

use crate::error::ErrorKind;
use crate::numeric::decimal::Decimal;

/// What is wrong with a system at values of its parameters.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// The system has no coordinates.
    #[error("the system has no coordinates")]
    NoCoordinates,
    /// The levels of a law are not in increasing order for these parameters.
    #[error("the levels of law {law} are not in increasing order: {levels:?}")]
    Levels {
        /// Name of the law.
        law: String,
        /// The levels.
        levels: Vec<f64>,
    },
    /// The mass matrix is singular.
    #[error("the mass matrix is singular: its determinant is {determinant:e}")]
    SingularMass {
        /// Its determinant.
        determinant: f64,
    },
    /// An equation holds one second derivative alone, and its mass is negative.
    #[error(
        "the mass of {coordinate} is {mass:e}, and a mass is positive: change the parameters, or the signs of the equation"
    )]
    NegativeMass {
        /// The coordinate.
        coordinate: String,
        /// Its mass.
        mass: f64,
    },
    /// The mass matrix is symmetric and not positive definite: there are motions of negative kinetic energy.
    #[error(
        "the mass matrix is symmetric and has the eigenvalue {eigenvalue:e}: kinetic energy is positive"
    )]
    IndefiniteMass {
        /// Its smallest eigenvalue.
        eigenvalue: f64,
    },
    /// Nothing holds the system along a direction, and its mean load is not zero along it: no motion is periodic.
    #[error(
        "no periodic orbit at {}: the mean load along {direction} is {load:.6e}, and nothing holds the system there, so that it is carried away",
        Decimal::plain(*.value)
    )]
    CarriedAway {
        /// Value of what is varied.
        value: f64,
        /// The mean load along the direction.
        load: f64,
        /// The direction, as a sum of coordinates.
        direction: String,
    },
    /// Nothing holds the system along a direction, and its motion there is not known beforehand, since something damps it, or since the method
    /// has no equation for it: the contact equation never has.
    #[error(
        "nothing holds the system along {direction}, so that its orbits may be anywhere along it: the harmonic balance finds them, and shooting does where nothing damps that motion"
    )]
    Free {
        /// The direction, as a sum of coordinates.
        direction: String,
    },
    /// A force is not affine on one of its pieces, or a stiffness or a direction varies in time: there is no closed form.
    #[error(
        "the motion has no closed form: a force is not affine on one of its pieces, or a stiffness or a direction varies in time"
    )]
    NotAffine,
}

crate::error::room_error! {
    ModelError, ModelError::kind;
    NoCoordinates {}
    Levels { law, levels }
    SingularMass { determinant }
    NegativeMass { coordinate, mass }
    IndefiniteMass { eigenvalue }
    CarriedAway { value, load, direction }
    Free { direction }
    NotAffine {}
    ;
}

impl ModelError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::CarriedAway { .. } => ErrorKind::NoOrbit,
            _ => ErrorKind::Model,
        }
    }
}
