//! Rules on terms of an equation: where they stand, and how they depend on time.

use crate::dag::Variable;
use crate::lower::term::{Motion, Term};

/// What depends on the motion stands left of the equals sign.
pub fn term_is_in_its_place(term: &Term, on_right: bool) -> syn::Result<()> {
    if on_right && term.moves() {
        return Err(term.extent.fault(
            "this term depends on the motion: bring it to the left of `=`, with the other sign; the right side holds forcing and loads",
        ));
    }
    Ok(())
}

/// Time enters by harmonics of `omega*t` alone.
pub fn term_is_harmonic(term: &Term) -> syn::Result<()> {
    if term.time > 0 {
        return Err(term.extent.fault(
            "not harmonic in omega*t: this term grows with time; write `t` only inside cos and sin, as in `cos(omega*t)`",
        ));
    }
    Ok(())
}

/// Mass does not depend on time.
pub fn mass_is_constant(term: &Term) -> syn::Result<()> {
    if matches!(term.motion, Motion::Linear(Variable::Acceleration(_))) && !term.is_steady() {
        return Err(term.extent.fault("a mass that varies with time is not supported: divide the equation by it, if it is common to all terms"));
    }
    Ok(())
}
