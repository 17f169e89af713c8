//! What a user of the runtime alone meets: messages, results to keep, structures given as matrices, declarations read from text.

mod accuracy;
mod at_rest;
mod backbone;
mod both_ways;
mod cancelled;
mod chosen;
mod curves;
mod either;
mod json;
mod maps;
mod messages;
mod outputs;
mod owned;
mod readings;
mod resumed;
mod steep;
mod structure;
mod text;
mod whole;
