//! Derivatives of what is read off orbits and of where folds are, against differences of shooting's own answers with a flow of 1e-13,
//! extrapolated (Richardson): what is differenced knows nothing of derivatives by parameters.

mod events;
mod folds;
mod grazing;
mod points;
mod switches;
mod units;

use hertzian::{Branch, Estimate, FrequencyResponse, Orbit, Shooting, System};

/// A function of a parameter's change, with the step of its differences.
fn richardson(h: f64, of: impl Fn(f64) -> f64) -> (f64, f64) {
    richardson_of(h, |change| [of(change)])[0]
}

/// Several functions at once.
fn richardson_of<const N: usize>(h: f64, of: impl Fn(f64) -> [f64; N]) -> [(f64, f64); N] {
    let steps = [h, 0.5 * h, 0.25 * h].map(|h| (h, of(h), of(-h)));
    std::array::from_fn(|index| {
        let [a, b, c] = steps.map(|(h, ahead, behind)| (ahead[index] - behind[index]) / (2.0 * h));
        let [ab, bc] = [(4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0];
        let last = (16.0 * bc - ab) / 15.0;
        (last, (last - bc).abs())
    })
}

hertzian::oscillator! {
    /// Contact on both sides without a load: figure 2a.
    Unloaded(x) {
        param zeta in 0.0..;
        param alpha > 0;
        param drive;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^alpha = drive*cos(omega*t);
    }
}

fn unloaded(v: &[f64]) -> Box<dyn System> {
    let [zeta, alpha, drive] = [v[0], v[1], v[2]];
    Box::new(Unloaded { zeta, alpha, drive })
}

/// Makes a system of the values of its parameters.
type Make = dyn Fn(&[f64]) -> Box<dyn System>;

/// By shooting with a flow as fine as it can be, near an orbit.
fn shot(system: &dyn System, near: &Orbit) -> FrequencyResponse<Shooting> {
    FrequencyResponse::of(system)
        .by(Shooting::new().tolerance(1e-13))
        .near_orbit(near)
}

/// Fails where a derivative differs from differences by more than a part of it, or than what both say of their errors, or than noise.
fn assert_near(
    what: &str,
    derivative: Estimate,
    (expected, error): (f64, f64),
    scale: f64,
    noise: f64,
) {
    let apart = (derivative.value - expected).abs();
    let allowed = noise + (1e-6 * expected.abs().max(1e-3 * scale)).max(derivative.error + error);
    println!(
        "{what}: {} against {expected} ({error:.0e}), apart {apart:.1e}, stated {:.1e}",
        derivative.value, derivative.error
    );
    // An error that is stated must say something.
    let largest = 1e-4 * expected.abs().max(1e-3 * scale).abs();
    assert!(
        derivative.error <= largest + noise + 2.0 * error,
        "{what}: {derivative:?} states too much of {expected}"
    );
    assert!(
        apart <= allowed,
        "{what}: {derivative:?} {expected} {error:e}"
    );
}

/// Names of the parameters of a branch.
fn names(branch: &Branch) -> Vec<String> {
    let parameters = branch.model.parameters.iter();
    parameters.map(|parameter| parameter.name.clone()).collect()
}
