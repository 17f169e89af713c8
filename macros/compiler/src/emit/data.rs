//! Facts and the law as data, written as constants.

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, quote};

use super::code::{number, position};
use super::tape::{Operation, Style, Tape};
use crate::dag::{Dag, Function, Id, Variable};
use crate::facts::{
    Exponent, LawFacts, LevelFacts, Piece, PieceFacts, Quantity, RateDependence, Term, Variation,
};
use crate::ir::Law;

/// A borrowed list.
pub fn list(items: impl IntoIterator<Item = TokenStream>) -> TokenStream {
    let items = items.into_iter();
    quote!(__Cow::Borrowed(&[#(#items),*]))
}

/// A borrowed text.
pub fn text(text: &str) -> TokenStream {
    quote!(__Cow::Borrowed(#text))
}

/// `LawFacts` as a constant expression.
pub fn facts(law: &Law, facts: &LawFacts) -> TokenStream {
    let name = text(&law.name);
    let arguments = list(law.arguments.iter().map(|argument| text(argument)));
    let levels = list(facts.levels.iter().copied().map(level));
    let pieces = list(facts.pieces.iter().map(piece));
    let rate = match facts.rate {
        RateDependence::None => quote!(None),
        RateDependence::Linear => quote!(Linear),
        RateDependence::General => quote!(General),
    };
    let odd = facts.odd;
    quote! {
        {
            use __emitted::{exponent, exponent_of, term};
            use __law::{Exponent, LevelFacts, PieceFacts, Quantity::*, Variation::*};
            __law::LawFacts {
                name: #name,
                arguments: #arguments,
                levels: #levels,
                pieces: #pieces,
                rate: __law::RateDependence::#rate,
                odd: #odd,
            }
        }
    }
}

fn level(facts: LevelFacts) -> TokenStream {
    let LevelFacts {
        belongs_above,
        force_jumps,
        by_gap_jumps,
        by_rate_jumps,
        unbounded_by_gap,
    } = facts;
    quote! {
        LevelFacts {
            belongs_above: #belongs_above,
            force_jumps: #force_jumps,
            by_gap_jumps: #by_gap_jumps,
            by_rate_jumps: #by_rate_jumps,
            unbounded_by_gap: #unbounded_by_gap,
        }
    }
}

fn piece(facts: &PieceFacts) -> TokenStream {
    let affine = facts.affine;
    let [force, by_gap, by_rate] = [facts.force, facts.by_gap, facts.by_rate].map(variation);
    let by_argument = list(facts.by_argument.iter().copied().map(variation));
    let terms = list(facts.terms.iter().map(term));
    quote! {
        PieceFacts {
            affine: #affine,
            force: #force,
            by_gap: #by_gap,
            by_rate: #by_rate,
            by_argument: #by_argument,
            terms: #terms,
        }
    }
}

fn variation(variation: Variation) -> TokenStream {
    match variation {
        Variation::Zero => quote!(Zero),
        Variation::Constant => quote!(Constant),
        Variation::Varying => quote!(Varying),
    }
}

fn term(term: &Term) -> TokenStream {
    let of = match term.of {
        Quantity::Force => quote!(Force),
        Quantity::ByGap => quote!(ByGap),
        Quantity::ByRate => quote!(ByRate),
        Quantity::ByArgument(index) => {
            let index = position(index);
            quote!(ByArgument(#index))
        }
    };
    let [lower, upper] = [term.lower, term.upper].map(exponent);
    let logarithm = term.logarithm;
    quote!(term(#of, #lower, #upper, #logarithm))
}

fn exponent(exponent: Exponent) -> TokenStream {
    if exponent == Exponent::ZERO {
        return quote!(Exponent::ZERO);
    }
    let number = number(exponent.number.to_f64());
    if let Some(argument) = exponent.argument.map(position) {
        quote!(exponent_of(#number, #argument))
    } else {
        quote!(exponent(#number))
    }
}

/// An `Option` as Rust source.
pub fn option(value: Option<impl ToTokens>) -> TokenStream {
    value.map_or_else(
        || quote!(::core::option::Option::None),
        |value| quote!(::core::option::Option::Some(#value)),
    )
}

/// `LawData` as a constant expression: one list of nodes for levels, pieces and all derivatives.
pub fn data(dag: &mut Dag, levels: &[(Id, Vec<Id>)], pieces: &[Piece]) -> TokenStream {
    let mut roots = Vec::new();
    for (value, by_argument) in levels {
        roots.push(*value);
        roots.extend(by_argument);
    }
    for piece in pieces {
        roots.extend(piece.outputs());
    }
    let tape = Tape::of(dag, &roots, Style::Data);
    let mut positions = tape.roots.iter();
    let mut next = || position(*positions.next().expect("a position for every root"));
    let levels = list(
        levels
            .iter()
            .map(|(_, by_argument)| {
                let value = next();
                let by_argument = list(by_argument.iter().map(|_| next()).map(|at| quote!(#at)));
                quote!(LevelData { value: #value, by_argument: #by_argument })
            })
            .collect::<Vec<_>>(),
    );
    let pieces = list(
        pieces
            .iter()
            .map(|piece| {
                let (force, by_gap, by_rate) = (next(), next(), next());
                let by_argument = list(piece.by_argument.iter().map(|_| next()).map(|at| quote!(#at)));
                quote! {
                    PieceData {
                        force: #force, by_gap: #by_gap, by_rate: #by_rate, by_argument: #by_argument,
                    }
                }
            })
            .collect::<Vec<_>>(),
    );
    let nodes = list(tape.operations.iter().map(|&operation| node(operation)));
    quote! {
        {
            use __generic::{LevelData, Node::*, PieceData};
            __generic::LawData { nodes: #nodes, levels: #levels, pieces: #pieces }
        }
    }
}

fn node(operation: Operation) -> TokenStream {
    let unary = |name: TokenStream, a: usize| {
        let a = position(a);
        quote!(#name(#a))
    };
    let binary = |name: TokenStream, a: usize, b: usize| {
        let (a, b) = (position(a), position(b));
        quote!(#name(#a, #b))
    };
    match operation {
        Operation::Number(value) => {
            let value = number(value);
            quote!(Number(#value))
        }
        Operation::Input(Variable::Gap) => quote!(Gap),
        Operation::Input(Variable::Rate) => quote!(Rate),
        Operation::Input(Variable::Argument(index)) => unary(quote!(Argument), index),
        Operation::Add(a, b) => binary(quote!(Add), a, b),
        Operation::Subtract(a, b) => binary(quote!(Subtract), a, b),
        Operation::Multiply(a, b) => binary(quote!(Multiply), a, b),
        Operation::Divide(a, b) => binary(quote!(Divide), a, b),
        Operation::Negate(a) => unary(quote!(Negate), a),
        Operation::Integer(a, exponent) => {
            let (a, exponent) = (position(a), Literal::i32_unsuffixed(exponent));
            quote!(Integer(#a, #exponent))
        }
        Operation::Power(a, b) => binary(quote!(Power), a, b),
        Operation::PowerLog(a, b) => binary(quote!(PowerLog), a, b),
        Operation::Call(function, a) => match function {
            Function::Absolute => unary(quote!(Absolute), a),
            Function::Sign => unary(quote!(Sign), a),
            Function::Sine => unary(quote!(Sine), a),
            Function::Cosine => unary(quote!(Cosine), a),
            Function::Exponential => unary(quote!(Exponential), a),
            Function::Tanh => unary(quote!(Tanh), a),
            Function::Step => unreachable!("data have no step"),
        },
        Operation::Input(_)
        | Operation::Root(_)
        | Operation::CubeRoot(_)
        | Operation::Reciprocal(_)
        | Operation::Logarithm(_)
        | Operation::Raise(..)
        | Operation::Nearest(..)
        | Operation::Over(..)
        | Operation::Shift { .. } => unreachable!("not an operation of laws as data"),
    }
}
