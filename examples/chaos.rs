//! A chaotic motion and its Lyapunov exponents: `cargo run --release --example chaos` draws `chaos.svg`.
//!
//! The state of a mass on a contact that opens, once in each period of the excitation. Neighbouring motions part at the rate of the largest
//! exponent; a positive one is chaos. Figure 11 of Wang, Zhang, Ying and Pang (2021), Appl. Sci. 11, 7722. To make it your own, change
//! the equation, the start, and the phase at which states are looked at.

use hertzian::attractors::lyapunov::Lyapunov;
use hertzian::chart::{Chart, Series};
use hertzian::time::stroboscope::Stroboscope;

hertzian::oscillator! {
    /// Contact that opens
    pub OneSided(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// load
        param load;
        /// excitation amplitude
        param drive;

        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap,
            else    => 0,
        }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

/// Follows the motion: first for the picture, then for the exponents.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = OneSided {
        zeta: 0.032,
        load: 1.0,
        drive: 1.785,
    };
    let mut map = Stroboscope::of(&model, 1.0)?;
    let mut state = [-0.35, 0.335];
    for _ in 0..1000 {
        map.map(&mut state)?;
    }
    let mut points = Vec::new();
    for _ in 0..20_000 {
        map.map(&mut state)?;
        points.push(state);
    }

    // Means over batches of periods, and how far they scatter.
    let mut motion = Lyapunov::new(&mut map, &state);
    for _ in 0..20 {
        motion.batch(2000)?;
    }
    for exponent in motion.exponents() {
        let (value, error) = (exponent.value, exponent.error);
        println!("exponent {value:.4} per period, standard error {error:.4}");
    }
    // Volumes of states shrink by damping in contact alone.
    println!("their sum {:.4}", motion.sum().value);

    Chart::new("Chaos of a contact that opens: ζ = 0.032, W = 1, A = 1.785, ω = 1")
        .x("x at the beginning of each period / static deflection")
        .y("rate of x / (static deflection × linear frequency)")
        .cloud(Series {
            label: "state, once in each of 20000 periods".to_owned(),
            points,
        })
        .write("chaos.svg")?;
    println!("written chaos.svg");
    Ok(())
}
