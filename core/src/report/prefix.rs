//! Numbers with units, as titles and summaries have them.

use crate::numeric::decimal::Decimal;

/// Symbols that take a prefix.
const PLAIN: [&str; 11] = ["N", "m", "Pa", "s", "Hz", "J", "W", "V", "A", "F", "C"];
/// Prefixes of powers of a thousand, from the smallest on.
const PREFIXES: [&str; 9] = ["p", "n", "u", "m", "", "k", "M", "G", "T"];
/// Sizes that are read without a prefix.
const READ: std::ops::Range<f64> = 1e-3..1e4;
/// Digits of a number that was divided by a prefix: enough for what anyone writes, and rounding is left out.
const DIGITS: usize = 13;

/// A number with its unit, with a prefix where that reads better: `1 GN/m^1.5`.
pub(crate) fn with_unit(value: f64, unit: &str) -> String {
    if unit.is_empty() {
        return Decimal::plain(value).to_string();
    }
    let end = unit.find(|c: char| !c.is_alphabetic());
    let (symbol, rest) = unit.split_at(end.unwrap_or(unit.len()));
    let takes = PLAIN.contains(&symbol) && !rest.starts_with('^');
    let usual = value == 0.0 || !value.is_finite() || READ.contains(&value.abs());
    if usual || !takes {
        return format!("{} {unit}", Decimal::plain(value));
    }
    let thousands = ((value.abs().log10() / 3.0).floor() as i32).clamp(-4, 4);
    let scaled = if thousands < 0 {
        value * 10_f64.powi(-3 * thousands)
    } else {
        value / 10_f64.powi(3 * thousands)
    };
    let rounded: f64 = format!("{scaled:.DIGITS$e}").parse().unwrap_or(scaled);
    let prefix = PREFIXES[(thousands + 4) as usize];
    format!("{} {prefix}{unit}", Decimal::plain(rounded))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::unit::in_unit;

    #[test]
    fn prefixes_stand_where_they_read_better() {
        for (value, unit, expected) in [
            (1e9, "N/m^1.5", "1 GN/m^1.5"),
            (2.5e-7, "m", "250 nm"),
            (4.5e-6, "m", "4.5 um"),
            (12345.0, "N", "12.345 kN"),
            (-3e5, "Pa", "-300 kPa"),
            (0.05, "m", "0.05 m"),
            (0.0, "N", "0 N"),
            (1e5, "N/mm^1.5", "100 kN/mm^1.5"),
            (1e7, "m^2", "10000000 m^2"),
            (1e7, "mm", "10000000 mm"),
            (1e-20, "N", "1e-8 pN"),
            (0.25, "", "0.25"),
            (1e8, "1/s", "100000000 1/s"),
        ] {
            assert_eq!(with_unit(value, unit), expected);
        }
        assert_eq!(in_unit("tip", "um"), "tip [um]");
        assert_eq!(in_unit("tip", ""), "tip");
    }
}
