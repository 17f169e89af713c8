//! The method that is chosen where none is asked for, and what comes of it.

use hertzian::system::System;
use hertzian::{
    Branch, Choice, ContactEquation, EventKind, FrequencyResponse, HarmonicBalance, Verdict,
};

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

fn followed(system: &dyn System) -> Branch {
    let request = FrequencyResponse::of(system).from(0.6).to(1.4);
    request.run().expect("a branch")
}

#[test]
fn laws_tell_the_method() {
    let contact = "contact equation";
    let balance = "harmonic balance";
    for (system, method, why) in [
        (&OneSided {} as &dyn System, contact, "law `contact` opens"),
        (&Duffing {}, balance, "every force is smooth"),
        (&Power { alpha: 1.5 }, balance, "every force is smooth"),
        (&Power { alpha: 1.0 }, balance, "every force is smooth"),
        (&Power { alpha: 0.6 }, contact, "law `spring` has a corner"),
        (&Stops {}, contact, "law `stop` opens"),
        (&Free {}, contact, "law `mesh` has a corner"),
    ] {
        let choice = Choice::of(system);
        assert_eq!(choice.method(), method);
        assert_eq!(choice.to_string(), format!("{method}, since {why}"));
    }
}

/// The folds of Wang et al. (2021), figure 5a, computed apart from this project.
#[test]
fn a_contact_that_opens_has_folds_to_nine_digits() {
    let branch = followed(&OneSided {});
    assert_eq!(branch.method(), Some("contact equation"));
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
        assert_eq!(branch.method(), Some("harmonic balance"));
    }
    let asked = request.harmonics(10).by(ContactEquation::new());
    assert_eq!(
        asked.run().expect("a branch").method(),
        Some("contact equation")
    );
}

#[test]
fn what_the_contact_equation_refuses_goes_to_the_balance() {
    let branch = followed(&Free {});
    assert_eq!(branch.method(), Some("harmonic balance"));
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
    assert_eq!(with.method(), Some("contact equation"));
    assert_eq!(without.method(), Some("harmonic balance"));
}

#[test]
fn a_branch_is_resumed_by_what_followed_it() {
    let request = FrequencyResponse::of(&OneSided {}).from(0.6).to(1.4);
    let whole = request.clone().run().expect("a branch");
    let part = request.max_points(40).run().expect("a branch");
    let resumed = part.resume().max_points(20_000).run().expect("the rest");
    assert_eq!(resumed.method(), Some("contact equation"));
    assert!(resumed.points == whole.points);
}
