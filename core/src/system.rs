//! The contract of a system: its equations of motion.

pub use hertzian_contract::system::*;
