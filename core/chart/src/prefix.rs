//! Prefixes of units: powers of a thousand.

/// Symbols that take a prefix.
const PLAIN: [&str; 11] = ["N", "m", "Pa", "s", "Hz", "J", "W", "V", "A", "F", "C"];
/// Prefixes of powers of a thousand, from the smallest on.
const PREFIXES: [&str; 9] = ["p", "n", "u", "m", "", "k", "M", "G", "T"];

/// Whether the first symbol of a unit takes a prefix: `N/m` does, `mm` has one, and of `m^2` or `m²` it would be squared.
pub fn takes_prefix(unit: &str) -> bool {
    let end = unit.find(|c: char| !c.is_alphabetic());
    let (symbol, rest) = unit.split_at(end.unwrap_or(unit.len()));
    let alone = rest.is_empty() || rest.starts_with('/');
    let times = rest.starts_with('*') && !rest.starts_with("**");
    PLAIN.contains(&symbol) && (alone || times)
}

/// A unit with the prefix in which a number of about ten to this power is between 1 and 1000, and the power of ten that the prefix stands
/// for; the unit itself, and zero, where it takes none.
///
/// ```
/// use hertzian_chart::prefixed;
///
/// assert_eq!(prefixed(-7, "m"), (-9, "nm".to_owned()));
/// assert_eq!(prefixed(4, "N/m^1.5"), (3, "kN/m^1.5".to_owned()));
/// assert_eq!(prefixed(-7, "mm"), (0, "mm".to_owned()));
/// assert_eq!(prefixed(-7, "m²"), (0, "m²".to_owned()));
/// ```
pub fn prefixed(power: i32, unit: &str) -> (i32, String) {
    if !takes_prefix(unit) {
        return (0, unit.to_owned());
    }
    let thousands = power.div_euclid(3).clamp(-4, 4);
    let prefix = PREFIXES[(thousands + 4) as usize];
    (3 * thousands, format!("{prefix}{unit}"))
}
