//! Collocation on one stretch in contact: Gauss nodes and the integrals of polynomials through forces at them ([`nodes`]), graded where the
//! force has an exponent that is not whole ([`grading`]), up to places between nodes too ([`partway`]). Nothing here knows an orbit.

pub(super) mod grading;
pub(super) mod nodes;
pub(super) mod partway;
