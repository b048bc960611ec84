//! The module graph of the generator, read off its sources: the uses among files.
//!
//! In: the folder of the generator, with its member crates. Out: their files, an arrow from each to every file whose
//! items it names, and the arrows that the table of layers forbids. A declaration (`mod`, `pub use`) is no use; a name
//! that is exported again leads to the file of its definition. Uses by tests do not count, and those by a method call
//! alone are not found.

mod circles;
mod layers;
mod read;
mod resolve;

use std::collections::BTreeSet;
use std::fmt;
use std::path::Path;

use read::Module;

/// The beginning of the sentence that says why the files of a circle are one thing.
const REASON: &str = "One thing with ";

/// The files of the generator's crates and the arrows among them.
#[derive(Debug)]
pub(crate) struct Graph {
    modules: Vec<Module>,
    /// Positions of the file that uses, and of the one that is used; ascending.
    arrows: BTreeSet<(usize, usize)>,
}

impl Graph {
    /// Reads the sources of a package and of its member crates.
    pub(crate) fn read(package: &Path) -> Self {
        let modules = read::modules(package);
        let arrows = resolve::arrows(&modules);
        Self { modules, arrows }
    }

    /// Arrows from a layer to one that it may not use, as `file -> file`.
    pub(crate) fn back(&self) -> Vec<String> {
        let back = self.arrows.iter().filter(|(from, to)| !layers::may_use(self.layer(*from), self.layer(*to)));
        back.map(|(from, to)| format!("{} -> {}", self.file(*from), self.file(*to))).collect()
    }

    /// Strongly connected sets of files, by name.
    pub(crate) fn circles(&self) -> Vec<Vec<&str>> {
        let circles = circles::circles(self.modules.len(), &self.arrows);
        circles.iter().map(|circle| circle.iter().map(|module| self.file(*module)).collect()).collect()
    }

    /// The reason that the files of a circle are one thing: the file whose documentation has it, and the sentence.
    pub(crate) fn reason(&self, circle: &[&str]) -> Option<(&str, &str)> {
        let modules = self.modules.iter().filter(|module| circle.contains(&module.file.as_str()));
        let mut said =
            modules.filter_map(|module| Some((module.file.as_str(), &module.docs[module.docs.find(REASON)?..])));
        said.next()
    }

    /// Foreign crates that a file uses outside of their layers, as `file uses crate`.
    pub(crate) fn strays(&self) -> Vec<String> {
        let mut strays = Vec::new();
        for (at, module) in self.modules.iter().enumerate() {
            let crates: BTreeSet<&str> = module.named.iter().filter_map(|path| Some(path.first()?.as_str())).collect();
            let strange = crates.iter().filter(|name| !layers::may_link(self.layer(at), name));
            strays.extend(strange.map(|name| format!("{} uses {name}", module.file)));
        }
        strays
    }

    /// A module of the first or second level, with all below it.
    fn room(&self, module: usize) -> &[String] {
        let path = &self.modules[module].path;
        &path[..path.len().min(2)]
    }

    fn layer(&self, module: usize) -> &str {
        self.modules[module].path.first().map_or("", String::as_str)
    }

    fn file(&self, module: usize) -> &str {
        &self.modules[module].file
    }
}

impl fmt::Display for Graph {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines: usize = self.modules.iter().map(|module| module.lines).sum();
        let between = |of: &dyn Fn(usize) -> Vec<String>| {
            let pairs = self.arrows.iter().map(|(from, to)| (of(*from), of(*to)));
            pairs.filter(|(from, to)| from != to).collect::<BTreeSet<_>>().len()
        };
        let (back, strays, circles) = (self.back(), self.strays(), self.circles());
        writeln!(f, "files                 {:>6}", self.modules.len())?;
        writeln!(f, "lines                 {lines:>6}")?;
        writeln!(f, "arrows between files  {:>6}", self.arrows.len())?;
        writeln!(f, "arrows between rooms  {:>6}", between(&|module| self.room(module).to_vec()))?;
        writeln!(f, "arrows between layers {:>6}", between(&|module| vec![self.layer(module).to_owned()]))?;
        writeln!(f, "arrows that run back  {:>6}", back.len())?;
        writeln!(f, "foreign crates astray {:>6}", strays.len())?;
        let files: usize = circles.iter().map(Vec::len).sum();
        write!(f, "circles among files   {:>6}, of {files} files", circles.len())?;
        for arrow in back {
            write!(f, "\nback: {arrow}")?;
        }
        for stray in strays {
            write!(f, "\nastray: {stray}")?;
        }
        for circle in circles {
            write!(f, "\ncircle: {}", circle.join(", "))?;
            write!(f, "\n  {}", self.reason(&circle).map_or("nothing says why", |(_, sentence)| sentence))?;
            for (from, to) in self.arrows.iter().map(|(from, to)| (self.file(*from), self.file(*to))) {
                if circle.contains(&from) && circle.contains(&to) {
                    write!(f, "\n  {from} -> {to}")?;
                }
            }
        }
        Ok(())
    }
}
