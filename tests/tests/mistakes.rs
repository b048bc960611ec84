//! Mistakes of the attribute's users with the compiler's messages: pairs in `tests/mistakes`.

#[test]
#[ignore = "compiles a crate for each mistake, and the generator once more: `.ci/full` runs it"]
fn each_mistake_gets_its_message() {
    trybuild::TestCases::new().compile_fail("mistakes/*.rs");
}
