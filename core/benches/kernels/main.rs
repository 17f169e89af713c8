//! Generated laws beside what a person would write instead: `cargo bench -p hertzian --bench kernels`.
//!
//! One core, 1024 samples: one period of an orbit that crosses the levels, in order, evaluated on all pieces by selection.
//! The contenders of a law run in turns, so that a change of the processor's frequency meets all alike; medians are compared. Each
//! instruction set that the processor has is a process of its own, since generated laws have one in a process.
//!
//! Compared are force, derivatives by gap and rate, and by the exponent where it is an argument:
//!
//! - exponent 3/2: with the best loop written by hand for the same instruction set (`by_hand`, `newton`);
//! - exponent an argument: with a loop that calls `powf`, with dual numbers (`scalar`), and with the interpreter.

mod by_hand;
mod contenders;
#[path = "../shared/dual.rs"]
mod dual;
mod laws;
#[cfg(target_arch = "x86_64")]
mod newton;
#[path = "../shared/processor.rs"]
mod processor;
mod race;
mod report;
mod samples;
mod scalar;

fn main() {
    if std::env::var_os(race::CHILD).is_some() {
        race::run_and_write();
    } else {
        report::print(&race::run_all());
    }
}
