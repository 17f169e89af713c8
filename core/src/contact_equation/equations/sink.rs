//! Where the derivatives of a pass go: nowhere; to a chain, with those of states by all unknowns that are no forces; or to equations with pairs,
//! where nothing is eliminated yet.
//!
//! Rows of derivatives begin with the states at the beginning in a chain, and without them where there are pairs. The parameter stands last.

use crate::continuation::arrow::links::PairLinks;
use crate::continuation::chain::Chain;

/// Where derivatives go.
#[derive(Debug)]
pub(in crate::contact_equation) enum Sink<'s> {
    Nowhere,
    Chain {
        chain: &'s mut Chain,
        /// Derivatives of what is not a force at a node, by what is none, when forces are eliminated.
        matrix: &'s mut [f64],
    },
    Pairs(&'s mut PairLinks),
}

impl Sink<'_> {
    /// Derivatives are asked for.
    pub(in crate::contact_equation) fn is_asked(&self) -> bool {
        !matches!(self, Self::Nowhere)
    }

    /// The first unknown that rows have, of so many states.
    pub(in crate::contact_equation) fn first(&self, order: usize) -> usize {
        match self {
            Self::Pairs(_) => order,
            Self::Nowhere | Self::Chain { .. } => 0,
        }
    }

    /// Everything of a link is zero, but that states go on as they are.
    pub(in crate::contact_equation) fn clear(&mut self, link: usize) {
        match self {
            Self::Nowhere => {}
            Self::Chain { chain, .. } => chain.link_mut(link).clear(),
            Self::Pairs(pairs) => pairs.link_mut(link).clear(),
        }
    }

    /// An equation of a link, to be written: by its own unknowns, by states and by all others.
    pub(in crate::contact_equation) fn equation_mut(
        &mut self,
        link: usize,
        row: usize,
    ) -> Option<[&mut [f64]; 3]> {
        match self {
            Self::Nowhere => None,
            Self::Chain { chain, .. } => Some(chain.link_mut(link).equation_mut(row)),
            Self::Pairs(pairs) => Some(pairs.link_mut(link).equation_mut(row)),
        }
    }

    /// A state behind a link, to be written: by the states before it that are in its block, and by the unknowns of the link.
    pub(in crate::contact_equation) fn state_mut(
        &mut self,
        link: usize,
        row: usize,
    ) -> Option<[&mut [f64]; 2]> {
        match self {
            Self::Nowhere => None,
            Self::Chain { chain, .. } => Some(chain.link_mut(link).state_mut(row)),
            Self::Pairs(pairs) => Some(pairs.link_mut(link).state_mut(row)),
        }
    }

    /// Adds a multiple of a linear form of the states behind a link to a row.
    pub(in crate::contact_equation) fn read(
        &mut self,
        row: usize,
        link: usize,
        factor: f64,
        form: &[f64],
    ) {
        match self {
            Self::Nowhere => {}
            Self::Chain { chain, .. } => chain.read(row, link, factor, form),
            Self::Pairs(pairs) => pairs.read(row - form.len(), link, factor, form),
        }
    }

    /// The rest of a row of an equation that is none of a link, of so many states and columns.
    pub(in crate::contact_equation) fn row_mut(
        &mut self,
        row: usize,
        [order, columns]: [usize; 2],
    ) -> &mut [f64] {
        match self {
            Self::Nowhere => &mut [],
            Self::Chain { matrix, .. } => &mut matrix[row * columns..][..columns],
            Self::Pairs(pairs) => pairs.direct_mut(row - order),
        }
    }
}
