//! `law!`: a law without a model, `pub Name(gap, argument, ...) { pieces }`.
//!
//! It is compiled as the law of the smallest model that has it, so that it has the same grammar, the same checks and the
//! same messages: the arguments are parameters, with their ranges, and the model is `ddot(x) + Name(x) = 0`.

use std::collections::HashMap;

use proc_macro2::TokenStream;

use hertzian_contract::system::Place;

use crate::ast::Form;
use crate::dag::{Id, Node, Variable};
use crate::emit;
use crate::errors::{Diagnostics, Errors, Extent};
use crate::ir::{Law, Level, Model};
use crate::{sketch, stages};

/// Expands a law to code that names the runtime by a path. After errors the expansion holds all of them, and a stub of the type.
pub fn law(runtime: &TokenStream, declaration: TokenStream) -> TokenStream {
    let written = declaration.clone();
    let compiled = stages::read(declaration, Form::LawAlone);
    let law = compiled.and_then(|mut model| {
        let law = alone(&mut model)?;
        Ok((model, law))
    });
    match law {
        Ok((model, law)) => emit::law_alone(runtime, &model, &law),
        Err(errors) => {
            let mut expansion = errors.into_compile_error();
            for sketch in sketch::of(written) {
                expansion.extend(emit::law_stub(runtime, &sketch.name, &sketch.visibility));
            }
            expansion
        }
    }
}

/// The law of the model, its arguments those that were written, in their order.
pub(crate) fn alone(model: &mut Model) -> Result<Law, Errors> {
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
    use quote::quote;

    use super::*;

    fn faults(text: &str) -> Vec<String> {
        let tokens = text.parse().expect("it is made of tokens");
        let compiled = stages::read(tokens, Form::LawAlone);
        compiled.expect_err("it is refused").messages()
    }

    #[test]
    fn arguments_keep_their_order() {
        let declaration =
            quote!(Stop(gap, play > 0, k) { gap > play => k*(gap - play)^2, else => 0 });
        let compiled = stages::read(declaration, Form::LawAlone);
        let mut model = compiled.expect("it is sound");
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
            let expansion = law(&quote!(::hertzian), tokens).to_string();
            assert!(expansion.contains("compile_error"), "{text}: {expansion}");
        }
    }

    #[test]
    fn messages_speak_of_arguments() {
        for (text, expected) in [
            (
                "Hertz(gap, k, n) { gap > 0 => k*gap^n, else => 0 }",
                "`gap` vanishes on this piece, so the exponent `n` must be positive: write `n > 0` in the list of arguments",
            ),
            (
                "Stop(gap, play, k) { gap > play => k*(gap - play)^2, -play <= gap <= play => 0, else => 1 }",
                "whether the level `-play` or `play` is the higher one is not known: write `play > 0` in the list of arguments",
            ),
            (
                "Hertz(gap, k, k) { gap > 0 => k*gap^1.5, else => 0 }",
                "argument `k` is declared twice: remove or rename one of them",
            ),
            (
                "Hertz(gap, k, c) { gap > 0 => k*gap^1.5, else => 0 }",
                "argument `c` is never used: remove it, or use it in a piece",
            ),
            (
                "Hertz(gap, gap) { gap > 0 => gap^1.5, else => 0 }",
                "gap `gap` has the name of an argument: rename one of them",
            ),
            (
                "Hertz(gap, k) { gap > 0 => k*gap^1.5 + wobble, else => 0 }",
                "unknown name `wobble`: add it to the arguments, as in `Hertz(gap, wobble)`",
            ),
            (
                "Hertz(gap, k 3) { gap > 0 => k*gap^1.5, else => 0 }",
                "expected `,`, `)`, or a range such as `in 0.0..` or `> 0`, found `3`",
            ),
            (
                "Hertz(gap, k: N/m^1.5 > 0) { gap > 0 => k*gap^1.5, else => 0 }",
                "an argument here has no unit: the law is evaluated with numbers as they are; remove it",
            ),
            (
                "Hertz(gap, k > ) { gap > 0 => k*gap^1.5, else => 0 }",
                "expected a number, found `)`",
            ),
        ] {
            assert_eq!(faults(text), [expected], "{text}");
        }
        for text in [
            "Hertz(gap, k = 3) {k*gap^3}",
            "Hertz(gap, k = 3 > 0) {k*gap^3}",
            "Hertz(gap, k > 0 = 3) {k*gap^3}",
        ] {
            let faults = faults(text);
            assert!(
                faults.len() == 1 && faults[0].contains("has no default: write `k`"),
                "{text}: {faults:?}"
            );
        }
    }
}
