//! Commands that a page shows, with their output.

use std::path::Path;
use std::process::Command;

/// Commands that no test runs, as each installs or serves something.
pub(super) const BY_HAND: &[&str] = &[
    "cargo install --path pebo-gen",
    "cargo install mdbook",
    "pip install ./pebo-gen/python",
    "mdbook serve docs",
    // By `docs/playground/test` in CI.
    "docs/build",
    "python3 -m http.server --directory target/site",
];

/// A line that matches any number of lines.
const GAP: &str = "...";

/// A command with its output on the page, line by line.
pub(super) struct Transcript<'a> {
    pub(super) command: &'a str,
    pub(super) lines: Vec<&'a str>,
}

impl Transcript<'_> {
    /// A part of the output is left out.
    pub(super) fn has_gap(&self) -> bool {
        self.lines.contains(&GAP)
    }

    /// The output on the page is that of the command.
    pub(super) fn agrees(&self, said: &str) -> bool {
        let mut rest: Vec<&str> = said.lines().collect();
        let mut parts = self.lines.split(|line| *line == GAP);
        let first = parts.next().unwrap_or_default();
        if !self.has_gap() {
            return rest == first;
        }
        if !rest.starts_with(first) {
            return false;
        }
        rest.drain(..first.len());
        let mut last: &[&str] = &[];
        for part in parts {
            last = part;
            let Some(at) = (0..=rest.len().saturating_sub(part.len())).find(|&at| rest[at..].starts_with(part)) else {
                return false;
            };
            rest.drain(..at + part.len());
        }
        // The part behind the last gap is the end.
        last.is_empty() || rest.is_empty()
    }
}

/// The commands of a block.
pub(super) fn commands(text: &str) -> Vec<Transcript<'_>> {
    let mut shown: Vec<Transcript> = Vec::new();
    for line in text.lines() {
        match line.strip_prefix("$ ") {
            Some(command) => shown.push(Transcript { command, lines: Vec::new() }),
            None => shown.last_mut().expect("a command before its output").lines.push(line),
        }
    }
    shown
}

/// The output of a shell for a command in a folder, on both streams, and the command's success.
pub(super) fn said(command: &str, folder: &Path) -> (String, bool) {
    let programs = Path::new(env!("CARGO_BIN_EXE_pebo-gen")).parent().expect("a folder").display();
    let path = format!("{programs}:{}", std::env::var("PATH").unwrap_or_default());
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("exec 2>&1\n{command}")]).current_dir(folder).env("PATH", path);
    let output = shell.output().expect("a shell");
    (String::from_utf8_lossy(&output.stdout).into_owned(), output.status.success())
}

#[test]
fn a_gap_stands_for_any_number_of_lines() {
    let shown = |lines: &[&'static str]| Transcript { command: "", lines: lines.to_vec() };
    for (lines, said, agrees) in [
        (&["a", "b"][..], "a\nb\n", true),
        (&["a"], "a\nb\n", false),
        (&["a", "..."], "a\nb\nc\n", true),
        (&["...", "c"], "a\nb\nc\n", true),
        (&["...", "b"], "a\nb\nc\n", false),
        (&["a", "...", "c"], "a\nc\n", true),
        (&["a", "...", "c", "..."], "a\nb\nc\nd\n", true),
        (&["b", "..."], "a\nb\n", false),
    ] {
        assert_eq!(shown(lines).agrees(said), agrees, "{lines:?} {said:?}");
    }
}
