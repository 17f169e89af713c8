//! Generated against interpreted laws, on the same samples: `cargo bench -p hertzian --bench kernels`.
//!
//! The samples are one period of an orbit that crosses the levels, in order, as the runtime asks for them. Both
//! contenders run in turns, so that a change of the processor's frequency meets both alike; medians are compared.

use std::hint::black_box;
use std::time::Instant;

use hertzian::generic::Interpreted;
use hertzian::law::{Derivatives, Law, On};
use hertzian::oscillator;
use hertzian::system::{Place, System};

const SAMPLES: usize = 1024;
/// Turns of each contender; the median is taken over them.
const TURNS: usize = 301;
/// Calls per turn, so that a turn is long compared with the resolution of the clock.
const CALLS: usize = 16;

oscillator! {
    /// One-sided Hertz contact with damping.
    Hertz(x) {
        /// damping ratio
        param zeta in 0.0..;

        /// gap > 0 is penetration
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap^1.5,
            else    => 0,
        }

        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
    }
}

oscillator! {
    /// A power of either sign, its exponent a parameter.
    Continuous(x) {
        /// exponent
        param alpha > 0;

        ddot(x) + 0.064*dot(x) + sgn(x)*|x|^alpha = 0.1*cos(omega*t);
    }
}

oscillator! {
    /// Backlash: no force within the play.
    Backlash(x) {
        /// half of the play
        param play > 0;

        /// gap beyond the play on either side
        law teeth(gap) {
            gap > play  => gap - play,
            gap < -play => gap + play,
            else        => 0,
        }

        ddot(x) + 0.064*dot(x) + teeth(x) = 0.1*cos(omega*t);
    }
}

/// What is asked of a law.
#[derive(Clone, Copy)]
enum Call {
    Force,
    Derivatives,
    ByArgument,
}

/// One period of an orbit and room for results.
struct Batch {
    arguments: Vec<f64>,
    gap: Vec<f64>,
    rate: Vec<f64>,
    out: [Vec<f64>; 4],
}

fn main() {
    let models: [(&str, &dyn System); 3] = [
        ("Hertz, exponent 3/2, damped", &Hertz { zeta: 0.032 }),
        ("power, exponent a parameter", &Continuous { alpha: 1.7 }),
        ("backlash", &Backlash { play: 0.3 }),
    ];
    println!("nanoseconds per sample, medians of {TURNS} turns, {SAMPLES} samples");
    println!(
        "{:<30}{:<32}{:>10}{:>13}{:>8}",
        "law", "call", "generated", "interpreted", "ratio"
    );
    for (name, system) in models {
        let interpreted = Interpreted::of(system);
        let laws = [system.law(0), interpreted.law(0)];
        let mut batch = Batch::new(system);
        for (call, what) in [
            (Call::Force, "force"),
            (Call::Derivatives, "force, by gap, by rate"),
            (Call::ByArgument, "the same and by an argument"),
        ] {
            let [generated, interpreted] = compare(laws, call, &mut batch);
            let ratio = interpreted / generated;
            println!("{name:<30}{what:<32}{generated:>10.2}{interpreted:>13.2}{ratio:>8.1}");
        }
    }
}

/// Median times per sample in nanoseconds.
fn compare(laws: [&dyn Law; 2], call: Call, batch: &mut Batch) -> [f64; 2] {
    let mut times = [const { Vec::new() }; 2];
    for _ in 0..TURNS {
        for (law, times) in laws.iter().zip(&mut times) {
            let start = Instant::now();
            for _ in 0..CALLS {
                batch.evaluate(*law, call);
            }
            times.push(start.elapsed().as_secs_f64());
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        1e9 * times[TURNS / 2] / (CALLS * SAMPLES) as f64
    })
}

impl Batch {
    fn new(system: &dyn System) -> Self {
        let phase = |i: usize| std::f64::consts::TAU * i as f64 / SAMPLES as f64;
        let gap = |tau: f64| 0.3 + 1.1 * tau.cos() + 0.2 * (2.0 * tau).sin();
        let rate = |tau: f64| -1.1 * tau.sin() + 0.4 * (2.0 * tau).cos();
        Self {
            arguments: arguments(system),
            gap: (0..SAMPLES).map(phase).map(gap).collect(),
            rate: (0..SAMPLES).map(phase).map(rate).collect(),
            out: std::array::from_fn(|_| vec![0.0; SAMPLES]),
        }
    }

    fn evaluate(&mut self, law: &dyn Law, call: Call) {
        let (gap, rate) = (black_box(&self.gap), black_box(&self.rate));
        let arguments = black_box(&self.arguments);
        let [force, by_gap, by_rate, by_argument] = &mut self.out;
        let on = On::AllPieces;
        if let Call::Force = call {
            law.force(on, arguments, gap, rate, force);
        } else {
            let out = Derivatives {
                force,
                by_gap,
                by_rate,
            };
            match call {
                Call::ByArgument => {
                    law.derivatives_and_by(0, on, arguments, gap, rate, out, by_argument);
                }
                _ => law.derivatives(on, arguments, gap, rate, out),
            }
        }
        black_box(&self.out);
    }
}

/// The arguments of the law of the only contact, at the values of the parameters.
fn arguments(system: &dyn System) -> Vec<f64> {
    let facts = system.facts();
    let mut parameters = vec![0.0; facts.parameters.len()];
    system.values(&mut parameters);
    let mut coefficients = vec![0.0; facts.places.len()];
    system.coefficients(&parameters, 1.0, &mut coefficients);
    let mut arguments = vec![0.0; system.law(0).facts().arguments.len()];
    for (place, value) in facts.places.iter().zip(&coefficients) {
        if let Place::Argument { index, .. } = *place {
            arguments[index] += value;
        }
    }
    arguments
}
