//! The stroboscopic map of a one-sided spring: `cargo bench -p hertzian --bench strobe`.
//!
//! Wang et al. (2021), Eq. (1), with exponent one, damping ratio 0.032, load 1, amplitude 1.78 and frequency 1: chaotic, with
//! about six contacts in five periods. One trajectory, each state from the one before. Contenders:
//!
//! - `exact`: the closed form, called for one period at a time;
//! - `plain C`: [`plain.c`](plain.c), compiled here by `gcc -O3 -march=native`. Long steps make it fast and let it miss short
//!   contacts; it may take the step that is fastest for it among those that are wrong for at most one state in a hundred;
//! - `integrated`: the flow that integrates any system, at a tolerance of 1e-10.
//!
//! They run in turns, so that a change of the processor's frequency meets all alike; medians are compared.

use std::error::Error;
use std::f64::consts::TAU;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

use hertzian::oscillator;
use hertzian::system::Variable;
use hertzian::time::affine::Affine;
use hertzian::time::{Flow, Integrated, Tangent};

/// Turns of each contender; the median is taken over them.
const TURNS: usize = 301;
/// Periods in a turn; of the integrated flow, fewer.
const PERIODS: usize = 2000;
const INTEGRATED_PERIODS: usize = 100;
/// Steps that plain C may choose from, and states and periods for which it is compared with the exact flow.
const STEPS: [f64; 9] = [0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.7, 1.0, 2.0];
const COMPARED: usize = 1000;
const COMPARED_PERIODS: usize = 4;
/// A state on the attractor.
const START: [f64; 2] = [-0.33, 0.33];

oscillator! {
    /// One-sided spring.
    OneSided(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// normal load
        param load;
        /// excitation amplitude
        param drive;

        /// gap > 0 is penetration
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap,
            else    => 0,
        }

        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let model = OneSided {
        zeta: 0.032,
        load: 1.0,
        drive: 1.78,
    };
    let values = [model.zeta, model.load, model.drive];
    let mut exact = Affine::new(&model, &values, 1.0)?;
    let mut integrated = Integrated::new(&model, &values, 1.0, 1e-10)?;
    let mut plain = Plain::new(&mut exact)?;

    let mut times = [const { Vec::new() }; 4];
    let mut states = [START; 4];
    for _ in 0..TURNS {
        times[0].push(timed(&mut exact, PERIODS, &mut states[0])?);
        if let Some(plain) = &mut plain {
            times[1].push(plain.run(PERIODS, plain.step, &mut states[1])?);
        }
        let time = timed(&mut integrated, INTEGRATED_PERIODS, &mut states[2])?;
        times[2].push(time);
        times[3].push(timed_with_tangent(&mut exact, &mut states[3])?);
    }
    let [exact_time, plain_time, integrated_time, with_tangent] =
        times.map(|mut times| (!times.is_empty()).then(|| median(&mut times)));
    println!("nanoseconds per period, medians of {TURNS} turns");
    let rows = [
        ("exact", exact_time),
        ("exact, with its derivatives", with_tangent),
        ("plain C", plain_time),
        ("integrated, 1e-10", integrated_time),
    ];
    for (name, time) in rows {
        let (Some(time), Some(exact)) = (time, exact_time) else {
            continue;
        };
        println!("{name:<30}{time:>10.0}{:>10.2}", exact / time);
    }
    println!(
        "a new parameter and one period {:>8.0}; with the derivative by it {:>8.0}",
        changed(&mut exact, None)?,
        changed(&mut exact, Some(Variable::Parameter(2)))?
    );
    Ok(())
}

/// Nanoseconds per period.
fn timed(flow: &mut dyn Flow, periods: usize, state: &mut [f64; 2]) -> Result<f64, Box<dyn Error>> {
    let from = Instant::now();
    for _ in 0..periods {
        flow.advance(0.0, TAU, state, None, None)?;
    }
    Ok(from.elapsed().as_secs_f64() * 1e9 / periods as f64)
}

/// The same with the derivatives by the state, from the unit matrix in every period.
fn timed_with_tangent(flow: &mut dyn Flow, state: &mut [f64; 2]) -> Result<f64, Box<dyn Error>> {
    let mut tangent = Tangent::of_state(1, None);
    let from = Instant::now();
    for _ in 0..PERIODS {
        tangent.columns.copy_from_slice(&[1.0, 0.0, 0.0, 1.0]);
        flow.advance(0.0, TAU, state, Some(&mut tangent), None)?;
    }
    Ok(from.elapsed().as_secs_f64() * 1e9 / PERIODS as f64)
}

/// Nanoseconds for a new value of a parameter and one period from a given state.
fn changed(flow: &mut dyn Flow, by: Option<Variable>) -> Result<f64, Box<dyn Error>> {
    let mut times = Vec::new();
    let mut tangent = Tangent::of_state(1, by);
    let unit = tangent.clone();
    for turn in 0..TURNS {
        let value = 1.7 + 1e-6 * turn as f64;
        let mut state = START;
        let from = Instant::now();
        flow.set(Variable::Parameter(2), value)?;
        tangent.clone_from(&unit);
        flow.advance(0.0, TAU, &mut state, by.map(|_| &mut tangent), None)?;
        times.push(from.elapsed().as_secs_f64() * 1e9);
    }
    Ok(median(&mut times))
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// The program in C, waiting for work.
struct Plain {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    step: f64,
}

impl Plain {
    /// Compiles and starts it, and chooses its step. `None` without `gcc`.
    fn new(exact: &mut dyn Flow) -> Result<Option<Self>, Box<dyn Error>> {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/strobe/plain.c");
        let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("strobe_plain");
        let compiled = Command::new("gcc")
            .args(["-O3", "-march=native", "-o"])
            .args([&program, &source])
            .arg("-lm")
            .status();
        if !compiled.is_ok_and(|status| status.success()) {
            println!("without gcc there is no plain C to compare with");
            return Ok(None);
        }
        let mut child = Command::new(&program)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let to = child.stdin.take().ok_or("no input")?;
        let from = BufReader::new(child.stdout.take().ok_or("no output")?);
        let mut plain = Self {
            child,
            to,
            from,
            step: STEPS[0],
        };
        let mut fastest = f64::INFINITY;
        for step in STEPS {
            let wrong = plain.wrong(step, exact)?;
            if wrong > 0.01 {
                continue;
            }
            let mut times = Vec::new();
            for _ in 0..TURNS {
                times.push(plain.run(PERIODS / 4, step, &mut START.clone())?);
            }
            let time = median(&mut times);
            println!("plain C, step {step:<5}{time:>10.0}, wrong for {wrong:.3} of the states");
            if time < fastest {
                (fastest, plain.step) = (time, step);
            }
        }
        Ok(Some(plain))
    }

    /// Runs some periods; nanoseconds per period.
    fn run(
        &mut self,
        periods: usize,
        step: f64,
        state: &mut [f64; 2],
    ) -> Result<f64, Box<dyn Error>> {
        let [x, v] = *state;
        writeln!(self.to, "{periods} {step} {x:e} {v:e}")?;
        self.to.flush()?;
        let mut line = String::new();
        self.from.read_line(&mut line)?;
        let numbers = line.split_whitespace().map(str::parse::<f64>);
        let numbers = numbers.collect::<Result<Vec<_>, _>>()?;
        let [time, x, v] = numbers[..] else {
            return Err("the answer is not three numbers".into());
        };
        *state = [x, v];
        Ok(time / periods as f64)
    }

    /// The share of states of a trajectory from which it does not go where the exact flow goes.
    fn wrong(&mut self, step: f64, exact: &mut dyn Flow) -> Result<f64, Box<dyn Error>> {
        let mut start = START;
        let mut wrong = 0;
        for _ in 0..COMPARED {
            let (mut a, mut b) = (start, start);
            self.run(COMPARED_PERIODS, step, &mut a)?;
            exact.advance(0.0, COMPARED_PERIODS as f64 * TAU, &mut b, None, None)?;
            let distance = (a[0] - b[0]).abs() + (a[1] - b[1]).abs();
            wrong += usize::from(distance > 1e-10);
            start = b;
        }
        Ok(wrong as f64 / COMPARED as f64)
    }
}

impl Drop for Plain {
    fn drop(&mut self) {
        // It ends with its input; if it has ended already there is nothing to do.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
