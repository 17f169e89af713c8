//! What stands in for a model that did not compile, so that one mistake gives one message.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::wrap;

/// The type with its fields, defaults and an implementation that is never run: the declaration has already been refused.
pub fn stub(
    runtime: &TokenStream,
    name: &Ident,
    visibility: &syn::Visibility,
    fields: &[Ident],
) -> TokenStream {
    let implementation = wrap(
        runtime,
        name,
        &quote! {
            #[automatically_derived]
            impl __system::System for #name {
                fn facts(&self) -> &__system::SystemFacts { __emitted::refused() }
                fn values(&self, _: &mut [f64]) {}
                fn coefficients(&self, _: &[f64], _: f64, _: &mut [f64]) {}
                fn coefficients_by(&self, _: __system::Variable, _: &[f64], _: f64, _: &mut [f64]) {}
                fn law(&self, _: usize) -> &dyn __law::Law { __emitted::refused() }
                fn shared(&self) -> __Arc<dyn __system::System> { __emitted::refused() }
            }
        },
    );
    quote! {
        #[allow(missing_docs)]
        #[derive(::core::fmt::Debug, ::core::clone::Clone, ::core::cmp::PartialEq, ::core::default::Default)]
        #visibility struct #name { #(pub #fields: ::core::primitive::f64),* }
        #implementation
    }
}
