//! `pebo-gen explain`: the longer story of a diagnostic.

use std::io::Write as _;

use pebo_gen::source::{Code, nearest};

use super::arguments::ExplainOptions;
use super::{Ending, terminal};

pub(super) fn run(options: &ExplainOptions) -> Ending {
    let Some(code) = Code::from_name(&options.code) else {
        let names = Code::ALL.iter().map(|code| code.name());
        let help = match nearest(&options.code, names) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the codes are {}", Code::ALL.iter().map(|c| c.name()).collect::<Vec<_>>().join(", ")),
        };
        terminal::say(&format!("error: there is no diagnostic `{}`\n  = help: {help}\n", options.code));
        return Ending::Malformed;
    };
    let _ = writeln!(std::io::stdout().lock(), "{}: {}\n\n{}", code.name(), code.title(), code.explanation());
    Ending::Accepted
}
