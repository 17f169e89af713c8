//! The stages in their order, from tokens to a checked model; what emits it is called by whoever wants code.

use proc_macro2::TokenStream;

use crate::ast::Form;
use crate::errors::{Diagnostics, Errors};
use crate::ir::Model;
use crate::{check, interpret, lower, parse};

/// Parses, checks and lowers.
///
/// # Errors
/// Everything that is wrong with the declaration.
pub fn read(tokens: TokenStream, form: Form) -> Result<Model, Errors> {
    let mut diagnostics = Diagnostics::default();
    let model = model(tokens, form, &mut diagnostics);
    diagnostics
        .finish()
        .and_then(|()| model.ok_or_else(Errors::internal))
}

/// Each stage runs only if the one before found nothing, so that no fault is reported twice.
fn model(tokens: TokenStream, form: Form, diagnostics: &mut Diagnostics) -> Option<Model> {
    let declaration = parse::parse(tokens, form, diagnostics)?;
    if !diagnostics.is_clean() {
        return None;
    }
    let units = check::check(&declaration, diagnostics);
    if !diagnostics.is_clean() {
        return None;
    }
    let model = lower::lower(&declaration, units, diagnostics)?;
    if !interpret::derivatives_fit(&model, lower::BUDGET) {
        diagnostics.only(lower::too_long(&declaration));
        return None;
    }
    Some(model)
}
