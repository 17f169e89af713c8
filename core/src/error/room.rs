//! What the enums of all rooms are alike in: `{:?}` of an error is its sentence with its sources, `{:#?}` its variant with everything that it
//! carries; a program reads the name of the variant and its numbers.
//!
//! A program whose `main` returns a `Result` shows `{:?}` of the error, and whoever runs it is to read the sentence.

use std::error::Error as StdError;
use std::io;
use std::path::PathBuf;

use crate::event::EventKind;
use crate::system::Variable;

/// The error of a room, as [`Error`](super::Error) holds it.
pub(crate) trait Room: StdError + Send + Sync + 'static {
    /// The name of its variant.
    fn variant(&self) -> &str;

    /// Appends the numbers that it carries, by the names of their fields, and behind them those of what it comes from.
    fn append_values<'s>(&'s self, values: &mut Vec<(&'s str, f64)>);
}

/// What a variant carries.
pub(crate) trait Field {
    /// Appends the numbers in it; a text has none.
    fn append_values<'s>(&'s self, name: &'static str, values: &mut Vec<(&'s str, f64)>);
}

macro_rules! numbers {
    ($($number:ty: $value:expr),*) => {
        $(impl Field for $number {
            fn append_values<'s>(&'s self, name: &'static str, values: &mut Vec<(&'s str, f64)>) {
                let value: fn($number) -> f64 = $value;
                values.push((name, value(*self)));
            }
        })*
    };
}

macro_rules! texts {
    ($($text:ty),*) => {
        $(impl Field for $text {
            fn append_values<'s>(&'s self, _: &'static str, _: &mut Vec<(&'s str, f64)>) {}
        })*
    };
}

numbers!(
    f64: |number| number,
    u32: f64::from,
    u64: |count| count as f64,
    usize: |count| count as f64
);
texts!(
    &'static str,
    String,
    Vec<String>,
    PathBuf,
    io::ErrorKind,
    EventKind,
    Variable
);

impl Field for Vec<f64> {
    fn append_values<'s>(&'s self, name: &'static str, values: &mut Vec<(&'s str, f64)>) {
        values.extend(self.iter().map(|value| (name, *value)));
    }
}

/// What it comes from.
impl<E: Room> Field for E {
    fn append_values<'s>(&'s self, _: &'static str, values: &mut Vec<(&'s str, f64)>) {
        Room::append_values(self, values);
    }
}

/// What an enum of errors is to users: [`From`] for [`Error`](super::Error), where a function says its kind,
/// [`Debug`](std::fmt::Debug) and [`Room`], from its variants with their fields and, after a semicolon, the variants that hold another error.
/// One that is missing, or a field of it, does not compile.
///
/// A variant must not show itself by `{:?}` alone: of `main() -> Result` that is all that a user reads.
macro_rules! room_error {
    (
        $error:ident $(, $kind:expr)?;
        $($(#[$on:meta])* $variant:ident { $($field:ident),* })*;
        $($(#[$condition:meta])* $other:ident)*
    ) => {
        $(impl From<$error> for crate::error::Error {
            fn from(error: $error) -> Self {
                let kind: fn(&$error) -> crate::error::ErrorKind = $kind;
                Self::new(kind(&error), error)
            }
        })?

        impl std::fmt::Debug for $error {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                if !f.alternate() {
                    return std::fmt::Display::fmt(&crate::error::chain(self), f);
                }
                match self {
                    $($(#[$on])* Self::$variant { $($field),* } => f
                        .debug_struct(stringify!($variant))
                        $(.field(stringify!($field), $field))*
                        .finish(),)*
                    $($(#[$condition])* Self::$other(error) => {
                        f.debug_tuple(stringify!($other)).field(error).finish()
                    })*
                }
            }
        }

        impl crate::error::Room for $error {
            fn variant(&self) -> &str {
                match self {
                    $($(#[$on])* Self::$variant { .. } => stringify!($variant),)*
                    // What only passes another error on is that one.
                    $($(#[$condition])* Self::$other(error) => crate::error::Room::variant(error),)*
                }
            }

            fn append_values<'s>(&'s self, values: &mut Vec<(&'s str, f64)>) {
                match self {
                    $($(#[$on])* Self::$variant { $($field),* } => {
                        $(crate::error::Field::append_values($field, stringify!($field), values);)*
                    })*
                    $($(#[$condition])* Self::$other(error) => {
                        crate::error::Room::append_values(error, values);
                    })*
                }
            }
        }
    };
}

pub(crate) use room_error;

#[cfg(test)]
mod tests {
    use crate::attractors::basin::BasinError;
    use crate::attractors::log::LogError;
    use crate::bifurcation::error::BifurcationError;
    use std::error::Error as _;

    use crate::branches::error::OrbitError;
    use crate::error::{Error, ErrorKind, chain};
    use crate::model::error::ModelError;
    use crate::model::structure::StructureError;
    use crate::response::FrequencyResponse;
    use crate::time::FlowError;

    crate::oscillator! {
        Linear(x) {
            param drive = 0.1;
            ddot(x) + 0.2*dot(x) + x = drive*cos(omega*t);
        }
    }

    /// What a program shows whose `main` returns the error.
    #[test]
    fn a_main_that_fails_shows_the_sentence() {
        let main = || -> Result<(), Error> {
            FrequencyResponse::of(&Linear::default()).from(1.0).run()?;
            Ok(())
        };
        let error = main().expect_err("a range with one end");
        let sentence = "the range is not complete: `to(...)` has not been called";
        assert_eq!(format!("{error:?}"), sentence);
        let boxed: Box<dyn std::error::Error> = error.into();
        assert_eq!(format!("{boxed:?}"), sentence);
        assert_eq!(
            format!("{boxed:#?}"),
            "Missing {\n    name: \"to\",\n    why: \"the range is not complete\",\n}"
        );
    }

    /// What each source says is said once, however deep it lies.
    #[test]
    fn a_chain_says_everything_once() {
        let reason = BasinError::Motion {
            reason: FlowError::Rests { phase: 1.5 },
        };
        let error = Error::from(BifurcationError::Search { value: 0.7, reason });
        assert_eq!(error.kind(), ErrorKind::Motion);
        assert_eq!(error.variant(), "Search");
        assert_eq!(error.values(), [("value", 0.7), ("phase", 1.5)]);
        assert_eq!(
            chain(&error).to_string(),
            "attractors at 0.7 could not be looked for: no motion of the grid can be computed: the motion rests on a level at which the force jumps, at the phase 1.5"
        );
        let path = "some".into();
        let found = String::new();
        let log = BasinError::from(LogError::Other { path, found });
        assert_eq!(chain(&log).to_string(), "some is no checkpoint");
        let log = Error::from(log);
        assert_eq!((log.kind(), log.variant()), (ErrorKind::File, "Other"));
        assert_eq!(log.values(), []);
        assert_eq!(error, error.clone());
        assert_ne!(error, Error::from(ModelError::NotAffine));
    }

    /// Counts, lists, and the numbers of what it comes from, of an enum as of what is a struct.
    #[test]
    fn numbers_have_the_names_of_their_fields() {
        let reason = crate::continuation::newton::NewtonError::Singular {
            iterations: 2,
            column: 3,
            pivot: 0.5,
        };
        let error = Error::from(OrbitError::NoStart { value: 0.2, reason });
        let of_reason = [("iterations", 2.0), ("column", 3.0), ("pivot", 0.5)];
        assert_eq!(error.variant(), "NoStart");
        assert_eq!(error.values(), [&[("value", 0.2)], &of_reason[..]].concat());
        let law = "stop".to_owned();
        let levels = vec![2.0, 1.0];
        let error = Error::from(ModelError::Levels { law, levels });
        assert_eq!(error.values(), [("levels", 2.0), ("levels", 1.0)]);
        assert_eq!(error.value("levels"), Some(2.0));
        let motion = crate::time::MotionError {
            value: 0.2,
            reason: FlowError::TooManySteps {
                phase: 1.5,
                steps: 7,
            },
        };
        let error = Error::from(motion);
        assert_eq!(error.variant(), "TooManySteps");
        let expected = [("value", 0.2), ("phase", 1.5), ("steps", 7.0)];
        assert_eq!(error.values(), expected);
    }

    #[test]
    fn sentences_hold_sentences_and_details_hold_details() {
        let reason = crate::continuation::newton::NewtonError::Singular {
            iterations: 2,
            column: 3,
            pivot: 0.0,
        };
        let error = Error::from(OrbitError::NoStart { value: 0.2, reason });
        let sentence = "no periodic orbit found at 0.2";
        let why = "the Jacobian is singular after 2 iterations: pivot 0.0e0 in column 3";
        assert_eq!(error.to_string(), sentence);
        assert_eq!(error.source().expect("a reason").to_string(), why);
        assert_eq!(format!("{error:?}"), format!("{sentence}: {why}"));
        let details = format!("{error:#?}");
        for part in ["NoStart {", "value: 0.2,", "Singular {", "column: 3,"] {
            assert!(details.contains(part), "{details}");
        }
        let flow = FlowError::Rests { phase: 1.5 };
        assert_eq!(
            format!("{:#?}", Error::from(flow)),
            "Rests {\n    phase: 1.5,\n}"
        );
        assert_eq!(
            format!("{:#?}", Error::from(ModelError::NotAffine)),
            "NotAffine"
        );
        let path = "some".into();
        let log = LogError::Other {
            path,
            found: String::new(),
        };
        let name = "grid";
        let basin = BasinError::Request {
            name,
            must: "must be finite",
        };
        let structure = Error::from(StructureError::SingularMass { pivot: 0.0 });
        let [log, basin] = [Error::from(log), Error::from(basin)];
        let sentences: [(&dyn std::fmt::Debug, &dyn std::fmt::Display); 4] = [
            (&flow, &flow),
            (&log, &log),
            (&basin, &basin),
            (&structure, &structure),
        ];
        for (debug, display) in sentences {
            assert_eq!(format!("{debug:?}"), display.to_string());
        }
    }
}
