//! The contract of a contact law: what the compiler emits and the runtime reads.
//!
//! A law is a force `phi(g, r; a)` of one gap `g`, of its rate `r = dg/dt` and of arguments `a`. *Levels* of the gap
//! divide it into pieces: piece `i` lies between level `i - 1` and level `i`, so `L` levels make `L + 1` pieces. Inside
//! a piece the force is smooth, except for powers that vanish or are unbounded at its ends.
//!
//! All evaluation is batched, structure of arrays: one dynamic call for a whole batch.

use std::borrow::Cow;

use crate::data::LawData;

/// A law as the runtime sees it. Generated types, the interpreter and laws written by hand implement it alike.
///
/// Every method that takes slices requires `arguments.len()` to be the number of arguments in [`LawFacts`], and all
/// slices of samples to be of one length; implementations may panic otherwise (the runtime upholds it).
///
/// At a level the force belongs to the piece that the declaration says (`>` or `>=`). A derivative that is
/// unbounded there, as that of `g^0.6` at `g = 0`, is returned as zero *at the level itself*: a single point carries no
/// weight in an integral, and an infinity in a sampled Jacobian would hide every other term. Beside the level it is
/// returned as it is.
pub trait Law: Send + Sync {
    /// What is known of the law without evaluating it.
    fn facts(&self) -> &LawFacts;

    /// The same law as data, for the interpreter; `None` for a law that has none, as one written by hand.
    fn data(&self) -> Option<&LawData> {
        None
    }

    /// Writes the gaps at which pieces meet, in increasing order. `levels.len()` is the number of levels.
    fn levels(&self, arguments: &[f64], levels: &mut [f64]);

    /// Writes the derivative of every level with respect to one argument.
    fn levels_by(&self, arguments: &[f64], argument: usize, by_argument: &mut [f64]);

    /// Force at every sample.
    fn force(&self, on: On, arguments: &[f64], gap: &[f64], rate: &[f64], force: &mut [f64]);

    /// Force and its derivatives with respect to gap and rate at every sample.
    fn derivatives(
        &self,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
    );

    /// As [`Law::derivatives`], and the derivative of the force with respect to one argument.
    #[allow(
        clippy::too_many_arguments,
        reason = "a batch in, a batch out: a struct would only rename them"
    )]
    fn derivatives_and_by(
        &self,
        argument: usize,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
        by_argument: &mut [f64],
    );

    /// Where the force is linear in the rate, `phi = f(g) + h(g) r`: the spring `f` and the primitive `G` with
    /// `G' = h`, continuous across levels, as laws of the gap alone with the same arguments and levels. Then
    /// `h(g) dg/dt = dG(g)/dt`. `None` unless [`LawFacts::rate`] is [`RateDependence::Linear`]; also where the
    /// compiler knows no primitive of `h`.
    fn parts(&self) -> Option<Parts<'_>>;
}

impl std::fmt::Debug for dyn Law + '_ {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Law({})", self.facts().name)
    }
}

/// The two laws of the gap alone of which a law that is linear in its rate consists, see [`Law::parts`].
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Parts<'a> {
    /// `f(g)`, the force at zero rate.
    pub spring: &'a dyn Law,
    /// `G(g)`, whose time derivative is the rate term.
    pub primitive: &'a dyn Law,
}

impl<'a> Parts<'a> {
    /// A spring, and the primitive of the rate term.
    #[inline]
    pub const fn new(spring: &'a dyn Law, primitive: &'a dyn Law) -> Self {
        Self { spring, primitive }
    }
}

/// Which pieces a batch is evaluated on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum On {
    /// Every sample on the piece its gap lies in: sampled evaluation, by selection.
    AllPieces,
    /// Every sample on this piece, wherever its gap lies: switched evaluation, and one-sided limits at a level. Powers
    /// are guarded: outside the piece the result is finite but means nothing.
    Piece(usize),
}

/// Where [`Law::derivatives`] writes. All slices have the length of the batch.
#[derive(Debug)]
pub struct Derivatives<'a> {
    /// `phi`
    pub force: &'a mut [f64],
    /// `d phi / d gap`
    pub by_gap: &'a mut [f64],
    /// `d phi / d rate`
    pub by_rate: &'a mut [f64],
}

/// What is known of a law without evaluating it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LawFacts {
    /// Name in the declaration.
    pub name: Cow<'static, str>,
    /// The arguments, in the order of the argument slice.
    pub arguments: Cow<'static, [ArgumentFacts]>,
    /// One entry per level, in increasing order of the gap.
    pub levels: Cow<'static, [LevelFacts]>,
    /// One entry per piece, `levels.len() + 1` of them, in increasing order of the gap.
    pub pieces: Cow<'static, [PieceFacts]>,
    /// How the force depends on the rate.
    pub rate: RateDependence,
    /// The force is odd in gap and rate together: `phi(-g, -r) = -phi(g, r)`.
    pub odd: bool,
}

impl LawFacts {
    /// A law of these pieces, one more than there are levels. It depends on the rate in any way, has no arguments and is not odd,
    /// unless said otherwise.
    pub fn new(
        name: impl Into<Cow<'static, str>>,
        levels: impl IntoIterator<Item = LevelFacts>,
        pieces: impl IntoIterator<Item = PieceFacts>,
    ) -> Self {
        Self {
            name: name.into(),
            arguments: Cow::Borrowed(&[]),
            levels: levels.into_iter().collect(),
            pieces: pieces.into_iter().collect(),
            rate: RateDependence::General,
            odd: false,
        }
    }

    crate::setters! { self:
        /// The arguments, in the order of the argument slice.
        arguments(arguments: impl IntoIterator<Item = ArgumentFacts>) {
            self.arguments = arguments.into_iter().collect();
        }

        /// How the force depends on the rate.
        rate(rate: RateDependence) { self.rate = rate }

        /// Whether the force is odd in gap and rate together.
        odd(odd: bool) { self.odd = odd }
    }
}

/// What is known of an argument. Everything else that is known of the law holds for values within the range.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ArgumentFacts {
    /// Its name.
    pub name: Cow<'static, str>,
    /// Lower end of the range.
    pub minimum: Bound,
    /// Upper end of the range.
    pub maximum: Bound,
}

impl ArgumentFacts {
    /// An argument that may have any value.
    #[inline]
    pub const fn named(name: Cow<'static, str>) -> Self {
        Self {
            name,
            minimum: Bound::Unbounded,
            maximum: Bound::Unbounded,
        }
    }

    /// The range that its values must be in.
    #[must_use]
    pub fn range(mut self, minimum: Bound, maximum: Bound) -> Self {
        self.minimum = minimum;
        self.maximum = maximum;
        self
    }

    /// Whether a value is finite and within the range.
    #[inline]
    pub fn admits(&self, value: f64) -> bool {
        is_within(self.minimum, self.maximum, value)
    }
}

/// One end of a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// No bound.
    Unbounded,
    /// The value itself is allowed.
    Included(f64),
    /// The value itself is not allowed.
    Excluded(f64),
}

/// Whether a value is finite and between two bounds.
#[inline]
pub(crate) fn is_within(minimum: Bound, maximum: Bound, value: f64) -> bool {
    let above = match minimum {
        Bound::Unbounded => true,
        Bound::Included(bound) => value >= bound,
        Bound::Excluded(bound) => value > bound,
    };
    let below = match maximum {
        Bound::Unbounded => true,
        Bound::Included(bound) => value <= bound,
        Bound::Excluded(bound) => value < bound,
    };
    value.is_finite() && above && below
}

/// How a force depends on the rate of its gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RateDependence {
    /// Not at all.
    None,
    /// `f(g) + h(g) r`; see [`Law::parts`].
    Linear,
    /// In any other way.
    General,
}

/// What happens to the force and its derivatives where two pieces meet. By default nothing: all of them are continuous, and the level
/// belongs to the piece below it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
#[allow(
    clippy::struct_excessive_bools,
    reason = "independent facts, not states"
)]
pub struct LevelFacts {
    /// The level itself belongs to the piece above it (`gap >= level`).
    pub belongs_above: bool,
    /// The force jumps, even at zero rate (a preloaded stop).
    pub force_jumps: bool,
    /// `d phi / d gap` differs on the two sides, or is unbounded on one of them.
    pub by_gap_jumps: bool,
    /// `d phi / d rate` differs on the two sides: the force jumps wherever the rate is not zero.
    pub by_rate_jumps: bool,
    /// `d phi / d gap` is unbounded on at least one side (an exponent below one).
    pub unbounded_by_gap: bool,
}

impl LevelFacts {
    /// Whether the level itself belongs to the piece above it.
    #[must_use]
    pub const fn belongs_above(mut self, holds: bool) -> Self {
        self.belongs_above = holds;
        self
    }

    /// Whether the force jumps, even at zero rate.
    #[must_use]
    pub const fn force_jumps(mut self, holds: bool) -> Self {
        self.force_jumps = holds;
        self
    }

    /// Whether the derivative by the gap differs on the two sides, or is unbounded on one of them.
    #[must_use]
    pub const fn by_gap_jumps(mut self, holds: bool) -> Self {
        self.by_gap_jumps = holds;
        self
    }

    /// Whether the derivative by the rate differs on the two sides.
    #[must_use]
    pub const fn by_rate_jumps(mut self, holds: bool) -> Self {
        self.by_rate_jumps = holds;
        self
    }

    /// Whether the derivative by the gap is unbounded on at least one side.
    #[must_use]
    pub const fn unbounded_by_gap(mut self, holds: bool) -> Self {
        self.unbounded_by_gap = holds;
        self
    }
}

/// What is known of one piece.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PieceFacts {
    /// The force is constant plus linear in gap and rate, with coefficients that do not depend on either.
    pub affine: bool,
    /// How the force varies over the piece.
    pub force: Variation,
    /// How `d phi / d gap` varies over the piece.
    pub by_gap: Variation,
    /// How `d phi / d rate` varies over the piece.
    pub by_rate: Variation,
    /// How `d phi / d argument` varies over the piece, one entry per argument.
    pub by_argument: Cow<'static, [Variation]>,
    /// Every additive term of the force and of each derivative, with its exponents at the ends of the piece.
    pub terms: Cow<'static, [TermFacts]>,
}

impl PieceFacts {
    /// A piece on which nothing is known of a law with so many arguments but that it is smooth.
    pub fn smooth(arguments: usize) -> Self {
        Self {
            affine: false,
            force: Variation::Varying,
            by_gap: Variation::Varying,
            by_rate: Variation::Varying,
            by_argument: vec![Variation::Varying; arguments].into(),
            terms: Cow::Borrowed(&[]),
        }
    }

    /// A piece without force.
    pub fn zero(arguments: usize) -> Self {
        Self {
            affine: true,
            force: Variation::Zero,
            by_gap: Variation::Zero,
            by_rate: Variation::Zero,
            by_argument: vec![Variation::Zero; arguments].into(),
            terms: Cow::Borrowed(&[]),
        }
    }

    crate::setters! { self:
        /// How the force varies.
        force(force: Variation) { self.force = force }

        /// How the derivatives by gap and by rate vary. Where both do not, the piece is affine.
        slopes(by_gap: Variation, by_rate: Variation) {
            self.by_gap = by_gap;
            self.by_rate = by_rate;
            self.affine = ![by_gap, by_rate].contains(&Variation::Varying);
        }

        /// How the derivatives by the arguments vary.
        by_argument(by_argument: impl IntoIterator<Item = Variation>) {
            self.by_argument = by_argument.into_iter().collect();
        }

        /// The terms of the force and of each derivative with their exponents; those that are smooth need not be there.
        terms(terms: impl IntoIterator<Item = TermFacts>) { self.terms = terms.into_iter().collect() }
    }
}

/// How a quantity varies over a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Variation {
    /// Zero everywhere.
    Zero,
    /// The same everywhere on the piece, whatever gap and rate.
    Constant,
    /// Depends on gap or rate.
    Varying,
}

/// The behaviour of one additive term near the ends of its piece: it is `|g - level|^exponent` times a smooth factor.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct TermFacts {
    /// The quantity the term belongs to.
    pub of: Quantity,
    /// Exponent at the lower end; zero where the term is smooth or the piece is unbounded below.
    pub lower: Exponent,
    /// Exponent at the upper end; zero where the term is smooth or the piece is unbounded above.
    pub upper: Exponent,
    /// The term carries a logarithm of the distance as well (the derivative by a runtime exponent).
    pub logarithm: bool,
}

impl TermFacts {
    /// A term with these exponents at the ends of its piece.
    pub const fn new(of: Quantity, lower: Exponent, upper: Exponent) -> Self {
        Self {
            of,
            lower,
            upper,
            logarithm: false,
        }
    }

    /// Whether the term carries a logarithm of the distance as well.
    #[must_use]
    pub const fn logarithm(mut self, logarithm: bool) -> Self {
        self.logarithm = logarithm;
        self
    }
}

/// A force or one of its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quantity {
    /// `phi`
    Force,
    /// `d phi / d gap`
    ByGap,
    /// `d phi / d rate`
    ByRate,
    /// `d phi / d argument`
    ByArgument(usize),
}

/// An exponent known at compile time, or a runtime argument plus a number.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Exponent {
    /// The number.
    pub number: f64,
    /// The argument added to it, by position.
    pub argument: Option<usize>,
}

impl Exponent {
    /// No power: smooth.
    pub const ZERO: Self = Self::new(0.0);

    /// A number.
    pub const fn new(number: f64) -> Self {
        Self {
            number,
            argument: None,
        }
    }

    /// A number plus the argument at a position.
    pub const fn of_argument(number: f64, argument: usize) -> Self {
        Self {
            number,
            argument: Some(argument),
        }
    }

    /// Its value for given arguments.
    #[inline]
    pub fn value(self, arguments: &[f64]) -> f64 {
        self.number + self.argument.map_or(0.0, |index| arguments[index])
    }
}
