//! A law that stands alone: a type without fields.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::{document, law, wrap_items};
use crate::ir::{Law, Model};

/// Writes a law as Rust code; `model` has its name, its visibility, its documentation and its graph.
pub fn law_alone(runtime: &TokenStream, model: &Model, law: &Law) -> TokenStream {
    let documentation = document::of_law_alone(&model.documentation, &model.dag, law);
    let implementation = law::family(&mut model.dag.clone(), law, 0);
    let declared = declared(&model.name, &quote!(&__LAW_0));
    let implementation = wrap_items(runtime, &quote!(#implementation #declared));
    let structure = structure(&model.name, &model.visibility, &documentation);
    quote!(#structure #implementation)
}

/// What stands in for a law that did not compile.
pub fn law_stub(runtime: &TokenStream, name: &Ident, visibility: &syn::Visibility) -> TokenStream {
    let structure = structure(name, visibility, "A law that was refused.");
    let declared = wrap_items(runtime, &declared(name, &quote!(__emitted::refused())));
    quote!(#structure #declared)
}

fn structure(name: &Ident, visibility: &syn::Visibility, documentation: &str) -> TokenStream {
    quote! {
        #[doc = #documentation]
        #[derive(
            ::core::fmt::Debug, ::core::clone::Clone, ::core::marker::Copy, ::core::default::Default,
            ::core::cmp::PartialEq, ::core::cmp::Eq,
        )]
        #visibility struct #name;
    }
}

fn declared(name: &Ident, law: &TokenStream) -> TokenStream {
    quote! {
        impl __emitted::Declared for #name {
            fn declared(&self) -> &'static dyn __law::Law { #law }
        }
    }
}
