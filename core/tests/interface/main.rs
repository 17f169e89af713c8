//! What a user of the runtime alone meets: messages, results to keep, structures given as matrices, declarations read from text.

mod accuracy;
mod at_rest;
mod backbone;
#[cfg(feature = "serde")]
mod both_ways;
mod cancelled;
mod chosen;
mod curves;
mod either;
#[cfg(feature = "serde")]
mod json;
mod maps;
mod messages;
mod outputs;
mod owned;
#[cfg(feature = "serde")]
mod resumed;
mod structure;
#[cfg(feature = "text")]
mod text;
#[cfg(feature = "serde")]
mod whole;
