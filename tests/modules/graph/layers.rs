//! The one table of layers and their uses.

/// Each layer with those that it may use.
pub(super) const LAYERS: &[(&str, &[&str])] = &[
    ("source", &[]),
    ("cas", &[]),
    // The parser reads the table of functions.
    ("model", &["cas", "source"]),
    ("plant", &["model", "cas", "source"]),
    ("analysis", &["plant", "cas", "source"]),
    ("search", &["analysis", "plant", "cas", "source"]),
    ("program", &["cas"]),
    ("emit", &["program", "analysis", "plant", "cas"]),
    ("report", &["program", "search", "analysis", "plant", "cas", "source"]),
    ("certificate", &["analysis", "plant", "model", "cas"]),
    // The settings of an observer, and its runs.
    ("lab", &["program", "analysis", "plant", "model", "cas", "source"]),
    // Its public face.
    ("simulate", &["lab"]),
    // Formulas typeset for a reader, with the sentences of the report.
    ("page", &["report", "emit", "analysis", "plant", "cas", "source"]),
    // From a source to an answer, and front ends.
    ("derived", &["emit", "lab", "search", "analysis", "plant", "model", "cas", "source"]),
    // A crate around the emitted code.
    ("c_face", &["derived", "emit", "lab", "analysis", "plant", "cas"]),
    (
        "answer",
        &[
            "c_face",
            "page",
            "derived",
            "emit",
            "report",
            "certificate",
            "lab",
            "search",
            "analysis",
            "plant",
            "model",
            "cas",
            "source",
        ],
    ),
    ("builder", &["derived", "emit", "cas", "source"]),
    ("cli", &["answer", "emit", "report", "simulate", "analysis", "model", "cas", "source"]),
];

/// A layer may use another one; the crate's root, which has no name, declares all.
pub(super) fn may_use(layer: &str, used: &str) -> bool {
    let allowed = LAYERS.iter().find(|(name, _)| *name == layer).map_or(&[][..], |(_, uses)| uses);
    layer == used || layer.is_empty() || allowed.contains(&used)
}

/// Foreign crates with the layers that may use them; all others are free.
const FOREIGN: &[(&str, &[&str])] = &[
    // Code that is written, and code that is read.
    ("quote", &["emit", "model"]),
    ("granit_parser", &["model"]),
    ("serde_yaml", &["model"]),
    ("annotate_snippets", &["source"]),
    ("csv_core", &["lab"]),
    ("dashu_int", &["cas"]),
    ("jiff", &["lab"]),
    // The emitter names it in the code it writes.
    ("pebo_runtime", &["lab", "emit"]),
    ("clap", &["cli"]),
];

/// A layer may use a foreign crate.
pub(super) fn may_link(layer: &str, name: &str) -> bool {
    FOREIGN.iter().all(|(foreign, layers)| *foreign != name || layers.contains(&layer))
}
