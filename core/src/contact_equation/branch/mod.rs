//! The contact equation as the engine of branches sees it ([`method`]): events located again with more nodes ([`events`]), extremes of gaps and
//! crossings that hardly are any ([`gap_extremes`], [`slowest_crossing`]), orbits whose switches have another order ([`switch_order`]),
//! and what a branch goes on from ([`resume_state`]).

pub(super) mod events;
pub(super) mod gap_extremes;
pub(super) mod method;
pub(super) mod resume_state;
pub(super) mod slowest_crossing;
pub(super) mod switch_order;
