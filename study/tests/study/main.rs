//! Studies: their variants, their rows, and what is kept.

mod common;
mod forms;
mod kept;
mod rows;
mod uncertainty;
mod variants;
