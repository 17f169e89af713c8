//! Units of columns beside those of a model.

use std::f64::consts::PI;

/// Prefixes, with their powers of ten.
const PREFIXES: [(&str, f64); 10] = [
    ("", 1.0),
    ("p", 1e-12),
    ("n", 1e-9),
    ("u", 1e-6),
    ("µ", 1e-6),
    ("m", 1e-3),
    ("c", 1e-2),
    ("k", 1e3),
    ("M", 1e6),
    ("G", 1e9),
];

/// The factor from a unit to the one that the model has.
///
/// # Errors
/// Why there is none.
pub(crate) fn factor(given: Option<&str>, expected: &str, has_units: bool) -> Result<f64, String> {
    let Some(given) = given else {
        return Ok(1.0);
    };
    if given == expected || (given == "1" && expected.is_empty()) {
        return Ok(1.0);
    }
    match (given, expected) {
        ("deg", "rad") => return Ok(PI / 180.0),
        ("%", "" | "1") => return Ok(0.01),
        _ => {}
    }
    if !has_units {
        return Err(format!(
            "the model has no units: leave [{given}] out, or declare units in the model"
        ));
    }
    let split = |unit: &str| {
        let parts = PREFIXES
            .iter()
            .filter_map(|(prefix, factor)| Some((unit.strip_prefix(prefix)?.to_owned(), *factor)));
        parts
            .filter(|(rest, _)| takes_prefix(rest))
            .collect::<Vec<_>>()
    };
    for (rest, from) in split(given) {
        if let Some((_, to)) = split(expected)
            .into_iter()
            .find(|(other, _)| *other == rest)
        {
            return Ok(from / to);
        }
    }
    let in_words = if expected.is_empty() {
        "a plain number"
    } else {
        expected
    };
    Err(format!(
        "[{given}] is not what the model measures it in, which is {in_words}, nor that with another prefix"
    ))
}

/// Whether what is left is a unit, whose first symbol has no exponent: a prefix would have it too.
fn takes_prefix(rest: &str) -> bool {
    let end = rest
        .find(|c: char| !c.is_alphabetic())
        .unwrap_or(rest.len());
    end > 0 && !rest[end..].starts_with('^')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_are_powers_of_ten() {
        let of = |given, expected| factor(Some(given), expected, true);
        assert_eq!(of("um", "m"), Ok(1e-6));
        assert_eq!(of("mm", "um"), Ok(1e-3 / 1e-6));
        assert_eq!(of("mm/s", "m/s"), Ok(1e-3));
        assert_eq!(of("deg", "rad"), Ok(PI / 180.0));
        assert_eq!(factor(None, "m", true), Ok(1.0));
        // A square of a prefix is not one.
        assert!(of("mm^2", "m^2").is_err());
        assert!(of("V", "m").is_err());
        assert!(factor(Some("mm"), "", false).is_err());
    }
}
