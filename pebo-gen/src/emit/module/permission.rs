//! Lints that a model's own names, numbers or size would trip: allowed where they do, with the reason.

use proc_macro2::TokenStream;
use quote::quote;

use crate::emit::literal::{Scalar, significant};
use pebo_cas::Rational;

/// For literals with more digits than the scalar shows.
pub(in crate::emit) fn for_numbers(scalar: Scalar, numbers: impl IntoIterator<Item = Rational>) -> Option<TokenStream> {
    let long = numbers.into_iter().any(|number| significant(&number) > scalar.digits());
    long.then(|| {
        quote! {
            #[allow(
                clippy::excessive_precision,
                reason = "exact numbers of the model, rounded by the compiler"
            )]
        }
    })
}

/// For variables with names of one letter, and for names that differ in a letter.
pub(in crate::emit) fn for_names(names: &[String]) -> Option<TokenStream> {
    /// Clippy takes four; two arguments have names of one letter.
    const MOST_LETTERS: usize = 2;
    let letters = names.iter().filter(|name| name.chars().count() == 1).count();
    let similar = |a: &String, b: &String| {
        let mut differing = a.chars().zip(b.chars()).filter(|(a, b)| a != b);
        let first = differing.next().is_some_and(|(a, b)| !a.is_numeric() && !b.is_numeric());
        a.len() == b.len() && a.len() > 2 && first && differing.next().is_none()
    };
    let alike = names.iter().enumerate().any(|(i, a)| names[..i].iter().any(|b| similar(a, b)));
    let lints: Vec<TokenStream> = [
        (letters > MOST_LETTERS).then(|| quote!(clippy::many_single_char_names)),
        alike.then(|| quote!(clippy::similar_names)),
    ]
    .into_iter()
    .flatten()
    .collect();
    (!lints.is_empty()).then(|| quote!(#[allow(#(#lints,)* reason = "the names of the model")]))
}

/// For fields that share their first or last word, or begin or end with the name of their structure.
pub(in crate::emit) fn for_fields(structure: &str, names: &[String]) -> Option<TokenStream> {
    /// Clippy looks at structures of so many fields.
    const FEWEST: usize = 3;
    let structure = structure.to_lowercase();
    let words: Vec<(&str, &str)> = names
        .iter()
        .map(|name| (name.split('_').next().unwrap_or(name), name.rsplit('_').next().unwrap_or(name)))
        .collect();
    let shared = words.iter().all(|word| word.0 == words[0].0) || words.iter().all(|word| word.1 == words[0].1);
    let own = words.iter().any(|&(first, last)| first == structure || last == structure);
    (names.len() >= FEWEST && (shared || own))
        .then(|| quote!(#[allow(clippy::struct_field_names, reason = "the names of the model")]))
}

/// For functions that may exceed a hundred lines.
pub(in crate::emit) fn for_length(lines: usize) -> Option<TokenStream> {
    /// A statement may take more than one line.
    const MOST_LINES: usize = 40;
    (lines > MOST_LINES).then(|| {
        quote! {
            #[allow(clippy::too_many_lines, reason = "straight-line code")]
        }
    })
}

/// For methods of the model that not every program calls: of so many constants, and with so many numbers in an argument
/// at most.
pub(in crate::emit) fn for_methods(constants: usize, longest: usize) -> TokenStream {
    /// Clippy wants values that are no larger than a pointer themselves; these are, in single precision.
    const MOST_CONSTANTS: usize = 2;
    /// The lint wants values of more than 256 bytes, in double precision, by reference.
    const MOST_NUMBERS: usize = 32;
    let lints: Vec<TokenStream> = [
        (longest > MOST_NUMBERS).then(|| quote!(clippy::large_types_passed_by_value)),
        (constants <= MOST_CONSTANTS).then(|| quote!(clippy::trivially_copy_pass_by_ref)),
    ]
    .into_iter()
    .flatten()
    .collect();
    quote!(#[allow(#(#lints,)* dead_code, reason = "one interface for all models, called or not")])
}
