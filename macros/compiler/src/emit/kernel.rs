//! The kernels of one sample: levels, each piece, and all pieces by selection.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::code::{Code, position};
use super::law::Emitter;
use super::tape::{Style, Tape};
use crate::dag::{Dag, Id, Variable};

impl Emitter<'_> {
    /// Levels, each piece, and all pieces by selection, for one sample: force, by gap, by rate, by each argument. What a
    /// caller does not use of the outputs is not computed.
    pub(super) fn functions(&self, dag: &mut Dag) -> TokenStream {
        let mut functions = self.level_function(dag);
        for (index, piece) in self.kernels.iter().enumerate() {
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
        let tape = Tape::of(dag, roots, Style::Code);
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

    pub(super) fn copy_levels(&self) -> TokenStream {
        if self.levels.is_empty() {
            return TokenStream::new();
        }
        quote!(levels.copy_from_slice(&Self::level(__emitted::arguments(arguments)));)
    }

    pub(super) fn levels_by(&self, dag: &mut Dag) -> TokenStream {
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
}

/// The function of a piece.
pub fn piece_name(index: usize) -> Ident {
    format_ident!("piece_{index}")
}

fn used(code: &Code, variable: Variable, name: &str) -> TokenStream {
    if code.inputs.contains(&variable) {
        let name = format_ident!("{name}");
        quote!(#name)
    } else {
        quote!(_)
    }
}
