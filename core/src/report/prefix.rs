//! Numbers with units, as titles and summaries have them.

use crate::numeric::decimal::Decimal;
use hertzian_chart::{prefixed, takes_prefix};

/// Sizes that are read without a prefix.
const READ: std::ops::Range<f64> = 1e-3..1e4;
/// Digits of a number that was divided by a prefix: enough for what anyone writes, and rounding is left out.
const DIGITS: usize = 13;

/// A number with its unit, with a prefix where that reads better: `1 GN/m^1.5`.
pub(crate) fn with_unit(value: f64, unit: &str) -> String {
    if unit.is_empty() {
        return Decimal::plain(value).to_string();
    }
    let usual = value == 0.0 || !value.is_finite() || READ.contains(&value.abs());
    if usual || !takes_prefix(unit) {
        return format!("{} {unit}", Decimal::plain(value));
    }
    let (power, unit) = prefixed(value.abs().log10().floor() as i32, unit);
    let scaled = if power < 0 {
        value * 10_f64.powi(-power)
    } else {
        value / 10_f64.powi(power)
    };
    let rounded: f64 = format!("{scaled:.DIGITS$e}").parse().unwrap_or(scaled);
    format!("{} {unit}", Decimal::plain(rounded))
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
