//! The contract of a contact law: what the compiler emits and the runtime reads.
//!
//! A law is a force `phi(g, r; a)` of one gap `g`, of its rate `r = dg/dt` and of arguments `a`. *Levels* of the gap divide it into pieces:
//! piece `i` lies between level `i - 1` and level `i`. Inside a piece the force is smooth, except for powers that vanish or are unbounded
//! at its ends. The example of [`system`](crate::system) has a law by hand.

pub use hertzian_contract::law::*;

/// Whether the stiffness is unbounded at a level, at values of the arguments. It may depend on an exponent, so it is not asked of the
/// facts of the level.
pub(crate) fn is_unbounded(facts: &LawFacts, level: usize, arguments: &[f64]) -> bool {
    let below = facts.pieces[level].terms.iter();
    let above = facts.pieces[level + 1].terms.iter();
    let ends = below.map(|term| (term.of, term.upper));
    let ends = ends.chain(above.map(|term| (term.of, term.lower)));
    ends.into_iter()
        .any(|(of, end)| of == Quantity::ByGap && end.value(arguments) < 0.0)
}
