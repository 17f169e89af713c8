//! Backbone curves: against the closed form without a load, and against quadratures of the period with one.
//!
//! Exact values: computed independently of this project by quadrature with 30 digits (`backbone_free` and `backbone` of the
//! reference values).

use std::ops::ControlFlow;

use hertzian::backbone::{FreeOscillation, PhaseResonance};
use hertzian::error::ErrorKind;
use hertzian::{Error, Point, RequestError, Stop, System};

hertzian::oscillator! {
    Continuous(x) {
        param alpha > 0;
        param load;
        ddot(x) + sgn(x)*|x|^alpha = load;
    }
}

hertzian::oscillator! {
    OneSided(x) {
        param alpha > 0;
        param load;
        law contact(gap) { gap > 0 => gap^alpha, else => 0 }
        ddot(x) + contact(x) = load;
    }
}

hertzian::oscillator! {
    Driven(x) {
        param zeta >= 0;
        param drive;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^1.5 = drive*cos(omega*t);
    }
}

/// Without a load `omega = coefficient a^((alpha - 1) / 2)`.
const COEFFICIENTS: [(f64, f64); 6] = [
    (0.6, 1.040_748_834_943_126_2),
    (1.0, 1.0),
    (1.5, 0.954_693_569_728_51),
    (2.0, 0.914_681_356_501_962_4),
    (2.5, 0.879_091_468_910_228_9),
    (3.0, 0.847_213_084_793_979),
];

/// With the load one: one-sided, exponent, and largest and smallest displacement with the frequency.
const WITH_LOAD: [(bool, f64, [[f64; 3]; 3]); 6] = [
    (
        false,
        0.6,
        [
            [1.25, 0.758_108_854_590_462_4, 0.775_468_344_792_869],
            [2.2, -0.006_564_994_776_920_48, 0.806_399_233_315_548],
            [6.0, -2.419_177_732_772_473_9, 0.752_572_312_835_082],
        ],
    ),
    (
        false,
        1.0,
        [[1.25, 0.75, 1.0], [2.2, -0.2, 1.0], [6.0, -4.0, 1.0]],
    ),
    (
        false,
        1.5,
        [
            [1.25, 0.739_049_803_538_509_9, 1.221_363_830_907_07],
            [2.2, -0.572_398_830_974_745_7, 1.128_591_127_167_62],
            [6.0, -5.153_702_672_777_399, 1.469_276_534_239_28],
        ],
    ),
    (
        true,
        0.6,
        [
            [2.2, -0.006_766_114_671_726_84, 0.805_539_677_220_709],
            [3.0, -0.624_716_334_247_055_2, 0.758_704_585_680_86],
            [6.0, -4.988_085_193_438_206, 0.528_746_263_746_882],
        ],
    ),
    (
        true,
        1.0,
        [
            [2.2, -0.22, 0.975_882_628_847_801],
            [3.0, -1.5, 0.821_021_053_874_229],
            [6.0, -12.0, 0.470_923_351_150_636],
        ],
    ),
    (
        true,
        1.5,
        [
            [2.2, -0.671_552_054_203_440_7, 1.041_675_598_198_08],
            [3.0, -3.235_382_907_247_958_3, 0.781_146_845_933_312],
            [6.0, -29.272_652_296_077_764, 0.358_681_000_526_892],
        ],
    ),
];

/// The position of the first coordinate where the oscillation begins.
fn position(point: &Point) -> f64 {
    point.orbit.state()[0]
}

fn curve(system: &dyn System, from: f64, to: f64) -> Vec<Point> {
    let curve = FreeOscillation::of(system).from(from).to(to).run().unwrap();
    assert_eq!(curve.stopped, Stop::ReachedEnd);
    let points = curve.points;
    let ends = [&points[0], &points[points.len() - 1]].map(position);
    assert_eq!(ends, [from, to]);
    points
}

#[test]
fn without_a_load_the_closed_form() {
    for (alpha, coefficient) in COEFFICIENTS {
        let model = Continuous { alpha, load: 0.0 };
        for point in curve(&model, 0.5, 3.0) {
            let amplitude = position(&point);
            let expected = coefficient * amplitude.powf(0.5 * (alpha - 1.0));
            let error = (point.omega() / expected - 1.0).abs();
            assert!(error < 1e-10, "{alpha} {amplitude}: {error:.1e}");
            assert!((point.peak_to_peak() / (2.0 * amplitude) - 1.0).abs() < 1e-10);
        }
    }
}

#[test]
fn with_a_load_the_quadratures() {
    for (one_sided, alpha, rows) in WITH_LOAD {
        let load = 1.0;
        let model: Box<dyn System> = if one_sided {
            Box::new(OneSided { alpha, load })
        } else {
            Box::new(Continuous { alpha, load })
        };
        for [largest, smallest, omega] in rows {
            let point = &curve(&*model, largest, 1.01 * largest)[0];
            let error = (point.omega() / omega - 1.0).abs();
            assert!(error < 1e-8, "{one_sided} {alpha} {largest}: {error:.1e}");
            let error = (point.motion().minimum - smallest).abs();
            assert!(
                error < 1e-8 * largest,
                "{one_sided} {alpha} {largest}: {error:.1e}"
            );
        }
    }
}

hertzian::oscillator! {
    Stiff(x) {
        param stiffness > 0;
        ddot(x) + stiffness*x = 0;
    }
}

/// From a tenth of a millisecond to hours.
#[test]
fn any_scale_of_time() {
    for stiffness in [1e-8_f64, 1e8] {
        let model = Stiff { stiffness };
        for point in curve(&model, 1.0, 1.5) {
            let error = (point.omega() / stiffness.sqrt() - 1.0).abs();
            assert!(error < 1e-9, "{stiffness} {error:.1e}");
            let middle = point.motion().maximum + point.motion().minimum;
            assert!(middle.abs() < 1e-9);
        }
    }
}

hertzian::oscillator! {
    /// A ball on a plane, `s` units of time in each of its own.
    Ball(x) {
        param s > 0;
        law contact(gap) { gap > 0 => s^2*gap^1.5, else => 0 }
        ddot(x) + contact(x) = s^2;
    }
}

/// A megahertz, with contact lost in each period: the value of `WITH_LOAD`.
#[test]
fn any_scale_of_time_with_a_contact() {
    let row = WITH_LOAD
        .iter()
        .find(|(one_sided, alpha, _)| *one_sided && *alpha == 1.5);
    let [largest, _, expected] = row.unwrap().2[2];
    for s in [1e-6, 1e7] {
        let point = &curve(&Ball { s }, largest, 1.01 * largest)[0];
        let error = (point.omega() / (s * expected) - 1.0).abs();
        assert!(error < 1e-9, "{s} {error:.1e}");
    }
}

hertzian::oscillator! {
    /// Two masses pressed together by a spring of Hertz: with `x = -y` a single mass with the spring `(2 x)^1.5`.
    Pair(x, y) {
        param s > 0;
        param l > 0;
        law spring(gap) {
            gap > 0 => s^2*l*(gap/l)^1.5,
            else    => -s^2*l*(-gap/l)^1.5,
        }
        ddot(x) + 0.5*s^2*x + spring(x - y) = 0;
        ddot(y) + 0.5*s^2*y - spring(x - y) = 0;
    }
}

/// Frequency and other positions count relative to themselves: as many points, and the same ones, in any units.
#[test]
fn several_coordinates_in_any_units() {
    let follow = |s: f64, l: f64| {
        let model = Pair { s, l };
        let request = FreeOscillation::of(&model).from(0.5 * l).to(2.0 * l);
        let found = request.near_rest(&[0.5 * l, -0.5 * l], 1.7 * s).run();
        found.unwrap().points
    };
    let expected = follow(1.0, 1.0);
    for (s, l) in [(1e6, 1e-6), (1e-3, 1e3)] {
        let found = follow(s, l);
        assert_eq!(found.len(), expected.len());
        for (a, b) in found.iter().zip(&expected) {
            assert!((a.omega() / (s * b.omega()) - 1.0).abs() < 1e-8);
            let [a, b] = [a, b].map(|point| point.orbit.state()[1]);
            assert!((a / (l * b) - 1.0).abs() < 1e-8);
        }
    }
}

hertzian::oscillator! {
    /// Two equal masses with springs of Hertz to the ground, and a straight one between them: they move as one in the first mode, against each other
    /// in the second one; damped and driven.
    Coupled(x, y) {
        param zeta = 0.1;
        law spring(gap) {
            gap > 0 => gap^1.5 + zeta*dot(gap),
            else    => -(-gap)^1.5,
        }
        ddot(x) + 0.2*dot(x) + spring(x) + 0.3*(x - y) = cos(omega*t);
        ddot(y) + 0.2*dot(y) + spring(y) + 0.3*(y - x) = 0;
    }
}

/// As one they have the closed form of one mass, though nothing holds them in the linear limit, and the slope of their force at rest is zero.
#[test]
fn two_masses_move_as_one() {
    let request = FreeOscillation::of(&Coupled::default()).conservative();
    let request = request.mode(1).along("y").from(0.4).to(1.5);
    let curve = request.run().unwrap();
    assert_eq!(curve.stopped, Stop::ReachedEnd);
    let energies = request.energies(&curve).unwrap();
    for (point, energy) in curve.points.iter().zip(energies) {
        let [x, y] = [0, 1].map(|i| point.orbit.state()[i]);
        assert!((x / y - 1.0).abs() < 1e-9, "{x} {y}");
        let expected = 0.954_693_569_728_51 * y.powf(0.25);
        assert!((point.omega() / expected - 1.0).abs() < 1e-10);
        assert!((energy / (2.0 * 0.4 * y.powf(2.5)) - 1.0).abs() < 1e-11);
    }
}

hertzian::oscillator! {
    /// Two masses between three springs of one, the first with a cubic spring to the ground besides: the example of Kerschen, Peeters, Golinval and
    /// Vakakis (2009), Mech. Syst. Signal Process. 23, section 3.
    Kerschen(x, y) {
        ddot(x) + 2*x - y + 0.5*x^3 = 0;
        ddot(y) + 2*y - x = 0;
    }
}

/// The largest position of the first mass along the first mode before it turns back: by another integrator (DOP853 of scipy) and a parabola.
const TURNS: f64 = 8.605_725;

/// Whether a curve turned back there, but for the last step.
fn has_turned(stop: Stop) -> bool {
    matches!(stop, Stop::TurnedBack { value } if (TURNS - 1e-3..TURNS + 1e-6).contains(&value))
}

/// The curve of the first mode turns back: it is taken up beyond, and no line leads there.
#[test]
fn a_curve_that_turns_back_is_taken_up_again() {
    let request = FreeOscillation::of(&Kerschen {}).mode(1).along("x");
    let curve = request.clone().to(10.0).run().unwrap();
    assert_eq!(curve.stopped, Stop::ReachedEnd);
    let [leap] = &curve.leaps[..] else {
        panic!("{:?}", curve.leaps);
    };
    assert!(has_turned(leap.reason), "{}", leap.reason);
    let sizes: Vec<usize> = curve.parts().map(<[Point]>::len).collect();
    assert_eq!(sizes, [leap.after, curve.points.len() - leap.after]);
    let [before, behind] = [leap.after - 1, leap.after].map(|index| &curve.points[index]);
    assert!(position(before) < TURNS && TURNS < position(behind));
    let place = |point: &Point| [point.value, point.peak_to_peak()];
    let runs = curve.runs();
    let both = [before, behind].map(place);
    assert!(runs.iter().any(|run| run.points.last() == Some(&both[0])));
    assert!(runs.iter().any(|run| run.points.first() == Some(&both[1])));
    let with_both = |run: &&hertzian::chart::Run| both.iter().all(|own| run.points.contains(own));
    assert_eq!(runs.iter().filter(with_both).count(), 0);
    // Every motion comes back.
    let errors = curve.points.iter().map(|point| point.error);
    assert!(errors.flatten().all(|error| error < 1e-9));
    // There is nothing beyond that is asked for.
    let ended = request.to(8.61).run().unwrap();
    assert!(has_turned(ended.stopped), "{}", ended.stopped);
    assert!(ended.leaps.is_empty());
}

/// A force that a factor in an equation turns has a potential as well: the energy at rest is that of the springs and of `0.5*x^3`.
#[test]
fn a_force_with_a_factor_has_an_energy() {
    let request = FreeOscillation::of(&Kerschen {}).mode(1).along("x");
    let request = request.to(3.0);
    let curve = request.run().unwrap();
    let energies = request.energies(&curve).unwrap();
    for (point, energy) in curve.points.iter().zip(energies) {
        let [x, y] = [0, 1].map(|i| point.orbit.state()[i]);
        let expected = x * x - x * y + y * y + 0.125 * x.powi(4);
        assert!(
            (energy / expected - 1.0).abs() < 1e-12,
            "{energy} {expected}"
        );
    }
}

hertzian::oscillator! {
    /// Two masses, one of which pushes the other and is not pushed back.
    Following(x, y) {
        ddot(x) + x + 0.1*(x - y)^3 = 0;
        ddot(y) + 2*y + x^3 = 0;
    }
}

/// A force without a reaction has no potential.
#[test]
fn a_force_without_a_reaction_has_no_energy() {
    let curve = FreeOscillation::of(&Kerschen {}).mode(1).along("x").to(1.0);
    let curve = curve.run().unwrap();
    let energies = FreeOscillation::of(&Following {}).energies(&curve);
    assert_eq!(energies.unwrap_err().kind(), ErrorKind::Model);
}

/// What is not there is said.
#[test]
fn a_mode_that_is_not_there_is_said() {
    let request = FreeOscillation::of(&Coupled::default()).conservative();
    let said = |request: &FreeOscillation| request.run().unwrap_err().to_string();
    let beyond = said(&request.clone().mode(3).to(1.0));
    assert_eq!(
        beyond,
        "no free oscillation begins at mode 3: 1 modes move x and come back to rest"
    );
    let unknown = said(&request.clone().mode(1).along("z").to(1.0));
    assert_eq!(unknown, "no coordinate is called z: there are x, y");
    let open = said(&request.mode(2));
    assert!(open.contains("`to(...)` has not been called"), "{open}");
}

/// Nothing moves: in the dead zone of a contact, and at a position of equilibrium.
#[test]
fn rest_does_not_oscillate() {
    for (load, from) in [(0.0, -1.0), (1.0, 1.0)] {
        let model = OneSided { alpha: 1.0, load };
        let request = FreeOscillation::of(&model).from(from).to(2.0);
        let error = request.run().unwrap_err();
        assert_eq!(error.kind(), ErrorKind::NoOrbit);
        let sentence = format!("the motion from rest at {from} does not come to rest again");
        assert_eq!(error.to_string(), sentence);
    }
}

/// The sentence says how far the motion misses its beginning, and what to do.
fn assert_not_free(error: &Error) {
    assert_eq!(error.kind(), ErrorKind::Model);
    let said = error.to_string();
    let said_so = said.starts_with("the motion misses its beginning by ")
        && said.ends_with(" of its size after a period: set damping and excitation to zero");
    assert!(said_so, "{said}");
}

/// What is driven by a cosine goes back the way it came when it begins at the crest, and is not free all the same.
#[test]
fn what_is_driven_is_not_free() {
    let model = Driven {
        zeta: 0.0,
        drive: 0.1,
    };
    let request = FreeOscillation::of(&model).from(0.5).to(1.0);
    let error = request.near_rest(&[0.5], 0.67).run().unwrap_err();
    assert_not_free(&error);
}

#[test]
fn what_is_damped_is_not_free() {
    let model = Driven {
        zeta: 0.01,
        drive: 0.0,
    };
    let error = FreeOscillation::of(&model)
        .from(0.5)
        .to(1.0)
        .run()
        .unwrap_err();
    assert_not_free(&error);
}

/// The first harmonic of the damped system lags by a quarter, and its frequency is that of the free system of the same amplitude
/// but for an order of the damping: halving the damping takes at least two fifths of the difference.
#[test]
fn phase_resonance_is_near_free_oscillation() {
    let differences = [0.02, 0.01].map(|zeta| {
        // The drive balances damping, so that the amplitudes are alike.
        let model = Driven {
            zeta,
            drive: 2.0 * zeta,
        };
        let to = 2.0 * model.drive;
        let request = PhaseResonance::of(&model).vary("drive").to(to);
        let curve = request.between(0.45, 1.4).run().unwrap();
        assert_eq!(curve.stopped, Stop::ReachedEnd);
        let curve = curve.points;
        assert!((curve[curve.len() - 1].value - to).abs() < 1e-12);
        for point in &curve {
            assert!(point.orbit.series(0).unwrap()[1].abs() < 1e-8, "{point:?}");
        }
        let point = &curve[0];
        let amplitude = 0.5 * point.peak_to_peak();
        let free = 0.954_693_569_728_51 * amplitude.powf(0.25);
        (point.omega() / free - 1.0).abs()
    });
    let [large, small] = differences;
    assert!(large < 0.02, "{large:.1e}");
    assert!(
        small < 0.01 && small < 0.6 * large,
        "{large:.1e} {small:.1e}"
    );
}

/// What is missing, cannot be varied, or is not there is said; a caller can stop.
#[test]
fn what_cannot_be_followed_is_said() {
    let model = Driven {
        zeta: 0.02,
        drive: 0.04,
    };
    let request = PhaseResonance::of(&model).to(0.08).between(0.45, 1.4);
    let vary = |name: &str| request.clone().vary(name).run().unwrap_err();
    let missing = request.run().unwrap_err();
    assert!(matches!(
        missing.downcast_ref(),
        Some(RequestError::Missing { name: "vary", .. })
    ));
    assert!(matches!(
        vary("omega").downcast_ref(),
        Some(RequestError::Varied { .. })
    ));
    assert!(matches!(
        vary("force").downcast_ref(),
        Some(RequestError::UnknownParameter { .. })
    ));
    let none = request.clone().vary("drive").between(2.0, 3.0);
    let error = none.run().unwrap_err();
    assert_eq!(error.kind(), ErrorKind::NoOrbit);
    assert_eq!(
        error.to_string(),
        "no orbit in phase resonance found at 0.04 between the excitation frequencies 2 and 3"
    );
    let free = FreeOscillation::of(&model).from(0.5);
    let error = free.run().unwrap_err();
    assert!(matches!(
        error.downcast_ref(),
        Some(RequestError::Missing { name: "to", .. })
    ));
    let mut seen = 0;
    let stopped = request.vary("drive").run_with(|_| {
        seen += 1;
        if seen == 3 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    let stopped = stopped.unwrap();
    assert_eq!(stopped.points.len(), 3);
    assert_eq!(stopped.stopped, Stop::Interrupted);
}
