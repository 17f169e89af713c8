//! First orbits where nothing stiff is near rest, of motions that are tiny beside their static state, and of whatever settles.

use std::f64::consts::TAU;

use hertzian::time::stroboscope::Stroboscope;
use hertzian::time::{self, Tangent};
use hertzian::{
    Branch, ContactEquation, FrequencyResponse, HarmonicBalance, Shooting, Stop, System,
};
use hertzian_tests::random::Random;

hertzian::oscillator! {
    /// Gear pair with backlash and a stiffness of the mesh that varies in time, Kahraman and Singh (1991).
    GearPair(x) {
        param unsteady;
        law mesh(gap) { gap > 1 => gap - 1, -1 <= gap <= 1 => 0, gap < -1 => gap + 1 }
        ddot(x) + 0.1*dot(x) + (1 + 0.2*cos(omega*t))*mesh(x) = 0.1 + unsteady*omega^2*cos(omega*t);
    }
}

/// Peak-to-peak at a frequency by shooting with DOP853 in extended precision, confirmed by collocation; for a fluctuation of 0.2 and of
/// 0.05. There is one orbit at each of these frequencies.
const GEAR_PAIR: [(f64, f64, f64); 4] = [
    (0.2, 1.2, 0.602_503_468_861_241_3),
    (0.2, 0.7, 1.065_351_188_531_121_3),
    (0.05, 1.0, 0.323_123_031_523_886_33),
    (0.05, 0.7, 0.017_890_908_473_405_13),
];

/// At rest the teeth do not touch: the stiffness there is zero, whatever the frequency.
#[test]
fn a_gear_pair_finds_its_flank() {
    for unsteady in [0.2, 0.05] {
        let model = GearPair { unsteady };
        for step in 0..20 {
            let omega = 0.3 + 0.1 * f64::from(step);
            FrequencyResponse::of(&model).orbit(omega).unwrap();
        }
    }
    for (unsteady, omega, exact) in GEAR_PAIR {
        let model = GearPair { unsteady };
        let point = FrequencyResponse::of(&model).orbit(omega).unwrap();
        let error = (point.peak_to_peak() / exact - 1.0).abs();
        assert!(error <= point.error.unwrap(), "{omega}: {error:e}");
        let cycle = FrequencyResponse::of(&model)
            .by(Shooting::new())
            .orbit(omega)
            .unwrap();
        assert!((cycle.peak_to_peak() / exact - 1.0).abs() < 1e-8);
    }
}

hertzian::oscillator! {
    /// A stiffness that comes back after five periods of two, of which few nodes resolve little.
    Slow(x) {
        param unsteady;
        ddot(x) + 0.1*dot(x) + x + x^3 + unsteady*x^2*cos(2/5*omega*t) = 0.3*cos(omega*t);
    }
}

/// Where the first orbit is resolved better its tangent may be another one, which leads to the end of the range all the same.
#[test]
fn a_branch_leads_into_its_range_however_coarse_its_first_orbit_was() {
    for unsteady in [1e-3, 0.1] {
        let model = Slow { unsteady };
        let request = FrequencyResponse::of(&model).from(0.5).to(0.7);
        let branch = request.clone().by(ContactEquation::new()).run().unwrap();
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        let values = branch.points.windows(2);
        assert!(values.clone().all(|pair| pair[0].value < pair[1].value));
        let [found] = &branch.at(0.6).unwrap()[..] else {
            panic!("one orbit at each value");
        };
        let exact = request.by(Shooting::new()).orbit(0.6).unwrap();
        let off = (found.peak_to_peak() / exact.peak_to_peak() - 1.0).abs();
        let error = found.error.unwrap() + exact.error.unwrap();
        assert!(off <= error, "{off:e} {error:e}");
    }
}

hertzian::oscillator! {
    /// Balls between two rings that turn: eight contacts at angles that move with the cage.
    Bearing(x, y) {
        param mass;
        param damping;
        param stiffness;
        param clearance;
        param load;
        law ball(gap) { gap > 0 => stiffness*gap^1.5, else => 0 }
        mass*ddot(x) + damping*dot(x)
            + ball(x*cos(2/5*omega*t) + y*sin(2/5*omega*t) - clearance)*cos(2/5*omega*t)
            + ball(x*cos(2/5*omega*t + 1/4*pi) + y*sin(2/5*omega*t + 1/4*pi) - clearance)*cos(2/5*omega*t + 1/4*pi)
            + ball(x*cos(2/5*omega*t + 1/2*pi) + y*sin(2/5*omega*t + 1/2*pi) - clearance)*cos(2/5*omega*t + 1/2*pi)
            + ball(x*cos(2/5*omega*t + 3/4*pi) + y*sin(2/5*omega*t + 3/4*pi) - clearance)*cos(2/5*omega*t + 3/4*pi)
            + ball(x*cos(2/5*omega*t + pi) + y*sin(2/5*omega*t + pi) - clearance)*cos(2/5*omega*t + pi)
            + ball(x*cos(2/5*omega*t + 5/4*pi) + y*sin(2/5*omega*t + 5/4*pi) - clearance)*cos(2/5*omega*t + 5/4*pi)
            + ball(x*cos(2/5*omega*t + 3/2*pi) + y*sin(2/5*omega*t + 3/2*pi) - clearance)*cos(2/5*omega*t + 3/2*pi)
            + ball(x*cos(2/5*omega*t + 7/4*pi) + y*sin(2/5*omega*t + 7/4*pi) - clearance)*cos(2/5*omega*t + 7/4*pi)
            = load;
        mass*ddot(y) + damping*dot(y)
            + ball(x*cos(2/5*omega*t) + y*sin(2/5*omega*t) - clearance)*sin(2/5*omega*t)
            + ball(x*cos(2/5*omega*t + 1/4*pi) + y*sin(2/5*omega*t + 1/4*pi) - clearance)*sin(2/5*omega*t + 1/4*pi)
            + ball(x*cos(2/5*omega*t + 1/2*pi) + y*sin(2/5*omega*t + 1/2*pi) - clearance)*sin(2/5*omega*t + 1/2*pi)
            + ball(x*cos(2/5*omega*t + 3/4*pi) + y*sin(2/5*omega*t + 3/4*pi) - clearance)*sin(2/5*omega*t + 3/4*pi)
            + ball(x*cos(2/5*omega*t + pi) + y*sin(2/5*omega*t + pi) - clearance)*sin(2/5*omega*t + pi)
            + ball(x*cos(2/5*omega*t + 5/4*pi) + y*sin(2/5*omega*t + 5/4*pi) - clearance)*sin(2/5*omega*t + 5/4*pi)
            + ball(x*cos(2/5*omega*t + 3/2*pi) + y*sin(2/5*omega*t + 3/2*pi) - clearance)*sin(2/5*omega*t + 3/2*pi)
            + ball(x*cos(2/5*omega*t + 7/4*pi) + y*sin(2/5*omega*t + 7/4*pi) - clearance)*sin(2/5*omega*t + 7/4*pi)
            = 0;
    }
}

/// Shooting with DOP853 in extended precision, confirmed by a balance of 120 sampled harmonics: peak-to-peak of both coordinates.
const BEARING: [(f64, [f64; 2]); 2] = [
    (
        1.0,
        [0.002_384_145_843_898_788_4, 0.006_332_789_880_370_151],
    ),
    (0.7, [0.006_886_893_620_128_287, 0.015_156_924_479_275_55]),
];

#[test]
fn a_ball_bearing_has_its_orbit_in_the_clearance() {
    let model = Bearing {
        mass: 1.0,
        damping: 0.05,
        stiffness: 1.0,
        clearance: 0.1,
        load: 1.0,
    };
    for (omega, exact) in BEARING {
        let point = FrequencyResponse::of(&model)
            .stability(false)
            .orbit(omega)
            .unwrap();
        let motions = &point.observed.motions;
        // Relative to the coordinate that moves most.
        let stated = point.error.unwrap() * motions[1].peak_to_peak();
        for (motion, exact) in motions.iter().zip(exact) {
            let error = (motion.peak_to_peak() - exact).abs();
            assert!(error <= stated, "{omega}: {error:e} {stated:e}");
        }
    }
}

/// Preloaded, the balls are eight springs of stiffness `3/2 k sqrt(preload)` around the shaft: together four times as stiff in any
/// direction, whatever the angle of the cage, but for terms of the square of the displacement over the preload. What oscillates is of that
/// order, or nothing but rounding.
#[test]
fn a_preloaded_bearing_rests_whatever_the_tolerance() {
    for micrometres in [1.0, 2.0, 5.0] {
        let preload: f64 = 1e-6 * micrometres;
        let model = Bearing {
            mass: 0.6,
            damping: 200.0,
            stiffness: 1e10,
            clearance: -preload,
            load: 6.0,
        };
        let at_rest = 6.0 / (6.0 * 1e10 * preload.sqrt());
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let request = FrequencyResponse::of(&model).tolerance(tolerance);
            let point = request.stability(false).orbit(5000.0).unwrap();
            let mean = point.orbit.series(0).unwrap()[0];
            let order = (at_rest / preload).powi(2);
            assert!((mean / at_rest - 1.0).abs() < order, "{mean:e} {at_rest:e}");
            assert!(point.peak_to_peak() < order * at_rest);
        }
    }
}

hertzian::oscillator! {
    /// One-sided contact under a load.
    Loaded(x) {
        param load;
        param drive;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

/// A small motion about a static state is the linear response with the stiffness there, and its error is that of rounding relative to
/// the whole: to the displacement at rest.
#[test]
fn small_motions_about_a_static_state_are_linear() {
    let cases = [
        (1.0, 1e-8),
        (1.0, 1e-10),
        (1.0, 1e-12),
        (1.0, 1e-14),
        (1e6, 0.1),
        (1e-6, 1e-14),
    ];
    for (load, drive) in cases {
        let model = Loaded { load, drive };
        let rest = f64::powf(load, 2.0 / 3.0);
        let stiffness = 1.5 * rest.sqrt();
        let natural = stiffness.sqrt();
        let branch = FrequencyResponse::of(&model)
            .from(0.5 * natural)
            .to(2.0 * natural)
            .run()
            .unwrap();
        assert!(branch.points.len() > 30);
        assert_eq!(branch.points.last().unwrap().value, 2.0 * natural);
        for point in &branch.points {
            let omega = point.omega();
            let receptance = 1.0 / (stiffness - omega * omega).hypot(0.064 * omega);
            let exact = 2.0 * drive * receptance;
            let error = (point.peak_to_peak() / exact - 1.0).abs();
            // Rounding of the force, and the square of what is left out of the linear motion.
            let bend = exact * stiffness * receptance / rest;
            let rounding = 200.0 * f64::EPSILON * load * receptance / exact;
            assert!(
                error <= rounding + bend * bend.min(exact / rest),
                "{load} {drive} {omega}: {error:e} {rounding:e}"
            );
            let stated = point.error.unwrap();
            assert!(
                error <= stated + bend * bend,
                "{load} {drive} {omega}: {error:e} {stated:e}"
            );
        }
    }
}

hertzian::oscillator! {
    /// Play between two flanks under a load towards one of them, in any units of length and time.
    Play(x) {
        param size > 0;
        param rate > 0;
        param zeta;
        param alpha > 0;
        param steady;
        param mesh;
        param drive;
        law flanks(gap) {
            gap > size           => ((gap - size)/size)^alpha,
            -size <= gap <= size => 0,
            gap < -size          => -((-gap - size)/size)^alpha,
        }
        ddot(x) + 2*zeta*rate*dot(x) + rate^2*size*(1 + mesh*cos(omega*t))*flanks(x)
            = rate^2*size*(steady + drive*cos(omega*t));
    }
}

hertzian::oscillator! {
    /// A mass that lies on another one, which lies on the ground: nothing else holds them.
    Stack(x, y) {
        param size > 0;
        param rate > 0;
        param zeta;
        param weight;
        param drive;
        law ground(gap) { gap > 0 => 2*zeta*rate*dot(gap) + rate^2*size*(gap/size)^1.5, else => 0 }
        ddot(x) + ground(x) - ground(y - x) = rate^2*size*(weight + drive*cos(omega*t));
        ddot(y) + ground(y - x) = rate^2*size*weight;
    }
}

hertzian::oscillator! {
    /// Two wells.
    Wells(x) {
        param size > 0;
        param rate > 0;
        param zeta;
        param drive;
        ddot(x) + 2*zeta*rate*dot(x) - rate^2*x + rate^2*x^3/size^2 = rate^2*size*drive*cos(omega*t);
    }
}

/// Whether a motion from rest comes back after a period, a thousand periods later.
fn settles(model: &dyn System, omega: f64, size: f64) -> bool {
    let mut map = Stroboscope::of(model, omega).unwrap();
    let mut state = vec![0.0; map.order()];
    for _ in 0..1000 {
        if map.map(&mut state).is_err() {
            return false;
        }
    }
    let before = state.clone();
    let moved = map.map(&mut state).is_ok();
    let returns = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-7 * size;
    moved
        && state
            .iter()
            .zip(&before)
            .take(before.len() / 2)
            .all(returns)
}

/// A start is found, and is an orbit: integrated over a period it comes back, as nearly as neighbours stay together.
fn has_a_start(model: &dyn System, omega: f64, (size, rate): (f64, f64), case: &str) {
    let found = FrequencyResponse::of(model).stability(false).orbit(omega);
    let point = found.unwrap_or_else(|error| panic!("{case} at {omega}: {error}"));
    let mut map = Stroboscope::of(model, omega).unwrap();
    let n = map.order() / 2;
    let motions = (0..n).map(|i| point.orbit.state_at(i, 0.0).unwrap());
    let (mut state, velocities): (Vec<f64>, Vec<f64>) = motions.unzip();
    state.extend(velocities);
    let before = state.clone();
    let mut tangent = Tangent::of_state(n, None);
    map.map_with(&mut state, &mut tangent).unwrap();
    let growth = tangent
        .columns
        .chunks(2 * n)
        .enumerate()
        .map(|(j, column)| {
            let unit = if j < n { 1.0 } else { rate };
            unit * column[..n].iter().map(|x| x.abs()).sum::<f64>()
        });
    let growth = growth.fold(1.0, f64::max);
    for i in 0..n {
        let moved = (state[i] - before[i]).abs() / size;
        assert!(
            moved < 1e-4 * growth,
            "{case} at {omega}: {moved:e} {growth:e}"
        );
    }
}

/// Units of length and time: the same model in others has a start too.
const UNITS: [(f64, f64); 3] = [(1.0, 1.0), (1e-5, 1e5), (1e5, 1e-5)];

#[test]
fn whatever_settles_has_a_start_in_any_units() {
    let random = &mut Random::seeded(17);
    let mut settled = 0;
    for case in 0..30 {
        let mut draw = |low: f64, high: f64| random.between(low, high);
        let (zeta, drive) = (draw(0.02, 0.2), draw(0.05, 1.0));
        let (steady, mesh) = (draw(0.05, 1.0), draw(0.0, 0.4));
        let steady = if case % 2 == 0 { steady } else { -steady };
        let alpha = [1.0, 1.5, 3.0][case % 3];
        let own = draw(0.3, 2.5);
        let one = (1.0, 1.0);
        let models = |(size, rate): (f64, f64)| -> [Box<dyn System>; 3] {
            [
                Box::new(Play {
                    size,
                    rate,
                    zeta,
                    alpha,
                    steady,
                    mesh,
                    drive,
                }),
                Box::new(Stack {
                    size,
                    rate,
                    zeta,
                    weight: steady.abs(),
                    drive: 0.5 * drive * steady.abs(),
                }),
                Box::new(Wells {
                    size,
                    rate,
                    zeta,
                    drive,
                }),
            ]
        };
        for (kind, model) in models(one).iter().enumerate() {
            if !settles(model.as_ref(), own, 1.0) {
                continue;
            }
            settled += 1;
            for units in UNITS {
                let (_, rate) = units;
                let model = &models(units)[kind];
                has_a_start(
                    model.as_ref(),
                    own * rate,
                    units,
                    &format!("{case} {kind} {units:?}"),
                );
            }
        }
    }
    assert!(settled > 40, "{settled}");
}

hertzian::oscillator! {
    /// A contact that holds on to what leaves it, and a weak spring to the ground.
    Adhesive(x) {
        law contact(gap) { gap > 0 => gap^1.5 - 0.3, else => 0 }
        ddot(x) + 0.04*dot(x) + 0.05*x + contact(x) = 0.2*cos(omega*t) + 1;
    }
}

/// The motion from rest settles to an orbit that neither the linear response nor a homotopy leads to.
#[test]
fn an_adhesive_contact_has_a_start_everywhere() {
    for step in 0..16 {
        let omega = 0.9 + 0.05 * f64::from(step);
        has_a_start(&Adhesive {}, omega, (1.0, 1.0), "adhesive");
    }
}

hertzian::oscillator! {
    /// Two masses that stiffen each other: the force is the derivative of `coupling*x^2*y^2/2`.
    Stiffening(x, y) {
        param coupling;
        param load;
        ddot(x) + 0.1*dot(x) + x + 0.8*(x - y) + coupling*(y^2)*x = 0;
        ddot(y) + 0.1*dot(y) + 1.4*y + 0.8*(y - x) + coupling*(x^2)*y = 0.3*cos(omega*t) + load;
    }
}

/// Far from rest the products are differences of cubes, and all that is left of them and of the linear forces is rounding: a residual of
/// zero there is no equilibrium.
#[test]
fn a_residual_that_is_all_rounding_is_no_start() {
    for (coupling, load) in [(0.2, 1.0), (2e-6, 1.0), (0.2, 0.0), (20.0, 30.0)] {
        let model = Stiffening { coupling, load };
        for step in 0..20 {
            let omega = 0.5 + 0.13 * f64::from(step);
            let point = FrequencyResponse::of(&model).orbit(omega).unwrap();
            let cycle = FrequencyResponse::of(&model)
                .by(Shooting::new())
                .near_orbit(&point.orbit)
                .orbit(omega)
                .unwrap();
            let error = (point.peak_to_peak() / cycle.peak_to_peak() - 1.0).abs();
            assert!(
                error <= point.error.unwrap().max(1e-8),
                "{coupling} {load} {omega}: {error:e}"
            );
        }
    }
}

hertzian::oscillator! {
    /// Three masses in a row, the last beside a spring whose stiffness is unbounded at rest.
    Steep(x, y, z) {
        param drive;
        law steep(gap) { sgn(gap)*(322*abs(gap)^0.52) }
        law stop(gap) { gap > 0 => 5.03e4*gap^0.73 + 0.11*dot(gap), else => 0 }
        0.0124*ddot(x) + 0.13*dot(x) + 6785*(x - y) + 0.043*(dot(x) - dot(y)) = 0;
        0.0124*ddot(y) + 0.34*dot(y) + 3.76e10*y^3 - 1.87e4*y + 6785*(y - x) + 0.043*(dot(y) - dot(x))
            + 20782*(y - z) + 0.37*(dot(y) - dot(z)) + stop(y) = drive*cos(omega*t);
        0.0124*ddot(z) + 1.22*dot(z) + 20782*(z - y) + 0.37*(dot(z) - dot(y)) + steep(z) = 0;
    }
}

/// Newton's method leads nowhere, and no motion can be computed from rest, but one that begins beside it settles.
#[test]
fn motions_that_cannot_begin_at_rest_begin_beside_it() {
    let steep = Steep { drive: 0.687 };
    let by_balance = FrequencyResponse::of(&steep).orbit(1467.0).unwrap();
    let mut flow = time::of(&steep, 1467.0, 1e-10).unwrap();
    let mut state = [1e-6, 1e-6, 1e-6, 0.0, 0.0, 0.0];
    for _ in 0..600 {
        flow.advance(0.0, TAU, &mut state, None, None).unwrap();
    }
    let request = FrequencyResponse::of(&steep).by(Shooting::new());
    let settled = request.near_state(&state).orbit(1467.0).unwrap();
    let [a, b] = [&by_balance, &settled].map(hertzian::Point::peak_to_peak);
    assert!((a / b - 1.0).abs() < by_balance.error.unwrap(), "{a} {b}");
    assert_eq!(by_balance.stability.verdict, settled.stability.verdict);
}

hertzian::oscillator! {
    /// A mass that meets a stop, below its resonance, in any units of length and time: there are three orbits.
    Meeting(x) {
        param size > 0;
        param rate > 0;
        law stop(gap) { gap > 0 => 17.387*rate^2*size*(gap/size)^1.5, else => 0 }
        ddot(x) + 0.02214*rate*dot(x) + rate^2*x - stop(-x - size) = 2.3313*rate^2*size*cos(omega*t);
    }
}

/// At rest in its middle a system has no size, in whatever units. The first orbit, and all that follow, are the same in all of them, as
/// nearly as two orbits are known.
#[test]
fn branches_are_the_same_in_any_units() {
    type Request = dyn Fn(&dyn System, [f64; 2]) -> Branch;
    let branches = |request: &Request| {
        UNITS.map(|(size, rate)| {
            let branch = request(&Meeting { size, rate }, [0.412 * rate, 0.493 * rate]);
            let points = branch.points.iter();
            let points = points.map(|point| [point.value / rate, point.peak_to_peak() / size]);
            (branch.stopped, points.collect::<Vec<_>>())
        })
    };
    let by_all: [&Request; 3] = [
        &|system, [from, to]| {
            let request = FrequencyResponse::of(system).from(from).to(to);
            request.by(HarmonicBalance::new()).run().unwrap()
        },
        &|system, [from, to]| {
            let request = FrequencyResponse::of(system).from(from).to(to);
            request.by(Shooting::new()).run().unwrap()
        },
        &|system, [from, to]| {
            let request = FrequencyResponse::of(system).from(from).to(to);
            request.by(ContactEquation::new()).run().unwrap()
        },
    ];
    for request in by_all {
        let [(stopped, points), others @ ..] = branches(request);
        for (_, other) in &others {
            assert_eq!(points.len(), other.len(), "{stopped}");
            for (a, b) in points.iter().zip(other) {
                let apart = [0, 1].map(|i| (a[i] / b[i] - 1.0).abs());
                assert!(apart.iter().all(|apart| *apart < 2e-6), "{a:?} {b:?}");
            }
        }
    }
}
