//! What stands in for a model that did not compile, so that one mistake gives one message.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::wrap;

/// The type with its fields and an implementation that is never run: the declaration has already been refused. It has
/// defaults if the declaration gives one to every parameter.
pub fn stub(
    name: &Ident,
    visibility: &syn::Visibility,
    fields: &[Ident],
    has_defaults: bool,
) -> TokenStream {
    let default = has_defaults.then(|| quote!(, ::core::default::Default));
    let implementation = wrap(
        name,
        &quote! {
            #[automatically_derived]
            impl __system::System for #name {
                fn facts(&self) -> &__system::SystemFacts { __emitted::refused() }
                fn values(&self, _: &mut [f64]) {}
                fn coefficients(&self, _: &[f64], _: f64, _: &mut [f64]) {}
                fn coefficients_by(&self, _: __system::Variable, _: &[f64], _: f64, _: &mut [f64]) {}
                fn law(&self, _: usize) -> &dyn __law::Law { __emitted::refused() }
            }
        },
    );
    quote! {
        #[allow(missing_docs)]
        #[derive(::core::fmt::Debug, ::core::clone::Clone, ::core::cmp::PartialEq #default)]
        #visibility struct #name { #(pub #fields: ::core::primitive::f64),* }
        #implementation
    }
}
