//! The contract of a contact law: what the compiler emits and the runtime reads.
//!
//! A law is a force `phi(g, r; a)` of one gap `g`, of its rate `r = dg/dt` and of arguments `a`. *Levels* of the gap divide it into pieces:
//! piece `i` lies between level `i - 1` and level `i`. Inside a piece the force is smooth, except for powers that vanish or are unbounded
//! at its ends. The example of [`system`](crate::system) has a law by hand.

pub use hertzian_contract::law::*;

/// Whether the stiffness is unbounded at a level, at values of the arguments. It may depend on an exponent, so it is not asked of the
/// facts of the level.
pub(crate) fn is_unbounded(facts: &LawFacts, level: usize, arguments: &[f64]) -> bool {
    unbounded_by(facts, level, arguments).is_some()
}

/// The least negative power of the distance from a level that the stiffness goes as beside it; `None` where it is bounded.
pub(crate) fn unbounded_by(facts: &LawFacts, level: usize, arguments: &[f64]) -> Option<f64> {
    let below = facts.pieces[level].terms.iter();
    let above = facts.pieces[level + 1].terms.iter();
    let ends = below.map(|term| (term.of, term.upper));
    let ends = ends.chain(above.map(|term| (term.of, term.lower)));
    ends.filter(|(of, _)| *of == Quantity::ByGap)
        .map(|(_, end)| end.value(arguments))
        .filter(|exponent| *exponent < 0.0)
        .min_by(f64::total_cmp)
}
