hertzian::oscillator! {
    /// Contact that can be lost: force and damping act for x > 0 only.
    OneSided(x) {
        /// exponent of the contact force
        param alpha = 1.5 > 0;
        /// damping ratio
        param zeta = 0.032 in 0.0..;
        /// normal load W
        param load = 1;
        /// excitation amplitude A
        param drive = 0.1;

        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap^alpha,
            else    => 0,
        }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

fn main() -> Result<(), hertzian::Error> {
    let model = OneSided {
        alpha: 1.0,
        zeta: 0.032,
        load: 1.0,
        drive: 1.0,
    };
    let request = hertzian::FrequencyResponse::of(&model)
        .vary("drive")
        .omega(1.0)
        .from(1.0)
        .to(1.6)
        .by(hertzian::Shooting::new());
    let patience = request.transient_periods()?;
    let settling = hertzian::bifurcation::Settling::new().patience(patience);
    let request = hertzian::Bifurcations::starting_with(request)
        .max_points(50_000)
        .depth(1)
        .cover(settling);
    let diagram = request.run()?;
    for found in &diagram.branches {
        for event in &found.branch.events {
            println!("{}", found.branch.describe(event));
        }
    }
    diagram.plot("response.svg")
}
