//! Code generation: a checked model becomes a type that implements the runtime's contract.
//!
//! Everything but the type itself stands inside one anonymous constant, so that no name leaks into the user's module;
//! inside it, every path starts at a crate root or at an alias of one. The runtime is named
//! by the path that the caller gives, which is `$crate` in its macros: what the user calls the crate does not matter.

mod alone;
mod code;
mod data;
mod document;
mod kernel;
mod law;
mod names;
mod pieces;
mod raising;
mod shared;
mod stub;
mod system;

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use crate::ir::{Model, Parameter};

pub use alone::{law_alone, law_stub};
pub use stub::stub;

/// Writes a model as Rust code, which names the runtime by a path.
pub fn emit(runtime: &TokenStream, model: &Model) -> TokenStream {
    let mut model = model.clone();
    let laws: TokenStream = (0..model.laws.len())
        .map(|index| {
            let law = model.laws[index].clone();
            law::family(&mut model.dag, &law, index)
        })
        .collect();
    let system = system::system(&mut model);
    let structure = structure(&model);
    let defaults = defaults(&model);
    let implementation = wrap(runtime, &model.name, &quote!(#laws #system #defaults));
    quote!(#structure #implementation)
}

/// The type: one public field per parameter.
fn structure(model: &Model) -> TokenStream {
    let (visibility, name) = (&model.visibility, &model.name);
    let documentation = document::of_model(model);
    let fields = model.parameters.iter().map(
        |Parameter {
             name,
             documentation,
             unit,
             ..
         }| {
            let documentation = document::of_field(name, documentation, unit);
            quote!(#[doc = #documentation] pub #name: ::core::primitive::f64)
        },
    );
    quote! {
        #[doc = #documentation]
        #[derive(::core::fmt::Debug, ::core::clone::Clone, ::core::cmp::PartialEq)]
        #visibility struct #name { #(#fields),* }
    }
}

/// `Default`, where every parameter has one.
fn defaults(model: &Model) -> Option<TokenStream> {
    let name = &model.name;
    let values = model
        .parameters
        .iter()
        .map(|Parameter { name, default, .. }| {
            let value = code::number((*default)?);
            Some(quote!(#name: #value))
        });
    let values = values.collect::<Option<Vec<_>>>()?;
    (!values.is_empty()).then(|| {
        quote! {
            #[automatically_derived]
            impl ::core::default::Default for #name {
                fn default() -> Self { Self { #(#values),* } }
            }
        }
    })
}

/// Puts the implementations of a model into an anonymous constant.
fn wrap(runtime: &TokenStream, name: &Ident, items: &TokenStream) -> TokenStream {
    let items = quote! {
        impl #name {
            /// The same system, its laws interpreted from data: the oracle of the generated code.
            pub fn generic(&self) -> __Arc<dyn __system::System> {
                __generic::interpreted(self)
            }
        }

        #items
    };
    wrap_items(runtime, &items)
}

/// Puts items into an anonymous constant, with the aliases they use. The path of the runtime stands here and nowhere else.
fn wrap_items(runtime: &TokenStream, items: &TokenStream) -> TokenStream {
    quote! {
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, clippy::restriction)]
        #[allow(missing_docs, nonstandard_style, unused, unused_qualifications)]
        const _: () = {
            use ::core::primitive::{f64, usize};
            // One name, so that a crate which cannot be found is one error. A glob would report each of its names.
            use #runtime as __hertzian;
            use __hertzian::{emitted as __emitted, generic as __generic, law as __law, system as __system};
            use ::std::{borrow::Cow as __Cow, sync::Arc as __Arc};

            #items
        };
    }
}
