//! What is read off a periodic orbit: motions, contacts, stability.

pub mod observe;
pub mod stability;
