//! Structures from files and their reduction, against closed forms and dense matrices.

mod backbone;
mod common;
mod events;
mod files;
mod multipliers;
mod outputs;
mod random;
mod reduction;
mod reference;
mod turning;
