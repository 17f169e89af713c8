//! The book's blocks of code, compiled and run. One of them draws a picture.

#![cfg(feature = "plot")]

#[doc = include_str!("../../docs/book/src/declaring-contacts.md")]
struct DeclaringContacts;

#[doc = include_str!("../../docs/book/src/response-curves.md")]
struct ResponseCurves;

#[doc = include_str!("../../docs/book/src/outputs.md")]
struct Outputs;

#[doc = include_str!("../../docs/book/src/bifurcations.md")]
struct Bifurcations;

#[doc = include_str!("../../docs/book/src/attractors.md")]
struct Attractors;

#[doc = include_str!("../../docs/book/src/stability.md")]
struct StabilityOfOrbits;

#[doc = include_str!("../../docs/book/src/sensitivities.md")]
struct Sensitivities;

#[doc = include_str!("../../docs/book/src/measured-contact.md")]
struct MeasuredContact;

#[doc = include_str!("../../docs/book/src/theory.md")]
struct Theory;
