//! What a structure is made of ([`structure`]): directions ([`direction`]) along which loads ([`load`]), contacts ([`contact`]) and outputs
//! ([`output`]) are, damping and gyroscopic matrices ([`damping`]); and whether all of that fits together ([`check`]).

mod check;
pub(crate) mod contact;
pub(crate) mod damping;
pub(crate) mod direction;
pub(crate) mod load;
pub(crate) mod output;
pub(crate) mod structure;
