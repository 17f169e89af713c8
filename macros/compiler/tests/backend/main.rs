//! From checked models to code: expressions, derivatives, facts and what is emitted.

mod dag;
mod derivatives;
mod emit;
mod facts;
mod models;
