//! Rules that need the lowered expressions; those on what is written are in [`check`](crate::check).

pub mod forcing;
pub mod inertia;
pub mod outputs;
pub mod pieces;
pub mod powers;
pub mod rates;
