//! Laws whose stiffness is unbounded on both sides of a level, which are followed by shooting by default.
//!
//! Where the motion comes to a height `h` beyond such a level, `gap^a` with `a` below one on both sides, it stays there for a time that goes
//! as `h^(1/2)`, and its stiffness goes as `h^(a - 1)`. So the impulse of a perturbation there, and with it the monodromy, goes as
//!
//! ```text
//! h^(a - 1/2)                                                                                                 (1)
//! ```
//!
//! (`a = 0.6`: a change of the height by a thousandth is seen as one by a half). Without a gap that opens, the same stretch is lost on the other
//! side at once. The contact equation, whose unknowns are the ends of both, divides its steps there, sometimes until none is left. Shooting has no
//! unknown for a stretch, and goes over it.
//!
//! Source of the time beyond the level: Nordmark (1991), J. Sound Vib. 145, 279; what a power of the gap makes of it is (1).

use crate::law::{Exponent, LawFacts, Quantity};

/// Whether a derivative by the gap is unbounded below a level, and above it.
pub(super) fn is_unbounded(law: &LawFacts, level: usize, arguments: &[f64]) -> [bool; 2] {
    let below = law.pieces[level].terms.iter();
    let mut below = below.map(|term| (term.of, term.upper));
    let above = law.pieces[level + 1].terms.iter();
    let mut above = above.map(|term| (term.of, term.lower));
    let unbounded = |(of, exponent): (Quantity, Exponent)| {
        of == Quantity::ByGap && exponent.value(arguments) < 0.0
    };
    [below.any(unbounded), above.any(unbounded)]
}

/// Whether a derivative by the gap is unbounded on both sides of a level.
pub(super) fn is_steep(law: &LawFacts, arguments: &[f64]) -> bool {
    (0..law.levels.len()).any(|level| is_unbounded(law, level, arguments) == [true; 2])
}
