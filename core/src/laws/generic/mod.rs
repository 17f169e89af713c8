//! The same laws, interpreted: the oracle of the generated code, and what it is benchmarked against.
//!
//! A law is a list of nodes in which every operand comes before its use, and, for each piece, the nodes that are its
//! force and its derivatives. The data come from the same front end as the generated code, so the two cannot drift.

mod consistent;
mod law;
pub(crate) mod narrow;
mod program;
pub(crate) mod scales;
#[cfg(test)]
mod tests;
#[cfg(feature = "text")]
mod text;

use std::sync::Arc;

use crate::law::Law;
use crate::model::valued::with_laws;
use crate::system::System;

#[doc(hidden)]
pub use consistent::DataError;
#[doc(hidden)]
pub use hertzian_contract::data::{LawData, LevelData, Node, PieceData};
#[doc(hidden)]
pub use law::InterpretedLaw;
#[cfg(feature = "text")]
pub use text::{Declaration, DeclarationError, Fault, law_from_text};

/// The same system at the values that its parameters have now, its laws interpreted; everything else is the system's own, and so is a law
/// that has no [data](crate::law::Law::data), or data that do not describe it.
///
/// It computes what the system computes, from the same declaration, without the generated kernels.
pub fn interpreted(system: &dyn System) -> Arc<dyn System> {
    let laws = (0..system.facts().laws).map(|index| {
        let law = InterpretedLaw::of(system.law(index))?;
        Some(Box::new(law) as Box<dyn Law>)
    });
    with_laws(system, laws.collect())
}
