//! Rules on what outputs are made of.

use crate::ast::Output;
use crate::errors::Extent;
use crate::lower::term::{Motion, Term};

/// An output is a sum of coordinates, their derivatives and forces of laws, with coefficients that do not move.
pub fn output_is_linear(term: &Term) -> syn::Result<()> {
    if matches!(term.motion, Motion::Nonlinear(_)) {
        return Err(term.extent.fault(
            "an output is linear in coordinates, `dot` and `ddot` of them, and forces of laws: declare what is not as a law that acts in an equation, and read `force` of it",
        ));
    }
    Ok(())
}

/// An output holds something of the motion.
pub fn output_moves(output: &Output, terms: &[Term]) -> syn::Result<()> {
    if terms.iter().any(Term::moves) {
        return Ok(());
    }
    Err(output.value.extent.fault(
        "this output holds neither a coordinate nor a force: it is the same whatever the motion is",
    ))
}

/// An output has the period of the equations.
pub fn output_has_the_period(whole: bool, extent: Extent) -> syn::Result<()> {
    if whole {
        return Ok(());
    }
    Err(extent.fault(
        "this takes longer to repeat than the equations do: use whole multiples of the frequencies that are in them",
    ))
}

/// A law that is called in an output acts at that gap in an equation.
pub fn call_is_in_the_equations<T>(contact: Option<T>, extent: Extent) -> syn::Result<T> {
    contact.ok_or_else(|| {
        extent.fault(
            "the law acts at this gap in no equation: call it as it is called there, or name it by `let` for both",
        )
    })
}

/// `force(law)` is that of the one contact of the law.
pub fn force_is_of_one_contact(law: &str, contacts: usize, extent: Extent) -> syn::Result<()> {
    if contacts == 1 {
        return Ok(());
    }
    Err(extent.fault(format!(
        "law `{law}` acts in {contacts} contacts: call it as in the equation, with the gap of the one that is meant"
    )))
}
