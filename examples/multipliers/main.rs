//! Errors and times of the methods for multipliers, as a table and two pictures: `multipliers --help`.

use std::process::ExitCode;

fn main() -> ExitCode {
    hertzian_examples::multipliers::main()
}
