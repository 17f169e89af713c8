//! Where methods fail: each case shows one on a problem whose answer is known, and what is answered by default.
//!
//! The book describes them in `docs/book/src/failure-gallery.md`, with the numbers printed here:
//!
//!     cargo test -p hertzian-tests --test all response::failures -- --nocapture
//!
//! Exact values are from an independent computation, or from the integration by hand of `oracle`, which is tested against these.

mod grazing;
mod hill;
mod integration;
mod limits;
mod models;
mod moving;
mod newton;
mod oracle;
mod quadrature;
mod sampling;
mod spread;
mod stiff;
