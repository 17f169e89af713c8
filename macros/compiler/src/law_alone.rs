//! `law!`: a law without a model, `pub Name(gap, argument, ...) { pieces }`.
//!
//! It is compiled as the law of the smallest model that has it, so that it has the same grammar, the same checks and the
//! same messages: the arguments are parameters, with their ranges, and the model is `ddot(x) + Name(x) = 0`.

use std::collections::HashMap;

use proc_macro2::{Delimiter, Group, Ident, Punct, Spacing, TokenStream, TokenTree};
use quote::{quote, quote_spanned};

use crate::dag::{Id, Node, Variable};
use crate::emit;
use crate::errors::{Diagnostics, Errors, Extent};
use crate::ir::{Law, Level, Model, Place};

/// Expands a law. After errors the expansion holds all of them, and a stub of the type.
pub fn law(declaration: TokenStream) -> TokenStream {
    let model = model_of(declaration);
    let (read, compiled) = crate::read(model);
    let law = compiled.and_then(|mut model| {
        let law = alone(&mut model)?;
        Ok((model, law))
    });
    match law {
        Ok((model, law)) => emit::law_alone(&model, &law),
        Err(errors) => {
            let mut expansion = errors.into_compile_error();
            expansion.extend(read.map(|read| emit::law_stub(&read.name, &read.visibility)));
            expansion
        }
    }
}

/// The declaration of the smallest model with the law. What is not in its place is left where it is, for the parser to
/// complain about.
fn model_of(declaration: TokenStream) -> TokenStream {
    let mut head = Vec::new();
    let mut tokens = declaration.clone().into_iter().peekable();
    while let Some(token) = tokens.peek() {
        if is_group(token, Delimiter::Parenthesis)
            && matches!(head.last(), Some(TokenTree::Ident(name)) if name != "pub")
        {
            break;
        }
        head.extend(tokens.next());
    }
    let name = head.last().cloned();
    let (Some(TokenTree::Group(names)), Some(TokenTree::Ident(name))) = (tokens.next(), name)
    else {
        return declaration;
    };
    let span = name.span();
    let coordinate = Ident::new("coordinate_of_the_law", span);
    let body: TokenStream = tokens.collect();
    let (gap, parameters) = arguments(&names);
    let law = quote_spanned!(span=> law #name);
    let equation = quote_spanned!(span=> ddot(#coordinate) + #name(#coordinate) = 0;);
    let mut pieces = body.into_iter();
    let braces = pieces.next();
    let rest: TokenStream = pieces.collect();
    quote! {
        #(#head)* (#coordinate) {
            #parameters
            #law #gap #braces
            #equation
        }
        #rest
    }
}

/// The gap in parentheses, and the other arguments as parameters.
fn arguments(names: &Group) -> (TokenTree, TokenStream) {
    let mut gap = TokenStream::new();
    let mut parameters = TokenStream::new();
    let mut current = TokenStream::new();
    let mut first = true;
    let end = TokenTree::Punct(Punct::new(',', Spacing::Alone));
    for token in names.stream().into_iter().chain([end]) {
        if !matches!(&token, TokenTree::Punct(mark) if mark.as_char() == ',') {
            current.extend([token]);
            continue;
        }
        let argument = std::mem::take(&mut current);
        if first {
            gap = argument;
        } else if !argument.is_empty() {
            parameters.extend(quote!(param #argument;));
        }
        first = false;
    }
    let mut gap = Group::new(Delimiter::Parenthesis, gap);
    gap.set_span(names.span());
    (TokenTree::Group(gap), parameters)
}

fn is_group(token: &TokenTree, delimiter: Delimiter) -> bool {
    matches!(token, TokenTree::Group(group) if group.delimiter() == delimiter)
}

/// The law of the model, its arguments those that were written, in their order.
fn alone(model: &mut Model) -> Result<Law, Errors> {
    let place = Extent::at(model.name.span());
    let [law] = model.laws.as_slice() else {
        return Err(refuse(
            place,
            "this is linear in gap and rate everywhere: put it into the matrices of stiffness and damping",
        ));
    };
    let law = law.clone();
    let mut by = HashMap::new();
    for (at, value) in model.coefficients.clone() {
        let Place::Argument { index, .. } = at else {
            continue;
        };
        let Node::Variable(Variable::Parameter(parameter)) = *model.dag.node(value) else {
            return Err(refuse(
                place,
                "an exponent here is a number, an argument, or an argument plus a number",
            ));
        };
        let argument = model.dag.variable(Variable::Argument(parameter));
        by.insert(Variable::Argument(index), argument);
    }
    let dag = &mut model.dag;
    let mut rename = |id: Id| dag.substitute(id, &by);
    let parameters = model.parameters.iter();
    Ok(Law {
        name: law.name,
        arguments: parameters.clone().map(|p| p.name.to_string()).collect(),
        ranges: parameters.map(|p| (p.minimum, p.maximum)).collect(),
        levels: law
            .levels
            .iter()
            .map(|level| Level {
                value: rename(level.value),
                ..*level
            })
            .collect(),
        pieces: law.pieces.iter().map(|&piece| rename(piece)).collect(),
    })
}

fn refuse(place: Extent, message: &str) -> Errors {
    let mut diagnostics = Diagnostics::default();
    diagnostics.report(place, message);
    match diagnostics.finish() {
        Err(errors) => errors,
        Ok(()) => Errors::internal(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_becomes_the_law_of_the_smallest_model() {
        let law =
            quote!(pub Hertz(gap, k > 0, c) { gap > 0 => k*gap^1.5*(1 + c*dot(gap)), else => 0 });
        let expected = quote! {
            pub Hertz(coordinate_of_the_law) {
                param k > 0;
                param c;
                law Hertz(gap) { gap > 0 => k*gap^1.5*(1 + c*dot(gap)), else => 0 }
                ddot(coordinate_of_the_law) + Hertz(coordinate_of_the_law) = 0;
            }
        };
        assert_eq!(model_of(law).to_string(), expected.to_string());
    }

    #[test]
    fn arguments_keep_their_order() {
        let declaration =
            quote!(Stop(gap, play > 0, k) { gap > play => k*(gap - play)^2, else => 0 });
        let mut model = crate::compile(model_of(declaration)).expect("it is sound");
        let law = alone(&mut model).expect("it is a law");
        assert_eq!(law.arguments, ["play", "k"]);
        assert!(
            model
                .dag
                .depends_on(law.levels[0].value, Variable::Argument(0))
        );
        assert!(model.dag.depends_on(law.pieces[1], Variable::Argument(1)));
    }

    #[test]
    fn what_is_no_law_is_refused() {
        for text in [
            "",
            "Hertz",
            "Hertz(gap)",
            "Hertz(gap) {}",
            "Line(gap, k) { k*gap }",
            "pub (gap) { gap^3 }",
        ] {
            let tokens: TokenStream = text.parse().expect("it is made of tokens");
            let expansion = law(tokens).to_string();
            assert!(expansion.contains("compile_error"), "{text}: {expansion}");
        }
    }
}
