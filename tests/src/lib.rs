//! Tests of hertzian across its crates.
