//! Following a curve of solutions as one parameter varies. Knows problems, not balances.

pub(crate) mod arrow;
pub(crate) mod chain;
pub(crate) mod jacobian;
pub(crate) mod newton;
pub(crate) mod statistics;

mod closing;
pub(crate) mod crossing;
pub(crate) mod follow;
pub(crate) mod locate;
mod position;
pub mod problem;
pub(crate) mod step_control;
mod stepper;
pub(crate) mod stop;
#[cfg(test)]
mod tests;
