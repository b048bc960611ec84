//! `pebo-gen explain`: the explanation of a diagnostic.

use crate::Standing;
use crate::source::{Code, nearest};

use super::arguments::ExplainOptions;
use super::{standard, terminal};

pub(super) fn run(options: &ExplainOptions) -> Standing {
    let Some(code) = Code::from_name(&options.code) else {
        let names = Code::ALL.iter().map(|code| code.name());
        let help = match nearest(&options.code, names) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the codes are {}", Code::ALL.iter().map(|c| c.name()).collect::<Vec<_>>().join(", ")),
        };
        terminal::say(&format!("error: there is no diagnostic `{}`\n  = help: {help}\n", options.code));
        return Standing::Malformed;
    };
    standard::print(story(code).as_bytes())
}

/// Title, explanation, example, and reference to the paper.
fn story(code: Code) -> String {
    let example = code.example().lines().map(|line| format!("    {line}")).collect::<Vec<_>>().join("\n");
    let paper = code.paper().map_or_else(String::new, |place| format!("\nIn Ortega et al. 2015: {place}.\n"));
    format!(
        "{}: {}\n\n{}\n\nExample, with what to do instead:\n\n{example}\n{paper}",
        code.name(),
        code.title(),
        code.explanation()
    )
}
