//! The interpreter against closed forms, on data written by hand.

use std::borrow::Cow;

use super::scales::Scales;
use super::{DataError, InterpretedLaw, LawData, LevelData, Node, PieceData};
use crate::law::{
    ArgumentFacts, Derivatives, Exponent, Law, LawFacts, LevelFacts, On, Parts, PieceFacts,
    Quantity, RateDependence, TermFacts, Variation,
};

const ARGUMENTS: [ArgumentFacts; 2] = [
    ArgumentFacts::named(Cow::Borrowed("zeta")),
    ArgumentFacts::named(Cow::Borrowed("alpha")),
];
const ZETA: f64 = 0.032;

/// `2 zeta r + g^alpha` for `g > 0`, else zero; the exponent is an argument or a number.
fn hertz(exponent: Option<f64>) -> InterpretedLaw {
    let exponent = exponent.map_or(Node::Argument(1), Node::Number);
    let nodes = vec![
        Node::Gap,
        Node::Rate,
        Node::Argument(0),
        exponent,
        Node::Number(2.0),
        Node::Number(0.0),
        Node::Number(1.0),
        Node::Multiply(4, 2),
        Node::Multiply(7, 1),
        Node::Power(0, 3),
        Node::Add(8, 9),
        Node::Subtract(3, 6),
        Node::Power(0, 11),
        Node::Multiply(3, 12),
        Node::Multiply(4, 1),
        Node::PowerLog(0, 3),
    ];
    let free = piece(5, 5, 5, [5, 5]);
    let contact = piece(10, 13, 7, [14, 15]);
    InterpretedLaw::new(facts(), data(nodes, vec![free, contact])).expect("a law")
}

fn piece(force: usize, by_gap: usize, by_rate: usize, by_argument: [usize; 2]) -> PieceData {
    PieceData::new([force, by_gap, by_rate], by_argument.to_vec())
}

fn data(nodes: Vec<Node>, pieces: Vec<PieceData>) -> LawData {
    LawData::new(nodes, [LevelData::new(5, vec![5, 5])], pieces)
}

fn facts() -> LawFacts {
    let power = TermFacts::new(
        Quantity::Force,
        Exponent::of_argument(0.0, 1),
        Exponent::ZERO,
    );
    let closed = PieceFacts::smooth(2)
        .slopes(Variation::Varying, Variation::Constant)
        .terms([power]);
    let level = LevelFacts::default()
        .by_gap_jumps(true)
        .by_rate_jumps(true)
        .unbounded_by_gap(true);
    LawFacts::new("hertz", [level], [PieceFacts::zero(2), closed])
        .arguments(ARGUMENTS.iter().cloned())
        .rate(RateDependence::Linear)
}

/// Force, by gap, by rate and by one argument of a batch.
fn evaluate(
    law: &dyn Law,
    argument: usize,
    on: On,
    arguments: &[f64],
    gap: &[f64],
    rate: &[f64],
) -> [Vec<f64>; 4] {
    let mut all = [const { Vec::new() }; 4];
    for values in &mut all {
        values.resize(gap.len(), f64::NAN);
    }
    let [force, by_gap, by_rate, by] = &mut all;
    let out = Derivatives {
        force,
        by_gap,
        by_rate,
    };
    law.derivatives_and_by(argument, on, arguments, gap, rate, out, by);
    all
}

/// The closed forms `[phi, by gap, by rate, by zeta, by alpha]` in contact; unbounded ones are zero at the level.
fn contact(alpha: f64, g: f64, r: f64) -> [f64; 5] {
    let by_gap = if g == 0.0 && alpha < 1.0 {
        0.0
    } else {
        alpha * g.powf(alpha - 1.0)
    };
    let by_alpha = if g == 0.0 {
        0.0
    } else {
        g.powf(alpha) * g.ln()
    };
    let force = 2.0 * ZETA * r + g.powf(alpha);
    [force, by_gap, 2.0 * ZETA, 2.0 * r, by_alpha]
}

fn close(found: f64, expected: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(
        error <= 4.0 * f64::EPSILON * expected.abs(),
        "{what}: {found:e} instead of {expected:e}"
    );
}

const GAPS: [f64; 10] = [
    -1e6, -1.0, -1e-300, -0.0, 0.0, 5e-324, 1e-300, 0.3, 2.0, 1e6,
];

#[test]
fn matches_closed_forms_at_and_around_the_level() {
    for alpha in [0.6, 1.0, 1.5] {
        for law in [hertz(None), hertz(Some(alpha))] {
            let rate: Vec<f64> = GAPS.iter().map(|g| 0.25 + g.signum()).collect();
            for argument in [0, 1] {
                let arguments = [ZETA, alpha];
                let of = |on| evaluate(&law, argument, on, &arguments, &GAPS, &rate);
                let [all, above] = [of(On::AllPieces), of(On::Piece(1))];
                for (i, &g) in GAPS.iter().enumerate() {
                    let exact = contact(alpha, g.max(0.0), rate[i]);
                    for (k, exact) in [exact[0], exact[1], exact[2], exact[3 + argument]]
                        .into_iter()
                        .enumerate()
                    {
                        let what = format!("alpha {alpha}, gap {g:e}, output {k}");
                        close(all[k][i], if g > 0.0 { exact } else { 0.0 }, &what);
                        if g >= 0.0 {
                            close(above[k][i], exact, &what);
                        }
                        assert!(above[k][i].is_finite(), "{what}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_level_belongs_to_the_piece_that_the_facts_say() {
    let law = hertz(None);
    let mut facts = law.facts().clone();
    facts.levels.to_mut()[0].belongs_above = true;
    let above = InterpretedLaw::new(facts, law.data().expect("data").clone()).expect("a law");
    let of = |law: &dyn Law| evaluate(law, 0, On::AllPieces, &[ZETA, 1.5], &[0.0], &[1.0])[0][0];
    assert_eq!(of(&law), 0.0);
    assert_eq!(of(&above), 2.0 * ZETA);
}

#[test]
fn batches_of_any_length_agree_with_single_samples() {
    let law = hertz(None);
    let arguments = [ZETA, 1.5];
    for length in [0, 1, 63, 64, 65, 200] {
        let gap: Vec<f64> = (0..length).map(|i| f64::from(i * 37 % 19) - 9.0).collect();
        let rate: Vec<f64> = (0..length).map(|i| f64::from(i % 7)).collect();
        let batch = evaluate(&law, 1, On::AllPieces, &arguments, &gap, &rate);
        let mut force = vec![f64::NAN; gap.len()];
        law.force(On::AllPieces, &arguments, &gap, &rate, &mut force);
        assert_eq!(force, batch[0]);
        for i in 0..gap.len() {
            let single = evaluate(
                &law,
                1,
                On::AllPieces,
                &arguments,
                &gap[i..=i],
                &rate[i..=i],
            );
            for (single, batch) in single.iter().zip(&batch) {
                assert_eq!(single[0].to_bits(), batch[i].to_bits());
            }
        }
    }
}

#[test]
fn a_twin_has_the_same_parts() {
    let law = hertz(None);
    assert!(law.parts().is_none());
    let mut facts = law.facts().clone();
    facts.rate = RateDependence::None;
    let nodes = &law.data().expect("data").nodes;
    let part = |force, by_gap, by| {
        let pieces = vec![piece(5, 5, 5, [5, 5]), piece(force, by_gap, 5, by)];
        let mut nodes = nodes.to_vec();
        nodes.extend([Node::Multiply(7, 0), Node::Multiply(4, 0)]);
        InterpretedLaw::new(facts.clone(), data(nodes, pieces)).expect("a law")
    };
    let law = law
        .clone()
        .with_parts(part(9, 13, [5, 15]), part(16, 7, [17, 5]));
    let twin = InterpretedLaw::of(&law).expect("data");
    let parts = twin.parts().expect("a law that is linear in its rate");
    let of = |law: &dyn Law| evaluate(law, 0, On::AllPieces, &[ZETA, 1.5], &[4.0], &[3.0]);
    let [force, by_gap, by_rate, by_zeta] = of(parts.spring);
    assert_eq!(
        [force[0], by_gap[0], by_rate[0], by_zeta[0]],
        [8.0, 3.0, 0.0, 0.0]
    );
    let [force, by_gap, by_rate, by_zeta] = of(parts.primitive);
    assert_eq!(
        [force[0], by_gap[0], by_rate[0], by_zeta[0]],
        [8.0 * ZETA, 2.0 * ZETA, 0.0, 8.0]
    );
}

#[test]
fn levels_follow_the_arguments() {
    let nodes = vec![
        Node::Argument(0),
        Node::Negate(0),
        Node::Number(1.0),
        Node::Number(-1.0),
        Node::Number(0.0),
    ];
    let level = |value, by_argument| LevelData::new(value, vec![by_argument, 4]);
    let mut facts = facts();
    facts.levels = vec![facts.levels[0]; 2].into();
    let pieces = vec![piece(4, 4, 4, [4, 4]); 3];
    let data = LawData::new(nodes, [level(1, 3), level(0, 2)], pieces);
    let law = InterpretedLaw::new(facts, data).expect("a law");
    let mut levels = [0.0; 2];
    law.levels(&[0.7, 1.5], &mut levels);
    assert_eq!(levels, [-0.7, 0.7]);
    law.levels_by(&[0.7, 1.5], 0, &mut levels);
    assert_eq!(levels, [-1.0, 1.0]);
}

#[test]
fn a_node_that_uses_itself_is_refused() {
    let nodes = vec![Node::Negate(0)];
    let data = LawData::new(nodes, [], [piece(0, 0, 0, [0, 0])]);
    let mut facts = facts();
    facts.levels = Cow::Borrowed(&[]);
    let error = InterpretedLaw::new(facts, data).expect_err("a circle");
    assert_eq!(
        error,
        DataError::Operand {
            node: 0,
            operand: 0
        }
    );
    assert_eq!(
        error.to_string(),
        "node 0 does not come after its operand 0"
    );
}

/// A law by hand: the force is its own, and its data are what somebody wrote.
struct ByHand {
    law: InterpretedLaw,
    data: LawData,
}

impl Law for ByHand {
    fn facts(&self) -> &LawFacts {
        self.law.facts()
    }

    fn data(&self) -> Option<&LawData> {
        Some(&self.data)
    }

    fn levels(&self, arguments: &[f64], levels: &mut [f64]) {
        self.law.levels(arguments, levels);
    }

    fn levels_by(&self, arguments: &[f64], argument: usize, derivatives: &mut [f64]) {
        self.law.levels_by(arguments, argument, derivatives);
    }

    fn force(&self, on: On, arguments: &[f64], gap: &[f64], rate: &[f64], force: &mut [f64]) {
        self.law.force(on, arguments, gap, rate, force);
    }

    fn derivatives(
        &self,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
    ) {
        self.law.derivatives(on, arguments, gap, rate, out);
    }

    fn derivatives_and_by(
        &self,
        argument: usize,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
        by_argument: &mut [f64],
    ) {
        let law = &self.law;
        law.derivatives_and_by(argument, on, arguments, gap, rate, out, by_argument);
    }

    fn parts(&self) -> Option<Parts<'_>> {
        None
    }
}

type Spoil = fn(&mut LawData);

/// What may be wrong with the data of [`hertz`], and what is said of it.
fn faults() -> [(Spoil, DataError); 9] {
    [
        (
            |data| data.levels = Cow::Borrowed(&[]),
            DataError::Levels { facts: 1, data: 0 },
        ),
        (
            |data| data.pieces.to_mut().truncate(1),
            DataError::Pieces {
                levels: 1,
                pieces: 1,
            },
        ),
        (
            |data| data.pieces.to_mut()[1].by_argument = vec![5].into(),
            DataError::Derivatives {
                derivatives: 1,
                arguments: 2,
            },
        ),
        (
            |data| data.levels.to_mut()[0].by_argument = vec![5; 3].into(),
            DataError::Derivatives {
                derivatives: 3,
                arguments: 2,
            },
        ),
        (
            |data| data.nodes.to_mut()[2] = Node::Argument(7),
            DataError::Argument {
                node: 2,
                argument: 7,
                arguments: 2,
            },
        ),
        (
            |data| data.nodes.to_mut()[8] = Node::Tanh(99),
            DataError::Operand {
                node: 8,
                operand: 99,
            },
        ),
        (
            |data| data.nodes.to_mut()[9] = Node::Power(0, 12),
            DataError::Operand {
                node: 9,
                operand: 12,
            },
        ),
        (
            |data| data.pieces.to_mut()[0].force = 16,
            DataError::NoNode {
                node: 16,
                nodes: 16,
            },
        ),
        (
            |data| data.levels.to_mut()[0].value = 0,
            DataError::LevelVaries { level: 0 },
        ),
    ]
}

/// Whatever is written in the data of a law, an error says what does not fit, and nothing is known of the law by them.
#[test]
fn data_that_do_not_describe_their_law_are_refused() {
    let law = hertz(None);
    let good = law.data().expect("data").clone();
    for (spoil, expected) in faults() {
        let mut data = good.clone();
        spoil(&mut data);
        let refused = InterpretedLaw::new(law.facts().clone(), data.clone());
        assert_eq!(refused.expect_err("no law"), expected);
        let law = law.clone();
        let by_hand = ByHand { law, data };
        assert!(Scales::of(&by_hand).is_none(), "{expected}");
        assert!(InterpretedLaw::of(&by_hand).is_none(), "{expected}");
    }
    let by_hand = ByHand { law, data: good };
    assert!(Scales::of(&by_hand).is_some());
    assert!(InterpretedLaw::of(&by_hand).is_some());
}
