//! Generated code, the interpreter and dual numbers agree, on every declared model and at 1e5 random points each, or at
//! as many as the environment variable `HERTZIAN_POINTS` says.
//!
//! Three ways lead to a force and its derivatives: the code that the macro emits; the interpreter, which runs the
//! derivatives that the compiler found symbolically; and dual numbers (num-dual), which differentiate the data of the
//! *force* alone and so check the compiler's differentiation too. Gaps lie at distances from 1e-300 to 1e6 on both
//! sides of every level, and at the level itself and its neighbours among floating-point numbers. How far two results
//! may differ is computed along with them, see [`bound`]. A process has one instruction set, so that each set of the processor has a
//! process of its own, with as many points.

mod bound;
mod dual;
mod models;
mod random;
mod tree;

use bound::Bound;
use hertzian::generic::{LawData, PieceData, interpreted};
use hertzian::law::{Derivatives, Law, On, Parts};
use hertzian::power::Instructions;
use hertzian::system::{Place, System};
use hertzian_tests::random::Random;
use models::MODELS;
use random::magnitude;

/// Points of each model, unless `HERTZIAN_POINTS` says otherwise.
const DEFAULT_POINTS: usize = 100_000;
/// Points that share the parameters of the model.
const BATCH: usize = 1000;

/// The test that a process for one set runs.
const ON_ONE_SET: &str = "agreement::generated_interpreted_and_dual_numbers_agree";

#[test]
fn they_agree_on_the_other_instruction_sets() {
    let program = std::env::current_exe().expect("this program");
    let others = Instructions::ALL.into_iter();
    for set in others.filter(|set| set.is_available() && *set != Instructions::in_use()) {
        let run = std::process::Command::new(&program)
            .env("HERTZIAN_INSTRUCTIONS", set.name())
            .args(["--exact", ON_ONE_SET, "--nocapture"])
            .output();
        let run = run.expect("this program can be run");
        let text = [run.stdout, run.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
        let name = set.name();
        assert!(run.status.success(), "{name}: {}", text.concat());
        assert!(text[0].contains("1 passed"), "{name}: {}", text[0]);
        assert!(text[0].contains(&on(set)), "{name}: {}", text[0]);
    }
}

/// What a process says that it runs on.
fn on(set: Instructions) -> String {
    format!("on {}", set.name())
}

#[test]
fn generated_interpreted_and_dual_numbers_agree() {
    println!("{}", on(Instructions::in_use()));
    let batches = points().div_ceil(BATCH);
    for (name, model) in MODELS {
        let mut random = Random::seeded(20_210_603);
        for _ in 0..batches {
            let system = model(&mut random);
            let interpreted = interpreted(system.as_ref());
            assert!(!system.facts().contacts.is_empty(), "{name}: no contacts");
            for (contact, facts) in system.facts().contacts.iter().enumerate() {
                let arguments = arguments(system.as_ref(), contact);
                let (law, twin) = (system.law(facts.law), interpreted.law(facts.law));
                check_law(name, [law, twin], &arguments, &mut random);
                match (law.parts(), twin.parts()) {
                    (Some(a), Some(b)) => {
                        check_whole(name, law, a, &arguments, &mut random);
                        check_law(name, [a.spring, b.spring], &arguments, &mut random);
                        check_law(name, [a.primitive, b.primitive], &arguments, &mut random);
                    }
                    (None, None) => {}
                    _ => panic!("{name}: only one of the two laws has parts"),
                }
            }
        }
    }
}

fn points() -> usize {
    std::env::var("HERTZIAN_POINTS").map_or(DEFAULT_POINTS, |text| {
        text.parse().expect("HERTZIAN_POINTS is a whole number")
    })
}

/// The arguments of the law of a contact, at the values of the parameters.
fn arguments(system: &dyn System, contact: usize) -> Vec<f64> {
    let facts = system.facts();
    let mut parameters = vec![0.0; facts.parameters.len()];
    system.values(&mut parameters);
    let mut coefficients = vec![0.0; facts.places.len()];
    system.coefficients(&parameters, 1.0, &mut coefficients);
    let law = system.law(facts.contacts[contact].law);
    let mut arguments = vec![0.0; law.facts().arguments.len()];
    for (place, value) in facts.places.iter().zip(&coefficients) {
        if let Place::Argument { contact: of, index } = *place
            && of == contact
        {
            arguments[index] += value;
        }
    }
    arguments
}

/// A law and its twin on all pieces and on each, at new samples.
fn check_law(name: &str, laws: [&dyn Law; 2], arguments: &[f64], random: &mut Random) {
    let levels = laws.map(|law| levels(law, arguments));
    assert_eq!(levels[0], levels[1], "{name}: levels");
    let levels = levels[0].as_slice();
    let gaps = gaps(levels, random);
    check_pieces(name, laws, On::AllPieces, arguments, levels, &gaps, random);
    for piece in 0..=levels.len() {
        let low = piece
            .checked_sub(1)
            .map_or(f64::NEG_INFINITY, |i| levels[i]);
        let high = levels.get(piece).copied().unwrap_or(f64::INFINITY);
        let inside = gaps
            .iter()
            .copied()
            .filter(|gap| (low..=high).contains(gap));
        let inside: Vec<f64> = inside.collect();
        check_pieces(
            name,
            laws,
            On::Piece(piece),
            arguments,
            levels,
            &inside,
            random,
        );
        for law in laws {
            let outside = evaluate(law, On::Piece(piece), arguments, &gaps, &gaps);
            let finite = outside.iter().flatten().all(|value| value.is_finite());
            assert!(finite, "{name}: not finite outside piece {piece}");
        }
    }
}

/// A law is its spring plus the time derivative of its primitive, which is continuous.
fn check_whole(name: &str, law: &dyn Law, parts: Parts, arguments: &[f64], random: &mut Random) {
    let levels = levels(law, arguments);
    let gaps = gaps(&levels, random);
    let rates: Vec<f64> = gaps.iter().map(|_| magnitude(random, -6.0, 6.0)).collect();
    let of = |law| evaluate(law, On::AllPieces, arguments, &gaps, &rates);
    let (whole, spring, primitive) = (of(law), of(parts.spring), of(parts.primitive));
    for (i, (&gap, &rate)) in gaps.iter().zip(&rates).enumerate() {
        let piece = piece_of(law, &levels, gap);
        let bound = |law: &dyn Law, output: fn(&PieceData) -> usize| {
            let data = data(law);
            bound::nodes(data, gap, rate, arguments)[output(&data.pieces[piece])].error
        };
        let slope = primitive[1][i];
        let of_slope =
            bound(law, |piece| piece.by_rate) + bound(parts.primitive, |piece| piece.by_gap);
        assert!(
            (whole[2][i] - slope).abs() <= of_slope,
            "{name}: G' at gap {gap:e}"
        );
        let of_force = 2.0 * bound(law, |piece| piece.force) + of_slope * rate.abs();
        let force = spring[0][i] + slope * rate;
        assert!(
            (whole[0][i] - force).abs() <= of_force,
            "{name}: f + G' r at gap {gap:e}"
        );
    }
    for (i, &level) in levels.iter().enumerate() {
        let side = |piece| {
            evaluate(
                parts.primitive,
                On::Piece(piece),
                arguments,
                &[level],
                &[0.0],
            )[0][0]
        };
        let size = side(i).abs().max(side(i + 1).abs());
        let jump = (side(i) - side(i + 1)).abs();
        assert!(
            jump <= 8.0 * f64::EPSILON * size,
            "{name}: G jumps by {jump:e}"
        );
    }
}

/// A generated law has data.
fn data(law: &dyn Law) -> &LawData {
    law.data().expect("data of a generated law")
}

/// The levels of a law, with their derivatives checked.
fn levels(law: &dyn Law, arguments: &[f64]) -> Vec<f64> {
    let data = data(law);
    let mut levels = vec![f64::NAN; data.levels.len()];
    law.levels(arguments, &mut levels);
    let mut by = levels.clone();
    for argument in 0..arguments.len() {
        law.levels_by(arguments, argument, &mut by);
        let duals = dual::nodes(data, 0.0, 0.0, arguments, dual::By::Argument(argument));
        for (level, by) in data.levels.iter().zip(&by) {
            assert_eq!(
                *by, duals[level.value].eps,
                "a level by argument {argument}"
            );
        }
    }
    levels
}

/// Gaps around every level, and around zero.
fn gaps(levels: &[f64], random: &mut Random) -> Vec<f64> {
    let centres: Vec<f64> = levels.iter().copied().chain([0.0]).collect();
    let mut gaps: Vec<f64> = centres
        .iter()
        .flat_map(|level| [*level, level.next_up(), level.next_down()])
        .collect();
    while gaps.len() < BATCH {
        let centre = centres[random.below(centres.len())];
        gaps.push(centre + magnitude(random, -300.0, 6.0));
    }
    gaps
}

/// Force, by gap, by rate and by every argument of a batch.
fn evaluate(law: &dyn Law, on: On, arguments: &[f64], gap: &[f64], rate: &[f64]) -> Vec<Vec<f64>> {
    let unset = vec![f64::NAN; gap.len()];
    let mut alone = unset.clone();
    law.force(on, arguments, gap, rate, &mut alone);
    let mut all = vec![unset; 3 + arguments.len()];
    let (basic, by_arguments) = all.split_at_mut(3);
    law.derivatives(on, arguments, gap, rate, derivatives(basic));
    let without_argument = basic.to_vec();
    for (argument, by) in by_arguments.iter_mut().enumerate() {
        let out = derivatives(basic);
        law.derivatives_and_by(argument, on, arguments, gap, rate, out, by);
        assert_eq!(
            basic, without_argument,
            "outputs depend on the kind of call"
        );
    }
    assert_eq!(all[0], alone, "the force depends on the kind of call");
    all
}

fn derivatives(out: &mut [Vec<f64>]) -> Derivatives<'_> {
    let [force, by_gap, by_rate] = out else {
        panic!("there are three of them, not {}", out.len());
    };
    Derivatives {
        force,
        by_gap,
        by_rate,
    }
}

/// A law, its twin and dual numbers on one batch.
fn check_pieces(
    name: &str,
    laws: [&dyn Law; 2],
    on: On,
    arguments: &[f64],
    levels: &[f64],
    gaps: &[f64],
    random: &mut Random,
) {
    let rate = std::iter::repeat_with(|| magnitude(random, -6.0, 6.0));
    let rates: Vec<f64> = rate.take(gaps.len()).collect();
    let [generated, interpreted] = laws.map(|law| evaluate(law, on, arguments, gaps, &rates));
    let data = data(laws[0]);
    for (i, (&gap, &rate)) in gaps.iter().zip(&rates).enumerate() {
        let piece = match on {
            On::Piece(piece) => piece,
            On::AllPieces => piece_of(laws[0], levels, gap),
        };
        let nodes = bound::nodes(data, gap, rate, arguments);
        let dual = |by| dual::nodes(data, gap, rate, arguments, by)[data.pieces[piece].force];
        let piece = &data.pieces[piece];
        let by_argument = piece.by_argument.iter().enumerate();
        let by_gap = dual(dual::By::Gap);
        let expected = [
            (piece.force, by_gap.re),
            (piece.by_gap, by_gap.eps),
            (piece.by_rate, dual(dual::By::Rate).eps),
        ]
        .into_iter()
        .chain(by_argument.map(|(k, &node)| (node, dual(dual::By::Argument(k)).eps)));
        for (k, (node, exact)) in expected.enumerate() {
            let Bound { error, .. } = nodes[node];
            let found = [generated[k][i], interpreted[k][i]];
            let agree = |a: f64, b: f64| (a - b).abs() <= error;
            assert!(
                agree(found[0], found[1]) && agree(found[0], exact) && agree(found[1], exact),
                "{name}, law {}, {on:?}, output {k}, gap {gap:e}, rate {rate:e}, arguments {arguments:?}: \
                 generated {:e}, interpreted {:e}, dual {exact:e}, allowed {error:e}",
                laws[0].facts().name,
                found[0],
                found[1],
            );
        }
    }
}

fn piece_of(law: &dyn Law, levels: &[f64], gap: f64) -> usize {
    let facts = law.facts().levels.iter().zip(levels);
    facts
        .filter(|(facts, level)| gap > **level || (facts.belongs_above && gap == **level))
        .count()
}
