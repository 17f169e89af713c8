//! The contract of a contact law: what the compiler emits and the runtime reads.

pub use hertzian_contract::law::*;
