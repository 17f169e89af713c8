//! The kernels of one sample: levels, each piece, and all pieces by selection.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::code::{Code, position};
use super::law::Emitter;
use super::tape::{Style, Tape};
use crate::dag::{Dag, Id, Variable};

impl Emitter<'_> {
    /// The type of the kernels. What a caller does not use of the values of a piece is not computed.
    pub(super) fn kernels(&self, dag: &mut Dag, name: &Ident) -> TokenStream {
        let pieces: TokenStream = (0..self.pieces.len())
            .map(|index| self.piece(dag, index))
            .collect();
        let all_pieces = self.all_pieces(dag);
        let [arguments, levels_count, values] = self.sizes();
        let levels = self.levels(dag);
        let levels_by = self.levels_by(dag);
        let (on, by_argument) = (self.on(), self.by_argument());
        quote! {
            struct #name;

            impl #name { #pieces #all_pieces }

            impl __emitted::Kernels<#arguments, #levels_count, #values> for #name {
                #levels
                #levels_by
                #on
                #by_argument
            }
        }
    }

    /// The function of a piece, unless all of its values are zero.
    fn piece(&self, dag: &mut Dag, index: usize) -> TokenStream {
        if self.is_zero(index) {
            return TokenStream::new();
        }
        let name = piece_name(index);
        let code = self.code(dag, &self.pieces[index]);
        let (pattern, statements, values) = (self.pattern(&code), &code.statements, &code.roots);
        let gap = used(&code, Variable::Gap, "g");
        let rate = used(&code, Variable::Rate, "r");
        let [arguments, _, outputs] = self.sizes();
        quote! {
            #[inline(always)]
            fn #name(#pattern: [f64; #arguments], #gap: f64, #rate: f64) -> [f64; #outputs] {
                #statements
                [#(#values),*]
            }
        }
    }

    fn is_zero(&self, index: usize) -> bool {
        self.pieces[index].iter().all(|&value| value == self.zero)
    }

    /// The path of the function of a piece.
    fn path(&self, index: usize) -> TokenStream {
        if self.is_zero(index) {
            return quote!(__emitted::nothing);
        }
        let name = piece_name(index);
        quote!(Self::#name)
    }

    /// Every piece is computed, and one is selected by comparison: no branch.
    fn all_pieces(&self, dag: &mut Dag) -> TokenStream {
        if self.member.levels.is_empty() {
            return TokenStream::new();
        }
        let [arguments, _, outputs] = self.sizes();
        let mut values: Vec<TokenStream> = (0..self.pieces.len())
            .map(|index| {
                let piece = self.path(index);
                quote!(#piece(a, g, r))
            })
            .collect();
        let mut statements = TokenStream::new();
        if let Some(pieces) = &self.together {
            let code = self.code(dag, &pieces.concat());
            let pattern = self.pattern(&code);
            statements = code.statements;
            statements = quote!(let #pattern = a; #statements);
            let pieces = code.roots.chunks(pieces[0].len());
            values = pieces.map(|values| quote!([#(#values),*])).collect();
        }
        let first = &values[0];
        let levels = self.member.law.levels.iter().enumerate();
        let selections = levels.zip(&values[1..]).map(|((index, level), value)| {
            let index = position(index);
            let above = if level.belongs_above {
                quote!(>=)
            } else {
                quote!(>)
            };
            quote!(__emitted::select(&mut v, g #above level[#index], #value);)
        });
        quote! {
            #[inline(always)]
            fn all_pieces(a: [f64; #arguments], g: f64, r: f64) -> [f64; #outputs] {
                let level = <Self as __emitted::Kernels<_, _, _>>::levels(a);
                #statements
                let mut v = #first;
                #(#selections)*
                v
            }
        }
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

    fn levels(&self, dag: &mut Dag) -> TokenStream {
        let values: Vec<Id> = self.member.levels.iter().map(|(value, _)| *value).collect();
        let code = self.code(dag, &values);
        let (pattern, statements, roots) = (self.pattern(&code), &code.statements, &code.roots);
        let [arguments, levels, _] = self.sizes();
        quote! {
            #[inline(always)]
            fn levels(#pattern: [f64; #arguments]) -> [f64; #levels] {
                #statements
                [#(#roots),*]
            }
        }
    }

    /// Where no level depends on an argument, the provided method says so.
    fn levels_by(&self, dag: &mut Dag) -> TokenStream {
        let zero = dag.integer(0);
        let mut arms = TokenStream::new();
        for argument in 0..self.count() {
            let levels = self.member.levels.iter();
            let roots: Vec<Id> = levels.map(|(_, by)| by[argument]).collect();
            if roots.iter().all(|&root| root == zero) {
                continue;
            }
            let code = self.code(dag, &roots);
            let (pattern, statements, values) =
                (self.pattern(&code), &code.statements, &code.roots);
            let argument = position(argument);
            let bind = (!code.inputs.is_empty()).then(|| quote!(let #pattern = a;));
            arms.extend(quote!(#argument => { #bind #statements [#(#values),*] }));
        }
        if arms.is_empty() {
            return arms;
        }
        let [arguments, levels, _] = self.sizes();
        quote! {
            fn levels_by(argument: usize, a: [f64; #arguments]) -> [f64; #levels] {
                match argument { #arms _ => [0.0; #levels] }
            }
        }
    }

    /// Hands over the kernel of what a batch is evaluated on.
    fn on(&self) -> TokenStream {
        let all_pieces = if self.member.levels.is_empty() {
            self.path(0)
        } else {
            quote!(Self::all_pieces)
        };
        let arms = (0..self.pieces.len()).map(|index| {
            let (path, index) = (self.path(index), position(index));
            quote!(__law::On::Piece(#index) => batch.run(#path),)
        });
        let [arguments, _, outputs] = self.sizes();
        quote! {
            fn on(on: __law::On, batch: impl __emitted::Batch<#arguments, #outputs>) {
                match on {
                    __law::On::AllPieces => batch.run(#all_pieces),
                    #(#arms)*
                    __law::On::Piece(index) => __emitted::no_such_piece(index),
                }
            }
        }
    }

    /// Hands over the position of a derivative by an argument among the values of a kernel.
    fn by_argument(&self) -> TokenStream {
        let arms = (0..self.count()).map(|argument| {
            let (at, argument) = (position(3 + argument), position(argument));
            quote!(#argument => call.run::<#at>(),)
        });
        quote! {
            fn by_argument(argument: usize, call: impl __emitted::ByArgument) {
                match argument {
                    #(#arms)*
                    _ => __emitted::no_such_argument(argument),
                }
            }
        }
    }
}

fn piece_name(index: usize) -> Ident {
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
