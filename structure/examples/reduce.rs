//! Reduces a structure that a file describes, says what that changes, and keeps it.
//!
//! ```sh
//! python3 examples/structures/plate.py 400 125 /tmp/plate
//! cargo run --release -p hertzian-structure --example reduce -- /tmp/plate/plate.toml 2000 /tmp/plate/reduced.json
//! ```

use std::error::Error;
use std::time::Instant;

use hertzian_structure::{Reduction, file};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let usage = "reduce FILE.toml OMEGA [REDUCED.json]";
    let path = arguments.next().ok_or(usage)?;
    let omega: f64 = arguments.next().ok_or(usage)?.parse()?;
    let begin = Instant::now();
    let structure = file::read(path)?;
    println!(
        "{} coordinates read in {:.2} s",
        structure.coordinates(),
        begin.elapsed().as_secs_f64()
    );
    let begin = Instant::now();
    let reduced = Reduction::to(omega).run(&structure)?;
    println!(
        "{} modes and {} further vectors in {:.2} s",
        reduced.modes(),
        reduced.vectors() - reduced.modes(),
        begin.elapsed().as_secs_f64()
    );
    for frequency in reduced.frequencies() {
        println!("frequency {frequency:.6}");
    }
    for [frequency, error] in reduced.compliance_errors() {
        println!("compliance at {frequency:.1}: error {error:.1e}");
    }
    if let Some(path) = arguments.next() {
        reduced.write(path)?;
    }
    Ok(())
}
