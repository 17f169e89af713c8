//! Curves of the paper against exact values: folds, the errors stated for them, and orbits in between.

mod curves;
mod direct;
mod exact;
mod folds;
mod methods;
mod models;
mod orbits;
mod peaks;
mod rates;
mod stated;
