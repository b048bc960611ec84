//! Which sources are changed, and which tests are to notice.

/// A part of the project whose tests are judged.
pub struct Module {
    pub name: &'static str,
    pub package: &'static str,
    /// Folders and files below the root; a folder with all that is in it, but for tests.
    pub sources: &'static [&'static str],
    /// Test binaries with a filter, the quick ones first.
    pub tests: &'static [(&'static str, &'static str)],
}

/// Packages in the order in which they are built.
pub const PACKAGES: &[&str] = &["pebo-gen", "pebo-runtime"];

pub const MODULES: [Module; 4] = [
    Module {
        name: "field",
        package: "pebo-gen",
        sources: &["pebo-gen/src/cas/field"],
        tests: &[("lib", "cas::field::"), ("zero", ""), ("claims", ""), ("signs", "")],
    },
    Module {
        name: "analysis",
        package: "pebo-gen",
        sources: &["pebo-gen/src/analysis"],
        tests: &[("lib", "analysis::"), ("claims", ""), ("lib", "emit::"), ("classes", ""), ("places", "")],
    },
    Module {
        name: "program",
        package: "pebo-gen",
        sources: &["pebo-gen/src/program"],
        tests: &[("lib", "program::"), ("lib", "emit::")],
    },
    Module {
        name: "runtime",
        package: "pebo-runtime",
        sources: &["pebo-runtime/src"],
        tests: &[("lib", ""), ("runtime", "")],
    },
];

/// How a package's tests are built: without what its modules do not use.
pub fn features(package: &str) -> &'static [&'static str] {
    match package {
        "pebo-gen" => &["--no-default-features", "--features", "yaml"],
        _ => &[],
    }
}
