//! `cargo run --release --example paper -- --out DIR`: see [`hertzian_examples::paper`].

use std::process::ExitCode;

fn main() -> ExitCode {
    hertzian_examples::paper::main()
}
