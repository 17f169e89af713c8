//! The kernels of one sample: each piece, and all pieces by selection.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::code::{Code, base, position};
use super::law::Emitter;
use super::raising::Raising;
use crate::dag::{Dag, Id, Variable};
use crate::tape::powers::Plan;
use crate::tape::{Style, Tape};

/// A kernel as code.
pub struct Kernel {
    /// Its type.
    pub item: TokenStream,
    /// How a batch is run with it.
    pub run: TokenStream,
}

impl Emitter<'_> {
    /// The kernel of a piece.
    pub(super) fn piece(&self, dag: &mut Dag, kernels: &Ident, index: usize) -> Kernel {
        let roots = &self.pieces[index];
        if self.is_zero(roots) {
            return Kernel {
                item: TokenStream::new(),
                run: quote!(batch.run(__emitted::Nothing)),
            };
        }
        let name = format_ident!("{kernels}Piece{index}");
        let plan = Plan::of(dag, roots);
        let code = self.code(dag, roots, &plan);
        let body = self.straight(&code);
        if plan.is_empty() {
            return self.plain(&name, &body);
        }
        let bases = self.code(dag, &plan.bases, &Plan::default());
        let uses: Vec<_> = roots.iter().map(|&root| plan.uses(dag, &[root])).collect();
        let bodies = [self.straight(&bases), body];
        self.raising(dag, &name, &plan, &code, bodies, &uses)
    }

    /// Every piece is computed, and one is selected by comparison: no branch. Nothing, if there is one piece only.
    pub(super) fn all_pieces(&self, dag: &mut Dag, kernels: &Ident) -> Option<Kernel> {
        let shared = self.shared.as_ref();
        let pieces = shared.map_or(&self.pieces, |shared| &shared.pieces);
        if pieces.len() < 2 {
            return None;
        }
        let name = format_ident!("{kernels}AllPieces");
        let roots = pieces.concat();
        let plan = Plan::of(dag, &roots);
        let code = self.code(dag, &roots, &plan);
        let body = self.chosen(dag, &code, &self.selected(pieces, &code));
        let levels = bind_levels(kernels);
        let body = quote!(#levels #body);
        if plan.is_empty() {
            return Some(self.plain(&name, &body));
        }
        let bases = self.code(dag, &plan.bases, &Plan::default());
        let chosen = |input: &Variable| matches!(input, Variable::Base(_));
        let levels = bases.inputs.iter().any(chosen).then_some(levels);
        let roots = &bases.roots;
        let bases = self.chosen(dag, &bases, &quote!([#(#roots),*]));
        let uses: Vec<_> = (0..pieces[0].len())
            .map(|value| pieces.iter().map(|piece| piece[value]).collect::<Vec<Id>>())
            .map(|values| plan.uses(dag, &values))
            .collect();
        let bodies = [quote!(#levels #bases), body];
        Some(self.raising(dag, &name, &plan, &code, bodies, &uses))
    }

    fn is_zero(&self, values: &[Id]) -> bool {
        values.iter().all(|&value| value == self.zero)
    }

    /// A kernel without powers, from the code of its values.
    fn plain(&self, name: &Ident, body: &TokenStream) -> Kernel {
        let [arguments, _, values] = self.sizes();
        Kernel {
            item: quote! {
                struct #name;

                impl __emitted::Kernel<#arguments, #values> for #name {
                    #[inline(always)]
                    fn values(a: [f64; #arguments], g: f64, r: f64) -> [f64; #values] { #body }
                }
            },
            run: quote!(batch.run(#name)),
        }
    }

    /// A kernel with powers, from the code of its bases and of its values.
    fn raising(
        &self,
        dag: &mut Dag,
        name: &Ident,
        plan: &Plan,
        code: &Code,
        [bases, values]: [TokenStream; 2],
        uses: &[[Vec<usize>; 2]],
    ) -> Kernel {
        let exponents = self.code(dag, &plan.exponents, &Plan::default());
        let bound = self.bind(&exponents.inputs);
        let (statements, roots) = (&exponents.statements, &exponents.roots);
        let raising = Raising {
            name,
            plan,
            bases,
            exponents: quote!(#bound #statements [#(#roots),*]),
            values,
            code,
            uses,
        };
        Kernel {
            item: raising.emit(&position(self.count())),
            run: quote!(batch.raise(#name)),
        }
    }

    /// The body of a function that is code and nothing else.
    fn straight(&self, code: &Code) -> TokenStream {
        let arguments = self.bind(&code.inputs);
        let (statements, values) = (&code.statements, &code.roots);
        quote!(#arguments #statements [#(#values),*])
    }

    /// The body of a function of all pieces, before which arguments and the bases of several pieces are made out.
    fn chosen(&self, dag: &mut Dag, code: &Code, body: &TokenStream) -> TokenStream {
        let mut inputs = code.inputs.clone();
        let mut bases = TokenStream::new();
        for (index, of) in self
            .shared
            .iter()
            .flat_map(|shared| shared.bases.iter().enumerate())
        {
            if !code.inputs.contains(&Variable::Base(index)) {
                continue;
            }
            let ids: Vec<Id> = of.values().copied().collect();
            let of_bases = self.code(dag, &ids, &Plan::default());
            inputs.extend(&of_bases.inputs);
            let (name, statements) = (base(index), &of_bases.statements);
            let mut values = of.keys().zip(&of_bases.roots);
            let first = values.next().map(|(_, value)| value);
            let above = values.map(|(&piece, value)| {
                let condition = self.is_above(piece - 1);
                quote!(__emitted::choose(&mut base, #condition, #value);)
            });
            bases.extend(quote! {
                let #name = {
                    #statements
                    let mut base = #first;
                    #(#above)*
                    base
                };
            });
        }
        let (bound, statements) = (self.bind(&inputs), &code.statements);
        quote!(#bound #bases #statements #body)
    }

    /// The arguments, taken apart.
    fn bind(&self, used: &[Variable]) -> TokenStream {
        let any = used
            .iter()
            .any(|input| matches!(input, Variable::Argument(_)));
        let pattern = self.pattern_of(used);
        if any {
            quote!(let #pattern = a;)
        } else {
            TokenStream::new()
        }
    }

    /// The values of the piece that a sample lies on.
    fn selected(&self, pieces: &[Vec<Id>], code: &Code) -> TokenStream {
        let count = position(pieces[0].len());
        let values = pieces.iter().zip(code.roots.chunks(pieces[0].len()));
        let mut values = values.map(|(ids, values)| {
            if self.is_zero(ids) {
                quote!([0.0; #count])
            } else {
                quote!([#(#values),*])
            }
        });
        let first = values.next();
        let selections = values.enumerate().map(|(level, value)| {
            let condition = self.is_above(level);
            quote!(__emitted::select(&mut v, #condition, #value);)
        });
        quote! {
            let mut v = #first;
            #(#selections)*
            v
        }
    }

    /// Whether a sample lies above a level.
    fn is_above(&self, level: usize) -> TokenStream {
        let belongs_above = self.member.law.levels[level].belongs_above;
        let sign = if belongs_above { quote!(>=) } else { quote!(>) };
        let level = position(level);
        quote!(g #sign level[#level])
    }

    /// The code of expressions, after what is planned.
    pub(super) fn code(&self, dag: &mut Dag, roots: &[Id], plan: &Plan) -> Code {
        let tape = Tape::with(dag, roots, Style::Code, plan);
        Code::of(&tape, &|variable| self.name(variable))
    }

    /// The pattern that takes the arguments apart.
    pub(super) fn pattern(&self, code: &Code) -> TokenStream {
        self.pattern_of(&code.inputs)
    }

    fn pattern_of(&self, used: &[Variable]) -> TokenStream {
        let names = self.arguments.iter().enumerate().map(|(index, name)| {
            if used.contains(&Variable::Argument(index)) {
                quote!(#name)
            } else {
                quote!(_)
            }
        });
        quote!([#(#names),*])
    }
}

/// The levels, by the type that has them.
fn bind_levels(kernels: &Ident) -> TokenStream {
    quote!(let level = <#kernels as __emitted::Kernels<_, _, _>>::levels(a);)
}
