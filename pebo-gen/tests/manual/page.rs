//! The pages of the project and their parts.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag};

/// A page of Markdown.
pub(super) struct Page {
    pub(super) path: PathBuf,
    pub(super) text: String,
}

/// A fenced block: the words behind its fence, and the range of its text.
#[derive(Clone)]
pub(super) struct Block {
    pub(super) words: Vec<String>,
    pub(super) range: Range<usize>,
}

impl Block {
    /// The language, which is the first word.
    pub(super) fn language(&self) -> &str {
        self.words.first().map_or("", String::as_str)
    }
}

/// Begins a part of a page that is written by `generated`, up to [`END`].
pub(super) const BEGIN: &str = "<!-- generated: ";
pub(super) const END: &str = "<!-- end -->";

/// The project's folder.
pub(super) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// To be held by a test that may write pages.
pub(super) fn held() -> MutexGuard<'static, ()> {
    static PAGES: Mutex<()> = Mutex::new(());
    PAGES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Pages are to be written anew.
pub(super) fn updates() -> bool {
    std::env::var_os("UPDATE_DOCS").is_some()
}

impl Page {
    pub(super) fn read(path: PathBuf) -> Self {
        let text = std::fs::read_to_string(&path).expect("a page");
        Self { path, text }
    }

    /// Its fenced blocks, but for those that are generated.
    pub(super) fn blocks(&self) -> Vec<Block> {
        let generated = self.generated();
        let parser = Parser::new_ext(&self.text, Options::ENABLE_TABLES).into_offset_iter();
        let fenced = parser.filter_map(|(event, range)| match event {
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(info))) => Some((info, range)),
            _ => None,
        });
        let of_author = fenced.filter(|(_, range)| !generated.iter().any(|(_, part)| part.contains(&range.start)));
        of_author.map(|(info, range)| block(&self.text, &info, &range)).collect()
    }

    /// The generated parts: name and range of the text.
    pub(super) fn generated(&self) -> Vec<(String, Range<usize>)> {
        let mut parts = Vec::new();
        let mut from = 0;
        while let Some(begin) = self.text[from..].find(BEGIN).map(|at| from + at + BEGIN.len()) {
            let name = self.text[begin..].split(" -->").next().unwrap_or_default().to_owned();
            let start = begin + name.len() + " -->\n".len();
            let end = start + self.text[start..].find(END).expect("an end of the generated part");
            parts.push((name, start..end));
            from = end;
        }
        parts
    }

    /// The text of a block.
    pub(super) fn of(&self, block: &Block) -> &str {
        &self.text[block.range.clone()]
    }
}

/// A block, whose text is between the line of its fence and the line that closes it.
fn block(text: &str, info: &str, range: &Range<usize>) -> Block {
    let fence = text[range.clone()].find('\n').map_or(range.end, |end| range.start + end + 1);
    let close = text[range.clone()].trim_end().rfind('\n').map_or(range.end, |end| range.start + end + 1);
    Block { words: info.split_whitespace().map(str::to_owned).collect(), range: fence..close.max(fence) }
}

/// README.md and the manual.
pub(super) fn manual() -> Vec<Page> {
    let mut paths = files(&root().join("docs"), "md");
    paths.push(root().join("README.md"));
    paths.into_iter().map(Page::read).collect()
}

/// The files below a folder with an extension, except for built and hidden ones.
pub(super) fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let (path, name) = (entry.path(), entry.file_name());
        let name = name.to_string_lossy();
        if path.is_dir() {
            if name != "target" && name != "node_modules" && !name.starts_with('.') {
                found.extend(files(&path, extension));
            }
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}
