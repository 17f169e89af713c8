//! The system: an implementation of `hertzian::system::System`.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::code::{Code, number, position};
use super::data::{list, text};
use super::names::locals;
use super::tape::{Style, Tape};
use crate::dag::{Id, Variable};
use crate::differentiate::differentiate;
use crate::ir::{Bound, Model, Place, Wave};

/// The implementation for a model whose laws have the given types.
pub fn system(model: &mut Model, laws: &[Ident]) -> TokenStream {
    let name = model.name.clone();
    let facts = facts(model);
    let fields: Vec<&Ident> = model
        .parameters
        .iter()
        .map(|parameter| &parameter.name)
        .collect();
    let values = quote!(values.copy_from_slice(&[#(self.#fields),*]););
    let roots: Vec<Id> = model.coefficients.iter().map(|&(_, id)| id).collect();
    let coefficients = coefficients(model, &roots, &quote!(coefficients));
    let coefficients_by = coefficients_by(model, &roots);
    let indices = (0..laws.len()).map(position);
    quote! {
        #[automatically_derived]
        impl __system::System for #name {
            fn facts(&self) -> &__system::SystemFacts {
                static FACTS: __system::SystemFacts = #facts;
                &FACTS
            }

            fn values(&self, values: &mut [f64]) { #values }

            fn coefficients(&self, parameters: &[f64], omega: f64, coefficients: &mut [f64]) { #coefficients }

            fn coefficients_by(
                &self,
                variable: __system::Variable,
                parameters: &[f64],
                omega: f64,
                derivatives: &mut [f64],
            ) {
                #coefficients_by
            }

            fn law(&self, index: usize) -> &dyn __law::Law {
                match index {
                    #(#indices => &#laws,)*
                    _ => __emitted::no_such_law(index),
                }
            }
        }
    }
}

/// Straight-line code that writes expressions in parameters and frequency.
fn coefficients(model: &mut Model, roots: &[Id], into: &TokenStream) -> TokenStream {
    let zero = model.dag.integer(0);
    if roots.iter().all(|&root| root == zero) {
        return quote!(#into.fill(0.0););
    }
    let tape = Tape::of(&mut model.dag, roots, Style::Code);
    let names: Vec<String> = model
        .parameters
        .iter()
        .map(|p| p.name.to_string())
        .collect();
    let reserved = [
        "omega",
        "parameters",
        "coefficients",
        "derivatives",
        "variable",
        "self",
    ];
    let names = locals(&names, &reserved);
    let code = Code::of(&tape, &|variable| match variable {
        Variable::Omega => format_ident!("omega"),
        Variable::Parameter(index) => names[index].clone(),
        other => unreachable!("a coefficient depends on parameters and omega, not on {other:?}"),
    });
    let used = |index| code.inputs.contains(&Variable::Parameter(index));
    let pattern = names.iter().enumerate().map(|(index, name)| {
        if used(index) {
            quote!(#name)
        } else {
            quote!(_)
        }
    });
    let count = names.len();
    let length = position(count);
    let bind = (0..count)
        .any(used)
        .then(|| quote!(let [#(#pattern),*]: [f64; #length] = __emitted::arguments(parameters);));
    let (statements, values) = (&code.statements, &code.roots);
    quote! {
        #bind
        #statements
        #into.copy_from_slice(&[#(#values),*]);
    }
}

fn coefficients_by(model: &mut Model, roots: &[Id]) -> TokenStream {
    let by_omega = derivatives_by(model, roots, Variable::Omega);
    let by_parameters: Vec<TokenStream> = (0..model.parameters.len())
        .map(|index| {
            let body = derivatives_by(model, roots, Variable::Parameter(index));
            let index = position(index);
            quote!(__system::Variable::Parameter(#index) => { #body })
        })
        .collect();
    quote! {
        match variable {
            __system::Variable::Omega => { #by_omega }
            #(#by_parameters)*
            __system::Variable::Parameter(index) => __emitted::no_such_parameter(index),
        }
    }
}

fn derivatives_by(model: &mut Model, roots: &[Id], by: Variable) -> TokenStream {
    let derivatives: Vec<Id> = roots
        .iter()
        .map(|&root| differentiate(&mut model.dag, root, by))
        .collect();
    coefficients(model, &derivatives, &quote!(derivatives))
}

fn facts(model: &Model) -> TokenStream {
    let name = text(&model.name.to_string());
    let equation = text(&model.equation);
    let coordinates = list(model.coordinates.iter().map(|name| text(&name.to_string())));
    let parameters = list(model.parameters.iter().map(|parameter| {
        let name = text(&parameter.name.to_string());
        let documentation = text(&parameter.documentation);
        let [minimum, maximum] = [parameter.minimum, parameter.maximum].map(bound);
        quote! {
            __system::ParameterFacts {
                name: #name, documentation: #documentation, minimum: #minimum, maximum: #maximum,
            }
        }
    }));
    let divisor = Literal::u32_unsuffixed(model.divisor);
    let laws = position(model.laws.len());
    let contacts = list(model.contacts.iter().map(|contact| {
        let law = position(contact.law);
        quote!(__system::ContactFacts { law: #law })
    }));
    let places = list(model.coefficients.iter().map(|&(at, _)| place(at)));
    quote! {
        __system::SystemFacts {
            name: #name,
            equation: #equation,
            coordinates: #coordinates,
            parameters: #parameters,
            divisor: #divisor,
            laws: #laws,
            contacts: #contacts,
            places: #places,
        }
    }
}

fn bound(bound: Bound) -> TokenStream {
    match bound {
        Bound::Unbounded => quote!(__system::Bound::Unbounded),
        Bound::Included(value) => {
            let value = number(value);
            quote!(__system::Bound::Included(#value))
        }
        Bound::Excluded(value) => {
            let value = number(value);
            quote!(__system::Bound::Excluded(#value))
        }
    }
}

fn place(place: Place) -> TokenStream {
    let field = |name: &str, value: usize| {
        let (name, value) = (format_ident!("{name}"), position(value));
        quote!(#name: #value,)
    };
    let phase = |phase: Wave| {
        let wave = wave(phase);
        quote!(wave: #wave)
    };
    let (name, first, second, wave) = match place {
        Place::Mass { row, column } => ("Mass", field("row", row), field("column", column), None),
        Place::Damping { row, column } => {
            ("Damping", field("row", row), field("column", column), None)
        }
        Place::Stiffness { row, column, wave } => (
            "Stiffness",
            field("row", row),
            field("column", column),
            Some(wave),
        ),
        Place::Load { row, wave } => ("Load", field("row", row), quote!(), Some(wave)),
        Place::ForceDirection { contact, row, wave } => (
            "ForceDirection",
            field("contact", contact),
            field("row", row),
            Some(wave),
        ),
        Place::GapDirection {
            contact,
            column,
            wave,
        } => (
            "GapDirection",
            field("contact", contact),
            field("column", column),
            Some(wave),
        ),
        Place::Offset { contact, wave } => {
            ("Offset", field("contact", contact), quote!(), Some(wave))
        }
        Place::Argument { contact, index } => (
            "Argument",
            field("contact", contact),
            field("index", index),
            None,
        ),
    };
    let name = format_ident!("{name}");
    let wave = wave.map(phase);
    quote!(__system::Place::#name { #first #second #wave })
}

fn wave(wave: Wave) -> TokenStream {
    if wave.harmonic == 0 {
        return quote!(__system::Wave::CONSTANT);
    }
    let harmonic = Literal::u32_unsuffixed(wave.harmonic);
    let part = if wave.sine {
        quote!(Sine)
    } else {
        quote!(Cosine)
    };
    quote!(__system::Wave { harmonic: #harmonic, part: __system::Part::#part })
}
