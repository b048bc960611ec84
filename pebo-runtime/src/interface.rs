//! The version of the interface between emitted code and this library.

/// Counts the changes of the library that emitted code has to follow.
pub const INTERFACE: u32 = 2;

/// Fails to compile where a module was emitted for another [`INTERFACE`]: each emitted module calls it in a constant.
///
/// ```
/// const _: () = pebo_runtime::emitted_for(pebo_runtime::INTERFACE);
/// ```
///
/// ```compile_fail
/// const _: () = pebo_runtime::emitted_for(0);
/// ```
///
/// # Panics
/// If the versions differ; in a constant this is an error of the compiler.
pub const fn emitted_for(interface: u32) {
    assert!(interface == INTERFACE, "this module was emitted for another pebo-runtime: generate it again");
}
