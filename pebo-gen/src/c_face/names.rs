//! C names for the author's names.
//!
//! In: any names of a model. Out: names that C99 and C++17 take, different from one another. An author's name is kept
//! where it is a name of C; names that differ by case alone are two names there. Letters beyond ASCII become their
//! number, as `x3bb`; a keyword, and a word that system headers define, gets a trailing `_`.

use std::collections::BTreeSet;

/// Keywords of C and C++, and objects that system headers or compilers define as macros.
const RESERVED: &[&str] = &[
    "EOF",
    "FAR",
    "INFINITY",
    "NAN",
    "NEAR",
    "NULL",
    "alignas",
    "alignof",
    "and",
    "and_eq",
    "asm",
    "auto",
    "bitand",
    "bitor",
    "bool",
    "break",
    "case",
    "catch",
    "char",
    "char16_t",
    "char32_t",
    "char8_t",
    "class",
    "co_await",
    "co_return",
    "co_yield",
    "compl",
    "complex",
    "concept",
    "const",
    "const_cast",
    "consteval",
    "constexpr",
    "constinit",
    "continue",
    "decltype",
    "default",
    "delete",
    "do",
    "double",
    "dynamic_cast",
    "else",
    "enum",
    "errno",
    "explicit",
    "export",
    "extern",
    "false",
    "far",
    "float",
    "for",
    "friend",
    "goto",
    "if",
    "imaginary",
    "inline",
    "int",
    "linux",
    "long",
    "mutable",
    "namespace",
    "near",
    "new",
    "noexcept",
    "not",
    "not_eq",
    "nullptr",
    "operator",
    "or",
    "or_eq",
    "private",
    "protected",
    "public",
    "register",
    "reinterpret_cast",
    "requires",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "static_assert",
    "static_cast",
    "stderr",
    "stdin",
    "stdout",
    "struct",
    "switch",
    "template",
    "this",
    "thread_local",
    "throw",
    "true",
    "try",
    "typedef",
    "typeid",
    "typename",
    "typeof",
    "typeof_unqual",
    "union",
    "unix",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "while",
    "xor",
    "xor_eq",
];

/// Names that a type or a file cannot have besides: headers and functions of the C library, and the root of a crate.
const LIBRARY: &[&str] = &[
    "abort",
    "abs",
    "acos",
    "asin",
    "assert",
    "atan",
    "atan2",
    "bsearch",
    "calloc",
    "cbrt",
    "ceil",
    "clock",
    "cos",
    "cosh",
    "ctype",
    "div",
    "erf",
    "exit",
    "exp",
    "fabs",
    "fenv",
    "floor",
    "fmod",
    "free",
    "gamma",
    "index",
    "inttypes",
    "iso646",
    "j0",
    "j1",
    "jn",
    "labs",
    "ldiv",
    "lib",
    "limits",
    "link",
    "locale",
    "log",
    "main",
    "malloc",
    "math",
    "memory",
    "modf",
    "pause",
    "pipe",
    "poll",
    "pow",
    "printf",
    "puts",
    "qsort",
    "raise",
    "rand",
    "read",
    "realloc",
    "remainder",
    "remove",
    "rename",
    "rewind",
    "rint",
    "round",
    "scanf",
    "select",
    "setjmp",
    "signal",
    "sin",
    "sinh",
    "sleep",
    "sqrt",
    "srand",
    "stat",
    "stdarg",
    "stdbool",
    "stddef",
    "stdint",
    "stdio",
    "stdlib",
    "string",
    "strings",
    "system",
    "tan",
    "tanh",
    "tgmath",
    "threads",
    "time",
    "trunc",
    "uchar",
    "wait",
    "wchar",
    "wctype",
    "write",
    "y0",
    "y1",
    "yn",
];

/// The name of a model in front of what its header declares.
pub(super) fn prefix(model: &str) -> String {
    let name = ascii(model);
    if RESERVED.contains(&name.as_str()) || LIBRARY.contains(&name.as_str()) { format!("{name}_plant") } else { name }
}

/// The names of the fields of a structure.
pub(super) fn field_names(written: &[String]) -> Vec<String> {
    let mut taken: BTreeSet<String> = BTreeSet::new();
    // A name that is kept as it is goes before one that becomes the same.
    let mut names = vec![String::new(); written.len()];
    let is_kept = |name: &String| ascii(name) == *name && !RESERVED.contains(&name.as_str());
    let (kept, changed): (Vec<usize>, Vec<usize>) = (0..written.len()).partition(|&place| is_kept(&written[place]));
    for place in kept.into_iter().chain(changed) {
        let name = ascii(&written[place]);
        let first = if RESERVED.contains(&name.as_str()) { format!("{name}_") } else { name.clone() };
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        let free = std::iter::once(first).chain(numbered).find(|name| !taken.contains(name));
        names[place] = free.unwrap_or(name);
        taken.insert(names[place].clone());
    }
    names
}

/// The name in letters, digits and `_`, which neither a digit nor `_` begins: C keeps such names to itself.
fn ascii(name: &str) -> String {
    let mut found = String::with_capacity(name.len());
    for letter in name.trim_start_matches('_').chars() {
        match letter {
            _ if letter.is_ascii_alphanumeric() || letter == '_' => found.push(letter),
            _ if letter.is_alphanumeric() => found.extend(format!("x{:x}", u32::from(letter)).chars()),
            _ => found.push('_'),
        }
    }
    match found.chars().next() {
        None => "it".to_owned(),
        Some(first) if first.is_ascii_digit() => format!("n{found}"),
        Some(_) => found,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(written: &[&str]) -> Vec<String> {
        field_names(&written.iter().copied().map(String::from).collect::<Vec<_>>())
    }

    #[test]
    fn an_authors_name_is_kept_where_c_has_no_other_use_for_it() {
        assert_eq!(names(&["L1", "nP", "R_s", "I", "match", "gen"]), ["L1", "nP", "R_s", "I", "match", "gen"]);
        assert_eq!(names(&["l", "L", "TL", "tl"]), ["l", "L", "TL", "tl"]);
    }

    #[test]
    fn keywords_and_names_that_become_alike_are_told_apart() {
        assert_eq!(names(&["double", "class", "unix", "_a", "__B"]), ["double_", "class_", "unix_", "a", "B"]);
        assert_eq!(names(&["_a", "a", "double", "double_"]), ["a_2", "a", "double_2", "double_"]);
        assert_eq!(names(&["λ", "x3bb", "_1", "_"]), ["x3bb_2", "x3bb", "n1", "it"]);
    }

    #[test]
    fn a_model_is_no_function_of_the_c_library() {
        assert_eq!(
            ["cuk", "math", "time", "lib", "float"].map(prefix),
            ["cuk", "math_plant", "time_plant", "lib_plant", "float_plant"]
        );
    }

    #[test]
    fn words_are_in_alphabetical_order_and_stand_once() {
        for list in [RESERVED, LIBRARY] {
            assert!(list.is_sorted_by(|a, b| a < b));
        }
    }
}
