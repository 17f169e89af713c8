//! What is written of an error.

use std::fmt;

use super::Error;
use crate::numeric::decimal::Decimal;

impl Error {
    /// What is written of names, options and ranges.
    fn of_requests(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownParameter { name, known } => {
                let known = match &known[..] {
                    [] => "none".to_owned(),
                    known => known.join(", "),
                };
                write!(f, "there is no parameter {name}; there are {known}")
            }
            Self::Option { name, value, must } => {
                write!(f, "{name} = {}: {must}", Decimal::plain(*value))
            }
            Self::Missing { name: "omega" } => write!(
                f,
                "a parameter is varied at one excitation frequency, which is missing: give it, as in `omega(1.2)`"
            ),
            Self::Missing {
                name: name @ ("from" | "to"),
            } => write!(
                f,
                "the range is not complete: `{name}(...)` has not been called"
            ),
            Self::Missing { name } => write!(f, "`{name}` has not been given"),
            Self::Varied { name, must } => write!(f, "what is varied is {name}: it {must}"),
            Self::EmptyRange { value } => {
                write!(
                    f,
                    "the range is empty: from and to are both {}",
                    Decimal::plain(*value)
                )
            }
            _ => Ok(()),
        }
    }

    /// What is written of systems, and of the balances they ask for.
    fn of_systems(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Samples {
                samples,
                least,
                harmonics,
            } => write!(
                f,
                "{samples} samples are too few for {harmonics} harmonics: take {least} or more"
            ),
            Self::Unknowns { unknowns, most } => write!(
                f,
                "{unknowns} unknowns are too many, at most {most}: take fewer harmonics or a shorter period"
            ),
            Self::Levels { law, levels } => {
                write!(
                    f,
                    "the levels of law {law} are not in increasing order: {levels:?}"
                )
            }
            Self::Harmonics { harmonics, highest } => write!(
                f,
                "the declaration has harmonic {highest} of the orbit, and the balance only {harmonics}: take more harmonics"
            ),
            Self::NoCoordinates => write!(f, "the system has no coordinates"),
            Self::SingularMass { determinant } => {
                write!(
                    f,
                    "the mass matrix is singular: its determinant is {determinant:e}"
                )
            }
            Self::NegativeMass { coordinate, mass } => write!(
                f,
                "the mass of {coordinate} is {mass:e}, and a mass is positive: change the parameters, or the signs of the equation"
            ),
            Self::IndefiniteMass { eigenvalue } => write!(
                f,
                "the mass matrix is symmetric and has the eigenvalue {eigenvalue:e}: kinetic energy is positive"
            ),
            _ => Ok(()),
        }
    }

    /// What is written of flows and states.
    fn of_motions(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::State { entries, expected } => write!(
                f,
                "the state has {entries} entries instead of {expected}: all positions, then all velocities"
            ),
            Self::Values { values, expected } => {
                write!(f, "{values} values were given for {expected} parameters")
            }
            Self::CarriedAway {
                value,
                load,
                direction,
            } => write!(
                f,
                "no periodic orbit at {}: the mean load along {direction} is {load:.6e}, and nothing holds the system there, so that it is carried away",
                Decimal::plain(*value)
            ),
            Self::Free { direction } => write!(
                f,
                "nothing holds the system along {direction}, so that its orbits may be anywhere along it, and shooting finds none: `FrequencyResponse` does"
            ),
            Self::NotAffine => write!(
                f,
                "the motion has no closed form: a force is not affine on one of its pieces, or a stiffness or a direction varies in time"
            ),
            _ => Ok(()),
        }
    }

    /// What is written of backbones and of what begins at bifurcations.
    fn of_bifurcations(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NeverAtRest { position } => {
                write!(
                    f,
                    "the motion from rest at {position} does not come to rest again"
                )
            }
            Self::NotFree { apart } => write!(
                f,
                "the motion misses its beginning by {apart:.1e} of its size after a period: set damping and excitation to zero"
            ),
            Self::NoLoad => write!(
                f,
                "no load with the frequency of the excitation acts on the first coordinate: it has no phase resonance"
            ),
            Self::NoResonance {
                value,
                between: [low, high],
            } => write!(
                f,
                "no orbit in phase resonance found at {} between the excitation frequencies {} and {}",
                Decimal::plain(*value),
                Decimal::plain(*low),
                Decimal::plain(*high)
            ),
            Self::Search { value, reason } => {
                write!(
                    f,
                    "attractors at {} could not be looked for: {reason}",
                    Decimal::plain(*value)
                )
            }
            Self::NoBranch { kind, value } => {
                write!(
                    f,
                    "no further branch was found at the {kind} at {}",
                    Decimal::rounded(*value, 9)
                )
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter { name, value, range } => {
                write!(
                    f,
                    "parameter {name} = {} is outside its range {range}",
                    Decimal::plain(*value)
                )
            }
            Self::UnknownParameter { .. }
            | Self::Option { .. }
            | Self::Missing { .. }
            | Self::Varied { .. }
            | Self::EmptyRange { .. } => self.of_requests(f),
            Self::Samples { .. }
            | Self::Unknowns { .. }
            | Self::Levels { .. }
            | Self::Harmonics { .. }
            | Self::NoCoordinates
            | Self::SingularMass { .. }
            | Self::NegativeMass { .. }
            | Self::IndefiniteMass { .. } => self.of_systems(f),
            Self::Lost { value, from, to } => {
                write!(
                    f,
                    "the orbit at {}, between those at {} and {}, could not be computed",
                    Decimal::plain(*value),
                    Decimal::plain(*from),
                    Decimal::plain(*to)
                )
            }
            Self::NoStart { value, reason } => {
                write!(
                    f,
                    "no periodic orbit found at {}: {reason}",
                    Decimal::plain(*value)
                )
            }
            Self::State { .. }
            | Self::Values { .. }
            | Self::CarriedAway { .. }
            | Self::Free { .. }
            | Self::NotAffine => self.of_motions(f),
            Self::Beyond { value, fold } => write!(
                f,
                "no periodic orbit at {} near the given one: its branch turns back at {}, {:.1e} away",
                Decimal::plain(*value),
                Decimal::rounded(*fold, 12),
                (value - fold).abs()
            ),
            Self::Motion { value, reason } => {
                write!(
                    f,
                    "no periodic orbit found at {}: {reason}",
                    Decimal::plain(*value)
                )
            }
            Self::SearchLimit {
                value,
                evaluations,
                multiplications,
                reason,
            } => write!(
                f,
                "no periodic orbit found at {} in {evaluations} evaluations of the balance, which took the {:.0e} multiplications that a search is allowed; the last attempt: {reason}",
                Decimal::plain(*value),
                *multiplications as f64
            ),
            Self::NoSuchPeriod {
                period,
                value,
                attempts,
            } => write!(
                f,
                "no orbit of period {period} found at {}: {attempts}; start where there is one, and follow it from there",
                Decimal::plain(*value)
            ),
            Self::NeverAtRest { .. }
            | Self::NotFree { .. }
            | Self::NoLoad
            | Self::NoResonance { .. }
            | Self::Search { .. }
            | Self::NoBranch { .. } => self.of_bifurcations(f),
            Self::File { path, kind } => write!(f, "cannot write {}: {kind}", path.display()),
            Self::Flow(error) => error.fmt(f),
            Self::Log(error) => error.fmt(f),
            Self::Structure(error) => error.fmt(f),
            #[cfg(feature = "text")]
            Self::Declaration(error) => error.fmt(f),
        }
    }
}
