//! One law: a unit type that implements `hertzian::law::Law`.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::data;
use super::magnitude::share_magnitudes;
use super::names::locals;
use crate::dag::{Dag, Id, Variable};
use crate::differentiate::differentiate;
use crate::facts::{Piece, Variation, derive, variation};
use crate::ir::Law;
use crate::simplify::{expand, factor};

/// A law being written.
pub(super) struct Emitter<'a> {
    pub(super) law: &'a Law,
    pub(super) pieces: Vec<Piece>,
    /// The pieces as they are computed.
    pub(super) kernels: Vec<Piece>,
    /// How every output of every piece varies.
    pub(super) variations: Vec<Vec<Variation>>,
    /// Levels and their derivatives by each argument.
    pub(super) levels: Vec<(Id, Vec<Id>)>,
    /// Identifiers of the arguments.
    pub(super) arguments: Vec<Ident>,
}

/// The type of a law and its implementation; `parts` are the types of its spring and primitive.
pub fn law(dag: &mut Dag, law: &Law, name: &Ident, parts: Option<(&Ident, &Ident)>) -> TokenStream {
    let emitter = Emitter::of(dag, law);
    let facts = data::facts(law, &derive(dag, law, &emitter.pieces));
    let data = data::data(dag, &emitter.levels, &emitter.pieces);
    let functions = emitter.functions(dag);
    let (force, derivatives, derivatives_and_by) = (
        emitter.force(),
        emitter.derivatives(),
        emitter.derivatives_and_by(),
    );
    let (levels, levels_by) = (emitter.copy_levels(), emitter.levels_by(dag));
    let parts = data::option(parts.map(
        |(spring, primitive)| quote!(__law::Parts { spring: &#spring, primitive: &#primitive }),
    ));
    quote! {
        struct #name;

        impl #name { #functions }

        #[automatically_derived]
        impl __law::Law for #name {
            fn facts(&self) -> &__law::LawFacts {
                static FACTS: __law::LawFacts = #facts;
                &FACTS
            }

            fn data(&self) -> &__generic::LawData {
                static DATA: __generic::LawData = #data;
                &DATA
            }

            fn levels(&self, arguments: &[f64], levels: &mut [f64]) { #levels }

            fn levels_by(&self, arguments: &[f64], argument: usize, by_argument: &mut [f64]) { #levels_by }

            fn force(&self, on: __law::On, arguments: &[f64], gap: &[f64], rate: &[f64], force: &mut [f64]) {
                #force
            }

            fn derivatives(
                &self,
                on: __law::On,
                arguments: &[f64],
                gap: &[f64],
                rate: &[f64],
                out: __law::Derivatives<'_>,
            ) {
                #derivatives
            }

            fn derivatives_and_by(
                &self,
                argument: usize,
                on: __law::On,
                arguments: &[f64],
                gap: &[f64],
                rate: &[f64],
                out: __law::Derivatives<'_>,
                by_argument: &mut [f64],
            ) {
                #derivatives_and_by
            }

            fn parts(&self) -> ::core::option::Option<__law::Parts<'_>> { #parts }
        }
    }
}

impl<'a> Emitter<'a> {
    fn of(dag: &mut Dag, law: &'a Law) -> Self {
        let count = law.arguments.len();
        let mut pieces: Vec<Piece> = law
            .pieces
            .iter()
            .map(|&force| Piece::of(dag, force, count))
            .collect();
        let mut variations = Vec::new();
        for piece in &mut pieces {
            variations.push(simplify(dag, piece));
        }
        let kernels = share_magnitudes(dag, &pieces);
        let levels = law
            .levels
            .iter()
            .map(|level| {
                let by = |index| differentiate(dag, level.value, Variable::Argument(index));
                (level.value, (0..count).map(by).collect())
            })
            .collect();
        let arguments = locals(&law.arguments, &["g", "r", "level", "v"]);
        Self {
            law,
            pieces,
            kernels,
            variations,
            levels,
            arguments,
        }
    }

    pub(super) fn count(&self) -> usize {
        self.arguments.len()
    }

    pub(super) fn name(&self, variable: Variable) -> Ident {
        match variable {
            Variable::Gap => format_ident!("g"),
            Variable::Rate => format_ident!("r"),
            Variable::Argument(index) => self.arguments[index].clone(),
            other => unreachable!("a law depends on gap, rate and arguments, not on {other:?}"),
        }
    }
}

/// Puts every output of a piece into the form to be computed, and says how each varies.
fn simplify(dag: &mut Dag, piece: &mut Piece) -> Vec<Variation> {
    let mut variations = Vec::new();
    let outputs = [&mut piece.force, &mut piece.by_gap, &mut piece.by_rate];
    for output in outputs.into_iter().chain(piece.by_argument.iter_mut()) {
        let how = variation(dag, *output);
        // What does not vary is written without gap and rate, even where that takes multiplying out.
        *output = if how == Variation::Varying {
            *output
        } else {
            expand(dag, *output)
        };
        *output = factor(dag, *output);
        variations.push(how);
    }
    variations
}
