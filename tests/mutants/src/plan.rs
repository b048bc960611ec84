//! The sources that are changed, and the tests that are to notice.

/// A package of the workspace.
pub struct Package {
    pub name: &'static str,
    /// Below the root.
    pub folder: &'static str,
    /// Arguments that build its tests, without features that the modules do not use.
    pub features: &'static [&'static str],
}

/// Tests of a package.
pub struct Tests {
    pub package: &'static Package,
    /// `lib`, or an integration test.
    pub target: &'static str,
    pub filter: &'static str,
}

/// A part of the project whose tests are judged.
pub struct Module {
    pub name: &'static str,
    /// The package that has the sources.
    pub package: &'static Package,
    /// Folders and files below the root; a folder with all that is in it, but for tests.
    pub sources: &'static [&'static str],
    /// The quick ones first.
    pub tests: &'static [Tests],
}

const CAS: &Package = &Package { name: "pebo-cas", folder: "pebo-gen/cas", features: &[] };
const DESIGN: &Package = &Package { name: "pebo-design", folder: "pebo-gen/design", features: &["--features", "yaml"] };
const GEN: &Package =
    &Package { name: "pebo-gen", folder: "pebo-gen", features: &["--no-default-features", "--features", "yaml"] };
const RUNTIME: &Package = &Package { name: "pebo-runtime", folder: "pebo-runtime", features: &[] };

/// The packages with sources, in the order in which they are changed.
pub const PACKAGES: [&Package; 3] = [CAS, DESIGN, RUNTIME];

const fn tests(package: &'static Package, target: &'static str, filter: &'static str) -> Tests {
    Tests { package, target, filter }
}

pub const MODULES: [Module; 4] = [
    Module {
        name: "tower",
        package: CAS,
        sources: &["pebo-gen/cas/src/tower"],
        tests: &[
            tests(CAS, "lib", "tower::"),
            tests(GEN, "zero", ""),
            tests(GEN, "claims", ""),
            tests(GEN, "signs", ""),
        ],
    },
    Module {
        name: "analysis",
        package: DESIGN,
        sources: &["pebo-gen/design/src/analysis"],
        tests: &[
            tests(DESIGN, "lib", "analysis::"),
            tests(GEN, "claims", ""),
            tests(GEN, "lib", "emit::"),
            tests(GEN, "classes", ""),
            tests(GEN, "places", ""),
        ],
    },
    Module {
        name: "program",
        package: DESIGN,
        sources: &["pebo-gen/design/src/program"],
        tests: &[tests(DESIGN, "lib", "program::"), tests(GEN, "lib", "emit::")],
    },
    Module {
        name: "runtime",
        package: RUNTIME,
        sources: &["pebo-runtime/src"],
        tests: &[tests(RUNTIME, "lib", ""), tests(RUNTIME, "runtime", "")],
    },
];
