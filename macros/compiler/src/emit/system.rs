//! The system: an implementation of `hertzian::system::System`.

use hertzian_contract::system::{ParameterFacts, Part, Place, Signal, Wave};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::code::{Code, position};
use super::data::{bound, list, text};
use super::names::{imported, locals};
use crate::dag::{Id, Variable};
use crate::differentiate::differentiate;
use crate::ir::Model;
use crate::tape::{Style, Tape};

/// The implementation for a model.
pub fn system(model: &mut Model) -> TokenStream {
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
    let indices = (0..model.laws.len()).map(position);
    let laws = (0..model.laws.len()).map(|index| format_ident!("__LAW_{index}"));
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

            fn shared(&self) -> __Arc<dyn __system::System> {
                __Arc::new(::core::clone::Clone::clone(self))
            }
        }
    }
}

/// Code that writes expressions in parameters and frequency.
fn coefficients(model: &mut Model, roots: &[Id], into: &TokenStream) -> TokenStream {
    let zero = model.dag.integer(0);
    if roots.iter().all(|&root| root == zero) {
        return quote!(#into.fill(0.0));
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
    let write = quote!(#into.copy_from_slice(&[#(#values),*]));
    quote!(#bind #statements #write)
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
    let facts = model.facts();
    let (name, equation) = (&facts.name, &facts.equation);
    let coordinates = list(facts.coordinates.iter().map(|name| text(name)));
    let parameters = list(facts.parameters.iter().map(parameter));
    let divisor = Literal::u32_unsuffixed(facts.divisor);
    let laws = position(facts.laws);
    let contacts = list(facts.contacts.iter().map(|contact| {
        let law = position(contact.law);
        match &*contact.unit {
            "" => quote!(contact(#law)),
            unit => quote!(contact_in(#law, #unit)),
        }
    }));
    let places = list(facts.places.iter().copied().map(place));
    let units = list(facts.units.iter().map(|unit| text(unit)));
    let outputs = list(facts.outputs.iter().map(|output| {
        let (name, documentation, unit) = (&output.name, &output.documentation, &output.unit);
        quote!(output(#name, #documentation, #unit))
    }));
    let facts = if facts.units.is_empty() && facts.outputs.is_empty() {
        quote! {
            system_facts(#name, #equation, #coordinates, PARAMETERS, #divisor, #laws, CONTACTS, #places)
        }
    } else {
        quote! {
            measured_system(
                #name, #equation, #coordinates, #units, PARAMETERS, #divisor, #laws, CONTACTS, #places,
                { const OUTPUTS: &[__system::OutputFacts] = #outputs; OUTPUTS }
            )
        }
    };
    let names = imported(&quote!(#parameters #contacts #facts));
    quote! {
        {
            #names
            const PARAMETERS: &[__system::ParameterFacts] = #parameters;
            const CONTACTS: &[__system::ContactFacts] = #contacts;
            #facts
        }
    }
}

/// A parameter, and its unit if it has one.
fn parameter(parameter: &ParameterFacts) -> TokenStream {
    let ParameterFacts {
        name,
        documentation,
        unit,
        ..
    } = parameter;
    let [minimum, maximum] = [parameter.minimum, parameter.maximum].map(bound);
    if unit.is_empty() {
        quote!(parameter(#name, #documentation, #minimum, #maximum))
    } else {
        quote!(parameter_in(#name, #documentation, #unit, #minimum, #maximum))
    }
}

/// A coefficient of an output.
fn output_term(output: usize, of: Signal, at: Wave) -> TokenStream {
    let (name, index) = match of {
        Signal::Coordinate(index) => ("Coordinate", Some(index)),
        Signal::Rate(index) => ("Rate", Some(index)),
        Signal::Acceleration(index) => ("Acceleration", Some(index)),
        Signal::Force(index) => ("Force", Some(index)),
        _ => ("Constant", None),
    };
    let (name, output, at) = (format_ident!("{name}"), position(output), wave(at));
    let index = index.map(position).map(|index| quote!((#index)));
    quote!(output_term(#output, Signal::#name #index, #at))
}

fn place(place: Place) -> TokenStream {
    if let Place::Output { output, of, wave } = place {
        return output_term(output, of, wave);
    }
    let (name, positions, phase) = match place {
        Place::Mass { row, column } => ("mass", vec![row, column], None),
        Place::Damping { row, column } => ("damping", vec![row, column], None),
        Place::Stiffness { row, column, wave } => ("stiffness", vec![row, column], Some(wave)),
        Place::Load { row, wave } => ("load", vec![row], Some(wave)),
        Place::ForceDirection { contact, row, wave } => {
            ("force_direction", vec![contact, row], Some(wave))
        }
        Place::GapDirection {
            contact,
            column,
            wave,
        } => ("gap_direction", vec![contact, column], Some(wave)),
        Place::Offset { contact, wave } => ("offset", vec![contact], Some(wave)),
        Place::Argument { contact, index } => ("argument", vec![contact, index], None),
        other => unreachable!("lowering makes no {other:?}"),
    };
    let name = format_ident!("{name}");
    let operands = positions
        .into_iter()
        .map(|at| {
            let at = position(at);
            quote!(#at)
        })
        .chain(phase.map(wave));
    quote!(#name(#(#operands),*))
}

fn wave(wave: Wave) -> TokenStream {
    let harmonic = Literal::u32_unsuffixed(wave.harmonic);
    match (wave.harmonic, wave.part) {
        (0, _) => quote!(CONSTANT),
        (_, Part::Cosine) => quote!(cos(#harmonic)),
        (_, Part::Sine) => quote!(sin(#harmonic)),
    }
}
