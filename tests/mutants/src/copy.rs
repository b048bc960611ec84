//! A copy of the workspace that may be changed, and its test binaries.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::plan::{Module, Package, Tests};
use crate::rewrite;
use crate::sites::Fault;

/// The project as it is, and a copy of it below `target`.
pub struct Copy {
    original: PathBuf,
    folder: PathBuf,
}

/// A compiled target of tests.
pub struct Binary {
    pub path: PathBuf,
    /// The folder of its package, in which cargo runs it.
    pub folder: PathBuf,
}

/// The test binaries by package and target.
pub type Binaries = BTreeMap<(&'static str, &'static str), Binary>;

impl Copy {
    /// A copy of git's files of the project in the current folder.
    pub fn new() -> Result<Self, String> {
        let original = std::env::current_dir().map_err(|error| error.to_string())?;
        let folder = original.join("target/mutants");
        let listed =
            output(Command::new("git").args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"]))?;
        for name in listed.split('\0').filter(|name| !name.is_empty()) {
            let to = folder.join(name);
            let Ok(text) = std::fs::read(original.join(name)) else { continue };
            // Unchanged files keep their age, or all would be built anew.
            if std::fs::read(&to).is_ok_and(|there| there == text) {
                continue;
            }
            let parent = to.parent().unwrap_or(&folder);
            std::fs::create_dir_all(parent).map_err(|error| error.to_string())?;
            std::fs::write(&to, text).map_err(|error| format!("{}: {error}", to.display()))?;
        }
        Ok(Self { original, folder })
    }

    /// The project as it is.
    pub fn root(&self) -> &Path {
        &self.original
    }

    /// Builds the tests of modules with the faults in their package; faults that do not compile are taken out.
    pub fn build(&self, package: &Package, modules: &[&Module], faults: &mut Vec<Fault>) -> Result<Binaries, String> {
        let files: Vec<PathBuf> = faults.iter().map(|fault| fault.file.clone()).collect();
        loop {
            rewrite::write(&self.original, &self.folder, package.folder, &files, faults)?;
            let (messages, succeeded) = self.cargo(package, &["check", "--lib"])?;
            if succeeded {
                break;
            }
            let before = faults.len();
            let mut shown = String::new();
            for message in &messages {
                let Some(error) = message.get("message").filter(|error| error["level"] == "error") else { continue };
                shown.push_str(error["rendered"].as_str().unwrap_or_default());
                let spans = error["spans"].as_array().into_iter().flatten();
                for span in spans.filter(|span| span["is_primary"] == true) {
                    let (file, line) = (span["file_name"].as_str().unwrap_or_default(), &span["line_start"]);
                    // A message may begin within a fault of several lines.
                    let line = line.as_u64().unwrap_or(0) as usize;
                    let here = |fault: &Fault| Path::new(file) == fault.file && fault.line <= line;
                    let nearest = faults.iter().filter(|fault| here(fault)).map(|fault| fault.line).max();
                    faults.retain(|fault| !(here(fault) && Some(fault.line) == nearest));
                }
            }
            if faults.len() == before {
                return Err(format!("the copy does not compile, and no fault is to blame:\n{shown}"));
            }
        }
        let mut binaries = Binaries::new();
        for tests in modules.iter().flat_map(|module| module.tests) {
            let key = (tests.package.name, tests.target);
            if let Entry::Vacant(entry) = binaries.entry(key) {
                entry.insert(self.binary(tests)?);
            }
        }
        Ok(binaries)
    }

    /// Compiles a target of tests.
    fn binary(&self, tests: &Tests) -> Result<Binary, String> {
        let Tests { package, target, .. } = tests;
        let chosen = if *target == "lib" { vec!["--lib"] } else { vec!["--test", *target] };
        let words: Vec<&str> = ["test", "--no-run"].into_iter().chain(chosen).collect();
        let (messages, succeeded) = self.cargo(package, &words)?;
        let missing = || format!("the tests `{target}` of {} do not compile", package.name);
        if !succeeded {
            return Err(missing());
        }
        let mut built = messages.iter().filter(|message| message["profile"]["test"] == true);
        let path = built.find_map(|message| message["executable"].as_str()).ok_or_else(missing)?;
        Ok(Binary { path: PathBuf::from(path), folder: self.folder.join(package.folder) })
    }

    fn cargo(&self, package: &Package, words: &[&str]) -> Result<(Vec<Value>, bool), String> {
        let mut command = Command::new("cargo");
        command.args(words).args(["-p", package.name, "--message-format=json"]).args(package.features);
        command.current_dir(&self.folder).env_remove("CARGO_TARGET_DIR").stderr(Stdio::null());
        let found = command.output().map_err(|error| error.to_string())?;
        let lines = String::from_utf8_lossy(&found.stdout);
        Ok((lines.lines().filter_map(|line| serde_json::from_str(line).ok()).collect(), found.status.success()))
    }
}

fn output(command: &mut Command) -> Result<String, String> {
    let found = command.output().map_err(|error| error.to_string())?;
    if !found.status.success() {
        return Err(String::from_utf8_lossy(&found.stderr).into_owned());
    }
    String::from_utf8(found.stdout).map_err(|error| error.to_string())
}
