//! `{:?}` of an error is its sentence with its sources, `{:#?}` its variant with everything that it carries.
//!
//! A program whose `main` returns a `Result` shows `{:?}` of the error, and whoever runs it is to read the sentence.

/// What a public enum of errors is to users: [`From`] for [`Error`](super::Error), where a function says its kind, and
/// [`Debug`](std::fmt::Debug), from its variants with their fields and, after a semicolon, the variants that hold another error. One
/// that is missing, or a field of it, does not compile.
///
/// A variant must not show itself by `{:?}` alone: of `main() -> Result` that is all that a user reads.
macro_rules! room_error {
    ($error:ident $(, $kind:expr)?; $($variant:ident { $($field:ident),* })*; $($(#[$condition:meta])* $other:ident)*) => {
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
                    $(Self::$variant { $($field),* } => f
                        .debug_struct(stringify!($variant))
                        $(.field(stringify!($field), $field))*
                        .finish(),)*
                    $($(#[$condition])* Self::$other(error) => {
                        f.debug_tuple(stringify!($other)).field(error).finish()
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
        assert_eq!(
            chain(&error).to_string(),
            "attractors at 0.7 could not be looked for: no motion of the grid can be computed: the motion rests on a level at which the force jumps, at the phase 1.5"
        );
        let path = "some".into();
        let found = String::new();
        let log = BasinError::from(LogError::Other { path, found });
        assert_eq!(chain(&log).to_string(), "some is no checkpoint");
        assert_eq!(Error::from(log).kind(), ErrorKind::File);
        assert_eq!(error, error.clone());
        assert_ne!(error, Error::from(ModelError::NotAffine));
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
