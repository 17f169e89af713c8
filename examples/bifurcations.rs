//! What becomes of a motion as its drive grows: `cargo run --release --example bifurcations` draws `bifurcations.svg`.
//!
//! A mass on a contact that opens. Its period doubles again and again; every branch that begins at a bifurcation is followed by itself.
//! Figure 8a of Wang, Zhang, Ying and Pang (2021), Appl. Sci. 11, 7722. To make it your own, change the equation, what varies, and the
//! depth to which branches are followed.

use hertzian::chart::View;
use hertzian::{Bifurcations, Error, EventKind};

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

/// Follows all branches, lists what is on them, and draws them.
pub fn main() -> Result<(), Error> {
    let model = OneSided {
        zeta: 0.032,
        load: 1.0,
        drive: 0.1,
    };
    let request = Bifurcations::of(&model).vary("drive").omega(1.0);
    let diagram = request.from(0.1).to(2.0).depth(2).run()?;
    for (number, branch) in diagram.branches.iter().enumerate() {
        let cycles = branch.branch.points.len();
        println!(
            "branch {}: period {}, {cycles} orbits, {}",
            number + 1,
            branch.period(),
            branch.branch.stopped
        );
        for event in &branch.branch.events {
            println!("  {event}");
        }
    }
    for left in &diagram.omitted {
        println!("not followed: {left}");
    }
    // Where a level is touched, and where branches cross, is among what is printed.
    let view = View::new().events([EventKind::Fold, EventKind::PeriodDoubling]);
    diagram.chart_of(&view)?.write("bifurcations.svg")?;
    println!("written bifurcations.svg");
    Ok(())
}
