//! Generated laws beside what a person would write instead: `cargo bench -p hertzian --bench kernels`.
//!
//! One core, 1024 samples: one period of an orbit that crosses the levels, in order, evaluated on all pieces by selection.
//! The contenders of a law run in turns, so that a change of the processor's frequency meets all alike; medians are
//! compared. The generated code chooses its instruction set once per process, so this program starts itself once for
//! each set, in turns as well, and collects the times.
//!
//! What is aimed at, for force, derivatives by gap and rate, and by the exponent where it is an argument:
//!
//! - exponent 3/2: at most 1.10 times the best loop written by hand for the same instruction set (`by_hand`);
//! - exponent an argument: six times faster than a loop with `powf`, six times faster than dual numbers (`scalar`), and four
//!   times faster than the interpreter.

mod by_hand;
mod contenders;
#[path = "../shared/dual.rs"]
mod dual;
mod laws;
#[cfg(target_arch = "x86_64")]
mod newton;
#[path = "../shared/processor.rs"]
mod processor;
mod report;
mod samples;
mod scalar;

use std::collections::BTreeMap;
use std::process::Command;

use contenders::Times;
use processor::Instructions;

/// How often a process is started for each instruction set.
const ROUNDS: usize = 5;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    if let [_, role, name] = arguments.as_slice()
        && role == "child"
    {
        let instructions = Instructions::all().into_iter().find(|i| i.name() == name);
        contenders::run(instructions.expect("a name of `Instructions`"));
        return;
    }
    let mut times = BTreeMap::<_, Times>::new();
    for _ in 0..ROUNDS {
        for instructions in Instructions::present() {
            let times = times.entry(instructions).or_default();
            times.read(&child(instructions));
        }
    }
    report::print(&times);
}

/// What a process prints that is bound to one instruction set.
fn child(instructions: Instructions) -> String {
    let program = std::env::current_exe().expect("the path of this program");
    let output = Command::new(program)
        .args(["child", instructions.name()])
        .env("HERTZIAN_INSTRUCTIONS", instructions.name())
        .output()
        .expect("a process of this program");
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{complaint}");
    String::from_utf8(output.stdout).expect("names and numbers")
}
