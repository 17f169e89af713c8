//! One method, and another one where the first finds nothing.

use super::sealed::Follow;
use crate::balance::Parity;
use crate::balance_branch::check::Asked;
use crate::balance_branch::options::HarmonicBalance;
use crate::branches::request::Request;
use crate::error::Error;

/// Whether orbits may lose a symmetry on a branch unseen: the contact equation and shooting see that by multipliers alone, and the
/// balance by its equations.
pub(super) fn may_break(request: &Request, balance: &HarmonicBalance) -> bool {
    let asked = Asked::of(request, balance);
    !request.stability
        && asked.check().is_ok_and(|(context, _)| {
            let resolution = context.resolution;
            resolution.parity == Parity::Odd || resolution.stride > 1
        })
}

/// What the first method finds, or else the balance; the other way round where something would stay unseen.
///
/// # Errors
/// Those of the balance, or of a request that was cancelled.
pub(super) fn first_found<T>(
    first: &dyn Follow,
    balance: &HarmonicBalance,
    request: &Request,
    unseen: bool,
    mut find: impl FnMut(&dyn Follow) -> Result<T, Error>,
) -> Result<T, Error> {
    let mut methods: [&dyn Follow; 2] = [first, balance];
    if unseen {
        methods.reverse();
    }
    let found = find(methods[0]);
    if found.is_ok() || request.cancel.is_cancelled() {
        return found;
    }
    let other = find(methods[1]);
    // The balance says why there is none.
    if unseen { other.or(found) } else { other }
}
