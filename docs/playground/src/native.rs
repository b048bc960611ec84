//! Answers the questions on standard input, one a line, with one line each: the reference for the page.
//!
//! An example of the package `tests`, which has the generator compiled already.

mod cache;
mod question;
mod respond;

use std::io::{BufRead, Write, stdin, stdout};

use cache::ModelCache;
use respond::respond;

fn main() -> std::io::Result<()> {
    let mut cache = ModelCache::new(|_| ());
    for question in stdin().lock().lines() {
        writeln!(stdout().lock(), "{}", respond(&mut cache, &question?).replace('\n', " "))?;
    }
    Ok(())
}
