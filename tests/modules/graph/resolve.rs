//! From the paths that a file names to the files that define their items.

use std::collections::{BTreeMap, BTreeSet};

use super::read::{Module, Segments};

/// Exports of exports are followed so far.
const DEEPEST: usize = 8;

/// The arrows among the files.
pub(super) fn arrows(modules: &[Module]) -> BTreeSet<(usize, usize)> {
    let names = Names::new(modules);
    let mut arrows = BTreeSet::new();
    for (from, module) in modules.iter().enumerate() {
        let exported = module.exports.iter().filter_map(|name| module.imports.get(name));
        let exported = exported.filter_map(|path| names.file(from, path, DEEPEST));
        // Within a layer, an export declares; across layers it uses.
        let exported = exported.filter(|to| !module.path.is_empty() && names.layer(*to) != names.layer(from));
        let used = module.named.iter().filter_map(|path| names.file(from, path, DEEPEST)).chain(exported);
        arrows.extend(used.filter(|to| *to != from).map(|to| (from, to)));
    }
    arrows
}

/// The modules by their paths.
struct Names<'a> {
    modules: &'a [Module],
    places: BTreeMap<&'a [String], usize>,
}

impl<'a> Names<'a> {
    fn new(modules: &'a [Module]) -> Self {
        let mut places = BTreeMap::new();
        for (at, module) in modules.iter().enumerate() {
            // The library's root represents all: the roots of a program and of a member crate only declare layers.
            places.entry(module.path.as_slice()).or_insert(at);
        }
        Self { modules, places }
    }

    /// The file that defines the item of a path, if it is one of these crates'.
    fn file(&self, from: usize, path: &[String], deep: usize) -> Option<usize> {
        let here = &self.modules[from];
        let (first, mut rest) = path.split_first()?;
        let mut base: Segments = match first.as_str() {
            "crate" => here.root.clone(),
            "self" => here.path.clone(),
            "super" => here.path[..here.path.len().checked_sub(1)?].to_vec(),
            // An item of a child, or a name that this file exports; alone, the name of a child is one of a variable.
            name if (!rest.is_empty() && self.child(&here.path, name).is_some()) || here.exports.contains(name) => {
                rest = path;
                here.path.clone()
            }
            name => super::read::root(name)?,
        };
        while rest.first().is_some_and(|segment| segment == "super") {
            base.pop()?;
            rest = &rest[1..];
        }
        let at = *self.places.get(base.as_slice())?;
        Some(self.below(at, rest, deep))
    }

    /// The file of the rest of a path, from the module that it has come to.
    fn below(&self, mut at: usize, mut rest: &[String], deep: usize) -> usize {
        while let Some((segment, after)) = rest.split_first() {
            if let Some(child) = self.child(&self.modules[at].path, segment) {
                (at, rest) = (child, after);
                continue;
            }
            return self.item(at, segment, after, deep);
        }
        at
    }

    /// The file that defines a name of a module: that module, or the one that it is imported from.
    fn item(&self, at: usize, name: &str, after: &[String], deep: usize) -> usize {
        let module = &self.modules[at];
        if module.items.contains(name) || deep == 0 {
            return at;
        }
        if let Some(target) = module.imports.get(name) {
            let target: Segments = target.iter().chain(after).cloned().collect();
            // A layer's export of another one's item is its own: the export has the arrow.
            let own = |found: &usize| self.layer(at).is_none() || self.layer(*found) == self.layer(at);
            return self.file(at, &target, deep - 1).filter(own).unwrap_or(at);
        }
        let globs = module.globs.iter().filter_map(|glob| self.file(at, glob, deep - 1));
        globs
            .map(|glob| (glob, self.item(glob, name, after, deep - 1)))
            .find(|(_, found)| self.modules[*found].items.contains(name))
            .map_or(at, |(_, found)| found)
    }

    fn layer(&self, module: usize) -> Option<&String> {
        self.modules[module].path.first()
    }

    fn child(&self, path: &[String], name: &str) -> Option<usize> {
        let path: Segments = path.iter().cloned().chain([name.to_owned()]).collect();
        self.places.get(path.as_slice()).copied()
    }
}
