//! Models, commands and code of the pages.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::commands::{BY_HAND, commands, said};
use super::links::{commands_in_sentences, images};
use super::page::{Block, Page, files, held, manual, root, updates};

/// The blocks of one page, run from its beginning in a folder of its own.
struct Run {
    folder: tempfile::TempDir,
    page: Page,
    /// The mistakes of the page.
    wrong: String,
    /// Outputs to write into the page: where, and what.
    anew: Vec<(std::ops::Range<usize>, String)>,
}

impl Run {
    fn of(page: Page) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::os::unix::fs::symlink(root().join("models"), folder.path().join("models")).expect("a link");
        Self { folder, page, wrong: String::new(), anew: Vec::new() }
    }

    fn complain(&mut self, block: &Block, what: &str) {
        let line = self.page.text[..block.range.start].lines().count();
        writeln!(self.wrong, "{}:{line}: {what}", self.page.path.display()).expect("a string");
    }

    /// A model file, whole or in part.
    fn model(&mut self, block: &Block) {
        let text = self.page.of(block).to_owned();
        let [_, name, rest @ ..] = block.words.as_slice() else {
            if !self.sources("yaml", &[root().join("models")]).iter().any(|source| source.contains(&text)) {
                self.complain(block, "no model has this part");
            }
            return;
        };
        let file = self.folder.path().join(name);
        let rest: Vec<&str> = rest.iter().map(String::as_str).collect();
        let whole = match rest.as_slice() {
            ["with"] => replaced(&std::fs::read_to_string(&file).expect("a file to change"), &text),
            [] | ["refused"] => text,
            _ => return self.complain(block, "words that mean nothing here"),
        };
        std::fs::write(&file, whole).expect("a file");
        let (answer, accepted) = said(&format!("pebo-gen check {name}"), self.folder.path());
        if accepted == (rest == ["refused"]) {
            self.complain(block, &answer);
        }
    }

    /// Commands and their output.
    fn console(&mut self, block: &Block) {
        let text = self.page.of(block).to_owned();
        let refused = block.words.iter().any(|word| word == "refused");
        let mut anew = String::new();
        for shown in commands(&text) {
            let (answer, succeeds) = said(shown.command, self.folder.path());
            // Or a mistake of ours would be written down as true.
            if !shown.agrees(&answer) || succeeds == refused {
                self.complain(block, &format!("$ {}\n{answer}", shown.command));
            }
            let kept = if shown.has_gap() { shown.lines.join("\n") } else { answer.trim_end_matches('\n').to_owned() };
            writeln!(anew, "$ {}", shown.command).expect("a string");
            if !kept.is_empty() {
                writeln!(anew, "{kept}").expect("a string");
            }
        }
        self.anew.push((block.range.clone(), anew));
    }

    /// Code that some program has, whatever its indentation there.
    fn rust(&mut self, block: &Block) {
        let text = flush(self.page.of(block));
        let programs = ["tests/tests", "tests/examples", "tests/firmware", "pebo-runtime/tests"];
        let sources = self.sources("rs", &programs.map(|folder| root().join(folder)));
        if !sources.iter().any(|source| flush(source).contains(&text)) {
            self.complain(block, "no program has this part");
        }
    }

    /// The files of the folders, and those that the page made.
    fn sources(&self, extension: &str, folders: &[PathBuf]) -> Vec<String> {
        let own = std::fs::read_dir(self.folder.path()).expect("a folder").flatten().map(|entry| entry.path());
        let own = own.filter(|path| path.extension().is_some_and(|e| e == extension));
        let paths = folders.iter().flat_map(|folder| files(folder, extension)).chain(own);
        paths.map(|path| std::fs::read_to_string(path).expect("a source")).collect()
    }

    /// A file of the project, if one is named.
    fn file(&mut self, block: &Block) {
        let Some(name) = block.words.get(1) else { return };
        if std::fs::read_to_string(root().join(name)).ok().as_deref() != Some(self.page.of(block)) {
            self.complain(block, "the file is another");
        }
    }

    /// Commands for a shell that are run elsewhere.
    fn elsewhere(&mut self, block: &Block) {
        let ci = [".ci/run", ".ci/full"]
            .map(|script| std::fs::read_to_string(root().join(script)).expect("a script"))
            .concat();
        // CI runs the whole of README.md's blocks by itself.
        if self.page.path == root().join("README.md") {
            return;
        }
        let text = self.page.of(block).to_owned();
        for line in text.lines().filter(|line| !ci.contains(line) && !BY_HAND.contains(line)) {
            self.complain(block, &format!("nothing runs `{line}`"));
        }
    }

    /// Dependencies of a crate beside a checkout.
    fn dependencies(&mut self, block: &Block) {
        let beside = self.folder.path().join("pebo");
        if !beside.exists() {
            std::os::unix::fs::symlink(root().canonicalize().expect("a folder"), &beside).expect("a link");
        }
        let user = self.folder.path().join("user");
        std::fs::create_dir_all(user.join("src")).expect("a folder");
        std::fs::write(user.join("src/lib.rs"), "").expect("a file");
        std::fs::copy(root().join("Cargo.lock"), user.join("Cargo.lock")).expect("the lock file");
        let head = "[package]\nname = \"user\"\nedition = \"2024\"\n\n[workspace]\n\n";
        std::fs::write(user.join("Cargo.toml"), format!("{head}{}", self.page.of(block))).expect("a file");
        let mut cargo = Command::new(env!("CARGO"));
        let metadata = cargo.args(["metadata", "--offline", "--format-version", "1"]).current_dir(&user).output();
        let metadata = metadata.expect("cargo");
        if !metadata.status.success() {
            self.complain(block, &String::from_utf8_lossy(&metadata.stderr));
        }
    }

    /// A part of a C program or of a header that a command of the page wrote.
    fn c(&mut self, block: &Block) {
        let text = self.page.of(block).to_owned();
        let own = [self.folder.path().to_owned()];
        let parts = ["c", "h"].into_iter().flat_map(|extension| self.sources(extension, &own));
        if !parts.into_iter().any(|source| source.contains(&text)) {
            self.complain(block, "no C file that was written here has this part");
        }
    }

    /// A part of a recording that is shipped.
    fn recording(&mut self, block: &Block) {
        let text = self.page.of(block).to_owned();
        if !self.sources("csv", &[root().join("models")]).iter().any(|source| source.contains(&text)) {
            self.complain(block, "no recording has this part");
        }
    }

    /// The images that the page shows and a command of it drew.
    fn figures(&mut self) {
        for shown in images(&self.page) {
            let drawn = self.folder.path().join(shown.file_name().expect("a name"));
            let Ok(drawn) = std::fs::read(drawn) else { continue };
            if updates() {
                std::fs::write(&shown, drawn).expect("a figure");
            } else if std::fs::read(&shown).ok() != Some(drawn) {
                writeln!(self.wrong, "{}: a command of the page draws another", shown.display()).expect("a string");
            }
        }
    }

    /// Commands within sentences, which succeed.
    fn sentences(&mut self) {
        std::fs::create_dir_all(self.folder.path().join("src")).expect("a folder");
        for command in commands_in_sentences(&self.page).into_iter().filter(|command| !command.contains("MODEL")) {
            let (answer, succeeds) = said(&command, self.folder.path());
            if !succeeds {
                writeln!(self.wrong, "{}: `{command}`\n{answer}", self.page.path.display()).expect("a string");
            }
        }
    }

    fn all(mut self) -> String {
        for block in self.page.blocks() {
            match block.language() {
                "yaml" => self.model(&block),
                "console" => self.console(&block),
                "sh" => self.elsewhere(&block),
                "rust" => self.rust(&block),
                "c" => self.c(&block),
                "csv" => self.recording(&block),
                "toml" => self.dependencies(&block),
                "text" => self.file(&block),
                // The tests of the wheel do.
                "pycon" => {}
                _ => self.complain(&block, "a block of no kind that is known"),
            }
        }
        self.figures();
        self.sentences();
        if updates() {
            let Self { page, anew, .. } = &mut self;
            for (range, text) in anew.drain(..).rev() {
                page.text.replace_range(range, &text);
            }
            std::fs::write(&page.path, &page.text).expect("a page");
        }
        self.wrong
    }
}

/// Lines without leading and trailing spaces.
fn flush(text: &str) -> String {
    text.lines().flat_map(|line| [line.trim(), "\n"]).collect()
}

/// A model file whose keys of the first level are replaced by those of a part, which is put at the end.
fn replaced(whole: &str, part: &str) -> String {
    let key =
        |line: &str| line.starts_with(|c: char| c.is_alphabetic()).then(|| line.split(':').next().map(str::to_owned));
    let new: Vec<String> = part.lines().filter_map(|line| key(line).flatten()).collect();
    let mut kept = String::new();
    let mut keeps = true;
    for line in whole.lines() {
        if let Some(Some(key)) = key(line) {
            keeps = !new.contains(&key);
        }
        if keeps {
            writeln!(kept, "{line}").expect("a string");
        }
    }
    kept + part
}

#[test]
fn pages_are_true() {
    let _held = held();
    // Pages are independent of one another: a thread each.
    let wrong: String = std::thread::scope(|scope| {
        let running: Vec<_> = manual().into_iter().map(|page| scope.spawn(|| Run::of(page).all())).collect();
        running.into_iter().map(|page| page.join().expect("a page")).collect()
    });
    assert!(updates() || wrong.is_empty(), "{wrong}");
}

#[test]
fn a_part_replaces_the_keys_that_it_has() {
    assert_eq!(replaced("a: 1\nb:\n  c: 2\nd: 3\n", "b: 4\ne: 5\n"), "a: 1\nd: 3\nb: 4\ne: 5\n");
}

#[test]
fn the_manual_lists_its_pages() {
    let docs = root().join("docs");
    let summary = std::fs::read_to_string(docs.join("SUMMARY.md")).expect("the summary");
    for path in files(&docs, "md") {
        let name = path.strip_prefix(&docs).unwrap_or(Path::new("")).display().to_string();
        assert!(name == "SUMMARY.md" || summary.contains(&format!("({name})")), "{name} is not in docs/SUMMARY.md");
    }
}
