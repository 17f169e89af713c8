//! The methods of a law: one loop over a batch for what varies, one fill for what does not.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::code::position;
use super::kernel::piece_name;
use super::law::Emitter;
use crate::facts::Variation;

impl Emitter<'_> {
    /// The ways a batch can be evaluated: on all pieces, on one of them.
    fn targets(&self) -> Vec<Option<usize>> {
        let mut targets: Vec<Option<usize>> = (0..self.pieces.len()).map(Some).collect();
        targets.insert(0, None);
        targets
    }

    pub(super) fn force(&self) -> TokenStream {
        let arms = self.targets().into_iter().map(|target| {
            let pattern = on_pattern(target);
            let body = self.write(target, &[(0, quote!(force))]);
            quote!(#pattern => { #body })
        });
        self.dispatch(arms)
    }

    pub(super) fn derivatives(&self) -> TokenStream {
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
    pub(super) fn derivatives_and_by(&self) -> TokenStream {
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
            let outputs = position(3 + self.count());
            body.extend(quote! {
                __emitted::#write::<#(#indices,)* #outputs>(
                    gap, rate, #(#slices,)* |g, r| Self::#function(a, g, r),
                );
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

fn on_pattern(target: Option<usize>) -> TokenStream {
    target.map_or_else(
        || quote!(__law::On::AllPieces),
        |piece| {
            let piece = position(piece);
            quote!(__law::On::Piece(#piece))
        },
    )
}
