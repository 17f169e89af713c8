//! Bifurcations that the signs of test functions at the ends of a step do not show, or show as something else.

use hertzian::bifurcation::{Bifurcations, Reason};
use hertzian::{
    Branch, ContactEquation, Event, EventKind, FrequencyResponse, Shooting, Stop, System,
};

use crate::bifurcations::cascade::A1;

hertzian::oscillator! {
    /// The oscillator of figure 8, beside a mass on a hilltop: a multiplier of `exp(6 pi)`.
    BesideHilltop(x, y) {
        param drive;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
        ddot(y) - 9*y = 0;
    }
}

/// The determinant that vanishes is multiplied by 1.5e8, and so is its rounding.
#[test]
fn a_large_multiplier_hides_no_doubling() {
    let model = BesideHilltop { drive: 1.0 };
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0);
    let branch = shooting.from(1.0).to(1.4).run().unwrap();
    let doublings: Vec<_> = branch.events(EventKind::PeriodDoubling).collect();
    let [doubling] = doublings[..] else {
        panic!("{:?} {:?}", branch.events, branch.turns);
    };
    let error = (doubling.point.value - A1.drive).abs();
    assert!(
        error < 1e-7 && error <= doubling.error,
        "{doubling} {error:.1e}"
    );
}

hertzian::oscillator! {
    /// A driven oscillator, beside one whose stiffness varies: its rest loses stability in a tongue of the stiffness.
    Tongue(x, y) {
        param k;
        ddot(x) + 0.1*dot(x) + x = 0.1*cos(omega*t);
        ddot(y) + 0.02*dot(y) + (k + 0.05*cos(omega*t))*y = 0;
    }
}

fn values(branch: &Branch, kind: EventKind) -> Vec<f64> {
    branch.events(kind).map(|event| event.point.value).collect()
}

/// The tongue is much shorter than a step. To first order its ends are `k = 1/4 +- (p^2/4 - c^2/4)^(1/2)` with `p = 0.05`, `c = 0.02`.
#[test]
fn two_doublings_within_a_step() {
    let model = Tongue { k: 0.2 };
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("k")
        .omega(1.0)
        .from(0.12)
        .to(0.9);
    let long = values(&shooting.run().unwrap(), EventKind::PeriodDoubling);
    let short = shooting.largest_step(1e-3).run().unwrap();
    let short = values(&short, EventKind::PeriodDoubling);
    assert_eq!([long.len(), short.len()], [2, 2], "{long:?} {short:?}");
    let half = 0.5 * (0.05_f64.powi(2) - 0.02_f64.powi(2)).sqrt();
    for ((long, short), sign) in long.into_iter().zip(short).zip([-1.0, 1.0]) {
        assert!((long - short).abs() < 1e-9, "{long} {short}");
        assert!((long - 0.25 - sign * half).abs() < 2e-3, "{long}");
    }
}

hertzian::oscillator! {
    /// The oscillator of figure 5a, beside one whose stiffness vanishes at a frequency: there another branch crosses.
    BesidePitchfork(x, y) {
        param at;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
        ddot(y) + 0.5*dot(y) + (omega - at)*y + y^3 = 0;
    }
}

/// The fold of figure 5a, by the closed-form flow in 80-bit arithmetic (`frequency_response` of the reference values). Beside it
/// the frequency of the crossing is passed twice, before the fold and behind it, and once more below.
#[test]
fn a_fold_beside_crossings() {
    let fold = 0.715_119_549_676;
    for beside in [1e-2, 1e-3, 1e-4, 1e-5] {
        let at = fold + beside;
        let model = BesidePitchfork { at };
        let shooting = FrequencyResponse::of(&model)
            .by(Shooting::new())
            .from(1.2)
            .to(0.5);
        let branch = shooting.run().unwrap();
        let crossings: Vec<&Event> = branch.events(EventKind::SymmetryBreaking).collect();
        let near = |event: &&Event| (event.point.value - fold).abs() < 1e-9;
        assert_eq!(
            branch.folds().filter(near).count(),
            1,
            "{beside}: {:?}",
            branch.events
        );
        for event in &crossings {
            let error = (event.point.value - at).abs();
            assert!(
                error < 1e-9 && error <= event.error + 1e-15,
                "{event} {error:.1e}"
            );
        }
        assert!(
            crossings.len() >= 2,
            "{beside}: {:?} {:?}",
            branch.events,
            branch.turns
        );
    }
}

hertzian::oscillator! {
    /// Two oscillators of figure 8 that lose contact one after the other, at a drive of 0.064 times the load.
    Two(x, y) {
        param drive;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
        ddot(y) + contact(y) = drive*cos(omega*t) + 1.02;
    }
}

#[test]
fn two_levels_touched_within_a_step() {
    let model = Two { drive: 0.1 };
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0);
    let branch = shooting.from(0.05).to(0.2).run().unwrap();
    let touched: Vec<&Event> = branch.events(EventKind::Grazing { turns: false }).collect();
    assert_eq!(touched.len(), 2, "{:?}", branch.events);
    for (event, load) in touched.into_iter().zip([1.0, 1.02]) {
        let error = (event.point.value - 0.064 * load).abs();
        assert!(error < 1e-9 && error <= event.error, "{event} {error:.1e}");
    }
}

hertzian::oscillator! {
    /// A cubic spring with a Hertzian stop on one side.
    Stopped(x) {
        param drive;
        law stop(gap) { gap > 0 => 10*gap^1.5, else => 0 }
        ddot(x) + 0.06*dot(x) + x + 0.3*x^3 + stop(x - 0.5) = drive*cos(omega*t);
    }
}

/// Wherever a branch begins, it doubles at the same places, and every change of the verdict has an event.
#[test]
fn doublings_do_not_depend_on_where_a_branch_begins() {
    let model = Stopped { drive: 1.0 };
    for from in [0.3, 0.5, 0.8] {
        let branch = FrequencyResponse::of(&model)
            .by(Shooting::new())
            .from(from)
            .to(1.3)
            .run()
            .unwrap();
        let found: Vec<f64> = values(&branch, EventKind::PeriodDoubling)
            .into_iter()
            .filter(|value| (1.0..1.12).contains(value))
            .collect();
        let [low, high] = found[..] else {
            panic!(
                "{from} {found:?} {:?} {:?} {}",
                branch.events, branch.turns, branch.stopped
            );
        };
        assert!(
            (low - 1.053_610).abs() < 2e-6 && (high - 1.079_517).abs() < 2e-6,
            "{low} {high}"
        );
    }
}

/// However short the steps are, the branch of period two from one doubling ends at the other, and is followed once.
#[test]
fn no_branch_is_followed_twice() {
    let model = Stopped { drive: 1.0 };
    for step in [0.1, 0.03, 0.01, 0.005] {
        let request = Bifurcations::of(&model).from(0.8).to(1.3).depth(2);
        let diagram = request.largest_step(step).run().unwrap();
        let [first, second] = &diagram.branches[..] else {
            panic!("{step}: {} branches", diagram.branches.len());
        };
        assert_eq!([first.period(), second.period()], [1, 2]);
        let end = second.branch.stopped;
        let Stop::Joined {
            period: 1,
            symmetric: false,
            ..
        } = end
        else {
            panic!("{step}: {end}");
        };
        let reasons: Vec<_> = diagram.omitted.iter().map(|o| &o.reason).collect();
        assert_eq!(reasons, [&Reason::BranchEnds { branch: 1 }], "{step}");
        let joint = second.branch.events.last().unwrap();
        let doubling = first
            .branch
            .events(EventKind::PeriodDoubling)
            .nth(1)
            .unwrap();
        let apart = (joint.point.value - doubling.point.value).abs();
        assert!(apart <= joint.error + doubling.error, "{joint} {doubling}");
    }
}

hertzian::oscillator! {
    /// A linear oscillator, beside one that rests on a curve with a short fall: its two folds lie within a step.
    ShortFall(x, y) {
        param p;
        param a;
        param w > 0;
        param c;
        param f;
        ddot(x) + 0.1*dot(x) + 4*x = f*cos(omega*t);
        ddot(y) + 2*dot(y) + y - a*(y - c)/(1 + (y - c)^2/w^2) = p + 0.000001*cos(omega*t);
    }
}

/// The load `p = y - a z / (1 + z^2/w^2)` with `z = y - c` turns where `1 = a (1 - s) / (1 + s)^2`, `s = z^2/w^2`. The steps that follow
/// look at the one with the folds again, and find no further ones.
#[test]
fn two_folds_within_a_step_are_two() {
    let (a, w, c) = (1.000_173_8, 0.018_271, 0.534_954);
    let model = ShortFall {
        p: 0.5,
        a,
        w,
        c,
        f: 0.241_08,
    };
    let request = hertzian::FrequencyResponse::of(&model).vary("p").omega(1.0);
    let branch = request.from(0.0).to(1.0).harmonics(7).run().unwrap();
    let found: Vec<f64> = branch.folds().map(|fold| fold.point.value).collect();
    // s^2 + (2 + a) s + 1 - a = 0
    let s = 0.5 * ((a + 2.0).powi(2) + 4.0 * (a - 1.0)).sqrt() - 0.5 * (a + 2.0);
    let z = w * s.sqrt();
    let load = |z: f64| c + z - a * z / (1.0 + s);
    let [first, second] = found[..] else {
        panic!("{found:?}");
    };
    // Rising, the load is passed below the fall first.
    assert!((first - load(-z)).abs() < 1e-9, "{first} {}", load(-z));
    assert!((second - load(z)).abs() < 1e-9, "{second} {}", load(z));
}

hertzian::oscillator! {
    /// A linear oscillator that comes to a stop at its resonance only.
    Just(x) {
        param clearance;
        law stop(gap) { gap > 0 => gap^2, else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - clearance) = 0.1*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// Two linear oscillators with a stop each: while the amplitude of the one grows, that of the other falls.
    Exchanging(x, y) {
        param first;
        param second;
        law stop(gap) { gap > 0 => gap^2, else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - first) = 0.1*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 0.64*y + stop(y - second) = 0.1*cos(omega*t);
    }
}

/// What touches along a branch by either method, in either direction, in the order of frequencies, is what is known.
fn assert_touches<M: System>(model: &M, range: [f64; 2], known: [f64; 2]) {
    let [from, to] = range;
    for [from, to] in [[from, to], [to, from]] {
        let response = FrequencyResponse::of(model).from(from).to(to);
        let balance = response.clone().bifurcations(true).run().unwrap();
        let shooting = response.by(Shooting::new()).run().unwrap();
        for branch in [balance, shooting] {
            let grazing = EventKind::Grazing { turns: false };
            let mut touches: Vec<_> = branch.events(grazing).collect();
            touches.sort_by(|a, b| a.point.value.total_cmp(&b.point.value));
            assert_eq!(touches.len(), 2, "{touches:?} {:?}", branch.turns);
            for (touch, known) in touches.iter().zip(known) {
                let error = (touch.point.value - known).abs();
                assert!(
                    error < 1e-6 && error <= touch.error,
                    "{touch} {known} {error:.1e}"
                );
            }
        }
    }
}

/// Until it touches, the amplitude is `F / ((1 - w)^2 + c^2 w)^(1/2)` with `w = omega^2`: at most `F / (c^2 - c^4/4)^(1/2)`. The stop is
/// touched where the amplitude is the clearance, at two frequencies much less than a step apart.
#[test]
fn a_level_that_is_just_reached() {
    let (force, damping) = (0.1, 0.1_f64);
    let bend = 1.0 - 0.5 * damping * damping;
    let clearance = (1.0 - 1e-4) * force / (1.0 - bend * bend).sqrt();
    let root = (bend * bend - 1.0 + (force / clearance).powi(2)).sqrt();
    let known = [bend - root, bend + root].map(f64::sqrt);
    assert!(known[1] - known[0] < 2e-3);
    assert_touches(&Just { clearance }, [0.7, 1.3], known);
}

/// Levels are crossed as often behind both touches as before.
#[test]
fn one_stop_is_reached_and_another_one_left_within_a_step() {
    let known: [f64; 2] = [0.9, 0.9003];
    let amplitude =
        |stiffness: f64, omega: f64| 0.1 / (stiffness - omega * omega).hypot(0.1 * omega);
    let model = Exchanging {
        first: amplitude(1.0, known[0]),
        second: amplitude(0.64, known[1]),
    };
    // Each on one side of its resonance.
    assert_touches(&model, [0.85, 0.95], known);
}

hertzian::oscillator! {
    /// Two masses with a joint that is stiffer in compression.
    Joint(x, y) {
        law joint(gap) { gap > 0 => 0.9*gap, else => 1.86*gap }
        2*ddot(x) + 0.006*dot(x) + 0.45*x + 0.763*(x - y) + 0.0072*(dot(x) - dot(y)) - joint(y - x) = 0;
        ddot(y) + 0.03*dot(y) + 1.33*y + 0.763*(y - x) + 0.0072*(dot(y) - dot(x)) + joint(y - x) = 0.04*cos(omega*t);
    }
}

/// Two folds, between which the branch hardly leaves the line on which it goes before and behind them: a step that leads over them is one
/// that any test at its ends would pass. But on the way the joint opens and closes twice more.
#[test]
fn a_step_over_two_folds_is_made_again() {
    let joint = Joint {};
    for [from, to] in [[0.49, 0.55], [0.55, 0.49]] {
        let request = FrequencyResponse::of(&joint).from(from).to(to);
        let by_shooting = request.clone().by(Shooting::new()).run().unwrap();
        let by_balance = request.bifurcations(true).run().unwrap();
        let folds = [&by_balance, &by_shooting].map(|branch| {
            assert_eq!(
                (branch.stopped, branch.folds().count()),
                (Stop::ReachedEnd, 2)
            );
            let mut folds: Vec<&Event> = branch.folds().collect();
            folds.sort_by(|a, b| a.point.value.total_cmp(&b.point.value));
            folds
        });
        for (a, b) in folds[0].iter().zip(&folds[1]) {
            let apart = (a.point.value - b.point.value).abs();
            assert!(apart <= a.error + b.error && a.error < 1e-6, "{a} {b}");
        }
    }
}

hertzian::oscillator! {
    /// Six masses in a row, of which the first hits an elastic stop and the last is driven.
    Row(q[6]) {
        law stop(gap) { gap > 0 => 100*gap, else => 0 }
        ddot(q[0]) + 0.03*(dot(q[0]) - dot(q[1])) + q[0] - q[1] + stop(q[0] - 1) = 0;
        for i in 1..5 {
            ddot(q[i]) + 0.03*(2*dot(q[i]) - dot(q[i-1]) - dot(q[i+1])) + 2*q[i] - q[i-1] - q[i+1] = 0;
        }
        ddot(q[5]) + 0.03*(2*dot(q[5]) - dot(q[4])) + 2*q[5] - q[4] = 0.1*cos(omega*t);
    }
}

/// Close to a touch a pair of multipliers leaves the unit circle, and one of both comes back at minus one: at the ends of one step that looks
/// like one multiplier that has left. The contact equation and shooting have the same places.
#[test]
fn a_doubling_hides_no_torus() {
    let kinds = [EventKind::NeimarkSacker, EventKind::PeriodDoubling];
    let request = FrequencyResponse::of(&Row {}).from(0.224).to(0.2275);
    let by_shooting = request.clone().by(Shooting::new()).run().unwrap();
    let by_contact_equation = request.by(ContactEquation::new()).run().unwrap();
    assert_eq!(by_shooting.turns, []);
    assert_eq!(by_contact_equation.turns, []);
    for kind in kinds {
        let mut places = [&by_shooting, &by_contact_equation].map(|branch| {
            let found: Vec<f64> = branch.events(kind).map(|event| event.point.value).collect();
            assert_eq!(found.len(), 1, "{kind} {found:?}");
            found[0]
        });
        places.sort_by(f64::total_cmp);
        assert!(places[1] - places[0] < 1e-13, "{kind} {places:?}");
    }
}
