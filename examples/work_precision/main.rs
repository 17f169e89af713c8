//! `cargo run --release --example work_precision -- --out DIR`: see [`hertzian_examples::work_precision`].

use std::process::ExitCode;

fn main() -> ExitCode {
    hertzian_examples::work_precision::main()
}
