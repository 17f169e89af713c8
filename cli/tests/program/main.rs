//! The program: its subcommands, what they accept, write and refuse. One binary, so that its parts are linked once and run beside each other.

mod attractors;
mod cancels;
mod commands;
mod drawn_again;
#[cfg(feature = "explore")]
mod explore;
mod files;
mod fit;
mod folder;
mod kept;
mod multipliers;
mod paper;
mod pictures;
mod planes;
mod readme;
mod refusals;
mod response;
mod study;
mod tasks;
mod work_precision;
