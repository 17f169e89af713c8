//! The declarations of the guide, compiled.

#[doc = include_str!("../../docs/book/src/declaring-contacts.md")]
struct DeclaringContacts;
