//! What a user of the runtime alone meets: messages, structures given as matrices, declarations read from text.

mod messages;
mod structure;
#[cfg(feature = "text")]
mod text;
