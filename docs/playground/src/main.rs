//! Answers the questions on standard input, one a line, with one line each: what the page is held against.

use std::io::{BufRead, Write, stdin, stdout};

use pebo_playground::{Kept, respond};

fn main() -> std::io::Result<()> {
    let mut kept = Kept::new(|_| ());
    for question in stdin().lock().lines() {
        writeln!(stdout().lock(), "{}", respond(&mut kept, &question?).replace('\n', " "))?;
    }
    Ok(())
}
