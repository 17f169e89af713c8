//! The resonance of a ball that a load presses on a plane: `cargo run --release --example response` draws `response.svg`.
//!
//! The contact opens where the ball moves away, so that the resonance leans to lower frequencies. To make it your own, change the
//! equation, its parameters and the range of frequencies. Figure 5b of Wang, Zhang, Ying and Pang (2021), Appl. Sci. 11, 7722.

use hertzian::{Branch, Error, EventKind, FrequencyResponse};

hertzian::oscillator! {
    /// Ball on a plane
    pub OneSided(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// normal load W
        param load;
        /// excitation amplitude A
        param drive;

        // A positive gap is penetration; the exponent is that of Hertz.
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap^1.5,
            else    => 0,
        }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

/// Traces the curve, says what is on it, and draws it.
pub fn main() -> Result<(), Error> {
    let model = OneSided {
        zeta: 0.032,
        load: 1.0,
        drive: 0.1,
    };
    let branch = FrequencyResponse::of(&model).from(0.6).to(1.6).run()?;
    describe(&branch);

    // Contact is lost beyond orbits that graze, whose smallest penetration is zero: they are marked.
    let chart = branch
        .chart()
        .title("Ball on a plane, force as gap^1.5: ζ = 0.032, W = 1, A = 0.1");
    chart.write("response.svg")?;
    println!("written    response.svg");
    Ok(())
}

/// What a person wants to know first: how far the branch goes, where it turns, and where it is stable.
fn describe(branch: &Branch) {
    let points = &branch.points;
    println!("{}\n", branch.model.equation);
    if let (Some(first), Some(last)) = (points.first(), points.last()) {
        let (count, from, to) = (points.len(), first.value, last.value);
        println!("points     {count}, omega from {from} to {to}");
    }
    println!("ended      {}", branch.stopped);
    if let Some(method) = branch.method() {
        println!("method     {method}");
    }
    for event in &branch.events {
        let (kind, error) = (event.kind.to_string(), event.error);
        let omega = event.point.value;
        let size = event.point.peak_to_peak();
        println!("{kind:<10} omega {omega:.9} (error {error:.0e}), peak-to-peak {size:.6}");
        if event.kind == EventKind::Fold {
            // The event lies before the point with this number.
            let verdict = |index: usize| points.get(index).map(|point| point.stability.verdict);
            let before = event.after.checked_sub(1).and_then(verdict);
            if let (Some(before), Some(after)) = (before, verdict(event.after)) {
                println!(
                    "stability  {before} before the fold at omega {omega:.6}, {after} after it"
                );
            }
        }
    }
    let milliseconds = 1e3 * branch.elapsed.as_secs_f64();
    println!("time       {milliseconds:.0} ms; {}", branch.statistics);
}
