//! Events in the step next to a corner, or in that before a touch's own, of which both ends of the step show nothing; and what another event hides.
//!
//! Values are those of motions that are computed otherwise. With straight pieces: in closed form from switch to switch, the exponential of the matrix of each
//! piece, with the derivative of the map over a period and its jumps at switches; the modulus of a pair is one by the secant method in the frequency. Otherwise: by an
//! integrator of order 8 (tolerance 3e-14) between switches, with the derivative from differences, which tells the place to some 1e-9.

use hertzian::{Branch, ContactEquation, EventKind, FrequencyResponse, Shooting, System};

use crate::bifurcations::limbs::agrees;
use crate::bifurcations::preloads::{Masses, Preloads, assert_places};

hertzian::oscillator! {
    /// A stop whose dashpot does not pull.
    Pushing(x) {
        law stop(gap) { gap > 0 => max(0, 20*gap^1.5*(1 + 0.8*dot(gap))), else => 0 }
        ddot(x) + 0.04*dot(x) + x + stop(x - 0.6) = 0.6934*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// A bump of a ten-thousandth of the gap's range beside a stop.
    Bump(x) {
        law stop(gap) {
            gap > 0 => (7516.80327303667*gap^0.7371231213123255)*(1 + 0.697580885314424*dot(gap)),
            else => 0
        }
        law bump(gap) {
            1.8381428518674785*(gap/1.2164017796317535e-7)*exp(-((gap/1.2164017796317535e-7)^2))
        }
        0.03486603292902721*ddot(x) + 0.16790922644881556*dot(x) + 7113.3198480782285*x
            + stop(x) + bump(x - 0.000126039680292783) = 9.542267592636737*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// Play of which one side is touched, beside a smooth bump that nodes resolve to the tolerance.
    Play(x) {
        law play(gap) {
            gap > 0.7553865317027004 => 0.6509225236852505*(gap - 0.7553865317027004)^1.40813849291073,
            -0.7553865317027004 <= gap <= 0.7553865317027004 => 0,
            gap < -0.7553865317027004 => -(8.632917789114673*(-gap - 0.7553865317027004))
        }
        law bump(gap) { 0.11314166192071129*exp(-((gap/0.08912188422889752)^2)) }
        2.1811498423210907*ddot(x) + 0.19732558132610598*dot(x) + 0.6760391297907861*x + play(x)
            + 0.6666666666666666*bump(0.6666666666666666*x - 0.1117398743464259*sin(2/5*omega*t))
            = 0.08399535390225364*cos(omega*t) + 0.8076910388577745;
    }
}

/// Both methods, in both directions.
fn branches(system: &dyn System, [from, to]: [f64; 2]) -> Vec<Branch> {
    let mut branches = Vec::new();
    for ends in [[from, to], [to, from]] {
        let request = FrequencyResponse::of(system).from(ends[0]).to(ends[1]);
        branches.push(request.clone().by(ContactEquation::new()).run().unwrap());
        branches.push(request.by(Shooting::new()).run().unwrap());
    }
    branches
}

/// Downwards by the contact equation the last point before the touch at 1.41537501 is next to it, where moduli of multipliers go as the inverse of the root of
/// the way to it: two bifurcations are in the step before that point.
#[test]
fn two_bifurcations_before_a_point_beside_a_corner_are_found() {
    let system = &Masses {
        drive: 0.4339,
        preload: 0.0638,
    };
    agrees(system, [0.5, 2.2]);
    let expected = [1.415_417_292_772_284, 1.417_577_512_925_091];
    for branch in branches(system, [0.5, 2.2]) {
        let kind = EventKind::NeimarkSacker;
        assert_places(&branch, kind, [1.41, 1.43], &expected, 2e-14);
    }
}

/// Between two orbits on the way to a corner the pair that has left the unit circle becomes real, and one of both comes back at a fold: one multiplier is outside
/// as if the fold were all.
#[test]
fn a_fold_on_the_way_to_a_corner_hides_no_bifurcation() {
    let system = &Masses {
        drive: 0.3765,
        preload: 0.037,
    };
    agrees(system, [0.5, 2.2]);
    for branch in branches(system, [0.5, 2.2]) {
        // Its modulus goes as the root of the way to where the pair is real, 1e-9 of the frequency away: that is known to 1e-11.
        let expected = [1.426_397_913_841_016, 1.429_271_370_006_923];
        let kind = EventKind::NeimarkSacker;
        assert_places(&branch, kind, [1.42, 1.44], &expected, 5e-11);
    }
}

/// Downwards by shooting three doublings are in one long part of the way beside a corner, which shows one change of the sign. The two that were lost are asked for.
#[test]
fn three_doublings_on_the_way_to_a_corner_are_found() {
    let system = &Masses {
        drive: 0.1295,
        preload: 0.0581,
    };
    agrees(system, [0.5, 2.2]);
    for branch in branches(system, [0.5, 2.2]) {
        let expected = [0.986_997_247_040_814, 0.988_491_046_265_856];
        let kind = EventKind::PeriodDoubling;
        assert_places(&branch, kind, [0.9865, 0.99], &expected, 1e-12);
    }
}

/// The same beside two corners downwards by the contact equation.
#[test]
fn three_doublings_on_the_way_from_a_corner_are_found() {
    let system = &Preloads {
        drive: 0.8383,
        p: 0.4284,
    };
    agrees(system, [0.4, 2.2]);
    for branch in branches(system, [0.4, 2.2]) {
        let kind = EventKind::PeriodDoubling;
        for (window, expected) in [
            ([0.4096, 0.4099], 0.409_781_918_560_032),
            ([0.4762, 0.4763], 0.476_264_255_245_197),
        ] {
            assert_places(&branch, kind, window, &[expected], 1e-12);
        }
    }
}

/// Downwards by shooting two doublings are in the step before that in which the stop is touched, at 0.4856: nothing but the touch tells.
#[test]
fn two_doublings_in_the_step_before_that_of_a_touch_are_found() {
    let system = &Pushing {};
    for branch in branches(system, [0.4, 2.2]) {
        let expected = [0.487_933_872_1, 0.495_020_485_5];
        let kind = EventKind::PeriodDoubling;
        assert_places(&branch, kind, [0.485, 0.5], &expected, 1e-9);
    }
}

/// Panels that end where one orbit is in the bump step over it on the orbit before, of which they tell another sign.
#[test]
fn panels_of_one_orbit_hide_no_doubling_behind_another() {
    let system = &Bump {};
    for branch in branches(system, [606.407_785_1, 1_221.410_073_6]) {
        assert_eq!(branch.turns, []);
        // By shooting, whose errors are 1e-8, 4e-11 and 8e-12.
        let expected = [
            1_073.100_387_967_9,
            1_119.612_685_735_5,
            1_119.855_136_942_3,
        ];
        let kind = EventKind::PeriodDoubling;
        assert_places(&branch, kind, [606.0, 1_222.0], &expected, 1e-8);
    }
}

/// Orbits of the contact equation are known to 1e-6 of their size and jump by less than that where the play is touched.
#[test]
fn a_touch_at_which_orbits_jump_by_their_error_is_found() {
    let system = &Play {};
    for branch in branches(system, [0.732_562_12, 1.008_948_52]) {
        assert_eq!(branch.turns, []);
        let [touch] = &branch.events[..] else {
            panic!("{:?}", branch.events.len());
        };
        assert_eq!(touch.kind, EventKind::Grazing { turns: false });
        let off = (touch.point.value - 0.817_084_099_14).abs();
        assert!(touch.error < 2e-5, "{:e}", touch.error);
        assert!(off <= touch.error + 1e-11, "{off:e} {:e}", touch.error);
    }
}
