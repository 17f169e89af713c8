//! The contact equation as the engine of branches sees it ([`method`]): events located again with more nodes ([`events`]), extremes of gaps and
//! crossings that hardly are any ([`gap_extremes`], [`slowest_crossing`]), orbits whose switches have another order ([`ordered`]). [`guess`] has
//! where the first orbit is looked for, [`resume_state`] what a branch goes on from.

pub(super) mod events;
pub(super) mod gap_extremes;
pub(super) mod guess;
pub(super) mod method;
pub(super) mod ordered;
pub(super) mod resume_state;
pub(super) mod slowest_crossing;
