//! The sources with the faults in them, and the switch.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::sites::{Fault, ORIGINAL};

/// The switch: one fault by its number, or none; and a list of those that were run through, on request.
const SWITCH: &str = r#"
/// The faults that can be switched on.
mod mutants {
    extern crate std;
    use std::string::ToString as _;
    use std::sync::OnceLock;
    use std::sync::atomic::{AtomicBool, Ordering};

    static ACTIVE: OnceLock<u32> = OnceLock::new();
    static TRACE: OnceLock<Option<std::string::String>> = OnceLock::new();
    static REACHED: [AtomicBool; 4096] = [const { AtomicBool::new(false) }; 4096];

    pub(crate) fn on(number: u32) -> bool {
        let active = ACTIVE.get_or_init(|| std::env::var("PEBO_MUTANT").map_or(0, |n| n.parse().unwrap_or(0)));
        if let Some(folder) = TRACE.get_or_init(|| std::env::var("PEBO_REACHED").ok())
            && !REACHED[number as usize].swap(true, Ordering::Relaxed)
        {
            let _ = std::fs::write(std::path::Path::new(folder).join(number.to_string()), "");
        }
        *active == number
    }
}
"#;

/// Writes the files with their faults, from the texts of `from` to the copy, and the switch into the package's root.
pub fn write(from: &Path, to: &Path, package: &str, files: &[PathBuf], faults: &[Fault]) -> Result<(), String> {
    let mut files: BTreeMap<&Path, Vec<&Fault>> = files.iter().map(|file| (file.as_path(), Vec::new())).collect();
    for fault in faults {
        files.entry(&fault.file).or_default().push(fault);
    }
    let root = Path::new(package).join("src/lib.rs");
    files.entry(&root).or_default();
    for (path, mut faults) in files {
        let place = from.join(path);
        let mut text = std::fs::read_to_string(&place).map_err(|error| format!("{}: {error}", place.display()))?;
        faults.sort_by_key(|fault| std::cmp::Reverse(fault.place.start));
        for fault in faults {
            let original = text[fault.place.clone()].to_owned();
            let number = fault.number.to_string();
            let instead = fault.instead.replacen('@', &number, 1).replace(ORIGINAL, &original);
            // Lines stay where they are, so that a message of the compiler names the line of the fault.
            let added = instead.matches('\n').count() - original.matches('\n').count();
            let flat = if added > 0 { flatten(&instead, &original) } else { instead };
            text.replace_range(fault.place.clone(), &flat);
        }
        if path == root {
            text.push_str(SWITCH);
        }
        std::fs::write(to.join(path), text).map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// The faulty part on one line, the original as it was.
fn flatten(instead: &str, original: &str) -> String {
    let (faulty, rest) = instead.split_at(instead.rfind(original).unwrap_or(0));
    let lines = faulty.lines().map(|line| line.split("//").next().unwrap_or(line));
    lines.collect::<Vec<_>>().join(" ") + rest
}
