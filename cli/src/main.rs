//! The program `hertzian`: `hertzian --help` lists what it does.

use std::process::ExitCode;

fn main() -> ExitCode {
    hertzian_cli::command::main()
}
