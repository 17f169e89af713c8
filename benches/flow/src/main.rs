//! Motions of a one-sided spring, by the flow of hertzian and by general integrators: `cargo run --release` in this folder.
//!
//! Wang et al. (2021), Eq. (1), one-sided, with damping ratio 0.032, load 1 and frequency 1, over four periods with several losses
//! of contact, for the exponents 1, 3/2 and 0.6. Contenders, each over a range of tolerances:
//!
//! - `exact`: the closed form, for the exponent 1;
//! - `integrated`: collocation from switch to switch, on generated code;
//! - `diffsol`: its explicit method of the highest order, Tsitouras 5(4), with the event detection of the crate;
//! - `DOP853`: Dormand and Prince 8(5,3) of `differential-equations`, which is brought to events by Newton's method here.
//!
//! The libraries get the force of the piece as plain code, and are started again at every event, on the piece behind it. Errors are of the last state, against the closed form or, for
//! the other exponents, the integrated flow at its finest tolerance, which the tests of hertzian compare with values computed
//! elsewhere. All run in turns, so that a change of the processor's frequency meets all alike; medians are compared.

mod libraries;

use std::error::Error;
use std::f64::consts::TAU;
use std::time::Instant;

use hertzian::System;
use hertzian::time::affine::Affine;
use hertzian::time::{Flow, Integrated};
use libraries::Force;

/// Turns of each contender; the median is taken over them.
const TURNS: usize = 31;
/// Periods of the motion, and its first state.
pub const PERIODS: usize = 4;
pub const START: [f64; 2] = [1.2, 0.4];
/// The excitation.
pub const DRIVE: f64 = 1.0;
/// Errors at which times are compared.
const ERRORS: [f64; 3] = [1e-4, 1e-7, 1e-10];

macro_rules! one_sided {
    ($name:ident, $power:literal) => {
        hertzian::oscillator! {
            $name(x) {
                param zeta >= 0;
                param load;
                param drive;
                law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^$power, else => 0 }
                ddot(x) + contact(x) = drive*cos(omega*t) + load;
            }
        }
    };
}

one_sided!(Linear, 1);
one_sided!(Hertz, 1.5);
one_sided!(Soft, 0.6);

/// What is compared: it moves a state over all periods.
type Motion<'m> = Box<dyn FnMut(&mut [f64; 2]) -> Result<(), Box<dyn Error>> + 'm>;

/// A contender at one tolerance.
struct Contender<'m> {
    name: &'static str,
    tolerance: f64,
    motion: Motion<'m>,
    times: Vec<f64>,
    error: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let (zeta, load, drive) = (libraries::ZETA, libraries::LOAD, DRIVE);
    compare(&Linear { zeta, load, drive }, Force::Linear)?;
    compare(&Hertz { zeta, load, drive }, Force::Hertz)?;
    compare(&Soft { zeta, load, drive }, Force::Soft)
}

fn compare(model: &dyn System, force: Force) -> Result<(), Box<dyn Error>> {
    let values = [libraries::ZETA, libraries::LOAD, DRIVE];
    let mut contenders = Vec::new();
    if let Ok(flow) = Affine::new(model, &values, 1.0) {
        contenders.push(Contender::new("exact", 0.0, moved(flow)));
    }
    for exponent in 3..=13 {
        let tolerance = 10_f64.powi(-exponent);
        let integrated = Integrated::new(model, &values, 1.0, tolerance)?;
        let diffsol = move |state: &mut [f64; 2]| libraries::diffsol(force, tolerance, state);
        let dop853 = move |state: &mut [f64; 2]| libraries::dop853(force, tolerance, state);
        contenders.extend([
            Contender::new("integrated", tolerance, moved(integrated)),
            Contender::new("diffsol", tolerance, Box::new(diffsol)),
            Contender::new("DOP853", tolerance, Box::new(dop853)),
        ]);
    }
    let mut exact = START;
    match contenders[0].tolerance {
        0.0 => (contenders[0].motion)(&mut exact)?,
        _ => moved(Integrated::new(model, &values, 1.0, 1e-14)?)(&mut exact)?,
    }
    for _ in 0..TURNS {
        for contender in &mut contenders {
            contender.turn(exact)?;
        }
    }
    println!("{force:?}");
    println!("contender    tolerance     error  microseconds a period");
    for contender in &mut contenders {
        contender.times.sort_by(f64::total_cmp);
        let time = contender.times[TURNS / 2];
        contender.times = vec![time];
        println!(
            "{:<12}{:>10.0e}{:>10.1e}{time:>12.2}",
            contender.name, contender.tolerance, contender.error
        );
    }
    println!("microseconds a period for an error below");
    for name in ["exact", "integrated", "diffsol", "DOP853"] {
        let fastest = ERRORS.map(|error| {
            let mut best = f64::NAN;
            for one in contenders
                .iter()
                .filter(|one| one.name == name && one.error <= error)
            {
                best = best.min(one.times[0]);
            }
            format!("{best:>8.2} ({error:.0e})")
        });
        println!("{name:<12}{}", fastest.join(""));
    }
    Ok(())
}

/// All periods, with a flow.
fn moved<'m>(mut flow: impl Flow + 'm) -> Motion<'m> {
    Box::new(move |state| {
        for _ in 0..PERIODS {
            flow.advance(0.0, TAU, state, None, None)?;
        }
        Ok(())
    })
}

impl<'m> Contender<'m> {
    fn new(name: &'static str, tolerance: f64, motion: Motion<'m>) -> Self {
        Self {
            name,
            tolerance,
            motion,
            times: Vec::new(),
            error: f64::NAN,
        }
    }

    fn turn(&mut self, exact: [f64; 2]) -> Result<(), Box<dyn Error>> {
        let mut state = START;
        let from = Instant::now();
        (self.motion)(&mut state)?;
        self.times
            .push(from.elapsed().as_secs_f64() * 1e6 / PERIODS as f64);
        self.error = (state[0] - exact[0]).hypot(state[1] - exact[1]);
        Ok(())
    }
}
