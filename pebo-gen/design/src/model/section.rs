//! The table of keys: sections of a model file, a row a key.
//!
//! A row has the name, the type of the value, an example, and what it means. Behind these stand notes on how a file may
//! write it (the methods of `yaml::key::Key`), and behind `=>` what is checked of it (those of [`Row`]). The struct with
//! its documentation, the reading of files with the diagnostics on the shape of values, the checks, the JSON schema, the
//! manual's tables and the names of settings of a call follow from the rows.

use super::choice::Choice;
use super::formula::{Comparison, Decimal, Formula};
use super::spanned::{Entry, Spanned};

/// A number that may be left out.
pub(super) type Number = Option<Spanned<Decimal>>;
/// A list of numbers.
pub(super) type Numbers = Vec<Spanned<Decimal>>;
/// A number for each of some names.
pub(super) type Each = Vec<Entry<Spanned<Decimal>>>;
/// A text that may be left out.
pub(super) type Text = Option<Spanned<String>>;
/// A formula for each of some names.
pub(super) type Formulas = Vec<Entry<Formula>>;

macro_rules! section {
    (@name $field:ident $key:literal) => { $key };
    (@name $field:ident) => { stringify!($field) };
    ($(#[$attribute:meta])* $visibility:vis struct $name:ident {
        $($field:ident $(as $key:literal)?: $type:ty, $example:literal, $about:literal
        $(, $note:ident($($value:expr)?))* $(=> $($check:ident($($argument:expr),*)),+)?;)*
    }) => {
        $(#[$attribute])*
        #[derive(Clone, Debug, Default, PartialEq)]
        $visibility struct $name { $(#[doc = concat!($about, ".")] $visibility $field: $type,)* }

        impl $crate::model::section::Value for $name {
            fn rows(&self) -> Vec<$crate::model::section::Row<'_>> {
                vec![$(
                    $crate::model::section::Row::new(
                        $crate::model::section::section!(@name $field $($key)?), &self.$field
                    )$($(.$check($($argument),*))+)?
                ),*]
            }
        }

        #[cfg(feature = "yaml")]
        impl $crate::model::yaml::Section for $name {
            const KEYS: &'static [$crate::model::yaml::Key] = &[$(
                $crate::model::yaml::Key::new(
                    $crate::model::section::section!(@name $field $($key)?),
                    <$type as $crate::model::yaml::Read>::SHAPE,
                    $example,
                    $about,
                )$(.$note($($value)?))*
            ),*];
        }

        #[cfg(feature = "yaml")]
        impl $crate::model::yaml::Read for $name {
            const SHAPE: $crate::model::yaml::Shape =
                $crate::model::yaml::Shape::Record(<Self as $crate::model::yaml::Section>::KEYS);

            fn read<'a>(
                node: &'a $crate::model::yaml::Node,
                shape: &'static $crate::model::yaml::Shape,
                reader: &mut $crate::model::yaml::Reader<'a>,
            ) -> Option<Self> {
                let mut section = Self::default();
                reader.section(node, shape, &mut |key, node, reader| match key.name {
                    $(name if name == $crate::model::section::section!(@name $field $($key)?) => {
                        reader.fill(&mut section.$field, node, &key.shape);
                    })*
                    _ => {}
                })?;
                Some(section)
            }
        }
    };
}

pub(super) use section;

/// A value behind a key, as the checks see it.
pub(super) trait Value {
    /// The names in it, if it is a map from names.
    fn names(&self) -> Vec<&Spanned<String>> {
        Vec::new()
    }

    /// The numbers in it; of a map from names to numbers one for each name.
    fn numbers(&self) -> Vec<&Spanned<Decimal>> {
        Vec::new()
    }

    /// The rows below it, if it is a section.
    fn rows(&self) -> Vec<Row<'_>> {
        Vec::new()
    }

    /// The value under a key of the section.
    fn row(&self, key: &str) -> Option<&dyn Value> {
        self.rows().into_iter().find(|row| row.key == key).map(|row| row.value)
    }
}

/// A key with its value and what is checked of it.
pub(super) struct Row<'a> {
    pub(super) key: &'static str,
    pub(super) value: &'a dyn Value,
    /// The names that entries may be for; any if absent.
    pub(super) names: Option<Names>,
    /// The range of its numbers; any if absent.
    pub(super) limit: Option<Limit>,
}

/// Names of the model that entries of a map are for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Names {
    X,
    Y,
    XOrY,
    U,
    YOrU,
    ParameterOrX,
    Signal,
}

/// A range of numbers, and the diagnostic for one that is outside. In the message, `<name>` is the name in the map.
#[derive(Clone, Copy)]
pub(super) struct Limit {
    pub(super) admits: fn(f64) -> bool,
    pub(super) message: &'static str,
    pub(super) help: &'static str,
}

impl<'a> Row<'a> {
    pub(super) fn new(key: &'static str, value: &'a dyn Value) -> Self {
        Self { key, value, names: None, limit: None }
    }

    /// Entries are for these names.
    pub(super) fn of(self, names: Names) -> Self {
        Self { names: Some(names), ..self }
    }

    /// Numbers are in this range.
    pub(super) fn within(self, admits: fn(f64) -> bool, message: &'static str, help: &'static str) -> Self {
        Self { limit: Some(Limit { admits, message, help }), ..self }
    }

    pub(super) fn positive(self, message: &'static str) -> Self {
        self.within(|value| value > 0.0, message, "write a number above zero")
    }

    pub(super) fn not_negative(self, message: &'static str, help: &'static str) -> Self {
        self.within(|value| value >= 0.0, message, help)
    }

    /// Numbers are standard deviations of what may be exact.
    pub(super) fn deviation(self) -> Self {
        self.not_negative("a standard deviation must not be negative", "write 0 for none")
    }

    /// Numbers are delays.
    pub(super) fn late(self) -> Self {
        self.not_negative("a delay must not be negative", "write 0 for none")
    }

    /// Numbers are numbers of samples.
    pub(super) fn count(self, message: &'static str, help: &'static str) -> Self {
        let admits = |value: f64| value >= 1.0 && value.fract() == 0.0 && value <= f64::from(u32::MAX);
        self.within(admits, message, help)
    }
}

impl Value for Spanned<String> {}
impl Value for Formula {}
impl Value for Comparison {}
impl<T: Choice> Value for Spanned<T> {}

impl Value for Spanned<Decimal> {
    fn numbers(&self) -> Vec<&Spanned<Decimal>> {
        vec![self]
    }
}

impl<T: Value> Value for Option<T> {
    fn numbers(&self) -> Vec<&Spanned<Decimal>> {
        self.iter().flat_map(Value::numbers).collect()
    }

    fn rows(&self) -> Vec<Row<'_>> {
        self.iter().flat_map(Value::rows).collect()
    }
}

impl<T: Value> Value for Vec<T> {
    fn numbers(&self) -> Vec<&Spanned<Decimal>> {
        self.iter().flat_map(Value::numbers).collect()
    }

    fn rows(&self) -> Vec<Row<'_>> {
        self.iter().flat_map(Value::rows).collect()
    }
}

impl<T: Value> Value for Vec<Entry<T>> {
    fn names(&self) -> Vec<&Spanned<String>> {
        self.iter().map(|entry| &entry.name).collect()
    }

    fn numbers(&self) -> Vec<&Spanned<Decimal>> {
        self.iter().flat_map(|entry| entry.value.numbers()).collect()
    }

    fn rows(&self) -> Vec<Row<'_>> {
        self.iter().flat_map(|entry| entry.value.rows()).collect()
    }
}
