//! The motion of an orbit at any phase ([`motion`]), and extremes of its coordinates and gaps by that ([`extremes`]). Of a motion that is given
//! otherwise, as by a series, the gaps are seen from samples ([`gaps`]).

pub(super) mod extremes;
pub(super) mod gaps;
pub(super) mod motion;
