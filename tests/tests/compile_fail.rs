//! Faulty declarations and the messages they get: each case is one file, with its messages beside it.

#[test]
fn faulty_declarations_are_refused_where_they_are_wrong() {
    trybuild::TestCases::new().compile_fail("tests/compile_fail/*.rs");
}
