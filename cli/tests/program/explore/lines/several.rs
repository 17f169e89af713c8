hertzian::oscillator! {
    /// Two masses of which the first meets a stop.
    TwoMasses(x, y) {
        /// stiffness of the spring between the masses
        param coupling = 0.5 in 0.0..;
        /// damping ratio
        param zeta = 0.01 in 0.0..;
        /// stiffness of the stop
        param stop = 3 in 0.0..;
        /// way to the stop
        param distance = 1 > 0;
        /// excitation of the first mass
        param drive = 0.1;

        law wall(gap) { gap > 0 => stop*gap, else => 0 }

        ddot(x) + 2*zeta*dot(x) + x + coupling*(x - y) + wall(x - distance) = drive*cos(omega*t);
        ddot(y) + 2*zeta*dot(y) + y + coupling*(y - x) = 0;
    }
}

fn main() -> Result<(), hertzian::Error> {
    let model = TwoMasses {
        coupling: 0.5,
        zeta: 0.01,
        stop: 3.0,
        distance: 1.0,
        drive: 0.2,
    };
    let request = hertzian::FrequencyResponse::of(&model)
        .from(0.8)
        .to(1.2)
        .by(hertzian::ContactEquation::new());
    let patience = request.transient_periods()?;
    let settling = hertzian::bifurcation::Settling::new().patience(patience);
    let request = hertzian::Bifurcations::starting_with(request)
        .depth(0)
        .margin(0.0)
        .cover(settling);
    let diagram = request.run()?;
    for found in &diagram.branches {
        for event in &found.branch.events {
            println!("{}", found.branch.describe(event));
        }
    }
    diagram.plot("response.svg")
}
