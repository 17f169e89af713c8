//! The contact equation as the engine of branches sees it ([`method`]): test functions ([`test_values`]), whether an orbit is kept
//! ([`accept_orbit`]), other equations that the walk goes on with ([`prepare_equations`], [`change_equations`]), events located again with
//! more nodes ([`events`]) and the tangents there ([`event_tangent`]), extremes of gaps and crossings that hardly are any ([`gap_extremes`],
//! [`slowest_crossing`]), orbits whose switches have another order ([`switch_order`]), those in narrow places of laws ([`narrow_places`]),
//! where the first orbit is in other equations ([`first_orbit`]), whether the walk has come back to it ([`closed_states`]), and what a branch
//! goes on from ([`resume_state`]).

pub(super) mod accept_orbit;
mod change_equations;
mod closed_states;
mod event_tangent;
pub(super) mod events;
mod first_orbit;
pub(super) mod gap_extremes;
pub(super) mod method;
mod narrow_places;
mod prepare_equations;
pub(super) mod resume_state;
pub(super) mod slowest_crossing;
pub(super) mod switch_order;
mod test_values;
