//! One law: a unit type that implements `hertzian::law::Law`.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::code::{Code, position};
use super::data;
use super::names::locals;
use super::tape::{Style, Tape};
use crate::dag::{Dag, Id, Variable};
use crate::differentiate::differentiate;
use crate::facts::{Piece, Ranges, Variation, derive, variation};
use crate::ir::Law;
use crate::simplify::{expand, factor};

/// A law being written.
struct Emitter<'a> {
    law: &'a Law,
    pieces: Vec<Piece>,
    /// How every output of every piece varies.
    variations: Vec<Vec<Variation>>,
    /// Levels and their derivatives by each argument.
    levels: Vec<(Id, Vec<Id>)>,
    /// Identifiers of the arguments.
    arguments: Vec<Ident>,
}

/// The type of a law and its implementation; `parts` are the types of its spring and primitive.
pub fn law(dag: &mut Dag, law: &Law, name: &Ident, parts: Option<(&Ident, &Ident)>) -> TokenStream {
    let emitter = Emitter::of(dag, law);
    let facts = data::facts(law, &derive(dag, law, &emitter.pieces));
    let data = data::data(dag, &emitter.levels, &emitter.pieces);
    let functions = emitter.functions(dag);
    let (force, derivatives, derivatives_and_by) = (
        emitter.force(),
        emitter.derivatives(),
        emitter.derivatives_and_by(),
    );
    let (levels, levels_by) = (emitter.copy_levels(), emitter.levels_by(dag));
    let parts = data::option(parts.map(
        |(spring, primitive)| quote!(__law::Parts { spring: &#spring, primitive: &#primitive }),
    ));
    quote! {
        struct #name;

        impl #name { #functions }

        #[automatically_derived]
        impl __law::Law for #name {
            fn facts(&self) -> &__law::LawFacts {
                static FACTS: __law::LawFacts = #facts;
                &FACTS
            }

            fn data(&self) -> &__generic::LawData {
                static DATA: __generic::LawData = #data;
                &DATA
            }

            fn levels(&self, arguments: &[f64], levels: &mut [f64]) { #levels }

            fn levels_by(&self, arguments: &[f64], argument: usize, by_argument: &mut [f64]) { #levels_by }

            fn force(&self, on: __law::On, arguments: &[f64], gap: &[f64], rate: &[f64], force: &mut [f64]) {
                #force
            }

            fn derivatives(
                &self,
                on: __law::On,
                arguments: &[f64],
                gap: &[f64],
                rate: &[f64],
                out: __law::Derivatives<'_>,
            ) {
                #derivatives
            }

            fn derivatives_and_by(
                &self,
                argument: usize,
                on: __law::On,
                arguments: &[f64],
                gap: &[f64],
                rate: &[f64],
                out: __law::Derivatives<'_>,
                by_argument: &mut [f64],
            ) {
                #derivatives_and_by
            }

            fn parts(&self) -> ::core::option::Option<__law::Parts<'_>> { #parts }
        }
    }
}

impl<'a> Emitter<'a> {
    fn of(dag: &mut Dag, law: &'a Law) -> Self {
        let count = law.arguments.len();
        let mut pieces: Vec<Piece> = law
            .pieces
            .iter()
            .map(|&force| Piece::of(dag, force, count))
            .collect();
        let mut variations = Vec::new();
        for piece in &mut pieces {
            variations.push(simplify(dag, piece));
        }
        let levels = law
            .levels
            .iter()
            .map(|level| {
                let by = |index| differentiate(dag, level.value, Variable::Argument(index));
                (level.value, (0..count).map(by).collect())
            })
            .collect();
        let arguments = locals(&law.arguments, &["g", "r", "level", "v"]);
        Self {
            law,
            pieces,
            variations,
            levels,
            arguments,
        }
    }

    fn count(&self) -> usize {
        self.arguments.len()
    }

    fn name(&self, variable: Variable) -> Ident {
        match variable {
            Variable::Gap => format_ident!("g"),
            Variable::Rate => format_ident!("r"),
            Variable::Argument(index) => self.arguments[index].clone(),
            other => unreachable!("a law depends on gap, rate and arguments, not on {other:?}"),
        }
    }

    /// Levels, each piece, and all pieces by selection, for one sample: force, by gap, by rate, by each argument. What a
    /// caller does not use of the outputs is not computed.
    fn functions(&self, dag: &mut Dag) -> TokenStream {
        let mut functions = self.level_function(dag);
        for (index, piece) in self.pieces.iter().enumerate() {
            let name = piece_name(index);
            let code = self.code(dag, &piece.outputs());
            let (pattern, statements, roots) = (self.pattern(&code), &code.statements, &code.roots);
            let gap = used(&code, Variable::Gap, "g");
            let rate = used(&code, Variable::Rate, "r");
            let (arguments, outputs) = (position(self.count()), position(3 + self.count()));
            functions.extend(quote! {
                #[inline(always)]
                fn #name(#pattern: [f64; #arguments], #gap: f64, #rate: f64) -> [f64; #outputs] {
                    #statements
                    [#(#roots),*]
                }
            });
        }
        functions.extend(self.selection());
        functions
    }

    fn code(&self, dag: &mut Dag, roots: &[Id]) -> Code {
        let ranges = Ranges(&self.law.ranges);
        let tape = Tape::of(dag, roots, Style::Code, &|dag, id| {
            ranges.is_positive(dag, id)
        });
        Code::of(&tape, &|variable| self.name(variable))
    }

    /// The pattern that takes the arguments apart.
    fn pattern(&self, code: &Code) -> TokenStream {
        let names = self.arguments.iter().enumerate().map(|(index, name)| {
            if code.inputs.contains(&Variable::Argument(index)) {
                quote!(#name)
            } else {
                quote!(_)
            }
        });
        quote!([#(#names),*])
    }

    fn level_function(&self, dag: &mut Dag) -> TokenStream {
        if self.levels.is_empty() {
            return TokenStream::new();
        }
        let values: Vec<Id> = self.levels.iter().map(|(value, _)| *value).collect();
        let code = self.code(dag, &values);
        let (pattern, statements, roots) = (self.pattern(&code), &code.statements, &code.roots);
        let (arguments, levels) = (position(self.count()), position(self.levels.len()));
        quote! {
            #[inline(always)]
            fn level(#pattern: [f64; #arguments]) -> [f64; #levels] {
                #statements
                [#(#roots),*]
            }
        }
    }

    /// Every piece is computed, and one is selected by comparison: no branch.
    fn selection(&self) -> TokenStream {
        if self.levels.is_empty() {
            return TokenStream::new();
        }
        let (arguments, outputs) = (position(self.count()), position(3 + self.count()));
        let selections = self.law.levels.iter().enumerate().map(|(index, level)| {
            let piece = piece_name(index + 1);
            let index = position(index);
            let above = if level.belongs_above {
                quote!(>=)
            } else {
                quote!(>)
            };
            quote!(v = __emitted::select(g #above level[#index], Self::#piece(a, g, r), v);)
        });
        quote! {
            #[inline(always)]
            fn all_pieces(a: [f64; #arguments], g: f64, r: f64) -> [f64; #outputs] {
                let level = Self::level(a);
                let mut v = Self::piece_0(a, g, r);
                #(#selections)*
                v
            }
        }
    }

    fn copy_levels(&self) -> TokenStream {
        if self.levels.is_empty() {
            return TokenStream::new();
        }
        quote!(levels.copy_from_slice(&Self::level(__emitted::arguments(arguments)));)
    }

    fn levels_by(&self, dag: &mut Dag) -> TokenStream {
        let zero = dag.integer(0);
        let mut arms = TokenStream::new();
        for argument in 0..self.count() {
            let roots: Vec<Id> = self.levels.iter().map(|(_, by)| by[argument]).collect();
            if roots.iter().all(|&root| root == zero) {
                continue;
            }
            let code = self.code(dag, &roots);
            let (pattern, statements, values) =
                (self.pattern(&code), &code.statements, &code.roots);
            let (argument, count) = (position(argument), position(self.count()));
            arms.extend(quote! {
                #argument => {
                    let #pattern: [f64; #count] = __emitted::arguments(arguments);
                    #statements
                    by_argument.copy_from_slice(&[#(#values),*]);
                }
            });
        }
        if arms.is_empty() {
            quote!(by_argument.fill(0.0);)
        } else {
            quote!(match argument { #arms _ => by_argument.fill(0.0), })
        }
    }

    /// The ways a batch can be evaluated: on all pieces, on one of them.
    fn targets(&self) -> Vec<Option<usize>> {
        let mut targets: Vec<Option<usize>> = (0..self.pieces.len()).map(Some).collect();
        targets.insert(0, None);
        targets
    }

    fn force(&self) -> TokenStream {
        let arms = self.targets().into_iter().map(|target| {
            let pattern = on_pattern(target);
            let body = self.write(target, &[(0, quote!(force))]);
            quote!(#pattern => { #body })
        });
        self.dispatch(arms)
    }

    fn derivatives(&self) -> TokenStream {
        let outputs = [
            (0, quote!(force)),
            (1, quote!(by_gap)),
            (2, quote!(by_rate)),
        ];
        let arms = self.targets().into_iter().map(|target| {
            let pattern = on_pattern(target);
            let body = self.write(target, &outputs);
            quote!(#pattern => { #body })
        });
        let dispatch = self.dispatch(arms);
        quote! {
            let __law::Derivatives { force, by_gap, by_rate } = out;
            #dispatch
        }
    }

    /// Where the derivative by the argument does not vary, it is filled in beside what [`Self::derivatives`] does.
    fn derivatives_and_by(&self) -> TokenStream {
        if self.count() == 0 {
            return quote!(__emitted::no_such_argument(argument));
        }
        let mut arms = Vec::new();
        for argument in 0..self.count() {
            let output = 3 + argument;
            for target in self.targets() {
                let on = on_pattern(target);
                let body = if self.varies(target, output) {
                    let outputs = [
                        (0, quote!(out.force)),
                        (1, quote!(out.by_gap)),
                        (2, quote!(out.by_rate)),
                        (output, quote!(by_argument)),
                    ];
                    self.write(target, &outputs)
                } else {
                    let fill = self.write(target, &[(output, quote!(by_argument))]);
                    quote!(__law::Law::derivatives(self, on, arguments, gap, rate, out); #fill)
                };
                let argument = position(argument);
                arms.push(quote!((#argument, #on) => { #body }));
            }
        }
        let arguments = self.bind_arguments();
        quote! {
            #arguments
            match (argument, on) {
                #(#arms)*
                (_, __law::On::Piece(index)) => __emitted::no_such_piece(index),
                (_, __law::On::AllPieces) => __emitted::no_such_argument(argument),
            }
        }
    }

    fn bind_arguments(&self) -> TokenStream {
        let count = position(self.count());
        quote!(let a: [f64; #count] = __emitted::arguments(arguments);)
    }

    fn dispatch(&self, arms: impl Iterator<Item = TokenStream>) -> TokenStream {
        let arguments = self.bind_arguments();
        quote! {
            #arguments
            match on {
                #(#arms)*
                __law::On::Piece(index) => __emitted::no_such_piece(index),
            }
        }
    }

    fn varies(&self, target: Option<usize>, output: usize) -> bool {
        let varies_on = |piece: usize| self.variations[piece][output] == Variation::Varying;
        let differs = || {
            let first = self.pieces[0].outputs()[output];
            self.pieces
                .iter()
                .any(|piece| piece.outputs()[output] != first)
        };
        target.map_or_else(|| varies_on(0) || differs(), varies_on)
    }

    /// Writes outputs: in one loop those that vary, by filling those that do not.
    fn write(&self, target: Option<usize>, outputs: &[(usize, TokenStream)]) -> TokenStream {
        let function = match target {
            Some(piece) => piece_name(piece),
            None if self.levels.is_empty() => piece_name(0),
            None => format_ident!("all_pieces"),
        };
        let (varying, constant): (Vec<_>, Vec<_>) = outputs
            .iter()
            .partition(|(output, _)| self.varies(target, *output));
        let mut body = TokenStream::new();
        if !varying.is_empty() {
            let write = format_ident!("write_{}", varying.len());
            let indices = varying.iter().map(|(output, _)| position(*output));
            let slices = varying.iter().map(|(_, slice)| slice);
            body.extend(quote! {
                __emitted::#write(gap, rate, #(#slices,)* |g, r| {
                    let v = Self::#function(a, g, r);
                    [#(v[#indices]),*]
                });
            });
        }
        for (output, slice) in constant {
            let value = if self.variations[target.unwrap_or(0)][*output] == Variation::Zero {
                quote!(0.0)
            } else {
                let output = position(*output);
                quote!(Self::#function(a, 0.0, 0.0)[#output])
            };
            body.extend(quote!(#slice.fill(#value);));
        }
        body
    }
}

/// Puts every output of a piece into the form to be computed, and says how each varies.
fn simplify(dag: &mut Dag, piece: &mut Piece) -> Vec<Variation> {
    let mut variations = Vec::new();
    let outputs = [&mut piece.force, &mut piece.by_gap, &mut piece.by_rate];
    for output in outputs.into_iter().chain(piece.by_argument.iter_mut()) {
        let how = variation(dag, *output);
        // What does not vary is written without gap and rate, even where that takes multiplying out.
        *output = if how == Variation::Varying {
            *output
        } else {
            expand(dag, *output)
        };
        *output = factor(dag, *output);
        variations.push(how);
    }
    variations
}

fn piece_name(index: usize) -> Ident {
    format_ident!("piece_{index}")
}

fn on_pattern(target: Option<usize>) -> TokenStream {
    target.map_or_else(
        || quote!(__law::On::AllPieces),
        |piece| {
            let piece = position(piece);
            quote!(__law::On::Piece(#piece))
        },
    )
}

fn used(code: &Code, variable: Variable, name: &str) -> TokenStream {
    if code.inputs.contains(&variable) {
        let name = format_ident!("{name}");
        quote!(#name)
    } else {
        quote!(_)
    }
}
