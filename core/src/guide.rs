//! The declarations of the guide, compiled. One of them draws a picture.

#![cfg(feature = "plot")]

#[doc = include_str!("../../docs/book/src/declaring-contacts.md")]
struct DeclaringContacts;
