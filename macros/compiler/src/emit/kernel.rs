//! The type of the kernels of a law: its levels, and which kernel a batch is run with.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::code::position;
use super::law::Emitter;
use super::pieces::Kernel;
use crate::dag::{Dag, Id};
use crate::tape::powers::Plan;

impl Emitter<'_> {
    /// The type of the kernels. What a caller does not use of the values of a piece is not computed.
    pub(super) fn kernels(&self, dag: &mut Dag, name: &Ident) -> TokenStream {
        let pieces: Vec<Kernel> = (0..self.pieces.len())
            .map(|index| self.piece(dag, name, index))
            .collect();
        let all_pieces = self.all_pieces(dag, name);
        let [arguments, levels_count, values] = self.sizes();
        let levels = self.levels(dag);
        let levels_by = self.levels_by(dag);
        let on = self.on(&pieces, all_pieces.as_ref());
        let by_argument = self.by_argument();
        let items = pieces.iter().chain(&all_pieces).map(|kernel| &kernel.item);
        quote! {
            struct #name;

            #(#items)*

            impl __emitted::Kernels<#arguments, #levels_count, #values> for #name {
                #levels
                #levels_by
                #on
                #by_argument
            }
        }
    }

    fn levels(&self, dag: &mut Dag) -> TokenStream {
        let values: Vec<Id> = self.member.levels.iter().map(|(value, _)| *value).collect();
        let code = self.code(dag, &values, &Plan::default());
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
            let code = self.code(dag, &roots, &Plan::default());
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
    fn on(&self, pieces: &[Kernel], all_pieces: Option<&Kernel>) -> TokenStream {
        let all_pieces = &all_pieces.unwrap_or(&pieces[0]).run;
        let arms = pieces
            .iter()
            .enumerate()
            .map(|(index, Kernel { run, .. })| {
                let index = position(index);
                quote!(__law::On::Piece(#index) => #run,)
            });
        let [arguments, _, outputs] = self.sizes();
        quote! {
            fn on(on: __law::On, batch: impl __emitted::Batch<#arguments, #outputs>) {
                match on {
                    __law::On::AllPieces => #all_pieces,
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
