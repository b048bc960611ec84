//! Words of a model file that choose one of a few values.

/// A value that a file chooses by a word.
pub(super) trait Choice: Sized + 'static {
    /// The words.
    const WORDS: &'static [&'static str];

    /// The value of a word.
    fn of_word(word: &str) -> Option<Self>;
}

/// An enumeration, a row a variant with its word.
macro_rules! choices {
    ($(#[$attribute:meta])* $visibility:vis enum $name:ident {
        $($(#[$of_variant:meta])* $variant:ident = $word:literal,)*
    }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $visibility enum $name { $($(#[$of_variant])* $variant,)* }

        impl $name {
            /// All of them, in the order of [`NAMES`](Self::NAMES).
            pub const ALL: [Self; Self::NAMES.len()] = [$(Self::$variant),*];

            /// Their names in a model.
            pub const NAMES: &[&str] = &[$($word),*];

            /// The one of that name.
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|one| one.name() == name)
            }

            /// Its name in a model.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $word),* }
            }
        }

        impl $crate::model::choice::Choice for $name {
            const WORDS: &'static [&'static str] = Self::NAMES;

            fn of_word(word: &str) -> Option<Self> {
                Self::from_name(word)
            }
        }
    };
}

pub(super) use choices;
