//! What can be seen of a declaration that was refused: names, for stubs, so that the code which uses them does not fail too.

use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};

use crate::check::{MOST_DECLARED, is_primitive};

/// The name of a type, and of the parameters that it seems to have.
pub(crate) struct Sketch {
    pub visibility: syn::Visibility,
    pub name: Ident,
    pub parameters: Vec<Ident>,
}

/// Every `name(...)` on the outermost level, with the parameters of the braces after it: mostly one, more where several models
/// stand in one macro.
pub(crate) fn of(declaration: TokenStream) -> Vec<Sketch> {
    let mut sketches: Vec<Sketch> = Vec::new();
    let mut public = false;
    let mut last = None;
    for token in declaration {
        match token {
            TokenTree::Ident(word) => {
                public |= word == "pub";
                last = (word != "pub").then_some(word);
            }
            TokenTree::Group(group) if group.delimiter() == Delimiter::Parenthesis => {
                let name = last.take().filter(is_free);
                let is_new = |name: &Ident| sketches.iter().all(|sketch| sketch.name != *name);
                if let Some(name) = name.filter(is_new) {
                    let visibility = if public { "pub" } else { "" };
                    sketches.push(Sketch {
                        visibility: syn::parse_str(visibility)
                            .unwrap_or(syn::Visibility::Inherited),
                        name,
                        parameters: Vec::new(),
                    });
                    public = false;
                }
            }
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => {
                if let Some(sketch) = sketches.last_mut() {
                    add_parameters(group.stream(), &mut sketch.parameters);
                }
                public = false;
            }
            _ => last = None,
        }
    }
    sketches
}

/// Whether a type may have the name.
fn is_free(name: &Ident) -> bool {
    let text = name.to_string();
    syn::parse_str::<Ident>(&text).is_ok() && !is_primitive(name) && !text.starts_with("__")
}

/// The names after the word `param`.
fn add_parameters(items: TokenStream, parameters: &mut Vec<Ident>) {
    let mut is_next = false;
    for token in items {
        let TokenTree::Ident(word) = token else {
            is_next = false;
            continue;
        };
        let is_name = is_next && syn::parse_str::<Ident>(&word.to_string()).is_ok();
        is_next = word == "param";
        if is_name && parameters.len() < MOST_DECLARED && !parameters.contains(&word) {
            parameters.push(word);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_seen_where_a_declaration_cannot_be_read() {
        for (text, expected) in [
            (
                "pub struct M(x) { param a; param b = ; param 3; }",
                "pub M a b",
            ),
            ("M(x { param a; } N(y) { param b; }", ""),
            ("M(x) { param a; } pub N(y) { param b; }", "M a, pub N b"),
            ("M(x) = { law f(gap) { gap^3 } param a param b }", "M a b"),
            ("pub(crate) M(x) {}", "pub M"),
            ("f64(x) { param a; }", ""),
            ("", ""),
        ] {
            let shown = |sketch: &Sketch| {
                let public = matches!(sketch.visibility, syn::Visibility::Public(_));
                let name = sketch.name.to_string();
                let parameters = sketch.parameters.iter().map(ToString::to_string);
                let words = public.then(|| "pub".to_owned()).into_iter();
                words
                    .chain([name])
                    .chain(parameters)
                    .collect::<Vec<_>>()
                    .join(" ")
            };
            let Ok(tokens) = text.parse() else {
                continue;
            };
            let sketches: Vec<String> = of(tokens).iter().map(shown).collect();
            assert_eq!(sketches.join(", "), expected, "{text}");
        }
    }
}
