//! What tests of several rooms share.

#[cfg(test)]
pub(crate) mod allocations;
#[cfg(test)]
pub(crate) mod by_hand;
#[cfg(test)]
pub(crate) mod random;
