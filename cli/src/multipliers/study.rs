//! Oscillators whose multipliers are known, and what every method makes of them.

use std::ops::ControlFlow;
use std::time::Duration;

use hertzian::stability::Method;
use hertzian::{Branch, Complex, Error, FrequencyResponse, Point, Shooting, System};

hertzian::oscillator! {
    /// Contact on one side with a linear spring.
    Linear(x) {
        param drive;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

hertzian::oscillator! {
    /// Contact of two spheres.
    Hertz(x) {
        param drive;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

hertzian::oscillator! {
    /// A spring on both sides.
    Continuous(x) {
        param alpha > 0;
        param drive;
        ddot(x) + 0.064*dot(x) + sgn(x)*|x|^alpha = drive*cos(omega*t) + 1;
    }
}

/// An oscillator and the frequency of an orbit; damping ratio 0.032, load 1.
pub struct Oscillator {
    /// What the table calls it.
    pub name: &'static str,
    system: Box<dyn System>,
    drive: f64,
    omega: f64,
}

/// A method on an orbit of some harmonics.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The method.
    pub method: Method,
    /// Harmonics per period of the excitation.
    pub harmonics: usize,
    /// Largest error of a multiplier of the orbit as it is.
    pub error: f64,
    /// The same for the orbit corrected for what its harmonics leave out.
    pub corrected: f64,
    /// What is stated for the corrected orbit.
    pub estimate: f64,
    /// Least time of the method, for the orbit and the corrected one.
    pub microseconds: f64,
}

/// The methods that are compared, and what `work-precision` calls them.
pub const METHODS: [(Method, &str); 7] = [
    (Method::Default, "monodromy, as many steps as needed"),
    (Method::Monodromy, "monodromy, to 1e-10"),
    (Method::Hill, "Hill, symmetry"),
    (Method::HillWeightedMean, "Hill, weighted mean"),
    (Method::HillImaginaryPart, "Hill, imaginary part"),
    (Method::KoopmanHill, "Koopman-Hill, direct"),
    (Method::KoopmanHillSubharmonic, "Koopman-Hill, subharmonic"),
];
/// Times below the limit are the least of so many.
const TURNS: usize = 5;
const LONG: Duration = Duration::from_millis(20);
/// The exact orbit: tolerance of the flow.
const EXACT: f64 = 1e-12;
/// Harmonics between which the decay of coefficients is fitted.
const FIT: [usize; 2] = [20, 100];
/// Errors below this are rounding, and tell no order.
const ROUNDING: f64 = 1e-11;

/// Contact that is lost, and springs whose stiffness vanishes or is unbounded where they change their sign.
pub fn oscillators() -> Vec<Oscillator> {
    let drive = 1.0;
    let of = |name, system, omega| Oscillator {
        name,
        system,
        drive,
        omega,
    };
    let continuous = |alpha| Box::new(Continuous { alpha, drive });
    vec![
        of("one-sided, exponent 1", Box::new(Linear { drive }), 1.0),
        of("one-sided, exponent 3/2", Box::new(Hertz { drive }), 0.8),
        of("continuous, exponent 3/2", continuous(1.5), 0.8),
        of("continuous, exponent 0.6", continuous(0.6), 0.7),
    ]
}

impl Oscillator {
    /// Its first orbit with some harmonics, as a branch of one point.
    fn branch(&self, harmonics: usize) -> Result<Branch, Error> {
        FrequencyResponse::of(self.system.as_ref())
            .vary("drive")
            .omega(self.omega)
            .from(self.drive)
            .to(1.01 * self.drive)
            .harmonics(harmonics)
            .tolerance(1e-10)
            .stability(false)
            .run_with(|_| ControlFlow::Break(()))
    }

    fn exact(&self, near: &Branch) -> Result<Point, Error> {
        FrequencyResponse::of(self.system.as_ref())
            .by(Shooting::new().tolerance(EXACT))
            .near_orbit(&near.points[0].orbit)
            .orbit(self.omega)
    }
}

/// Every method with every number of harmonics.
///
/// # Errors
/// If an orbit is not found.
pub fn measure(oscillator: &Oscillator, harmonics: &[usize]) -> Result<Vec<Measured>, Error> {
    let mut measured = Vec::new();
    for &harmonics in harmonics {
        let branch = oscillator.branch(harmonics)?;
        let exact = oscillator.exact(&branch)?.stability.multipliers;
        for (method, _) in METHODS {
            let answer = branch.multipliers(&branch.points[0], method)?;
            let mut least = answer.elapsed;
            for _ in 0..TURNS {
                // What takes long is as well timed once.
                if least < LONG {
                    let again = branch.multipliers(&branch.points[0], method)?;
                    least = least.min(again.elapsed);
                }
            }
            measured.push(Measured {
                method,
                harmonics,
                error: distance(&answer.uncorrected, &exact),
                corrected: distance(&answer.stability.multipliers, &exact),
                estimate: answer.stability.error,
                microseconds: 1e6 * least.as_secs_f64(),
            });
        }
    }
    Ok(measured)
}

/// Largest error of two multipliers, each with its nearest; infinite if there are none.
fn distance(found: &[Complex<f64>], exact: &[Complex<f64>]) -> f64 {
    let ([a, b], [c, d]) = (found, exact) else {
        return f64::INFINITY;
    };
    let apart = |first: f64, second: f64| first.max(second);
    let straight = apart((a - c).norm(), (b - d).norm());
    straight.min(apart((a - d).norm(), (b - c).norm()))
}

/// The power of `k` with which the coefficients of the displacement fall, fitted by least squares to the logarithms.
///
/// # Errors
/// If the orbit is not found.
pub fn decay(oscillator: &Oscillator) -> Result<f64, Error> {
    let branch = oscillator.branch(FIT[1] + 50)?;
    let series = branch.points[0].orbit.series(0).unwrap_or_default();
    let points = (FIT[0]..=FIT[1]).map(|k| {
        let size = series[2 * k - 1].hypot(series[2 * k]);
        [(k as f64).ln(), size.ln()]
    });
    Ok(slope(&points.collect::<Vec<_>>()))
}

/// The order of every method: the negative slope of its errors in the logarithms.
pub fn orders(measured: &[Measured]) -> Vec<(Method, f64)> {
    let of = |method: Method| {
        let errors = measured.iter().filter(|m| m.method == method);
        let points = errors
            .filter(|m| m.error.is_finite() && m.error > ROUNDING)
            .map(|m| [(m.harmonics as f64).ln(), m.error.ln()]);
        (method, -slope(&points.collect::<Vec<_>>()))
    };
    METHODS.map(|(method, _)| of(method)).to_vec()
}

/// Slope of a line by least squares.
fn slope(points: &[[f64; 2]]) -> f64 {
    let count = points.len() as f64;
    let mean = |index: usize| points.iter().map(|p| p[index]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let products = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum::<f64>();
    products / points.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>()
}
