//! The exports of the module: the page writes a question into `room`, calls `ask`, and reads the answer at `answer`.
//!
//! Holds: one thread, which a module without shared memory has.

use std::cell::RefCell;

use super::cache::ModelCache;
use super::respond::respond;

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// Tells the page which part of a run is done.
    safe fn progress(done: f64);
}

fn tell(done: f64) {
    progress(done);
}

thread_local! {
    static TEXT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static KEPT: RefCell<ModelCache> = RefCell::new(ModelCache::new(tell));
}

/// Makes room for a question of so many bytes, and says where.
#[unsafe(no_mangle)]
pub extern "C" fn room(bytes: usize) -> *mut u8 {
    TEXT.with_borrow_mut(|text| {
        text.clear();
        text.resize(bytes, 0);
        text.as_mut_ptr()
    })
}

/// Answers the question, and says how many bytes the answer has.
#[unsafe(no_mangle)]
pub extern "C" fn ask() -> usize {
    let question = TEXT.take();
    let answer = KEPT.with_borrow_mut(|cache| respond(cache, &String::from_utf8_lossy(&question)));
    let bytes = answer.len();
    TEXT.set(answer.into_bytes());
    bytes
}

/// The address of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    TEXT.with_borrow(|text| text.as_ptr())
}
