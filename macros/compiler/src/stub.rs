//! What is emitted after an error: a type that bears the right name, fields and traits, so that the code that uses it does not fail too.

use proc_macro2::TokenStream;
use quote::quote;

use crate::ast::Declaration;

/// The type without its meaning. It is never run: the errors beside it stop the compilation.
pub fn stub(declaration: &Declaration) -> TokenStream {
    let Declaration {
        visibility, name, ..
    } = declaration;
    let mut fields: Vec<&proc_macro2::Ident> = Vec::new();
    for parameter in &declaration.parameters {
        if !fields.contains(&&parameter.name) {
            fields.push(&parameter.name);
        }
    }
    quote! {
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[allow(missing_docs, dead_code, non_snake_case)]
        #visibility struct #name {
            #(pub #fields: f64,)*
        }

        impl ::hertzian::system::System for #name {
            fn facts(&self) -> &::hertzian::system::SystemFacts {
                ::core::unreachable!()
            }
            fn values(&self, _: &mut [f64]) {}
            fn coefficients(&self, _: &[f64], _: f64, _: &mut [f64]) {}
            fn coefficients_by(&self, _: ::hertzian::system::Variable, _: &[f64], _: f64, _: &mut [f64]) {}
            fn law(&self, _: usize) -> &dyn ::hertzian::law::Law {
                ::core::unreachable!()
            }
        }
    }
}
