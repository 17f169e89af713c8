//! Units as exact powers of a few base units, and of ten: `mm` is a metre times ten to the minus three.

use std::fmt;

use crate::dag::Rational;

/// What the exponents of a [`Dimension`] belong to.
const BASES: [&str; 6] = ["kg", "m", "s", "A", "K", "10"];

/// Known symbols, as exponents of the base units and of ten.
pub(super) const SYMBOLS: [(&str, [i128; 6]); 32] = [
    ("kg", [1, 0, 0, 0, 0, 0]),
    ("g", [1, 0, 0, 0, 0, -3]),
    ("t", [1, 0, 0, 0, 0, 3]),
    ("m", [0, 1, 0, 0, 0, 0]),
    ("mm", [0, 1, 0, 0, 0, -3]),
    ("um", [0, 1, 0, 0, 0, -6]),
    ("nm", [0, 1, 0, 0, 0, -9]),
    ("s", [0, 0, 1, 0, 0, 0]),
    ("ms", [0, 0, 1, 0, 0, -3]),
    ("us", [0, 0, 1, 0, 0, -6]),
    ("A", [0, 0, 0, 1, 0, 0]),
    ("K", [0, 0, 0, 0, 1, 0]),
    ("rad", [0; 6]),
    ("Hz", [0, 0, -1, 0, 0, 0]),
    ("kHz", [0, 0, -1, 0, 0, 3]),
    ("nN", [1, 1, -2, 0, 0, -9]),
    ("uN", [1, 1, -2, 0, 0, -6]),
    ("mN", [1, 1, -2, 0, 0, -3]),
    ("N", [1, 1, -2, 0, 0, 0]),
    ("kN", [1, 1, -2, 0, 0, 3]),
    ("MN", [1, 1, -2, 0, 0, 6]),
    ("Pa", [1, -1, -2, 0, 0, 0]),
    ("kPa", [1, -1, -2, 0, 0, 3]),
    ("MPa", [1, -1, -2, 0, 0, 6]),
    ("GPa", [1, -1, -2, 0, 0, 9]),
    ("J", [1, 2, -2, 0, 0, 0]),
    ("W", [1, 2, -3, 0, 0, 0]),
    ("V", [1, 2, -3, -1, 0, 0]),
    ("C", [0, 0, 1, 1, 0, 0]),
    ("F", [-1, -2, 4, 2, 0, 0]),
    ("H", [1, 2, -2, -2, 0, 0]),
    ("T", [1, 0, -2, -1, 0, 0]),
];

/// Exponents of the base units and of ten.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Dimension([Rational; 6]);

impl Dimension {
    /// A plain number.
    pub const ONE: Self = Self([Rational::ZERO; 6]);

    /// What a symbol stands for.
    pub fn of_symbol(symbol: &str) -> Option<Self> {
        let (_, exponents) = SYMBOLS.iter().find(|(known, _)| *known == symbol)?;
        Some(Self(exponents.map(Rational::integer)))
    }

    /// The product of two; `None` where an exponent does not fit.
    pub fn times(self, other: Self) -> Option<Self> {
        let mut product = self;
        for (own, other) in product.0.iter_mut().zip(other.0) {
            *own = own.checked_add(other)?;
        }
        Some(product)
    }

    /// A power; `None` where an exponent does not fit.
    pub fn power(self, exponent: Rational) -> Option<Self> {
        let mut power = self;
        for own in &mut power.0 {
            *own = own.checked_mul(exponent)?;
        }
        Some(power)
    }

    /// The power of ten between this and another unit of the same; `None` where they measure something else.
    pub fn in_units_of(self, other: Self) -> Option<Rational> {
        let alike = self.0[..5] == other.0[..5];
        alike.then(|| self.0[5].checked_sub(other.0[5])).flatten()
    }

    /// Divided by a power of time.
    pub fn per_time(self, times: i128) -> Option<Self> {
        let second = Self::of_symbol("s")?;
        self.times(second.power(Rational::integer(-times))?)
    }
}

impl fmt::Display for Dimension {
    /// A symbol where there is one; else forces as `N` and all else in base units. A power of ten becomes a prefix: of the symbols
    /// that can carry it, the one with which the whole is shortest.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is_own = |symbol: &&str| Self::of_symbol(symbol) == Some(*self);
        let names = SYMBOLS.iter().map(|(symbol, _)| *symbol);
        // Rates by time are those of angles here: Hz counts whole turns. What acts on an angle is a moment: N*m.
        let names = names.filter(|symbol| !["rad", "Hz", "kHz", "J"].contains(symbol));
        if let Some(symbol) = names.clone().find(is_own) {
            return formatter.write_str(symbol);
        }
        let lengths = ["mm", "um", "nm"].into_iter();
        // Nothing is measured by forces that has no mass in it: `mm/s^2`, not `N/t`.
        let massless = self.0[0].is_zero();
        let has_mass =
            |symbol: &str| Self::of_symbol(symbol).is_some_and(|own| !own.0[0].is_zero());
        let fitting = lengths.chain(names);
        let fitting = fitting.filter(|symbol| !(massless && has_mass(symbol)));
        let prefixed = fitting.filter_map(|symbol| self.with(symbol));
        let shortest = prefixed.min_by_key(|text| (text.contains('('), text.len()));
        match shortest.filter(|_| !self.0[5].is_zero()) {
            Some(text) => formatter.write_str(&text),
            None => formatter.write_str(&self.in_base_units(None)),
        }
    }
}

impl Dimension {
    /// The power of a symbol that carries the power of ten, and the rest in base units; `None` where the symbol cannot.
    fn with(self, symbol: &str) -> Option<String> {
        let own = Self::of_symbol(symbol)?;
        let power = self.0[5].checked_div(own.0[5])?;
        let rest = self.times(own.power(power.negate()?)?)?;
        Some(rest.in_base_units(Some((symbol, power))))
    }

    fn in_base_units(self, first: Option<(&str, Rational)>) -> String {
        let mut factors: Vec<(&str, Rational)> = BASES.into_iter().zip(self.0).collect();
        let mass = self.0[0];
        let newtons = Self::of_symbol("N")
            .and_then(|newton| newton.power(mass.negate()?))
            .and_then(|divisor| self.times(divisor));
        if let Some(rest) = newtons.filter(|_| !mass.is_zero() && !self.0[2].is_zero()) {
            factors = BASES.into_iter().zip(rest.0).collect();
            factors[0] = ("N", mass);
        }
        if let Some(first) = first {
            let at = usize::from(factors[0].0 == "N");
            factors.insert(at, first);
        }
        factors.retain(|(_, exponent)| !exponent.is_zero());
        let (above, below): (Vec<_>, Vec<_>) = factors
            .into_iter()
            .partition(|(base, exponent)| *base == "10" || !exponent.is_negative());
        let mut text: Vec<String> = above
            .iter()
            .map(|&(base, exponent)| power_text(base, exponent))
            .collect();
        if text.is_empty() {
            text.push("1".to_owned());
        }
        let mut text = text.join("*");
        for (base, exponent) in below {
            let positive = exponent.absolute().unwrap_or(exponent);
            text = format!("{text}/{}", power_text(base, positive));
        }
        text
    }
}

/// `m^1.5`, with an exponent as one writes it.
fn power_text(base: &str, exponent: Rational) -> String {
    if exponent == Rational::ONE {
        return base.to_owned();
    }
    let decimal = exponent.to_f64().to_string();
    if Rational::from_decimal(&decimal) == Some(exponent) {
        format!("{base}^{decimal}")
    } else {
        format!("{base}^({exponent})")
    }
}
