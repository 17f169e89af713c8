//! Attractors and chaos of an oscillator with a power-law contact: `attractors --help` lists the options.

use std::process::ExitCode;

fn main() -> ExitCode {
    hertzian_examples::attractors::main()
}
