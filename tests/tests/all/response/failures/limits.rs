//! The edges of the range: no damping, no load, many impacts in a period, small and large exponents.

use hertzian::error::ErrorKind;
use hertzian::stability::Method;
use hertzian::{
    ContactEquation, Error, FrequencyResponse, HarmonicBalance, Point, Shooting, Stability, Stop,
    System, Verdict,
};

use super::models::{Continuous, OneSided, answer, distance, first, shown, start};

/// The first orbit at a frequency, by the balance at its defaults, and what is true of it.
fn at(system: &dyn System, omega: f64) -> (Point, Stability) {
    found(system, omega).unwrap()
}

/// The same, if there is one.
fn found(system: &dyn System, omega: f64) -> Result<(Point, Stability), Error> {
    let request = FrequencyResponse::of(system).by(HarmonicBalance::new());
    let request = request.from(omega).to(1.001 * omega);
    let point = start(&request)?.points.remove(0);
    let shooting = FrequencyResponse::of(system)
        .by(Shooting::new().tolerance(1e-11))
        .near_orbit(&point.orbit);
    let cycle = shooting.orbit(omega)?;
    Ok((point, cycle.stability))
}

/// The answer by default is true to its estimate.
fn assert_true(name: &str, found: &Stability, exact: &Stability) {
    let error = distance(&found.multipliers, &exact.multipliers);
    println!(
        "{name}: default {error:.1e}, estimate {:.1e}, {}",
        found.error, found.verdict
    );
    assert!(error < found.error + exact.error, "{found:?} {exact:?}");
    assert!(found.verdict == exact.verdict || found.verdict == Verdict::Undecided);
}

/// Largest modulus less one, and largest error, by a projection with some harmonics.
fn projected(system: &dyn System, omega: f64, harmonics: usize, exact: &Stability) -> [f64; 2] {
    let request = FrequencyResponse::of(system).from(omega).to(1.001 * omega);
    let branch = first(&request.harmonics(harmonics));
    let found = answer(&branch, Method::KoopmanHill).uncorrected;
    [found[0].norm() - 1.0, distance(&found, &exact.multipliers)]
}

/// Both multipliers are on the unit circle. Whoever compares moduli with one gets a verdict by chance.
#[test]
fn without_damping_nothing_is_decided() {
    let model = OneSided {
        zeta: 0.0,
        alpha: 1.5,
        load: 1.0,
        drive: 0.3,
    };
    let omega = 0.6;
    let (point, exact) = at(&model, omega);
    let sides = [5, 10, 20].map(|harmonics| {
        let [beyond, error] = projected(&model, omega, harmonics, &exact);
        println!(
            "projection, {harmonics} harmonics: modulus less one {beyond:.0e}, error {error:.0e}"
        );
        beyond > 0.0
    });
    assert!(sides.contains(&true) && sides.contains(&false), "{sides:?}");
    assert_true("no damping", &point.stability, &exact);
    assert_eq!(point.stability.verdict, Verdict::Undecided);
}

/// Without a load there is no stiffness at rest, or an infinite one: nothing linear to begin with. With lengths in units of
/// `s = drive^(1/alpha)` and times in units of `s^((1-alpha)/2)` all drives are one problem, and the multipliers the same.
#[test]
fn without_load_at_any_drive() {
    for alpha in [1.5_f64, 0.6] {
        let found = [1.0_f64, 1e-3, 1e-6, 1e-9].map(|drive| {
            let frequency = drive.powf(0.5 * (alpha - 1.0) / alpha);
            let model = Continuous {
                zeta: 0.05 * frequency,
                alpha,
                load: 0.0,
                drive,
            };
            let (point, exact) = at(&model, 0.8 * frequency);
            let name = format!("no load, exponent {alpha}, drive {drive:e}");
            assert_true(&name, &point.stability, &exact);
            point.stability
        });
        for other in &found[1..] {
            let apart = distance(&other.multipliers, &found[0].multipliers);
            assert!(apart < 1e-9, "{alpha}: {apart:e}");
            assert_eq!(other.verdict, Verdict::Stable);
        }
    }
}

/// Exponent 0.3: an integrable stiffness whose square is not. Exponent 4: a contact that is almost none at small forces, and hard
/// at large ones.
#[test]
fn exponents_far_from_one() {
    for (alpha, omega, largest) in [(0.3, 1.0, 1e-3), (4.0, 1.0, 0.1)] {
        let model = Continuous {
            zeta: 0.05,
            alpha,
            load: 0.2,
            drive: 0.5,
        };
        let (point, exact) = at(&model, omega);
        for harmonics in [10, 40] {
            let [_, error] = projected(&model, omega, harmonics, &exact);
            println!("exponent {alpha}, projection with {harmonics} harmonics: {error:.0e}");
            assert!(harmonics > 10 || error > largest, "{error:e}");
        }
        assert_true(&format!("exponent {alpha}"), &point.stability, &exact);
        assert_eq!(point.stability.verdict, Verdict::Stable);
    }
}

/// A frequency far below the natural one: the contact opens and closes again and again while the force is low. Where 150 harmonics
/// resolve that, the answer is right; where they do not, the multipliers of the orbit that was found are not those of any motion.
#[test]
fn many_impacts_in_a_slow_period() {
    let omega = 0.05;
    println!("exponent, damping, drive: largest modulus with 20 harmonics");
    for (alpha, zeta, drive, resolved) in [
        (1.5, 0.05, 0.9, true),
        (1.0, 0.05, 1.01, true),
        (1.0, 0.2, 1.1, true),
        (1.0, 0.05, 1.06, false),
        (1.0, 0.2, 1.5, false),
        (1.5, 0.05, 1.1, false),
    ] {
        let model = OneSided {
            zeta,
            alpha,
            load: 1.0,
            drive,
        };
        let request = FrequencyResponse::of(&model).from(omega).to(0.0501);
        let largest = start(&request.harmonics(20)).map(|branch| {
            let coarse = answer(&branch, Method::Monodromy).uncorrected;
            coarse[0].norm()
        });
        println!("{alpha}, {zeta}, {drive}: {}", shown(largest.ok()));
        match found(&model, omega) {
            Ok((point, exact)) => {
                let impacts = point.observed.contacts[0].count;
                println!(
                    "    {impacts} impacts, exactly {:.1e}",
                    exact.multipliers[0].norm()
                );
                assert_true("   ", &point.stability, &exact);
                assert_eq!(resolved, point.stability.verdict == exact.verdict);
            }
            Err(error) => {
                println!("    {error}");
                assert!(!resolved);
            }
        }
    }
}

hertzian::oscillator! {
    /// Friction that drives, of full size from a rate of 1e-6 on.
    Driving(x) {
        param m = 0.017992496567387047 > 0;
        param c = 0.6630265812346576 > 0;
        param k = 7358.942140920422 > 0;
        param f = -0.006274728731116827;
        param v = 8.420281407601276e-7 > 0;
        param drive = 0.0038775922836808284 > 0;
        law friction(gap) { f*tanh(dot(gap)/v) }
        m*ddot(x) + c*dot(x) + k*x + friction(x + 3.7128288048460213e-6) = drive*cos(omega*t);
    }
}

/// So slow a motion is the load's against friction alone: `f tanh(x'/v) = drive cos(omega t)`, with the spring in quadrature to it and a three
/// hundredth as large. Its multipliers are `exp(6000)`: a method follows this orbit to the end of the range, or says that it finds none; two runs at least follow it.
#[test]
fn friction_that_drives() {
    let system = Driving::default();
    let samples = 2000;
    let phases = (0..samples).map(|sample| {
        let phase = (f64::from(sample) + 0.5) / f64::from(samples);
        (std::f64::consts::FRAC_PI_2 * phase).cos()
    });
    let rates = phases.map(|cosine| system.v * (system.drive / system.f.abs() * cosine).atanh());
    let way = std::f64::consts::PI * rates.sum::<f64>() / f64::from(samples);
    let [low, high] = [414.325_340_920_372_47, 458.518_440_191_908_7];
    let mut followed = 0;
    for [from, to] in [[low, high], [high, low]] {
        let request = FrequencyResponse::of(&system).from(from).to(to);
        let balance = request.clone().by(HarmonicBalance::new());
        for found in [
            balance.run(),
            request.clone().bifurcations(true).run(),
            request.clone().by(Shooting::new()).run(),
            request.by(ContactEquation::new()).run(),
        ] {
            let branch = match found {
                Ok(branch) => branch,
                Err(error) => {
                    assert_eq!(error.kind(), ErrorKind::NoOrbit, "{error}");
                    continue;
                }
            };
            for point in &branch.points {
                let apart = point.peak_to_peak() * point.omega() / way - 1.0;
                assert!(apart.abs() < 1e-3, "{}: {apart:e}", point.value);
            }
            assert_eq!(branch.stopped, Stop::ReachedEnd);
            followed += 1;
        }
    }
    assert!(followed >= 2, "{followed}");
}
