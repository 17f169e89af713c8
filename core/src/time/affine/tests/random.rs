//! Random systems against the independent flow, and tangents against differences.

use nalgebra::DMatrix;
use proptest::prelude::*;

use super::flow;
use super::reference::Reference;
use crate::oscillator;
use crate::system::{System, Variable};
use crate::time::{Flow, FlowError, Stretch, Tangent};

oscillator! {
    /// A mass between two damped stops that may be preloaded and may shake, under two harmonics.
    pub(super) Stops(x) {
        /// mass
        param mass > 0;
        /// damping of the mass
        param damping;
        /// its stiffness
        param stiffness;
        /// half of the play
        param play >= 0;
        /// stiffness of the upper stop
        param upper;
        /// stiffness of the lower stop
        param lower;
        /// damping of the upper stop
        param rub;
        /// force of the upper stop at first touch
        param preload;
        /// amplitude of the motion of the stops
        param shake;
        /// constant load
        param load;
        /// amplitude of the first harmonic
        param drive;
        /// amplitude of half of the first harmonic
        param half;

        /// gap of the upper stop beyond the play
        law stops(gap) {
            gap > play  => preload + upper*(gap - play) + rub*dot(gap),
            gap < -play => lower*(gap + play),
            else        => 0,
        }

        mass*ddot(x) + damping*dot(x) + stiffness*x + stops(x - shake*sin(omega*t))
            = load + drive*cos(omega*t) + half*sin(1/2*omega*t);
    }
}

oscillator! {
    /// Two masses; the first meets a damped stop, and a spring with play couples them.
    Two(x, y) {
        /// damping
        param zeta;
        /// stiffness of the stop
        param stop;
        /// place of the stop
        param place;
        /// stiffness of the coupling beyond its play
        param coupling;
        /// half of its play
        param play >= 0;
        /// excitation
        param drive;

        /// beyond the place
        law wall(gap) { gap > 0 => stop*gap + 2*zeta*dot(gap), else => 0 }

        /// either side of the play
        law spring(gap) {
            gap > play  => coupling*(gap - play),
            gap < -play => coupling*(gap + play),
            else        => 0,
        }

        ddot(x) + 2*zeta*dot(x) + x + wall(x - place) - spring(y - x) = drive*cos(omega*t);
        0.7*ddot(y) + 2*zeta*dot(y) - 0.3*y + spring(y - x) = 0.2 + 0.1*drive*sin(2*omega*t);
    }
}

/// A motion that comes to rest is compared over this part of the way.
const RESTS: f64 = 0.5;
/// Beyond this growth it is not allowed for.
const GROWN: f64 = 1e5;
/// Parts of a motion from the beginnings of which perturbations are followed to its end.
const PARTS: usize = 64;

/// The flow, the states seen at the ends of stretches, and the independent flow agree.
fn compare(system: &dyn System, omega: f64, start: &[f64], to: f64) {
    // Steps are phases: what oscillates by itself does so in time.
    compare_to(system, omega, start, to, 0.02 * omega.min(1.0), 1e-13);
}

/// The same, with steps of the independent flow of this length in time. Velocities of what moves faster have larger rounding errors.
pub(super) fn compare_in_steps(system: &dyn System, omega: f64, start: &[f64], to: f64, step: f64) {
    compare_to(
        system,
        omega,
        start,
        to,
        step * omega.min(1.0),
        1e-13 * 0.02 / step,
    );
}

/// The same, with this rounding error of states. A motion that comes to rest on a level where the force jumps, by ever shorter bounces, has
/// more switches than are followed, and that is said: it is compared up to half of the way there, where it has had few of them.
fn compare_to(system: &dyn System, omega: f64, start: &[f64], to: f64, step: f64, rounding: f64) {
    let from = 0.4;
    let mut flow = flow(system, omega);
    let n = flow.coordinates();
    let mut tangent = Tangent::of_state(n, None);
    let mut state = start.to_vec();
    let mut last = Vec::new();
    let mut phase = from;
    let mut see = |stretch: &dyn Stretch| {
        let mut at = vec![0.0; start.len()];
        assert_eq!(stretch.phases().0, phase);
        stretch.state(phase, &mut at);
        if !last.is_empty() {
            assert!(distance(&at, &last) < rounding, "{at:?} {last:?}");
        }
        phase = stretch.phases().1;
        stretch.state(phase, &mut at);
        last = at;
    };
    match flow.advance(from, to, &mut state, Some(&mut tangent), Some(&mut see)) {
        Err(FlowError::TooManySwitches { phase, switches }) => {
            let before = from + RESTS * (phase - from);
            let mut exact = start.to_vec();
            let had = Reference::new(system, omega).advance(from, before, step, &mut exact);
            assert!(2 * had < switches, "{had} of {switches}: no rest");
            return compare_to(system, omega, start, before, step, rounding);
        }
        advanced => advanced.unwrap(),
    }
    assert_eq!(phase, to);
    assert!(distance(&last, &state) < rounding);
    let mut plain = start.to_vec();
    flow.advance(from, to, &mut plain, None, None).unwrap();
    let mut exact = start.to_vec();
    Reference::new(system, omega).advance(from, to, step, &mut exact);
    let growth = growth(&mut flow, from, to, start);
    for found in [&state, &plain] {
        let error = distance(found, &exact);
        assert!(
            error < 1e-11 * growth.min(GROWN),
            "{error:e} {growth} {found:?} {exact:?}"
        );
    }
}

/// What a perturbation that is made at one of some places on the way has grown to at its end, at most: rounding errors are made everywhere, and in
/// short bounces, whose speeds change as the roots of heights, those of positions grow at once.
fn growth(flow: &mut dyn Flow, from: f64, to: f64, start: &[f64]) -> f64 {
    let order = start.len();
    let mut state = start.to_vec();
    let parts: Vec<DMatrix<f64>> = (0..PARTS)
        .map(|k| {
            let phase = |k: usize| from + (to - from) * k as f64 / PARTS as f64;
            let mut tangent = Tangent::of_state(order / 2, None);
            flow.advance(phase(k), phase(k + 1), &mut state, Some(&mut tangent), None)
                .unwrap();
            DMatrix::from_column_slice(order, order, &tangent.columns)
        })
        .collect();
    let mut onward = DMatrix::identity(order, order);
    parts.iter().rev().fold(1.0, |growth, part| {
        onward = &onward * part;
        onward.amax().max(growth)
    })
}

/// Relative to the size of the second.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let size = b.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
    let error = a
        .iter()
        .zip(b)
        .fold(0.0_f64, |error, (a, b)| error.max((a - b).abs()));
    error / size
}

/// The tangent is what central differences tend to; `None` if these do not tend to anything, as where the motion grazes.
fn check_tangent(
    system: &dyn System,
    omega: f64,
    start: &[f64],
    to: f64,
    by: Variable,
) -> Option<()> {
    let mut values = vec![0.0; system.facts().parameters.len()];
    system.values(&mut values);
    let mut flow = flow(system, omega);
    let mut tangent = Tangent::of_state(flow.coordinates(), Some(by));
    flow.advance(0.0, to, &mut start.to_vec(), Some(&mut tangent), None)
        .unwrap();
    let mut at = |direction: usize, step: f64| {
        let mut state = start.to_vec();
        let value = match by {
            Variable::Omega => omega,
            Variable::Parameter(index) => values[index],
        };
        if direction < start.len() {
            state[direction] += step;
            flow.set(by, value).unwrap();
        } else {
            flow.set(by, value + step).unwrap();
        }
        flow.advance(0.0, to, &mut state, None, None).unwrap();
        state
    };
    for (direction, column) in tangent.columns.chunks_exact(start.len()).enumerate() {
        let mut difference = |h: f64| -> Vec<f64> {
            let (plus, minus) = (at(direction, h), at(direction, -h));
            plus.iter()
                .zip(&minus)
                .map(|(p, m)| (p - m) / (2.0 * h))
                .collect()
        };
        let differences = [2e-5, 1e-5, 5e-6].map(&mut difference);
        let size = differences[2].iter().fold(1.0_f64, |m, x| m.max(x.abs()));
        for (i, exact) in column.iter().enumerate() {
            let [coarse, middle, fine] = [0, 1, 2].map(|k| differences[k][i]);
            // Of a motion that is smooth as far as it is displaced, errors are as the squares of the displacements. If it is
            // not, it touches or leaves a stop in between, and the differences are not those of one smooth function.
            let (first, second) = (coarse - middle, middle - fine);
            let smooth = (first - 4.0 * second).abs() < 0.05 * first.abs() + 1e-9 * size;
            if !smooth || first.abs() > 1e-5 * size {
                return None;
            }
            let error = (fine - second / 3.0 - exact).abs();
            assert!(
                error < 1e-8 * size,
                "{direction}: {error:e} {exact} {fine} {middle} {coarse}"
            );
        }
    }
    Some(())
}

fn stops() -> impl Strategy<Value = Stops> {
    let first = (
        0.3..3.0,
        -0.1..0.5,
        -0.5..2.0,
        0.0..1.0,
        0.0..20.0,
        -0.5..5.0,
    );
    let second = (0.0..1.0, 0.0..0.5, 0.0..0.5, -1.0..1.0, 0.0..2.0, 0.0..1.0);
    (first, second).prop_map(|(first, second)| {
        let (mass, damping, stiffness, play, upper, lower) = first;
        let (rub, preload, shake, load, drive, half) = second;
        Stops {
            mass,
            damping,
            stiffness,
            play,
            upper,
            lower,
            rub,
            preload,
            shake,
            load,
            drive,
            half,
        }
    })
}

fn two() -> impl Strategy<Value = Two> {
    let parts = (0.0..0.3, 0.0..30.0, -0.2..1.0, 0.0..5.0, 0.0..0.5, 0.0..2.0);
    parts.prop_map(|(zeta, stop, place, coupling, play, drive)| Two {
        zeta,
        stop,
        place,
        coupling,
        play,
        drive,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn one_coordinate(model in stops(), omega in 0.3..3.0, x in -2.0..2.0, v in -2.0..2.0) {
        compare(&model, omega, &[x, v], 9.0);
    }

    /// Without motion of the stops and with one harmonic: the arrays of fixed size.
    #[test]
    fn one_coordinate_of_one_harmonic(model in stops(), omega in 0.3..3.0, x in -2.0..2.0, v in -2.0..2.0) {
        let play = Clearance {
            damping: model.damping,
            stiffness: model.stiffness,
            play: model.play,
            upper: model.upper,
            lower: model.lower,
            rub: model.rub,
            preload: model.preload,
            load: model.load,
            drive: model.drive,
        };
        compare(&play, omega, &[x, v], 9.0);
    }

    #[test]
    fn two_coordinates(model in two(), omega in 0.3..3.0, x in -1.0..1.0, y in -1.0..1.0, v in -1.0..1.0) {
        compare(&model, omega, &[x, y, v, 0.3], 9.0);
    }

    #[test]
    fn tangent_of_one_coordinate(model in stops(), omega in 0.3..3.0, x in -2.0..2.0, v in -2.0..2.0, by in 0_usize..13) {
        let by = if by == 12 { Variable::Omega } else { Variable::Parameter(by) };
        prop_assume!(check_tangent(&model, omega, &[x, v], 8.0, by).is_some());
    }

    #[test]
    fn tangent_of_two_coordinates(model in two(), omega in 0.3..3.0, x in -1.0..1.0, y in -1.0..1.0, v in -1.0..1.0, by in 0_usize..7) {
        let by = if by == 6 { Variable::Omega } else { Variable::Parameter(by) };
        prop_assume!(check_tangent(&model, omega, &[x, y, v, 0.3], 8.0, by).is_some());
    }
}

/// Slow shaking of a stiff stop: what oscillates by itself does so many times in a radian of phase.
#[test]
fn a_stiff_stop_that_is_shaken_slowly() {
    let model = Stops {
        mass: 0.3,
        damping: 0.214_869,
        stiffness: 0.238_044,
        play: 0.797_584,
        upper: 14.029_232,
        lower: 0.0,
        rub: 0.572_985,
        preload: 0.249_767,
        shake: 0.0,
        load: 0.233_835,
        drive: 0.0,
        half: 0.0,
    };
    compare(&model, 0.3, &[0.0, 0.0], 2.2);
}

/// Thousands of ever shorter bounces, in which rounding errors of positions grow by the ratio of acceleration and speed.
#[test]
fn short_bounces_are_those_of_the_independent_flow() {
    let model = Stops {
        mass: 0.3,
        damping: 0.333_148_124_432_547_15,
        stiffness: 0.745_297_109_296_572_2,
        play: 0.517_087_238_386_076_7,
        upper: 19.424_176_033_361_274,
        lower: 0.0,
        rub: 0.518_364_569_574_284_7,
        preload: 0.363_056_245_330_882_9,
        shake: 0.0,
        load: 0.667_006_269_646_013,
        drive: 0.218_831_269_576_424_85,
        half: 0.061_984_673_346_979_87,
    };
    compare(&model, 0.3, &[0.0, 0.0], 4.3);
}

/// A mass that bounces on a level to which it is pushed from both sides: its speed decays with the time, and as many bounces fit in more.
#[test]
fn a_motion_that_comes_to_rest_on_a_level_is_compared_up_to_there() {
    let model = Stops {
        mass: 1.0,
        damping: 2.0,
        stiffness: 0.0,
        play: 0.05,
        upper: 20.0,
        lower: 0.0,
        rub: 0.5,
        preload: 2.0,
        shake: 0.0,
        load: 1.0,
        drive: 0.0,
        half: 0.0,
    };
    let mut state = [0.0, 0.0];
    let advanced = flow(&model, 1.0).advance(0.4, 20.0, &mut state, None, None);
    let rests = matches!(advanced, Err(FlowError::TooManySwitches { .. }));
    assert!(rests, "{advanced:?}");
    compare(&model, 1.0, &[0.0, 0.0], 20.0);
}

oscillator! {
    /// A mass between two fixed stops under one harmonic.
    Clearance(x) {
        /// damping
        param damping;
        /// stiffness
        param stiffness;
        /// half of the play
        param play >= 0;
        /// stiffness of the upper stop
        param upper;
        /// stiffness of the lower stop
        param lower;
        /// damping of the upper stop
        param rub;
        /// force of the upper stop at first touch
        param preload;
        /// constant load
        param load;
        /// amplitude
        param drive;

        /// the gap is measured against the coordinate
        law stops(gap) {
            gap > play  => lower*(gap - play),
            gap < -play => upper*(gap + play) + rub*dot(gap) - preload,
            else        => 0,
        }

        ddot(x) + damping*dot(x) + stiffness*x - stops(0.1 - x) = load + drive*sin(3*omega*t);
    }
}
