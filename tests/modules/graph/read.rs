//! The files of the generator's crates as modules: their declarations, and the paths that they name.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, ItemUse, Macro, UseTree, Visibility};

/// The segments of a path.
pub(super) type Segments = Vec<String>;

/// A file, which is a module.
#[derive(Debug, Default)]
pub(super) struct Module {
    /// Its name below the sources.
    pub(super) file: String,
    /// Its module path below the layers, empty for a root.
    pub(super) path: Segments,
    /// The path of `crate`.
    pub(super) root: Segments,
    /// Its lines, tests included.
    pub(super) lines: usize,
    /// Its documentation, in a line.
    pub(super) docs: String,
    /// The names that `use` brings, with their paths.
    pub(super) imports: BTreeMap<String, Segments>,
    /// The names that it exports again.
    pub(super) exports: BTreeSet<String>,
    /// Modules whose items `use` brings all.
    pub(super) globs: Vec<Segments>,
    /// The items that it defines.
    pub(super) items: BTreeSet<String>,
    /// The paths that its code names.
    pub(super) named: BTreeSet<Segments>,
}

/// A crate: the folder of its sources, its name in paths, and the layer that it is, where it is one alone.
struct Crate {
    folder: &'static str,
    name: &'static str,
    layer: Option<&'static str>,
}

/// The crates of the generator. The layers of those that hold several stand side by side.
const CRATES: [Crate; 4] = [
    Crate { folder: "src", name: "pebo_gen", layer: None },
    Crate { folder: "cas/src", name: "pebo_cas", layer: Some("cas") },
    Crate { folder: "design/src", name: "pebo_design", layer: None },
    Crate { folder: "lab/src", name: "pebo_lab", layer: Some("lab") },
];

/// The path of a crate by its name.
pub(super) fn root(name: &str) -> Option<Segments> {
    let named = CRATES.iter().find(|each| each.name == name)?;
    Some(named.layer.map(str::to_owned).into_iter().collect())
}

/// Every file of the generator but those of tests, in the order of crates and names.
pub(super) fn modules(package: &Path) -> Vec<Module> {
    let crates = CRATES.iter().filter(|each| package.join(each.folder).is_dir());
    crates.flat_map(|each| modules_of(package, each)).collect()
}

fn modules_of(package: &Path, each: &Crate) -> Vec<Module> {
    let source = &package.join(each.folder);
    let mut paths = files(source);
    paths.retain(|path| {
        let below = path.strip_prefix(source).expect("below the sources");
        !below.components().any(|part| part.as_os_str() == "tests" || part.as_os_str() == "tests.rs")
    });
    paths.sort();
    paths.iter().map(|path| module(source, each.layer, path)).collect()
}

/// Every Rust file below a folder.
pub(super) fn files(folder: &Path) -> Vec<PathBuf> {
    let (mut found, mut open) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }
    found
}

fn module(source: &Path, layer: Option<&str>, path: &Path) -> Module {
    let text = std::fs::read_to_string(path).expect("a source file");
    let below = Path::new(layer.unwrap_or_default()).join(path.strip_prefix(source).expect("below the sources"));
    let file = below.display().to_string();
    let mut segments: Segments =
        below.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if segments.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
        segments.pop();
    }
    let syntax = syn::parse_file(&text).unwrap_or_else(|error| panic!("{file}: {error}"));
    let root = layer.map(str::to_owned).into_iter().collect();
    let mut module = Module { file, path: segments, root, lines: text.lines().count(), ..Module::default() };
    module.docs = docs(&text);
    module.visit_file(&syntax);
    module
}

/// The lines of a module's documentation as one.
fn docs(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("//!"));
    lines.map(str::trim).collect::<Vec<_>>().join(" ")
}

/// The item is there for tests alone.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && matches!(&attribute.meta, syn::Meta::List(list) if list.tokens.to_string().contains("test"))
    })
}

impl<'a> Visit<'a> for Module {
    fn visit_item(&mut self, item: &'a Item) {
        let (attributes, name) = match item {
            Item::Const(item) => (&item.attrs, Some(&item.ident)),
            Item::Enum(item) => (&item.attrs, Some(&item.ident)),
            Item::Fn(item) => (&item.attrs, Some(&item.sig.ident)),
            Item::Mod(item) => (&item.attrs, None),
            Item::Static(item) => (&item.attrs, Some(&item.ident)),
            Item::Struct(item) => (&item.attrs, Some(&item.ident)),
            Item::Trait(item) => (&item.attrs, Some(&item.ident)),
            Item::Type(item) => (&item.attrs, Some(&item.ident)),
            Item::Use(item) => (&item.attrs, None),
            Item::Impl(item) => (&item.attrs, None),
            Item::Macro(item) => (&item.attrs, item.ident.as_ref()),
            _ => return visit::visit_item(self, item),
        };
        if !is_test(attributes) {
            self.items.extend(name.map(ToString::to_string));
            visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'a ItemUse) {
        let exported = !matches!(item.vis, Visibility::Inherited);
        self.imported(&item.tree, Vec::new(), exported);
    }

    /// `pub(super)` is no use of the parent.
    fn visit_visibility(&mut self, _: &'a Visibility) {}

    fn visit_path(&mut self, path: &'a syn::Path) {
        self.named.insert(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, called: &'a Macro) {
        self.scan(called.tokens.clone());
        visit::visit_macro(self, called);
    }
}

impl Module {
    fn imported(&mut self, tree: &UseTree, mut before: Segments, exported: bool) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.imported(&path.tree, before, exported);
            }
            UseTree::Group(group) => {
                group.items.iter().for_each(|tree| self.imported(tree, before.clone(), exported));
            }
            UseTree::Glob(_) => {
                self.named.extend((!exported).then(|| before.clone()));
                self.globs.push(before);
            }
            UseTree::Name(_) | UseTree::Rename(_) => {
                let (from, to) = match tree {
                    UseTree::Rename(rename) => (rename.ident.to_string(), rename.rename.to_string()),
                    UseTree::Name(name) => (name.ident.to_string(), name.ident.to_string()),
                    _ => return,
                };
                let is_self = from == "self";
                let name = if is_self && to == "self" { before.last().cloned().unwrap_or_default() } else { to };
                before.extend((!is_self).then_some(from));
                if exported {
                    self.exports.insert(name.clone());
                } else {
                    self.named.insert(before.clone());
                }
                self.imports.insert(name, before);
            }
        }
    }

    /// Paths among the tokens of a macro, which nobody parses.
    fn scan(&mut self, tokens: TokenStream) {
        let mut path: Segments = Vec::new();
        let mut joined = 2;
        for token in tokens {
            match token {
                TokenTree::Ident(ident) => {
                    if joined < 2 {
                        self.named.insert(std::mem::take(&mut path));
                    }
                    path.push(ident.to_string());
                    joined = 0;
                    continue;
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' && !path.is_empty() => {
                    joined += 1;
                    continue;
                }
                TokenTree::Group(group) => self.scan(group.stream()),
                _ => {}
            }
            self.named.insert(std::mem::take(&mut path));
            joined = 2;
        }
        self.named.insert(path);
    }
}
