//! Branches of orbits by harmonic balance, as the [engine](crate::branches::engine) follows them.

pub(crate) mod branch_switch;
pub(crate) mod check;
pub(crate) mod context;
pub(crate) mod motion;
pub(crate) mod options;
mod output_error;
pub(crate) mod point_evaluator;
pub(crate) mod run;
