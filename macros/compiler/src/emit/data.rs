//! Facts and the law as data, written as constants.

use std::str::FromStr;

use hertzian_contract::data::{Node, PieceData};
use hertzian_contract::law::{
    ArgumentFacts, Exponent, LevelFacts, PieceFacts, Quantity, RateDependence, TermFacts, Variation,
};
use hertzian_contract::system::Bound;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::code::{number, position};
use crate::interpret::Member;

/// A borrowed list.
pub fn list(items: impl IntoIterator<Item = TokenStream>) -> TokenStream {
    let items = items.into_iter();
    quote!(&[#(#items),*])
}

/// A list of positions.
fn positions(positions: &[usize]) -> TokenStream {
    list(positions.iter().map(|&at| {
        let at = position(at);
        quote!(#at)
    }))
}

/// A borrowed text.
pub fn text(text: &str) -> TokenStream {
    quote!(__Cow::Borrowed(#text))
}

/// The nodes of a family, with the arguments and the levels of a law of it, as constants.
pub fn nodes(nodes: &[Node], member: &Member) -> TokenStream {
    let nodes = list(nodes.iter().map(node));
    let levels = list(member.level_data.iter().map(|level| {
        let (value, by) = (position(level.value), positions(&level.by_argument));
        quote!(level(#value, #by))
    }));
    let arguments = list(member.facts.arguments.iter().map(argument));
    quote! {
        const ARGUMENTS: &[ArgumentFacts] = #arguments;
        const LEVELS: &[LevelData] = #levels;
        const NODES: &[Node] = #nodes;
    }
}

/// An argument, and its range if it has one.
fn argument(argument: &ArgumentFacts) -> TokenStream {
    let name = &argument.name;
    let ends = [argument.minimum, argument.maximum];
    if ends == [Bound::Unbounded; 2] {
        return quote!(free(#name));
    }
    let [minimum, maximum] = ends.map(bound);
    quote!(ranged(#name, #minimum, #maximum))
}

/// One end of a range.
pub fn bound(bound: Bound) -> TokenStream {
    match bound {
        Bound::Unbounded => quote!(Unbounded),
        Bound::Included(value) => {
            let value = number(value);
            quote!(Included(#value))
        }
        Bound::Excluded(value) => {
            let value = number(value);
            quote!(Excluded(#value))
        }
    }
}

/// Constants and an expression that make a law of its facts and data.
pub fn description(member: &Member) -> TokenStream {
    let name = &member.facts.name;
    let levels = list(member.facts.levels.iter().copied().map(level));
    let pieces = member.facts.pieces.iter().zip(&member.piece_data);
    let (facts, data): (Vec<_>, Vec<_>) = pieces
        .map(|(facts, data)| (piece_facts(facts), piece_data(data)))
        .unzip();
    let (facts, data) = (list(facts), list(data));
    let rate = match member.facts.rate {
        RateDependence::None => quote!(INDEPENDENT),
        RateDependence::Linear => quote!(LINEAR),
        _ => quote!(GENERAL),
    };
    let odd = member.facts.odd;
    quote! {
        const MEETING: &[LevelFacts] = #levels;
        const PIECES: &[PieceFacts] = #facts;
        const DATA: &[PieceData] = #data;
        let facts = law_facts(#name, ARGUMENTS, MEETING, PIECES, #rate, #odd);
        __emitted::Generated::new(facts, data(NODES, LEVELS, DATA))
    }
}

/// Only what is true of a level is written.
fn level(facts: LevelFacts) -> TokenStream {
    let flags = [
        ("BELONGS_ABOVE", facts.belongs_above),
        ("FORCE_JUMPS", facts.force_jumps),
        ("BY_GAP_JUMPS", facts.by_gap_jumps),
        ("BY_RATE_JUMPS", facts.by_rate_jumps),
        ("UNBOUNDED_BY_GAP", facts.unbounded_by_gap),
    ];
    let names = flags
        .iter()
        .filter(|(_, holds)| *holds)
        .map(|(name, _)| format_ident!("{name}"));
    quote!(meeting(&[#(#names),*]))
}

fn piece_facts(facts: &PieceFacts) -> TokenStream {
    let affine = facts.affine;
    let [force, by_gap, by_rate] = [facts.force, facts.by_gap, facts.by_rate].map(variation);
    let by_argument = list(facts.by_argument.iter().copied().map(variation));
    let terms = list(facts.terms.iter().map(term));
    quote!(piece(#affine, [#force, #by_gap, #by_rate], #by_argument, #terms))
}

fn piece_data(data: &PieceData) -> TokenStream {
    let basic = [data.force, data.by_gap, data.by_rate].map(position);
    let by_argument = positions(&data.by_argument);
    quote!(at([#(#basic),*], #by_argument))
}

fn variation(variation: Variation) -> TokenStream {
    match variation {
        Variation::Zero => quote!(Zero),
        Variation::Constant => quote!(Constant),
        _ => quote!(Varying),
    }
}

fn term(term: &TermFacts) -> TokenStream {
    let of = match term.of {
        Quantity::Force => quote!(Force),
        Quantity::ByGap => quote!(ByGap),
        Quantity::ByRate => quote!(ByRate),
        Quantity::ByArgument(index) => {
            let index = position(index);
            quote!(ByArgument(#index))
        }
        other => unreachable!("no terms of {other:?} are derived"),
    };
    let is_smooth = [term.lower, term.upper] == [Exponent::ZERO; 2];
    let [lower, upper] = [term.lower, term.upper].map(exponent);
    match (term.logarithm, is_smooth) {
        (true, _) => quote!(term_with_logarithm(#of, #lower, #upper)),
        (false, true) => quote!(smooth(#of)),
        (false, false) => quote!(term(#of, #lower, #upper)),
    }
}

fn exponent(exponent: Exponent) -> TokenStream {
    if exponent == Exponent::ZERO {
        return quote!(ZERO);
    }
    let number = number(exponent.number);
    if let Some(argument) = exponent.argument.map(position) {
        quote!(exponent_of(#number, #argument))
    } else {
        quote!(exponent(#number))
    }
}

/// A node is written as it is printed, but for its numbers.
fn node(node: &Node) -> TokenStream {
    if let Node::Number(value) = *node {
        let value = number(value);
        return quote!(Number(#value));
    }
    TokenStream::from_str(&format!("{node:?}")).expect("names and whole numbers are tokens")
}
