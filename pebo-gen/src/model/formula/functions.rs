//! The functions that formulas may call.

/// A function of the expression language.
#[derive(Debug, PartialEq, Eq)]
pub struct Function {
    /// Its name in formulas.
    pub name: &'static str,
    /// The number of its arguments.
    pub arguments: usize,
}

const fn row(name: &'static str, arguments: usize) -> Function {
    Function { name, arguments }
}

/// All of them. What they mean is in the algebra's own table, which this layer cannot see; a test
/// of the crate holds the two against each other.
pub const FUNCTIONS: &[Function] = &[
    row("sin", 1),
    row("cos", 1),
    row("tan", 1),
    row("asin", 1),
    row("acos", 1),
    row("atan", 1),
    row("atan2", 2),
    row("sinh", 1),
    row("cosh", 1),
    row("tanh", 1),
    row("exp", 1),
    row("log", 1),
    row("sqrt", 1),
    row("abs", 1),
];

/// Second names: `ln` is `log`.
const ALIASES: &[(&str, &str)] = &[("ln", "log")];

impl Function {
    /// The function called `name`.
    pub fn named(name: &str) -> Option<&'static Self> {
        let name = ALIASES.iter().find(|(alias, _)| *alias == name).map_or(name, |(_, name)| name);
        FUNCTIONS.iter().find(|function| function.name == name)
    }

    /// Every name that a function can be called by.
    pub(super) fn names() -> impl Iterator<Item = &'static str> {
        let aliases = ALIASES.iter().map(|(alias, _)| *alias);
        FUNCTIONS.iter().map(|function| function.name).chain(aliases)
    }
}
