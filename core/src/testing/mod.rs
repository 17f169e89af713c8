//! What tests of several rooms share.

#[cfg(test)]
pub(crate) mod allocations;
#[cfg(test)]
pub(crate) mod by_hand;
#[cfg(test)]
pub(crate) mod one_sided;
#[cfg(test)]
#[allow(
    dead_code,
    unreachable_pub,
    reason = "the tests across crates include the same file"
)]
pub(crate) mod random;
