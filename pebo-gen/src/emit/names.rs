//! Rust names for the author's names.
//!
//! In: any name of a model. Out: a name that rustc takes without a warning, different from every
//! other of its scope. The rules, in order:
//!
//! 1. lower case, with `_` where a capital follows a small letter or a digit: `L1` is `l1`, `nP` is `n_p`;
//! 2. characters that no Rust name may contain become `_`, and `_` neither leads, trails nor repeats;
//! 3. a name of more than [`LONGEST_WRITTEN`] characters loses words before its last, as many as it takes;
//! 4. a keyword, and a name that the emitted code uses itself (`y`, `self`), gets a trailing `_`: `type_`;
//! 5. a name that is taken gets the first free number from 2; of names that differ in case alone, the one that is
//!    written as Rust writes it is kept: `TL` and `tl` are `tl_2` and `tl`, whichever comes first.

use std::collections::BTreeSet;

/// No name that is made of formulas is longer.
pub(super) const LONGEST: usize = 20;

/// The most characters of the author's own names, so that a line holds the product of two parameters.
const LONGEST_WRITTEN: usize = 28;

/// The same for the model's type.
const LONGEST_TYPE: usize = 40;

/// Strict and reserved keywords of the 2024 edition, and the names that functions of the runtime's
/// `Model` give their arguments.
const RESERVED: [&str; 62] = [
    "abstract",
    "as",
    "async",
    "await",
    "become",
    "box",
    "break",
    "const",
    "continue",
    "crate",
    "do",
    "dyn",
    "else",
    "enum",
    "eta",
    "extension",
    "extern",
    "f32",
    "f64",
    "false",
    "final",
    "fn",
    "for",
    "gen",
    "if",
    "impl",
    "in",
    "let",
    "loop",
    "macro",
    "match",
    "mod",
    "move",
    "mut",
    "override",
    "parameters",
    "priv",
    "pub",
    "ref",
    "return",
    "self",
    "static",
    "struct",
    "super",
    "terms",
    "trait",
    "true",
    "try",
    "type",
    "typeof",
    "u",
    "union",
    "unsafe",
    "unsized",
    "use",
    "usize",
    "virtual",
    "where",
    "while",
    "y",
    "yield",
    "z",
];

/// Names that an emitted module declares or imports, and those of the prelude and of the trait's items that it uses.
pub(super) const TYPES: [&str; 63] = [
    "AdaptiveLeastSquares",
    "Bounded",
    "Default",
    "Drem",
    "Drift",
    "E",
    "Err",
    "Extension",
    "Fault",
    "Filter",
    "FiniteTime",
    "Flow",
    "From",
    "Functions",
    "Fundamental",
    "Gate",
    "Gradient",
    "Hold",
    "INSTANTS",
    "Integrator",
    "Kreisselmeier",
    "LeastSquares",
    "Limits",
    "Model",
    "NE",
    "NI",
    "NO",
    "NR",
    "NU",
    "NW",
    "NX",
    "NY",
    "NZ",
    "None",
    "NormalisedGradient",
    "Observer",
    "Ok",
    "Option",
    "OutputForm",
    "OutputSlopes",
    "PI",
    "Parameters",
    "REGRESSION",
    "ROWS",
    "Real",
    "Rebase",
    "Regression",
    "Response",
    "Result",
    "SMatrix",
    "SVector",
    "SampledRegression",
    "Scalar",
    "Self",
    "Sides",
    "Some",
    "Terms",
    "Tuned",
    "U",
    "WindowedRegression",
    "Within",
    "X",
    "Y",
];

/// The names of one scope.
#[derive(Clone, Debug, Default)]
pub(super) struct Names {
    taken: BTreeSet<String>,
}

impl Names {
    /// A name like the wanted one that nothing else in the scope has.
    pub(super) fn claim(&mut self, wanted: &str) -> String {
        let base = snake(wanted);
        let reserved = RESERVED.contains(&base.as_str());
        let first = if reserved { format!("{base}_") } else { base.clone() };
        if self.taken.insert(first.clone()) { first } else { self.first_free(&format!("{base}_"), 2) }
    }

    /// A name for each of the wanted ones, in their order.
    pub(super) fn claim_all(&mut self, wanted: &[String]) -> Vec<String> {
        let mut claimed = vec![String::new(); wanted.len()];
        let (alike, changed): (Vec<usize>, Vec<usize>) =
            (0..wanted.len()).partition(|&index| snake(&wanted[index]) == wanted[index]);
        for index in alike.into_iter().chain(changed) {
            claimed[index] = self.claim(&wanted[index]);
        }
        claimed
    }

    /// The stem with the first free number.
    pub(super) fn number(&mut self, stem: &str) -> String {
        self.first_free(stem, 1)
    }

    fn first_free(&mut self, stem: &str, from: usize) -> String {
        let mut number = from;
        loop {
            let name = format!("{stem}{number}");
            if self.taken.insert(name.clone()) {
                return name;
            }
            number += 1;
        }
    }
}

/// The name in snake case, cut to the greatest length.
pub(super) fn snake(name: &str) -> String {
    cut(name, LONGEST_WRITTEN)
}

fn cut(name: &str, longest: usize) -> String {
    let mut snake = String::with_capacity(name.len() + 2);
    let mut before = '_';
    for c in name.chars() {
        let starts_word = c.is_uppercase() && (before.is_lowercase() || before.is_numeric());
        if starts_word {
            snake.push('_');
        }
        if c.is_alphanumeric() {
            snake.extend(c.to_lowercase().filter(|lower| lower.is_alphanumeric()));
        } else if !snake.ends_with('_') {
            snake.push('_');
        }
        before = c;
    }
    // Long names differ as a rule at the end, as by the phase in `stator_resistance_of_the_winding_a`.
    let mut words: Vec<&str> = snake.split('_').filter(|word| !word.is_empty()).collect();
    while words.len() > 2 && words.join("_").chars().count() > longest {
        words.remove(words.len() - 2);
    }
    let cut: String = words.join("_").chars().take(longest).collect();
    let cut = cut.trim_end_matches('_');
    if cut.is_empty() {
        "it".to_owned()
    } else if cut.starts_with(char::is_numeric) {
        format!("n{cut}")
    } else {
        cut.to_owned()
    }
}

/// The name of the model's type: camel case, and never the name of another type in the module.
pub(super) fn camel(name: &str) -> String {
    let mut camel = String::with_capacity(name.len());
    for word in cut(name, LONGEST_TYPE).split('_') {
        let mut letters = word.chars();
        camel.extend(letters.next().into_iter().flat_map(char::to_uppercase));
        camel.extend(letters);
    }
    if TYPES.contains(&camel.as_str()) { format!("{camel}Plant") } else { camel }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_snake_case() {
        for (name, expected) in [
            ("L1", "l1"),
            ("nP", "n_p"),
            ("R_s", "r_s"),
            ("__x", "x"),
            ("_", "it"),
            ("LambdaM", "lambda_m"),
            ("iL1", "i_l1"),
            ("E", "e"),
            ("a__b", "a_b"),
            ("stator_resistance_of_phase_a", "stator_resistance_of_phase_a"),
            ("stator_resistance_of_the_winding_a", "stator_resistance_of_the_a"),
            ("stator_resistance_of_the_winding_b", "stator_resistance_of_the_b"),
        ] {
            assert_eq!(snake(name), expected, "{name}");
        }
    }

    #[test]
    fn keywords_and_clashes_get_suffixes() {
        let mut names = Names::default();
        let claimed = ["v", "V", "type", "Type", "gen", "y", "self", "fn", "v_2"];
        let claimed = claimed.map(|name| names.claim(name));
        assert_eq!(claimed, ["v", "v_2", "type_", "type_2", "gen_", "y_", "self_", "fn_", "v_2_2"]);
    }

    #[test]
    fn of_names_that_differ_in_case_alone_the_one_in_snake_case_stays() {
        let claimed = |wanted: &[&str]| {
            let wanted: Vec<String> = wanted.iter().copied().map(String::from).collect();
            Names::default().claim_all(&wanted)
        };
        assert_eq!(claimed(&["TL", "tl"]), ["tl_2", "tl"]);
        assert_eq!(claimed(&["tl", "TL", "Tl"]), ["tl", "tl_2", "tl_3"]);
        assert_eq!(claimed(&["V", "I"]), ["v", "i"]);
        assert_eq!(claimed(&["V", "v_2", "v"]), ["v_3", "v_2", "v"]);
    }

    #[test]
    fn every_claimed_name_is_an_identifier() {
        let mut names = Names::default();
        for reserved in RESERVED {
            assert!(syn::parse_str::<syn::Ident>(&names.claim(reserved)).is_ok(), "{reserved}");
        }
    }

    #[test]
    fn type_names_are_camel_case() {
        assert_eq!(camel("cuk"), "Cuk");
        assert_eq!(camel("cuk_case2"), "CukCase2");
        assert_eq!(camel("observer"), "ObserverPlant");
        assert_eq!(camel("tuned"), "TunedPlant");
        assert_eq!(camel("PMSM"), "Pmsm");
        assert_eq!(["gate", "from", "n_x"].map(camel), ["GatePlant", "FromPlant", "NXPlant"]);
    }
}
