//! The motion of an orbit at any phase ([`motion`]), and extremes of its coordinates and gaps by that ([`extremes`]). Of a motion that is given
//! otherwise, as by a series, the gaps are seen from samples ([`gaps`]). Panels end where slopes of forces jump ([`kinks`]).

mod content;
pub(super) mod extents;
pub(super) mod extremes;
mod fast;
mod forced;
pub(super) mod gaps;
mod grid;
pub(super) mod kinks;
mod layers;
pub(super) mod motion;
mod pieces;
pub(super) mod positions;
mod search;
pub(super) mod signal;
mod sums;
