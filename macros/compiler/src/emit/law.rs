//! One law: kernels on a type of its own, and a constant that makes a `hertzian::law::Law` of them.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::code::{base, position};
use super::data;
use super::names::{imported, locals};
use super::shared::{Shared, share_bases};
use crate::dag::{Dag, Id, Variable};
use crate::facts::Piece;
use crate::interpret::{Family, Member};
use crate::ir::Law;

/// A law being written.
pub(super) struct Emitter<'a> {
    pub(super) member: &'a Member,
    /// The values of every piece: force, by gap, by rate, by each argument; of a law that is linear in its rate then the
    /// primitive, and its derivatives by each argument.
    pub(super) pieces: Vec<Vec<Id>>,
    /// The same as they are computed together, where that differs from one by one.
    pub(super) shared: Option<Shared>,
    /// The number zero.
    pub(super) zero: Id,
    /// Identifiers of the arguments.
    pub(super) arguments: Vec<Ident>,
}

/// A law and, where it is linear in its rate, its parts: they are other views of its kernels.
pub fn family(dag: &mut Dag, law: &Law, index: usize) -> TokenStream {
    let family = Family::of(dag, law);
    let (kernels, whole) = (
        format_ident!("__Law{index}"),
        format_ident!("__LAW_{index}"),
    );
    let emitter = Emitter::of(dag, &family);
    let [arguments, levels, values] = emitter.sizes();
    let functions = emitter.kernels(dag, &kernels);
    let nodes = data::nodes(&family.nodes, &family.whole);
    let mut of_whole = data::description(&family.whole);
    let mut of_parts = TokenStream::new();
    if let Some([spring, primitive]) = &family.parts {
        let (spring, primitive) = (data::description(spring), data::description(primitive));
        of_parts.extend(quote! {
            static SPRING: __emitted::Generated<__emitted::Spring<#kernels>, #arguments, #levels, #values> = { #spring };
            static PRIMITIVE: __emitted::Generated<__emitted::Primitive<#kernels>, #arguments, #levels, #values> =
                { #primitive };
        });
        of_whole.extend(quote!(.with_parts(&SPRING, &PRIMITIVE)));
    }
    let names = imported(&quote!(#nodes #of_parts #of_whole));
    quote! {
        #functions

        static #whole: __emitted::Generated<#kernels, #arguments, #levels, #values> = {
            #names
            #nodes
            #of_parts
            #of_whole
        };
    }
}

impl<'a> Emitter<'a> {
    fn of(dag: &mut Dag, family: &'a Family) -> Self {
        let member = &family.whole;
        let mut pieces: Vec<Vec<Id>> = member.pieces.iter().map(Piece::outputs).collect();
        if let Some([_, primitive]) = &family.parts {
            for (values, piece) in pieces.iter_mut().zip(&primitive.pieces) {
                values.push(piece.force);
                values.extend(&piece.by_argument);
            }
        }
        Self {
            member,
            shared: share_bases(dag, &pieces),
            pieces,
            zero: dag.integer(0),
            arguments: locals(
                &member.law.arguments,
                &["g", "r", "level", "v", "l", "p", "base"],
            ),
        }
    }

    pub(super) fn count(&self) -> usize {
        self.arguments.len()
    }

    /// Counts of arguments, levels and values of a kernel.
    pub(super) fn sizes(&self) -> [Literal; 3] {
        [self.count(), self.member.levels.len(), self.pieces[0].len()].map(position)
    }

    pub(super) fn name(&self, variable: Variable) -> Ident {
        match variable {
            Variable::Gap => format_ident!("g"),
            Variable::Rate => format_ident!("r"),
            Variable::Base(index) => base(index),
            Variable::Argument(index) => self.arguments[index].clone(),
            other => unreachable!("a law depends on gap, rate and arguments, not on {other:?}"),
        }
    }
}
