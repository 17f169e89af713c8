//! What a user of the runtime alone meets: messages, results to keep, structures given as matrices, declarations read from text.

mod cancelled;
mod either;
#[cfg(feature = "serde")]
mod json;
mod messages;
mod owned;
mod structure;
#[cfg(feature = "text")]
mod text;
