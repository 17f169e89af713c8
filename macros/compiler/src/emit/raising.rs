//! Kernels with powers: an implementation of `hertzian::emitted::Raising` for a type of its own.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::code::{Code, logarithm, position, power};
use crate::tape::powers::Plan;

/// A kernel with powers, being written.
pub struct Raising<'a> {
    /// The name of its type.
    pub name: &'a Ident,
    /// What is computed before.
    pub plan: &'a Plan,
    /// The code of the bases, of `a`, `g` and `r`.
    pub bases: TokenStream,
    /// The code of the exponents, of `a`.
    pub exponents: TokenStream,
    /// The code of the values, of these and what is planned.
    pub values: TokenStream,
    /// What the code of the values uses.
    pub code: &'a Code,
    /// The planned logarithms and powers that each value needs.
    pub uses: &'a [[Vec<usize>; 2]],
}

impl Raising<'_> {
    /// The type and the implementation; `arguments` is how many arguments the law has.
    pub fn emit(&self, arguments: &Literal) -> TokenStream {
        let Self { name, plan, .. } = self;
        let [values_count, bases_count, groups_count, powers_count] = [
            self.uses.len(),
            plan.bases.len(),
            plan.groups.len(),
            plan.exponents.len(),
        ]
        .map(position);
        let groups = plan.groups.iter().map(|group| {
            let [base, first, count] = [group.base, group.first, group.count].map(position);
            if group.cube_root {
                quote!(__emitted::cube_root_group(#base, #first))
            } else {
                quote!(__emitted::group(#base, #first, #count))
            }
        });
        let uses = self.uses.iter().map(|uses| {
            let [logarithms, powers] = uses
                .each_ref()
                .map(|positions| positions.iter().map(|&at| position(at)));
            quote!(__emitted::uses(&[#(#logarithms),*], &[#(#powers),*]))
        });
        let (bases, exponents, values) = (&self.bases, &self.exponents, &self.values);
        let logarithms = bind(
            &quote!(l),
            plan.bases.len(),
            &self.code.logarithms,
            logarithm,
        );
        let powers = bind(&quote!(p), plan.exponents.len(), &self.code.powers, power);
        quote! {
            struct #name;

            impl __emitted::Raising<#arguments, #values_count, #bases_count, #groups_count, #powers_count> for #name {
                const GROUPS: [__emitted::Group; #groups_count] = [#(#groups),*];
                const USES: [__emitted::Uses; #values_count] = [#(#uses),*];

                #[inline(always)]
                fn bases(a: [f64; #arguments], g: f64, r: f64) -> [f64; #bases_count] { #bases }

                #[inline(always)]
                fn exponents(a: [f64; #arguments]) -> [f64; #powers_count] { #exponents }

                #[inline(always)]
                fn values(
                    a: [f64; #arguments],
                    g: f64,
                    r: f64,
                    l: [f64; #bases_count],
                    p: [f64; #powers_count],
                ) -> [f64; #values_count] {
                    #logarithms
                    #powers
                    #values
                }
            }
        }
    }
}

/// An array, taken apart.
fn bind(
    array: &TokenStream,
    count: usize,
    used: &[usize],
    name: fn(usize) -> Ident,
) -> TokenStream {
    if used.is_empty() {
        return TokenStream::new();
    }
    let names = (0..count).map(|position| {
        let name = name(position);
        if used.contains(&position) {
            quote!(#name)
        } else {
            quote!(_)
        }
    });
    quote!(let [#(#names),*] = #array;)
}
