//! Systems whose fastest oscillation is far above their motion: steps over many ranges of a table.

use std::f64::consts::TAU;

use proptest::prelude::*;

use super::flow;
use super::random::compare_in_steps;
use crate::oscillator;
use crate::system::Variable;
use crate::time::{Flow, Stretch, Tangent};

oscillator! {
    /// A mass between two stops, with a light one on a stiff spring.
    Stiff(x, y) {
        /// mass of the light one
        param light > 0;
        /// damping between both
        param rub;
        /// stiffness between both
        param coupling;
        /// stiffness of the stops
        param stop;
        /// half of the play
        param play >= 0;
        /// force of the upper stop at first touch
        param preload;
        /// excitation
        param drive;

        /// stops on both sides
        law stops(gap) {
            gap > play  => preload + stop*(gap - play) + 0.3*dot(gap),
            gap < -play => stop*(gap + play),
            else        => 0,
        }

        ddot(x) + 0.04*dot(x) + x + stops(x - 0.1*sin(2*omega*t)) + coupling*(x - y) + rub*(dot(x) - dot(y)) = drive*cos(omega*t);
        light*ddot(y) + coupling*(y - x) + rub*(dot(y) - dot(x)) = 0.1;
    }
}

/// The fast oscillation has a rate of some 600 to 1300, and falls by a factor `e` within 0.1 to 0.003 units of time.
fn stiff() -> impl Strategy<Value = Stiff> {
    let parts = (
        1e-3..2e-3,
        0.02..0.6,
        800.0..1600.0,
        0.0..30.0,
        0.0..1.0,
        0.0..0.5,
        0.2..2.0,
    );
    parts.prop_map(|(light, rub, coupling, stop, play, preload, drive)| Stiff {
        light,
        rub,
        coupling,
        stop,
        play,
        preload,
        drive,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn motions(model in stiff(), omega in 0.3..2.0, x in -1.0..1.0, v in -1.0..1.0) {
        compare_in_steps(&model, omega, &[x, x, v, v], 9.0, 1e-3);
    }

    /// At once, and in pieces that are too short for steps over many ranges.
    #[test]
    fn perturbations(model in stiff(), omega in 0.3..2.0, x in -1.0..1.0, v in -1.0..1.0, by in 0_usize..8) {
        let by = if by == 7 { Variable::Omega } else { Variable::Parameter(by) };
        let mut flow = flow(&model, omega);
        let mut move_in = |parts: u32| {
            let mut tangent = Tangent::of_state(2, Some(by));
            let mut state = [x, x, v, v];
            let phase = |part: u32| 7.0 * f64::from(part) / f64::from(parts);
            for part in 0..parts {
                flow.advance(phase(part), phase(part + 1), &mut state, Some(&mut tangent), None).unwrap();
            }
            (tangent.columns, flow.work().steps)
        };
        let (whole, steps) = move_in(1);
        let (pieces, all) = move_in(2000);
        prop_assert!(all - steps > steps);
        for (whole, pieces) in whole.chunks_exact(4).zip(pieces.chunks_exact(4)) {
            let size = pieces.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
            for (i, (whole, pieces)) in whole.iter().zip(pieces).enumerate() {
                // What the light mass does changes by up to 1e9 with its mass, times a rounding error, and velocities by the fast rate more.
                let rounding = if i < 2 { 1e-9 } else { 1e-7 };
                prop_assert!((whole - pieces).abs() < rounding * size, "{whole} {pieces}");
            }
        }
    }
}

/// The fast oscillation turns by three radians in a thousandth of the phase: the independent flow steps in time.
#[test]
fn a_light_mass_that_is_shaken_slowly() {
    let model = Stiff {
        light: 0.001,
        rub: 0.02,
        coupling: 800.0,
        stop: 7.823_913_303_961_198,
        play: 0.784_032_203_272_942_7,
        preload: 0.0,
        drive: 1.588_321_642_364_930_2,
    };
    compare_in_steps(&model, 0.3, &[0.0; 4], 9.0, 1e-3);
}

/// Steps follow the motion, and not the fastest oscillation: it takes a thousand ranges of its tables in a period.
#[test]
fn steps_follow_the_motion() {
    let model = Stiff {
        light: 1e-4,
        rub: 0.05,
        coupling: 1e3,
        stop: 20.0,
        play: 0.5,
        preload: 0.0,
        drive: 0.4,
    };
    let mut flow = flow(&model, 0.9);
    let mut state = [0.1, 0.1, 0.0, 0.0];
    flow.advance(0.0, 20.0 * TAU, &mut state, None, None)
        .unwrap();
    let before = flow.work();
    let mut longest: f64 = 0.0;
    let mut see = |stretch: &dyn Stretch| {
        let (from, to) = stretch.phases();
        longest = longest.max(to - from);
    };
    flow.advance(0.0, TAU, &mut state, None, Some(&mut see))
        .unwrap();
    let work = flow.work();
    let steps = work.steps - before.steps;
    assert!(
        work.switches > before.switches + 1 && steps < 200,
        "{steps}"
    );
    assert!(longest > 0.05, "{longest}");
}
