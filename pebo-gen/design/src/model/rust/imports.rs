//! Resolves `use` declarations of the module, as far as they may be mathematical constants.

use syn::UseTree;

/// Names with their paths.
#[derive(Default)]
pub(super) struct Imports {
    /// A path and the name that it has here; the name of a glob is `*`.
    names: Vec<(Vec<String>, String)>,
}

impl Imports {
    /// Notes the names that a `use` declares.
    pub(super) fn read(&mut self, tree: &UseTree) {
        let mut waiting = vec![(Vec::new(), tree)];
        while let Some((path, tree)) = waiting.pop() {
            // `self` at the end is the module that the path names.
            let longer = |name: &syn::Ident| match name.to_string() {
                last if last == "self" => path.clone(),
                name => [path.as_slice(), &[name]].concat(),
            };
            match tree {
                UseTree::Path(inner) => waiting.push((longer(&inner.ident), &inner.tree)),
                UseTree::Group(group) => waiting.extend(group.items.iter().map(|item| (path.clone(), item))),
                UseTree::Name(name) => {
                    let path = longer(&name.ident);
                    self.names.extend(path.last().cloned().map(|last| (path, last)));
                }
                UseTree::Rename(name) => self.names.push((longer(&name.ident), name.rename.to_string())),
                UseTree::Glob(_) => self.names.push((path, "*".to_owned())),
            }
        }
    }

    /// The constant of the standard library that a path means: its name in `core::f64::consts`.
    pub(super) fn constant(&self, path: &syn::Path) -> Option<String> {
        let path: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        let (name, module) = path.split_last()?;
        if of_floats(module) {
            return Some(name.clone());
        }
        self.names.iter().find_map(|(whole, here)| match module {
            // `use core::f64::consts::PI`, perhaps by another name, or `use core::f64::consts::*`.
            [] if here == name => {
                whole.split_last().filter(|(_, module)| of_floats(module)).map(|(last, _)| last.clone())
            }
            [] if here == "*" && of_floats(whole) => Some(name.clone()),
            // `use core::f64::consts`, or `use core::f64`.
            [first] if here == first && of_floats(whole) => Some(name.clone()),
            _ => None,
        })
    }
}

/// Tests whether a path is that of the constants of a floating-point type.
fn of_floats(path: &[String]) -> bool {
    let path: Vec<&str> = path.iter().map(String::as_str).collect();
    matches!(path.as_slice(), ["core" | "std", "f64" | "f32", "consts"] | ["f64" | "f32", "consts"])
}
