//! Frequency response of an oscillator with a power-law contact: `response --help` lists the options.

use std::process::ExitCode;

fn main() -> ExitCode {
    hertzian_examples::response::main()
}
