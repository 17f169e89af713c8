//! The method that is chosen where none is asked for, and what comes of it.

use std::ops::ControlFlow;

use hertzian::system::System;
use hertzian::{
    Branch, ContactEquation, EventKind, FrequencyResponse, HarmonicBalance, OrbitMethodKind,
    Shooting, Side, Stage, Stop, Verdict,
};

use crate::resumed::{texts, written_and_read};

hertzian::oscillator! {
    /// Figure 5a of Wang et al. (2021).
    OneSided(x) {
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
    }
}

hertzian::oscillator! {
    Duffing(x) { ddot(x) + 0.1*dot(x) + x + x^3 = 0.2*cos(omega*t); }
}

hertzian::oscillator! {
    /// A spring of any exponent, to both sides.
    Power(x) {
        param alpha > 0;
        law spring(gap) { gap > 0 => gap^alpha, else => -(-gap)^alpha }
        ddot(x) + 0.05*dot(x) + spring(x) = 0.1*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// As stiff as you like on one side of its level alone.
    Mixed(x) {
        law spring(gap) { gap > 0 => gap^0.6, else => gap }
        ddot(x) + 0.05*dot(x) + spring(x) = 0.1*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// A spring of two contacts, figure 2a of Wang et al. (2021): the odd symmetry breaks below the resonance.
    Stops(x) {
        law stop(gap) { gap > 0 => gap^1.5, else => 0 }
        ddot(x) + 0.02*dot(x) + stop(x) - stop(-x) = 0.1*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// Nothing holds both masses together.
    Free(x, y) {
        law mesh(gap) { gap > 0 => 2*gap, else => gap }
        ddot(x) + 0.1*(dot(x) - dot(y)) + mesh(x - y) = 0.1*cos(omega*t);
        ddot(y) + 0.1*(dot(y) - dot(x)) - mesh(x - y) = 0;
    }
}

hertzian::oscillator! {
    Two(x, y) {
        ddot(x) + 0.1*dot(x) + 2*x - y = 0.1*cos(omega*t);
        ddot(y) + 0.1*dot(y) + 2*y - x = 0;
    }
}

hertzian::oscillator! {
    /// One function, in two pieces.
    Cube(x) {
        law spring(gap) { gap > 0 => gap^3, else => -(-gap)^3 }
        ddot(x) + 0.05*dot(x) + spring(x) = 0.1*cos(omega*t);
    }
}

fn followed(system: &dyn System) -> Branch {
    let request = FrequencyResponse::of(system).from(0.6).to(1.4);
    request.run().expect("a branch")
}

#[test]
fn laws_tell_the_method() {
    let contact = OrbitMethodKind::ContactEquation;
    let balance = OrbitMethodKind::HarmonicBalance;
    let shooting = OrbitMethodKind::Shooting;
    let steep = "the stiffness of law `spring` is unbounded on both sides of a level";
    for (system, method, why) in [
        (&OneSided {} as &dyn System, contact, "law `contact` opens"),
        (&Duffing {}, balance, "every force is smooth"),
        (&Power { alpha: 1.5 }, balance, "every force is smooth"),
        (&Power { alpha: 1.0 }, balance, "every force is smooth"),
        (&Power { alpha: 0.6 }, shooting, steep),
        (&Mixed {}, contact, "law `spring` has a corner"),
        (&Stops {}, contact, "law `stop` opens"),
        (&Free {}, contact, "law `mesh` has a corner"),
    ] {
        let request = FrequencyResponse::of(system);
        assert_eq!(request.choice(), method);
        assert_eq!(request.reason(), why);
    }
}

hertzian::oscillator! {
    /// A buckled beam between stops falls away from the middle.
    Buckled(x) {
        law stop(gap) { gap > 0 => 5*gap^1.5, else => 0 }
        ddot(x) + 0.25*dot(x) - x + stop(x - 1) - stop(-x - 1) = 0.1*cos(omega*t);
    }
}

/// Without its stops the beam grows by `exp(0.8828 * 2 pi / omega)` in a period.
#[test]
fn what_grows_within_a_period_is_followed_by_shooting() {
    let request = FrequencyResponse::of(&Buckled {});
    let quick = request.clone().from(1.5).to(1.0);
    assert_eq!(quick.choice(), OrbitMethodKind::ContactEquation);
    let slow = request.clone().from(0.3).to(0.1);
    assert_eq!(slow.choice(), OrbitMethodKind::Shooting);
    let why = "motions grow by many digits within a period without contacts";
    assert_eq!(slow.reason(), why);
    let branch = slow.run().unwrap();
    assert_eq!(branch.method(), Some(OrbitMethodKind::Shooting));
    assert_eq!(branch.stopped, Stop::ReachedEnd);
}

/// What rounding grows to is in the errors that the contact equation states.
#[test]
fn what_rounding_grows_to_is_stated() {
    let request = FrequencyResponse::of(&Buckled {}).tolerance(1e-10);
    for omega in [0.6, 0.4, 0.3] {
        let range = request.clone().from(omega).to(0.9 * omega).max_points(2);
        let found = range.clone().by(ContactEquation::new()).run().unwrap();
        let exact = range.by(Shooting::new()).run().unwrap();
        let [found, exact] = [&found, &exact].map(|branch| &branch.points[0]);
        let off = (found.peak_to_peak() / exact.peak_to_peak() - 1.0).abs();
        let errors = [found, exact].map(|point| point.error.unwrap());
        assert!(off <= errors[0] + errors[1], "{omega}: {off:e} {errors:?}");
        let followed = std::f64::consts::TAU / omega / found.orbit.parts as f64;
        let grown = f64::EPSILON * (0.8828 * followed).exp();
        assert!(errors[0] >= grown, "{omega}: {errors:?}");
    }
}

/// Without multipliers a loss of symmetry shows in the equations of the balance alone.
#[test]
fn steep_laws_without_multipliers_are_of_the_balance() {
    let request = FrequencyResponse::of(&Power { alpha: 0.6 }).stability(false);
    let branch = request
        .tolerance(1e-3)
        .from(1.4)
        .to(1.3)
        .run()
        .expect("a branch");
    assert_eq!(branch.method(), Some(OrbitMethodKind::HarmonicBalance));
}

/// To many digits a force that is another function on the other side of a level has many harmonics.
#[test]
fn the_tolerance_tells_the_method() {
    let contact = "law `spring` has a level that matters to so many digits";
    let balance = "every force is smooth";
    for (system, tolerance, why) in [
        (&Power { alpha: 1.5 } as &dyn System, 1e-7, balance),
        (&Power { alpha: 1.5 }, 1e-8, contact),
        (&Power { alpha: 2.0 }, 1e-10, contact),
        (&Cube {}, 1e-10, balance),
        (&Duffing {}, 1e-10, balance),
    ] {
        let request = FrequencyResponse::of(system).tolerance(tolerance);
        assert_eq!(request.reason(), why);
        let method = request.choice();
        let branch = request.from(0.9).to(0.95).run().expect("a branch");
        assert_eq!(branch.method(), Some(method));
        assert_eq!(method == OrbitMethodKind::HarmonicBalance, why == balance);
    }
}

/// The folds of Wang et al. (2021), figure 5a, computed apart from this project.
#[test]
fn a_contact_that_opens_has_folds_to_nine_digits() {
    let branch = followed(&OneSided {});
    assert_eq!(branch.method(), Some(OrbitMethodKind::ContactEquation));
    let mut folds: Vec<f64> = branch.folds().map(|fold| fold.point.value).collect();
    folds.sort_by(f64::total_cmp);
    let exact = [0.715_119_549_676_419, 0.960_163_671_878_57];
    assert_eq!(folds.len(), exact.len());
    for (fold, exact) in folds.iter().zip(exact) {
        assert!((fold - exact).abs() < 1e-9, "{fold} {exact}");
    }
    // As the balance has it.
    let other = FrequencyResponse::of(&OneSided {}).by(HarmonicBalance::new());
    let other = other.from(0.6).to(1.4).run().expect("a branch");
    let [orbits, others] = [&branch, &other].map(|branch| branch.at(0.85).expect("orbits"));
    assert_eq!((orbits.len(), others.len()), (3, 3));
    for (orbit, other) in orbits.iter().zip(&others) {
        let [one, same] = [orbit, other].map(|point| &point.observed.contacts[0]);
        assert!((one.peak_force / same.peak_force - 1.0).abs() < 1e-4);
        assert_eq!(
            (one.count, orbit.stability.verdict),
            (same.count, other.stability.verdict)
        );
        assert!(orbit.error < Some(1e-9) && orbit.orbit.harmonics() > 0);
    }
}

#[test]
fn an_option_of_the_balance_asks_for_it() {
    let request = FrequencyResponse::of(&OneSided {}).from(0.6).to(0.65);
    let asked: [fn(FrequencyResponse) -> FrequencyResponse; 4] = [
        |request| request.harmonics(10),
        |request| request.doublings(true),
        |request| request.bifurcations(true),
        |request| request.symmetric(false),
    ];
    for set in asked {
        let branch = set(request.clone()).run().expect("a branch");
        assert_eq!(branch.method(), Some(OrbitMethodKind::HarmonicBalance));
    }
    let asked = request.harmonics(10).by(ContactEquation::new());
    assert_eq!(
        asked.run().expect("a branch").method(),
        Some(OrbitMethodKind::ContactEquation)
    );
}

#[test]
fn what_the_contact_equation_refuses_goes_to_the_balance() {
    let branch = followed(&Free {});
    assert_eq!(branch.method(), Some(OrbitMethodKind::HarmonicBalance));
    assert!(
        branch
            .points
            .iter()
            .all(|point| point.stability.verdict == Verdict::Stable)
    );
}

/// Without multipliers the contact equation does not see that a symmetry breaks, and the balance does.
#[test]
fn no_broken_symmetry_is_lost() {
    let request = FrequencyResponse::of(&Stops {}).from(0.45).to(0.3);
    let with = request.clone().run().expect("a branch");
    let without = request.stability(false).run().expect("a branch");
    let found = [&with, &without].map(|branch| branch.events(EventKind::SymmetryBreaking).count());
    assert!(found[0] > 0 && found[0] == found[1], "{found:?}");
    assert_eq!(with.method(), Some(OrbitMethodKind::ContactEquation));
    assert_eq!(without.method(), Some(OrbitMethodKind::HarmonicBalance));
}

/// So it is of branches both ways, and of those that begin at an event.
#[test]
fn no_broken_symmetry_is_lost_both_ways() {
    let request = FrequencyResponse::of(&Stops {}).from(0.45).to(0.3);
    let with = request.clone().through(0.4).expect("a branch");
    let quick = request.stability(false);
    let without = quick.through(0.4).expect("a branch");
    let found = [&with, &without].map(|branch| branch.events(EventKind::SymmetryBreaking).count());
    assert!(found[0] > 0 && found[0] == found[1], "{found:?}");
    assert_eq!(without.method(), Some(OrbitMethodKind::HarmonicBalance));
    // Nothing is left that could break on the branch that begins there.
    let event = with.events(EventKind::SymmetryBreaking).next();
    let other = quick.switch(event.expect("an event"), Side::One);
    assert_eq!(
        other.expect("a branch").method(),
        Some(OrbitMethodKind::ContactEquation)
    );
}

/// What a law is at both ends of the range counts, and not what it is now.
#[test]
fn the_range_of_a_parameter_tells_the_method() {
    let shooting = OrbitMethodKind::Shooting;
    let balance = OrbitMethodKind::HarmonicBalance;
    for (now, range, method) in [
        (1.5, [1.5, 0.8], shooting),
        (1.5, [0.8, 1.5], shooting),
        (0.8, [1.5, 1.2], balance),
        (1.5, [1.5, 1.2], balance),
    ] {
        let request = FrequencyResponse::of(&Power { alpha: now }).vary("alpha");
        let request = request.omega(0.6).from(range[0]).to(range[1]);
        assert_eq!(request.choice(), method, "{now} {range:?}");
        let branch = request.run().expect("a branch");
        assert_eq!(branch.method(), Some(method), "{now} {range:?}");
    }
}

/// An orbit that cannot be completed costs no other one.
#[test]
fn all_others_are_completed() {
    let mut branch = followed(&OneSided {});
    let states = FrequencyResponse::of(&Two {}).by(Shooting::new());
    let states = states.from(0.6).to(0.7).run().expect("a branch");
    branch.points[3] = states.points[0].clone();
    let error = branch.complete_all().expect_err("one is of another system");
    assert!(error.to_string().contains("state"), "{error}");
    for (index, point) in branch.points.iter().enumerate() {
        assert_eq!(point.orbit.harmonics() > 0, index != 3);
    }
    let mut begun = followed(&OneSided {});
    let mut seen = Vec::new();
    let stopped = begun.complete_all_with(|progress| {
        seen.push((progress.stage, progress.done, progress.total));
        if progress.done < 2 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    stopped.expect("nothing failed");
    let total = Some(begun.points.len());
    assert_eq!(seen, [1, 2].map(|done| (Stage::Completing, done, total)));
    let completed = begun
        .points
        .iter()
        .filter(|point| point.orbit.harmonics() > 0);
    assert_eq!(completed.count(), 2);
}

#[test]
fn a_branch_is_resumed_by_what_followed_it() {
    let request = FrequencyResponse::of(&OneSided {}).from(0.6).to(1.4);
    let whole = request.clone().run().expect("a branch");
    let part = request.max_points(40).run().expect("a branch");
    let resumed = part.resume().max_points(20_000).run().expect("the rest");
    assert_eq!(resumed.method(), Some(OrbitMethodKind::ContactEquation));
    assert!(resumed.points == whole.points);
}

hertzian::oscillator! {
    /// The contact equation is lost where the gap touches zero, with forces on both sides; the law of what is far away chooses it.
    Touching(x) {
        law spring(gap) { gap > 0 => gap^2.2, else => -(-gap)^2.2 }
        law far(gap) { gap > 0 => gap, else => 0 }
        ddot(x) + 0.064*dot(x) + spring(x) + far(x - 100) = 0.3 + 0.1*cos(omega*t);
    }
}

fn touching() -> FrequencyResponse {
    let request = FrequencyResponse::of(&Touching {}).tolerance(1e-3);
    request.from(1.6).to(0.6)
}

/// Stopped when so many points were seen, by the method that is tried first or by the one that is tried then.
fn interrupted(request: &FrequencyResponse, stage: Stage, points: usize) -> Branch {
    let part = request.run_with(|progress| {
        if progress.stage == stage && progress.done >= points {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    part.expect("a part")
}

/// It is interrupted while the contact equation leads on, and while the balance is behind it and ahead of it.
const INTERRUPTED: [(Stage, usize); 4] = [
    (Stage::Branch, 30),
    (Stage::Again, 1),
    (Stage::Again, 20),
    (Stage::Again, 100),
];

#[test]
fn a_branch_that_is_resumed_has_the_balance_to_fall_back_on() {
    let request = touching();
    let whole = request.run().expect("a branch");
    assert_eq!(whole.stopped, Stop::ReachedEnd);
    for (stage, points) in INTERRUPTED {
        let part = interrupted(&request, stage, points);
        assert_eq!(part.stopped, Stop::Interrupted, "{stage} {points}");
        let mut read = written_and_read(&part, "touching");
        read.attach(&Touching {}).expect("its model");
        for part in [part, read] {
            let resumed = part.resume().run().expect("a branch");
            assert_eq!(resumed.method(), whole.method());
            assert!(texts(&resumed) == texts(&whole), "{stage} {points}");
        }
    }
    // A limit is that of each of both.
    for points in [20, 80, 100] {
        let part = request.clone().max_points(points).run().expect("a part");
        assert_eq!(part.stopped, Stop::PointLimit { points });
        let resumed = part.resume().max_points(1000).run().expect("a branch");
        assert!(texts(&resumed) == texts(&whole), "{points}");
    }
    // What is followed beyond its range is followed anew where it is lost there.
    let short = request.clone().to(1.2).run().expect("a branch");
    let longer = short.resume().to(0.6).run().expect("a branch");
    assert_eq!(longer.stopped, Stop::ReachedEnd);
    let [longer, whole] = [longer, whole].map(|branch| branch.folds().count());
    assert_eq!(longer, whole);
}

#[test]
fn a_branch_that_is_kept_has_the_balance_to_fall_back_on() {
    let name = format!("hertzian-touching-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    let request = touching();
    let whole = request.run().expect("a branch");
    let kept = request.clone().keep(&path);
    let ended = kept.run().expect("a branch");
    assert!(texts(&ended) == texts(&whole));
    assert!(texts(&Branch::read(&path).expect("read")) == texts(&ended));
    for (stage, points) in INTERRUPTED {
        let mut killed = None;
        let part = kept.run_with(|progress| {
            let last = progress.stage == stage && progress.done >= points;
            if last {
                killed = std::fs::read(&path).ok();
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        });
        assert!(texts(&Branch::read(&path).expect("read")) == texts(&part.expect("a part")));
        let ended = std::fs::read(&path).expect("a file");
        // As it has ended, and as it is where the program is killed at that moment.
        for text in [Some(ended), killed].into_iter().flatten() {
            std::fs::write(&path, text).expect("written");
            let mut read = Branch::read(&path).expect("read");
            read.attach(&Touching {}).expect("its model");
            let resumed = read.resume().keep(&path).run().expect("a branch");
            assert!(texts(&resumed) == texts(&whole), "{stage} {points}");
            assert!(texts(&Branch::read(&path).expect("read")) == texts(&resumed));
        }
    }
    std::fs::remove_file(path).expect("removed");
}

/// Orbits are counted once for each method.
#[test]
fn progress_says_that_the_balance_is_tried() {
    let mut seen = Vec::new();
    let whole = touching().run_with(|progress| {
        seen.push((progress.stage, progress.done));
        ControlFlow::Continue(())
    });
    let (method, count) = whole
        .map(|branch| (branch.method(), branch.points.len()))
        .expect("a branch");
    assert_eq!(method, Some(OrbitMethodKind::HarmonicBalance));
    let first = seen.iter().take_while(|(stage, _)| *stage == Stage::Branch);
    let first = first.count();
    let [found, again] = [1..=first, 1..=count].map(Iterator::collect::<Vec<usize>>);
    let done: Vec<usize> = seen.iter().map(|(_, done)| *done).collect();
    assert!(first > 0 && done == [found, again].concat());
    assert!(
        seen[first..]
            .iter()
            .all(|(stage, _)| *stage == Stage::Again)
    );
}

/// It looks for what the contact equation would find.
#[test]
fn the_balance_that_is_tried_finds_all_events() {
    let tried = touching().run().expect("a branch");
    let balance = HarmonicBalance::new().bifurcations(true);
    let asked = touching().by(balance).run().expect("a branch");
    let [tried, asked] = [tried, asked].map(|branch| texts(&branch));
    assert!(tried == asked);
}
