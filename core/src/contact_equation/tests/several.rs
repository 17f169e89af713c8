//! Branches of several masses with several stops, whose switches pass each other beside touches and folds: every event is that of shooting,
//! in both directions, and nothing is left that could not be located.

use super::events_agree;
use crate::system::System;
use crate::{Branch, ContactEquation, EventKind, FrequencyResponse, Shooting};

crate::oscillator! {
    /// Two masses between stops on both sides.
    Both(x, y) {
        param k;
        param c;
        param s;
        param g;
        param drive;
        param ky;
        law stop(gap) { gap > 0 => k*gap^1.5 + c*gap*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + 0.5*x + s*(x - y) + stop(x - g) - stop(-x - g) = drive*cos(omega*t);
        ddot(y) + 0.1*dot(y) + ky*y - s*(x - y) + stop(y - g) - stop(-y - g) = 0;
    }
}

crate::oscillator! {
    /// Three masses in a row, the last one with a stop on the other side.
    Row(x, y, z) {
        param k;
        param c;
        param s;
        param g;
        param drive;
        param ky;
        law stop(gap) { gap > 0 => k*gap + c*gap*dot(gap), else => 0 }
        ddot(x) + 0.1*dot(x) + 0.5*x + s*(x - y) + stop(x - g) = drive*cos(omega*t);
        ddot(y) + 0.1*dot(y) + ky*y - s*(x - y) + s*(y - z) + stop(y - g) = 0;
        ddot(z) + 0.1*dot(z) + ky*z - s*(y - z) - stop(-z - g) = 0;
    }
}

crate::oscillator! {
    /// Three masses in a row, two of which are pressed together by a load.
    Pressed(x, y, z) {
        param coupling;
        law hertz(gap) { gap > 0 => 44_127_054.215_448_89*gap^2.5, else => 0 }
        let mass = 19.791_324_152_410_05;
        let damper = 14.291_481_523_489_097;
        let touch = hertz(x - y);
        mass*ddot(x) + 112.915_333_831_176_87*dot(x) + coupling*(x - y) + damper*(dot(x) - dot(y)) + touch
            = 59_689.454_869_124_55*cos(omega*t);
        mass*ddot(y) + 26.362_669_243_668_073*dot(y) + 966_230.587_326_636_8*y + coupling*(y - x) + damper*(dot(y) - dot(x))
            + 509_122.348_889_774_93*(y - z) + 10.209_909_257_165_892*(dot(y) - dot(z)) - touch = 0;
        mass*ddot(z) + 39.587_489_302_240_36*dot(z) + 509_122.348_889_774_93*(z - y) + 10.209_909_257_165_892*(dot(z) - dot(y))
            = 217_979.569_101_125_18;
    }
}

crate::oscillator! {
    /// Two masses in contact, the first of which meets a stop whose stiffness pulsates.
    Pulsating(x, y) {
        param coupling;
        law stop(gap) { gap > 0 => 1_018_479_623.466_673_9*gap, else => 0 }
        law hertz(gap) { gap > 0 => 14_165_405_490_057.99*gap^(2.744_522_900_391_128), else => 0 }
        let mass = 78.027_520_101_305_67;
        let damper = 2075.114_242_913_595_3;
        mass*ddot(x) + 24_330.136_445_510_536*dot(x) + 64_242_340.612_871_826*x + coupling*(x - y) + damper*(dot(x) - dot(y))
            + stop(x - y) + (1 + 0.155_334_833_060_413_46*cos(2*omega*t))*hertz(x) = 0;
        mass*ddot(y) + 2477.952_853_666_095*dot(y) + 85_128_677.941_766_87*y + coupling*(y - x) + damper*(dot(y) - dot(x))
            - stop(x - y) = 22_931.553_603_450_797*cos(omega*t) + 40_153.787_219_314_094;
    }
}

fn row([k, c, s, g, drive, ky]: [f64; 6]) -> Row {
    Row {
        k,
        c,
        s,
        g,
        drive,
        ky,
    }
}

fn agree(system: &dyn System, range: [f64; 2]) -> Branch {
    let [from, to] = range;
    events_agree(&FrequencyResponse::of(system).from(from).to(to))
}

/// Two intervals that overlap while their switches are out of order see one extreme each: it is watched once.
#[test]
fn an_extreme_that_is_seen_twice_is_watched_once() {
    let model = row([
        9.061_52,
        0.376_961,
        1.157_93,
        0.074_786_3,
        0.256_091,
        0.627_31,
    ]);
    agree(&model, [0.443_59, 0.743_854]);
    let model = row([
        4.873_13,
        0.075_801_6,
        0.839_04,
        0.158_805,
        0.475_267,
        1.055_59,
    ]);
    agree(&model, [0.464_01, 1.176]);
}

/// The last step goes beyond the end of the range, where there is no orbit by its equations: a shorter one leads to other equations before.
#[test]
fn the_end_of_a_range_beside_a_change_of_order_is_reached() {
    let model = row([
        9.036_05, 0.446_498, 0.493_015, 0.209_095, 0.419_875, 1.393_07,
    ]);
    agree(&model, [0.532_392, 1.049_79]);
}

/// A pair of multipliers leaves the circle before a touch and comes back behind it, within one step.
#[test]
fn tori_on_both_sides_of_a_touch_are_found() {
    let model = row([
        11.396_3, 0.321_847, 1.356_08, 0.353_897, 0.416_173, 1.037_33,
    ]);
    for range in [[0.435_359, 1.061_12], [1.061_12, 0.435_359]] {
        let branch = agree(&model, range);
        let tori = branch.events.iter();
        let tori = tori.filter(|event| event.kind == EventKind::NeimarkSacker);
        assert_eq!(tori.count(), 6);
    }
}

/// Between a change of order and a point a branch turns: slope and multipliers there are those of equations in the order of the orbits.
#[test]
fn folds_and_tori_beside_a_change_of_order_are_found() {
    let model = row([7.637_8, 0.445_477, 1.561_78, 0.312_49, 0.447_371, 0.732_671]);
    let branch = agree(&model, [0.658_621, 0.982_975]);
    assert_eq!(branch.folds().count(), 4);
    let model = row([16.791, 0.437_089, 1.928_22, 0.136_941, 0.164_169, 0.634_741]);
    let branch = agree(&model, [1.583_3, 0.795_33]);
    let tori = branch.events.iter();
    let tori = tori.filter(|event| event.kind == EventKind::NeimarkSacker);
    assert_eq!(tori.count(), 12);
    let model = row([
        10.190_1, 0.390_334, 0.792_689, 0.166_426, 0.745_11, 1.139_19,
    ]);
    agree(&model, [0.888_475, 1.440_59]);
}

/// A step to an orbit whose equations have no place for the one before is made again, shorter: what happens in it is looked for between both.
#[test]
fn a_step_over_several_changes_is_divided() {
    let (k, c, s) = (3.991_19, 0.421_121, 0.850_548);
    let (g, drive, ky) = (0.055_013_6, 0.294_618, 1.246_52);
    let model = Both {
        k,
        c,
        s,
        g,
        drive,
        ky,
    };
    agree(&model, [1.044_78, 0.527_498]);
}

/// One pair of multipliers leaves the circle in the step in which another one comes back, as many are outside at both ends, and behind a change of
/// nodes nothing but multipliers is known of the orbit before it.
#[test]
fn a_torus_that_follows_upon_another_one_behind_a_change_of_nodes_is_found() {
    let model = Pressed {
        coupling: 137_662.294_229_879_57,
    };
    for range in [[183.0, 281.0], [281.273_012_842_823_96, 183.0]] {
        let branch = FrequencyResponse::of(&model).from(range[0]).to(range[1]);
        let exact = branch.clone().by(Shooting::new()).run().unwrap();
        let branch = branch.by(ContactEquation::new()).run().unwrap();
        let tori = |branch: &Branch| -> Vec<f64> {
            let events = branch.events.iter();
            let tori = events.filter(|event| event.kind == EventKind::NeimarkSacker);
            let mut values: Vec<f64> = tori.map(|event| event.point.value).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let (found, exact) = (tori(&branch), tori(&exact));
        assert_eq!(found.len(), 6);
        for (found, exact) in found.iter().zip(&exact) {
            assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact}");
        }
    }
}

/// What nodes leave out of the height of an extreme moves the touch by many times what they leave out of the branch.
#[test]
fn errors_of_touches_are_those_of_their_extremes() {
    let model = Pulsating {
        coupling: 96_596_145.618_151_8,
    };
    for range in [
        [908.653_767_320_712_2, 598.729_688_281_939_6],
        [598.729_688_281_939_6, 908.653_767_320_712_2],
    ] {
        let branch = FrequencyResponse::of(&model).from(range[0]).to(range[1]);
        let exact = branch
            .clone()
            .by(Shooting::new().tolerance(1e-12))
            .run()
            .unwrap();
        let branch = branch.by(ContactEquation::new()).run().unwrap();
        assert_eq!(branch.events.len(), 2);
        for (found, exact) in branch.events.iter().zip(&exact.events) {
            let apart = (found.point.value - exact.point.value).abs();
            assert!(
                apart < found.error + exact.error,
                "{apart:e} {:e}",
                found.error
            );
            assert!(found.error < 1e-9 * found.point.value);
        }
    }
}
