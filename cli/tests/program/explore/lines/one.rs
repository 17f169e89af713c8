hertzian::oscillator! {
    /// A cubic spring with an elastic Hertz stop on one side.
    CubicWithStop(x) {
        /// damping ratio
        param zeta = 0.02 in 0.0..;
        /// stiffness of the stop
        param stop = 5 in 0.0..;
        /// distance of the stop
        param distance = 0.8 in 0.0..;
        /// excitation amplitude
        param drive = 0.1;

        law hertz(gap) { gap > 0 => stop*gap^1.5, else => 0 }

        ddot(x) + 2*zeta*dot(x) + x + 0.3*x^3 + hertz(x - distance) = drive*cos(omega*t);
    }
}

fn main() -> Result<(), hertzian::Error> {
    let model = CubicWithStop {
        zeta: 0.02,
        stop: 5.0,
        distance: 0.8,
        drive: 0.01,
    };
    let request = hertzian::FrequencyResponse::of(&model)
        .vary("drive")
        .omega(0.9)
        .from(0.01)
        .to(0.3)
        .by(hertzian::HarmonicBalance::new());
    let branch = request.run()?;
    for event in &branch.events {
        println!("{}", branch.describe(event));
    }
    branch.plot("response.svg")
}
