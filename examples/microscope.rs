//! The lever of a force microscope by its bending modes: `cargo run --release --example microscope` draws `microscope.svg`.
//!
//! ```text
//! q_n'' + r_n/Q q_n' + r_n^2 q_n + f(sum q_n - distance) = p_n y omega^2 cos(omega t),    tip = sum q_n
//! ```
//!
//! A uniform cantilever on a shaken holder over a sample that attracts it, then repels as Hertz has it: Derjaguin, Muller and Toporov (1975).
//! Modes are scaled to one at the tip, where all of a uniform beam have the same mass. Lengths are in nanometres, forces in those that bend
//! the first mode by one, time in units of its resonance. What one mode leaves out, Rodriguez and Garcia (2002): the tap of the tip rings in
//! the second mode near six times the frequency. To make it your own, take frequencies, qualities and values at the tip from a calibration.

use hertzian::chart::{Page, View};
use hertzian::structure::{Contact, DMatrix, Structure, parameter};
use hertzian::{Error, FrequencyResponse, Shooting};

hertzian::law! {
    /// Sample
    Sample(gap, contact, attraction, spacing > 0) {
        gap > 0 => contact*gap^1.5 - attraction/spacing^2,
        else    => -attraction*(spacing - gap)^-2,
    }
}

/// Of the first three modes: frequency over the first one, and by how much the holder shakes them, both from the roots of `cos b cosh b = -1`.
pub(crate) const RATIOS: [f64; 3] = [1.0, 6.266_893, 17.547_482];
pub(crate) const SHAKEN: [f64; 3] = [1.565_984, -0.867_872, 0.508_851];
pub(crate) const QUALITY: f64 = 400.0;

/// A lever of so many modes.
pub(crate) fn lever(modes: usize) -> Result<Structure, Error> {
    let diagonal = |of: &dyn Fn(f64) -> f64| {
        let entry = |i: usize, j: usize| if i == j { of(RATIOS[i]) } else { 0.0 };
        DMatrix::from_fn(modes, modes, entry)
    };
    let (mass, damping) = (diagonal(&|_| 1.0), diagonal(&|ratio| ratio / QUALITY));
    let sample = Contact::new(Sample)
        .arguments([0.1, 0.004, 0.165])
        .direction(vec![1.0; modes])
        .offset(parameter("distance", 8.0));
    let mut lever = Structure::of(&mass, &damping, &diagonal(&|ratio| ratio * ratio))
        .name(["one mode", "two modes", "three modes"][modes - 1])
        .contact(sample)
        .output("tip", vec![1.0; modes])
        .unit("nm");
    for (mode, shaken) in SHAKEN.into_iter().take(modes).enumerate() {
        let holder = parameter("holder", 0.016).times(shaken).times_omega(2);
        lever = lever.cosine(mode, 1, holder);
    }
    lever.build()
}

/// Traces the resonance with one mode and with three, and draws besides what rings near the second mode.
pub fn main() -> Result<(), Error> {
    let mut branches = Vec::new();
    for modes in [1, 3] {
        let request = FrequencyResponse::of(&lever(modes)?)
            .by(Shooting::new())
            .accuracy_of("tip");
        let mut branch = request.from(1.006).to(0.994).run()?;
        println!("{}:", branch.model.name);
        for event in &branch.events {
            println!("  {}", branch.describe(event));
        }
        branch.complete_all()?;
        branches.push(branch);
    }
    let view = View::new();
    let [size, ringing] = [view.clone(), view.of("tip:h6".parse()?)];
    let title = "Lever over a sample 8 nm away, holder shaken by 0.016 nm";
    let size = size.together(&branches)?.title(title);
    let ringing = ringing
        .together(&branches)?
        .title("Sixth harmonic, near the second mode");
    let x = "excitation frequency / first resonance";
    let page = Page::new(1).chart(size.x(x)).chart(ringing.x(x));
    Ok(page.write("microscope.svg")?)
}
