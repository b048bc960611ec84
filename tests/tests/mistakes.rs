//! What users of the attribute do wrong, and what the compiler says: pairs in `tests/mistakes`.

#[test]
fn each_mistake_gets_its_message() {
    trybuild::TestCases::new().compile_fail("mistakes/*.rs");
}
