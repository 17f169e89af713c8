//! Numbers, exactly where that fits: `1.5` is three halves.

use super::Parser;
use crate::ast::{Expr, Kind};
use crate::dag::Rational;
use crate::errors::{Extent, shortened};

impl Parser<'_> {
    /// The number a literal stands for. What is glued to it is reported, and the number still returned.
    pub(super) fn number(&mut self, literal: &str, extent: Extent) -> syn::Result<Expr> {
        let (text, suffix) = split_suffix(literal);
        let shown = shortened(literal);
        let Some(value) = Rational::from_decimal(text) else {
            let message = out_of_range(text, &shown);
            let message = message.unwrap_or_else(|| format!("`{shown}` is not a number"));
            return Err(extent.fault(message));
        };
        let radix = text == "0"
            && ["x", "b", "o"]
                .iter()
                .any(|letter| suffix.starts_with(letter));
        let exponent_less =
            suffix.starts_with(['e', 'E']) && suffix[1..].starts_with(|c: char| c.is_ascii_digit());
        if radix
            || exponent_less
            || matches!(
                suffix,
                "f64" | "f32" | "i32" | "i64" | "u32" | "u64" | "usize"
            )
        {
            self.diagnostics.report(
                extent,
                format!("write `{shown}` as a plain decimal number, such as `1.5e-3`"),
            );
        } else if !suffix.is_empty() {
            let message = format!(
                "`{shown}` is read as one number with a suffix: write a star, `{}*{}`",
                shortened(text),
                shortened(suffix)
            );
            self.diagnostics.report(extent, message);
        }
        Ok(Expr {
            kind: Kind::Number(value, text.to_owned()),
            extent,
        })
    }
}

/// What is said of a number that no double holds; `None` of what is no number.
pub(super) fn out_of_range(text: &str, shown: &str) -> Option<String> {
    let is_number = text.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    (is_number && split_suffix(text).1.is_empty()).then(|| {
        format!(
            "`{shown}` is out of range: numbers are zero or between 4.9e-324 and 1.8e308 in size"
        )
    })
}

/// Splits `2zeta` into `2` and `zeta`, and `1.5e3` not at all.
fn split_suffix(literal: &str) -> (&str, &str) {
    let bytes = literal.as_bytes();
    let mut end = usize::from(literal.starts_with('-'));
    while end < bytes.len() && (bytes[end].is_ascii_digit() || matches!(bytes[end], b'.' | b'_')) {
        end += 1;
    }
    if end < bytes.len() && matches!(bytes[end], b'e' | b'E') {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let first = end + 1 + sign;
        if bytes.get(first).is_some_and(u8::is_ascii_digit) {
            end = first;
            while end < bytes.len() && (bytes[end].is_ascii_digit() || bytes[end] == b'_') {
                end += 1;
            }
        }
    }
    literal.split_at(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_suffix_is_what_is_glued_to_a_number() {
        assert_eq!(split_suffix("2zeta"), ("2", "zeta"));
        assert_eq!(split_suffix("1.5e-3x"), ("1.5e-3", "x"));
        assert_eq!(split_suffix("1e3"), ("1e3", ""));
    }
}
