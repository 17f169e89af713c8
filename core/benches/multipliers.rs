//! What multipliers cost: `cargo bench -p hertzian --bench multipliers`.
//!
//! The curves of Fig. 5a and 5b of Wang et al. (2021), one-sided contact with exponents 1 and 3/2, damping ratio 0.032, load 1,
//! drive 0.1, omega from 0.6 to 1.4, at 10 harmonics: the share of the multipliers in the whole curve, both curves in turns.

use std::time::Instant;

use hertzian::{FrequencyResponse, System, oscillator};

oscillator! {
    /// One-sided contact with a linear spring.
    Linear(x) {
        param zeta in 0.0..;
        param load;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

oscillator! {
    /// One-sided contact of two spheres.
    Hertz(x) {
        param zeta in 0.0..;
        param load;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

const TURNS: usize = 201;

/// Least and median.
fn typical(times: &mut [f64]) -> [f64; 2] {
    times.sort_by(f64::total_cmp);
    [times[0], times[times.len() / 2]]
}

/// Times with and without multipliers in turns. On a machine that does other things the least of them tells most.
fn share(name: &str, system: &dyn System) {
    let with = FrequencyResponse::of(system)
        .from(0.6)
        .to(1.4)
        .harmonics(10);
    let without = with.clone().stability(false);
    let mut times = [Vec::new(), Vec::new()];
    let mut points = [0; 2];
    for _ in 0..TURNS {
        for (index, request) in [&with, &without].into_iter().enumerate() {
            let start = Instant::now();
            if let Ok(branch) = request.run() {
                times[index].push(start.elapsed().as_secs_f64());
                points[index] = branch.points.len();
            }
        }
    }
    let [with, without] = times.map(|mut times| typical(&mut times));
    for (kind, (a, b)) in ["least ", "median"]
        .into_iter()
        .zip(with.into_iter().zip(without))
    {
        println!(
            "{name} {kind}: {:.3} ms with, {:.3} ms without multipliers, {points:?} points; share {:.3}, {:.2} microseconds an orbit",
            1e3 * a,
            1e3 * b,
            1.0 - b / a,
            1e6 * (a - b) / points[0] as f64
        );
    }
}

fn main() {
    let (zeta, load, drive) = (0.032, 1.0, 0.1);
    share("alpha 1  ", &Linear { zeta, load, drive });
    share("alpha 1.5", &Hertz { zeta, load, drive });
}
