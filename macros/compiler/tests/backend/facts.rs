//! Facts and primitives of laws from the literature.

use hertzian_compiler::dag::{Function, Variable};
use hertzian_compiler::facts::{Piece, derive};
use hertzian_compiler::ir::{Law, Model};
use hertzian_compiler::primitive;
use hertzian_contract::law::{Exponent, LawFacts, Quantity, RateDependence, Variation};
use hertzian_contract::system::Bound;

fn facts(model: &mut Model) -> LawFacts {
    let law = model.laws[0].clone();
    facts_of(model, &law)
}

fn facts_of(model: &mut Model, law: &Law) -> LawFacts {
    let count = law.arguments.len();
    let dag = &mut model.dag;
    let pieces: Vec<Piece> = law
        .pieces
        .iter()
        .map(|&force| Piece::of(dag, force, count))
        .collect();
    derive(dag, law, &pieces)
}

/// The pieces of the primitive, as text.
fn primitive_of(model: &mut Model) -> Vec<String> {
    let law = model.laws[0].clone();
    let (_, primitive) = primitive::parts(&mut model.dag, &law).expect("it can be integrated");
    let name = |variable: Variable| match variable {
        Variable::Gap => "gap".to_owned(),
        Variable::Argument(index) => law.arguments[index].clone(),
        other => format!("{other:?}"),
    };
    primitive
        .pieces
        .iter()
        .map(|&piece| model.dag.display(piece, &name))
        .collect()
}

fn number(numerator: f64, denominator: f64) -> Exponent {
    Exponent::new(numerator / denominator)
}

fn argument(index: usize, number: f64) -> Exponent {
    Exponent::of_argument(number, index)
}

/// The exponents of a quantity at the lower end of a piece, with whether a logarithm goes with them.
fn lower(facts: &LawFacts, piece: usize, of: Quantity) -> Vec<(Exponent, bool)> {
    let terms = facts.pieces[piece]
        .terms
        .iter()
        .filter(|term| term.of == of);
    terms.map(|term| (term.lower, term.logarithm)).collect()
}

#[test]
fn one_sided_damping_jumps_only_in_the_rate() {
    let model = &mut crate::models::one_sided();
    let facts = facts(model);
    let level = facts.levels[0];
    assert!(
        !level.force_jumps && !level.by_gap_jumps && level.by_rate_jumps && !level.unbounded_by_gap
    );
    assert_eq!(facts.rate, RateDependence::Linear);
    assert!(!facts.odd && facts.pieces[0].affine && !facts.pieces[1].affine);
    assert_eq!(facts.pieces[1].by_rate, Variation::Constant);
    assert_eq!(facts.pieces[0].force, Variation::Zero);
    let force = lower(&facts, 1, Quantity::Force);
    assert!(force.contains(&(number(3.0, 2.0), false)) && force.contains(&(Exponent::ZERO, false)));
    assert_eq!(
        lower(&facts, 1, Quantity::ByGap),
        [(number(1.0, 2.0), false)]
    );
    assert_eq!(primitive_of(model), ["0", "2*zeta*gap"]);
}

#[test]
fn exponent_below_one_is_unbounded_stiffness() {
    let facts = facts(&mut crate::models::soft());
    let level = facts.levels[0];
    assert!(!level.force_jumps && level.by_gap_jumps && level.unbounded_by_gap);
    assert_eq!(
        lower(&facts, 1, Quantity::ByGap),
        [(number(-2.0, 5.0), false)]
    );
}

#[test]
fn runtime_exponent_carries_its_argument_and_a_logarithm() {
    let model = &mut crate::models::power_law();
    let facts = facts(model);
    let level = facts.levels[0];
    assert!(facts.odd);
    assert_eq!(facts.rate, RateDependence::None);
    // alpha > 0: the force vanishes at the level; alpha - 1 may be negative.
    assert!(!level.force_jumps && level.unbounded_by_gap);
    assert_eq!(
        lower(&facts, 1, Quantity::Force),
        [(argument(0, 0.0), false)]
    );
    assert_eq!(
        lower(&facts, 1, Quantity::ByGap),
        [(argument(0, -1.0), false)]
    );
    assert_eq!(
        lower(&facts, 1, Quantity::ByArgument(0)),
        [(argument(0, 0.0), true)]
    );
    let upper = facts.pieces[0]
        .terms
        .iter()
        .find(|term| term.of == Quantity::ByGap);
    assert_eq!(upper.map(|term| term.upper), Some(argument(0, -1.0)));
    let law = model.laws[0].clone();
    assert!(primitive::parts(&mut model.dag, &law).is_none());
}

#[test]
fn backlash_is_affine_continuous_and_odd() {
    let facts = facts(&mut crate::models::backlash());
    assert!(facts.odd && facts.pieces.iter().all(|piece| piece.affine));
    for level in facts.levels.iter() {
        assert!(!level.force_jumps && level.by_gap_jumps && !level.unbounded_by_gap);
    }
    assert_eq!(facts.pieces[2].by_gap, Variation::Constant);
    assert_eq!(
        facts.pieces[2].by_argument[..],
        [Variation::Varying, Variation::Constant]
    );
}

#[test]
fn hunt_crossley_is_smooth_at_contact_and_has_a_primitive() {
    let model = &mut crate::models::hunt_crossley();
    let facts = facts(model);
    let level = facts.levels[0];
    assert!(!level.force_jumps && !level.by_gap_jumps && !level.by_rate_jumps);
    assert_eq!(facts.rate, RateDependence::Linear);
    assert_eq!(
        lower(&facts, 1, Quantity::ByRate),
        [(number(3.0, 2.0), false)]
    );
    assert_eq!(primitive_of(model), ["0", "0.4*k*c*gap^2.5"]);
}

#[test]
fn preloaded_stop_jumps_in_force() {
    let facts = facts(&mut crate::models::preloaded());
    let level = facts.levels[0];
    assert!(level.force_jumps && level.by_gap_jumps && !level.by_rate_jumps && level.belongs_above);
    assert!(!facts.odd);
}

#[test]
fn attraction_outside_its_singularity_is_smooth() {
    let facts = facts(&mut crate::models::dmt());
    let level = facts.levels[0];
    assert!(!level.force_jumps && level.by_gap_jumps && !level.unbounded_by_gap);
    assert!(
        facts.pieces[0]
            .terms
            .iter()
            .all(|term| term.upper == Exponent::ZERO)
    );
}

#[test]
fn rate_term_at_a_runtime_level_is_integrated_in_its_base() {
    let model = &mut crate::models::shifted();
    let law = model.laws[0].clone();
    let (_, primitive) = primitive::parts(&mut model.dag, &law).expect("it can be integrated");
    let facts = facts_of(model, &primitive);
    // G is continuous, and so is G' = h.
    assert!(!facts.levels[0].force_jumps && !facts.levels[0].by_gap_jumps);
    let by_gap = lower(&facts, 1, Quantity::ByGap);
    assert!(by_gap.contains(&(argument(2, 0.0), false)), "{by_gap:?}");
}

#[test]
fn a_power_inside_a_smooth_function_shows_among_the_terms() {
    let mut s = crate::models::Sketch::new(&[]);
    let (gap, zero, exponent) = (s.gap(), s.number("0"), s.number("1.5"));
    let power = s.dag.power(gap, exponent);
    let force = s.dag.call(Function::Tanh, power);
    let law = s.law("soft", &[(zero, false)], &[zero, force]);
    let facts = facts(&mut s.model("Nested", law));
    assert!(lower(&facts, 1, Quantity::Force).contains(&(number(3.0, 2.0), false)));
    assert!(lower(&facts, 1, Quantity::ByGap).contains(&(number(1.0, 2.0), false)));
    assert!(!facts.levels[0].by_gap_jumps);
}

#[test]
fn an_exponent_that_may_be_negative_is_not_taken_to_vanish() {
    let any = (Bound::Unbounded, Bound::Unbounded);
    let mut s = crate::models::Sketch::new(&[("alpha", any)]);
    let (gap, zero, alpha) = (s.gap(), s.number("0"), s.argument(0));
    let force = s.dag.power(gap, alpha);
    let law = s.law("any", &[(zero, false)], &[zero, force]);
    let facts = facts(&mut s.model("Any", law));
    assert!(facts.levels[0].force_jumps && facts.levels[0].unbounded_by_gap);
}

#[test]
fn what_has_no_known_primitive_is_left_to_the_caller() {
    let mut s = crate::models::Sketch::new(&[]);
    let (gap, rate, one) = (s.gap(), s.rate(), s.number("1"));
    let square = s.dag.product(&[gap, gap]);
    let base = s.dag.sum(&[one, square]);
    let resistance = s.dag.quotient(rate, base);
    let law = s.law("odd one", &[], &[resistance]);
    let model = &mut s.model("Resistance", law);
    assert_eq!(facts(model).rate, RateDependence::Linear);
    let law = model.laws[0].clone();
    assert!(primitive::parts(&mut model.dag, &law).is_none());
}

#[test]
fn primitives_are_continuous_across_levels() {
    // Resistance c beyond gaps of -b and b, none between: G is -c (gap + b), 0, c (gap - b), up to a constant.
    let mut s = crate::models::Sketch::new(&[
        ("c", (Bound::Unbounded, Bound::Unbounded)),
        ("b", (Bound::Excluded(0.0), Bound::Unbounded)),
    ]);
    let (rate, c, b, zero) = (s.rate(), s.argument(0), s.argument(1), s.number("0"));
    let lower = s.dag.negate(b);
    let damping = s.dag.product(&[c, rate]);
    let law = s.law(
        "walls",
        &[(lower, true), (b, false)],
        &[damping, zero, damping],
    );
    let model = &mut s.model("Walls", law);
    assert_eq!(primitive_of(model), ["c*gap + c*b", "0", "c*gap - c*b"]);
}
