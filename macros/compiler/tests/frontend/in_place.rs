//! Forces written in the equation in place: what a law may be, they may be, and their faults are quoted as written.

use hertzian_compiler::dag::{Id, Variable};
use hertzian_compiler::ir::Model;
use hertzian_contract::system::Place;

use crate::{faults, model};

const K: f64 = 3.0;
const C: f64 = 0.7;

/// What the forces of a model add to `ddot(x)`, by its coefficients and laws.
fn force(model: &Model, x: f64, v: f64) -> f64 {
    let parameter = |variable| match variable {
        Variable::Parameter(index) => [K, C][index],
        other => panic!("{other:?} in a coefficient"),
    };
    let value = |id: Id| model.dag.evaluate(id, &parameter);
    let total = |wanted: &dyn Fn(Place) -> bool| -> f64 {
        let places = model.coefficients.iter();
        let found = places.filter(|&&(place, _)| wanted(place));
        found.map(|&(_, id)| value(id)).sum()
    };
    let mut sum = x * total(&|place| matches!(place, Place::Stiffness { .. }))
        + v * total(&|place| matches!(place, Place::Damping { .. }))
        - total(&|place| matches!(place, Place::Load { .. }));
    for (index, of) in model.contacts.iter().enumerate() {
        let law = &model.laws[of.law];
        let into = total(
            &|place| matches!(place, Place::GapDirection { contact, .. } if contact == index),
        );
        let out = total(
            &|place| matches!(place, Place::ForceDirection { contact, .. } if contact == index),
        );
        let variable = |variable| match variable {
            Variable::Gap => into * x,
            Variable::Rate => into * v,
            Variable::Argument(argument) => total(&|place| {
                let wanted = (index, argument);
                matches!(place, Place::Argument { contact, index } if (contact, index) == wanted)
            }),
            other => panic!("{other:?} in a law"),
        };
        let below = law.levels.iter().take_while(|level| {
            let height = into * x - model.dag.evaluate(level.value, &variable);
            height > 0.0 || (height == 0.0 && level.belongs_above)
        });
        let piece = law.pieces[below.count()];
        sum += out * model.dag.evaluate(piece, &variable);
    }
    sum
}

/// A force of `g` in place, the same as a law, and the same by hand agree.
fn assert_force(term: &str, by_hand: impl Fn(f64, f64) -> f64) {
    let head = "M(x) { param k > 0; param c in 0.0..;";
    let in_place = term.replace('g', "x");
    let models = [
        format!("{head} ddot(x) + 0*(k + c)*x + {in_place} = 0; }}"),
        format!("{head} law f(g) {{ {term} }} ddot(x) + 0*(k + c)*x + f(x) = 0; }}"),
    ];
    for text in models {
        let model = model(&text);
        for x in [-1.3, -0.4, 0.0, 0.2, 0.9, 2.5] {
            for v in [-3.0, -1.1, -0.5, 0.0, 0.3, 1.7] {
                let (value, expected) = (force(&model, x, v), by_hand(x, v));
                let bound = 1e-14 * (1.0 + expected.abs());
                assert!(
                    (value - expected).abs() <= bound,
                    "{value}, not {expected}, at {x}, {v} in {text}"
                );
            }
        }
    }
}

#[test]
fn extrema_of_gap_and_rate_are_those_of_a_law() {
    assert_force("max(0, 1 + 2*dot(g))", |_, v| f64::max(0.0, 1.0 + 2.0 * v));
    assert_force("g^2*max(0, 1 + 2*dot(g))", |x, v| {
        x * x * f64::max(0.0, 1.0 + 2.0 * v)
    });
    assert_force("max(0, g)*max(0, 1 + 2*dot(g))", |x, v| {
        x.max(0.0) * f64::max(0.0, 1.0 + 2.0 * v)
    });
    assert_force("(max(0, k*g + c*dot(g)) + 1)*g", |x, v| {
        (f64::max(0.0, K * x + C * v) + 1.0) * x
    });
    assert_force("max(0, k*g + c*dot(g))*H(g) + g^3", |x, v| {
        let contact = if x > 0.0 {
            f64::max(0.0, K * x + C * v)
        } else {
            0.0
        };
        contact + x.powi(3)
    });
    assert_force("min(k*g, 1 - dot(g))", |x, v| (K * x).min(1.0 - v));
    // Products of numbers of so many digits are not exact.
    assert_force(
        "max(0, 1.3322709549238666e-7*(dot(g) - 1.073478122165745e-5))",
        |_, v| {
            f64::max(
                0.0,
                1.332_270_954_923_866_6e-7 * (v - 1.073_478_122_165_745e-5),
            )
        },
    );
    assert_force("max(g, dot(g))", f64::max);
    assert_force("g*dot(g)*max(0, 1 - dot(g)^2)", |x, v| {
        x * v * f64::max(0.0, 1.0 - v * v)
    });
}

#[test]
fn a_positive_part_has_any_power() {
    assert_force("max(0, 1 + c*dot(g))^1.5", |_, v| {
        f64::max(0.0, 1.0 + C * v).powf(1.5)
    });
    assert_force("max(0, 2 + 2*dot(g))^0.6", |_, v| {
        f64::max(0.0, 2.0 + 2.0 * v).powf(0.6)
    });
    assert_force("max(2*dot(g) - k, 0)^k", |_, v| {
        f64::max(0.0, 2.0 * v - K).powf(K)
    });
    assert_force("(-min(0, 1 + dot(g)))^2.5", |_, v| {
        (-f64::min(0.0, 1.0 + v)).powf(2.5)
    });
    assert_force("max(0, k*(1 + dot(g)))^1.5", |_, v| {
        f64::max(0.0, K * (1.0 + v)).powf(1.5)
    });
    assert_force("g*(k*max(0, 1 - dot(g)))^1.5", |x, v| {
        x * (K * f64::max(0.0, 1.0 - v)).powf(1.5)
    });
    for term in [
        "max(-1, 1 + dot(x))^1.5",
        "min(0, 1 + dot(x))^1.5",
        "(dot(x)*max(0, 1 + dot(x)))^1.5",
        "max(0, 1 + dot(x))^-0.5",
    ] {
        let text = faults(&format!("M(x) {{ ddot(x) + {term} = 0; }}"));
        assert_eq!(text.lines().count(), 1, "{text}");
    }
}

/// Hunt and Crossley, Journal of Applied Mechanics 42 (1975) 440, without tension.
#[test]
fn hunt_and_crossley_without_tension_in_place() {
    let by_hand = |x: f64, v: f64| K * x.max(0.0).powf(1.5) * f64::max(0.0, 1.0 + C * v);
    for term in [
        "k*max(0, g)^1.5*max(0, 1 + c*dot(g))",
        "max(0, k*max(0, g)^1.5*(1 + c*dot(g)))",
        "k*H(g)*max(0, g*|g|^0.5*(1 + c*dot(g)))",
        "max(0, k*g*|g|^0.5*(1 + c*dot(g)))*H(g)",
    ] {
        assert_force(term, by_hand);
    }
}

#[test]
fn terms_may_take_back_the_jumps_of_each_other() {
    assert_force("H(1 + dot(g)) + dot(g)*H(1 + dot(g))", |_, v| {
        f64::max(0.0, 1.0 + v)
    });
    // Each is at fault where they do not.
    let text = faults("M(x) { ddot(x) + H(1 + dot(x)) + 2*dot(x)*H(1 + dot(x)) = 0; }");
    assert_eq!(text.lines().count(), 2, "{text}");
}

#[test]
fn jumps_in_the_rate_are_refused_once() {
    for term in [
        "sgn(dot(x))",
        "(1 - x^2)*sgn(dot(x))",
        "(1 + cos(omega*t))*sgn(dot(x))",
        "max(0, x)*H(1 + 2*dot(x))",
        "(max(0, x) + x^3)*(1 + dot(x))*sgn(dot(x))",
        "max(0, 1 - dot(x)^2) + dot(x)*sgn(1 - dot(x)^2)",
    ] {
        let text = faults(&format!("M(x) {{ ddot(x) + {term} = 0; }}"));
        for line in text.lines() {
            assert!(line.starts_with("the force jumps with the rate"), "{text}");
        }
        assert_eq!(text.lines().count(), 1, "{text}");
    }
    let text = faults("M(x) { ddot(x) + x*sgn(2*x + 2*dot(x)) = 0; }");
    assert!(
        text.starts_with("the force jumps where `2*x + 2*dot(x)` changes sign"),
        "{text}"
    );
    assert_eq!(text.lines().count(), 1, "{text}");
}

/// The declaration has one fault, whose message begins so.
fn assert_fault(text: &str, start: &str) {
    let text = faults(text);
    assert_eq!(text.lines().count(), 1, "{text}");
    assert!(text.starts_with(start), "{text}");
}

#[test]
fn faults_are_reported_once_and_quote_what_is_written() {
    for (equation, start) in [
        (
            "max(0, |x| - a)",
            "whether the level `0` or `-a` is the higher one is not known",
        ),
        ("|x|^a", "`|x|` vanishes on this piece, so the exponent `a`"),
        ("max(0, x)^a", "`max(0, x)` vanishes, so the exponent `a`"),
        ("(|x| - 1)^0.5", "`|x| - 1` may be negative on this piece"),
        (
            "x^(1/3)",
            "`x` may be negative on this piece, and a negative number has no power `1/3`: write `|x|^(1/3)`,",
        ),
        ("1/(|x| - 1)", "division by `|x| - 1`, which may vanish"),
        (
            "max(0, a*(x - y) - 1)",
            "whether `a*(x - y) - 1` rises or falls with the gap depends on the sign of `a`",
        ),
        ("max(0, 2*a*x - 2)", "whether `2*a*x - 2` rises or falls"),
        (
            "max(x^2 - 1, 1 - x)",
            "where `x^2 - 1 - (1 - x)` changes sign is not known",
        ),
        (
            "(1 + cos(omega*t))*x*|y|",
            "this term mixes `x` and `y` nonlinearly",
        ),
        (
            "(1 + cos(omega*t))*|a*x + b*y|",
            "the coefficient `a` of a coordinate in this gap may be zero",
        ),
        ("(1 + cos(omega*t))*t*x", "not harmonic in omega*t"),
        (
            "|x|^1/3",
            "`|x|^1/3` divides the power, not the exponent: put the exponent in parentheses, as in `|x|^(1/3)`",
        ),
    ] {
        let head = "M(x, y) { param a; param b;";
        let unused = "0*(a + b)*x";
        assert_fault(
            &format!("{head} ddot(x) + {unused} + {equation} = 0; ddot(y) = 0; }}"),
            start,
        );
    }
    assert_fault(
        "M(x) { ddot(x) = (1 + cos(omega*t))*x; }",
        "this term depends on the motion",
    );
    assert_fault(
        "M(x) { law f(g) { 0 < g < 1 => g^3, else => sgn(dot(g)) } ddot(x) + f(x) = 0; }",
        "the force jumps with the rate",
    );
}
