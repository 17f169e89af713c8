//! Names of local variables, and those that generated code imports.

use std::collections::BTreeSet;

use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::{format_ident, quote};

/// What `hertzian::emitted::constants` has.
const CONSTANTS: [&str; 78] = [
    "Absolute",
    "Add",
    "Argument",
    "ArgumentFacts",
    "BELONGS_ABOVE",
    "BY_GAP_JUMPS",
    "BY_RATE_JUMPS",
    "Bound",
    "ByArgument",
    "ByGap",
    "ByRate",
    "CONSTANT",
    "Constant",
    "Cosine",
    "Divide",
    "Excluded",
    "Exponential",
    "FORCE_JUMPS",
    "Force",
    "GENERAL",
    "Gap",
    "INDEPENDENT",
    "Included",
    "Integer",
    "LINEAR",
    "LevelData",
    "LevelFacts",
    "Multiply",
    "Negate",
    "Node",
    "Number",
    "PieceData",
    "PieceFacts",
    "Power",
    "PowerLog",
    "Quantity",
    "Rate",
    "Sign",
    "Signal",
    "Sine",
    "Subtract",
    "Tanh",
    "UNBOUNDED_BY_GAP",
    "Unbounded",
    "Varying",
    "ZERO",
    "Zero",
    "argument",
    "at",
    "contact",
    "contact_in",
    "cos",
    "damping",
    "data",
    "exponent",
    "exponent_of",
    "force_direction",
    "free",
    "gap_direction",
    "law_facts",
    "level",
    "load",
    "mass",
    "measured_system",
    "meeting",
    "offset",
    "output",
    "output_term",
    "parameter",
    "parameter_in",
    "piece",
    "ranged",
    "sin",
    "smooth",
    "stiffness",
    "system_facts",
    "term",
    "term_with_logarithm",
];

/// Imports the constants and functions that tokens use, by their names: names that a glob does not bring are an error each.
pub fn imported(tokens: &TokenStream) -> TokenStream {
    let mut used = BTreeSet::new();
    let mut pending = vec![tokens.clone()];
    while let Some(stream) = pending.pop() {
        for token in stream {
            match token {
                TokenTree::Ident(word) => {
                    let text = word.to_string();
                    if CONSTANTS.contains(&text.as_str()) {
                        used.insert(text);
                    }
                }
                TokenTree::Group(group) => pending.push(group.stream()),
                _ => {}
            }
        }
    }
    let used = used.iter().map(|name| format_ident!("{name}"));
    quote!(use __emitted::constants::{#(#used),*};)
}

/// An identifier for each name: the name itself where it is one, is not reserved for the code around it, and is not
/// taken; a numbered one otherwise. A name with a capital gets a number too: if the module around has a constant of that
/// name, a pattern would mean the constant.
pub fn locals(names: &[String], reserved: &[&str]) -> Vec<Ident> {
    let mut taken: Vec<Ident> = Vec::new();
    for (index, name) in names.iter().enumerate() {
        let identifier = syn::parse_str::<Ident>(name)
            .ok()
            .filter(|identifier| !taken.contains(identifier))
            .filter(|_| !reserved.contains(&name.as_str()) && !is_numbered(name))
            .filter(|_| !name.starts_with(char::is_uppercase));
        taken.push(identifier.unwrap_or_else(|| format_ident!("a{index}")));
    }
    taken
}

/// `t0`, `a0`, `b0`, `l0` and `p0` are names that the code itself makes up, and `a` is the array of arguments.
fn is_numbered(name: &str) -> bool {
    let digits = name.strip_prefix(['t', 'a', 'b', 'l', 'p']);
    let numbered = digits.is_some_and(|digits| digits.chars().all(|c| c.is_ascii_digit()));
    name == "a" || (numbered && name.len() > 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names of `hertzian::emitted::constants`, from its source: a name that is missing here is missing in generated code.
    #[test]
    fn every_constant_can_be_imported() {
        let source = include_str!("../../../../core/contract/src/constants.rs");
        for line in source.lines() {
            let Some(item) = line.strip_prefix("pub const ") else {
                continue;
            };
            let name = item.strip_prefix("fn ").unwrap_or(item);
            let end = name.find(|c: char| !c.is_alphanumeric() && c != '_');
            let name = &name[..end.unwrap_or(name.len())];
            assert!(CONSTANTS.contains(&name), "{name}");
        }
    }
}
