//! Loops, written out; and elements of arrays.

use crate::ast::{Expr, Loop};
use crate::dag::Variable;
use crate::errors::Extent;

use super::expand::{Expander, Meaning};
use super::term::{Motion, Term, collect};

impl Expander {
    /// Runs `body` for every index of a loop, with its names set.
    ///
    /// # Errors
    /// The first fault of a `let` or of `body`.
    pub fn repeat<T>(
        &mut self,
        repeated: &Loop<T>,
        mut body: impl FnMut(&mut Self) -> syn::Result<()>,
    ) -> syn::Result<()> {
        let place = Extent::at(repeated.index.span());
        for index in self.constants.range(repeated)? {
            self.constants.set(repeated, index);
            let value = self.dag.number(crate::dag::Rational::integer(index));
            let meaning = Meaning::Value(vec![Term::constant(value, place)]);
            self.names.insert(repeated.index.to_string(), meaning);
            for item in &repeated.lets {
                let terms = self.expand(&item.value)?;
                self.names
                    .insert(item.name.to_string(), Meaning::Value(terms));
                self.constants.name(item);
            }
            body(self)?;
        }
        self.constants.leave(repeated);
        self.names.remove(&repeated.index.to_string());
        for item in &repeated.lets {
            self.names.remove(&item.name.to_string());
        }
        Ok(())
    }

    /// The sum over a loop.
    pub(super) fn sigma(&mut self, repeated: &Loop<Expr>) -> syn::Result<Vec<Term>> {
        let mut sum = Vec::new();
        self.repeat(repeated, |expander| {
            sum.extend(expander.expand(&repeated.body)?);
            Ok(())
        })?;
        Ok(collect(&mut self.dag, sum))
    }

    /// `x[index]`
    pub(super) fn element(
        &mut self,
        name: &str,
        index: &Expr,
        extent: Extent,
    ) -> syn::Result<Vec<Term>> {
        let Some(&Meaning::Array(first, count)) = self.names.get(name) else {
            return Err(extent.fault(format!("`{name}` has no elements")));
        };
        let position = self.constants.whole(index, "an index")?;
        let inside = usize::try_from(position)
            .ok()
            .filter(|&position| position < count);
        let Some(position) = inside else {
            return Err(extent.fault(format!(
                "there is no `{name}[{position}]`: `{name}` has the elements `{name}[0]` to `{name}[{}]`; shorten the range, or write the equations at the ends on their own",
                count - 1
            )));
        };
        let one = self.dag.integer(1);
        Ok(vec![Term {
            motion: Motion::Linear(Variable::Coordinate(first + position)),
            ..Term::constant(one, extent)
        }])
    }
}
