//! `{:?}` of an error is its sentence, `{:#?}` its variant with everything that it carries.
//!
//! A program whose `main` returns a `Result` shows `{:?}` of the error, and whoever runs it is to read the sentence.

/// Writes [`Debug`](std::fmt::Debug) of an enum of errors, from its variants with their fields and, after a semicolon, the variants
/// that hold another error. One that is missing, or a field of it, does not compile.
macro_rules! sentence_as_debug {
    ($error:ident: $($variant:ident { $($field:ident),* })*; $($(#[$condition:meta])* $other:ident)*) => {
        impl std::fmt::Debug for $error {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                if !f.alternate() {
                    return std::fmt::Display::fmt(self, f);
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

pub(crate) use sentence_as_debug;

#[cfg(test)]
mod tests {
    use crate::attractors::basin::BasinError;
    use crate::attractors::log::LogError;
    use crate::error::Error;
    use crate::model::structure::StructureError;
    use crate::numeric::linear::Singular;
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
        assert_eq!(format!("{boxed:#?}"), "Missing {\n    name: \"to\",\n}");
    }

    #[test]
    fn sentences_hold_sentences_and_details_hold_details() {
        let at = Singular {
            column: 3,
            pivot: 0.0,
        };
        let reason = crate::error::NewtonError::Singular { iterations: 2, at };
        let error = Error::NoStart { value: 0.2, reason };
        assert_eq!(format!("{error:?}"), error.to_string());
        assert!(
            error
                .to_string()
                .starts_with("no periodic orbit found at 0.2: ")
        );
        let details = format!("{error:#?}");
        for part in ["NoStart {", "value: 0.2,", "Singular {", "column: 3,"] {
            assert!(details.contains(part), "{details}");
        }
        let flow = FlowError::Rests { phase: 1.5 };
        assert_eq!(
            format!("{:#?}", Error::Flow(flow)),
            "Flow(\n    Rests {\n        phase: 1.5,\n    },\n)"
        );
        assert_eq!(format!("{:#?}", Error::NotAffine), "NotAffine");
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
        let structure = StructureError::SingularMass { pivot: 0.0 };
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
