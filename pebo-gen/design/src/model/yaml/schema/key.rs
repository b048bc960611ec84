//! What the table of keys says of each: its name, whether it must be there, and the shape of its value.

/// The shape that a value must have.
#[derive(Debug)]
pub(crate) enum Shape {
    /// Any scalar. Names are texts here: whether they are names is checked where they are declared.
    Text,
    /// A decimal.
    Number,
    /// A formula or a comparison; parsed later.
    Formula,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A list of values of one shape.
    List(&'static Shape),
    /// A list, or a single value that stands for a list of one.
    OneOrMore(&'static Shape),
    /// A map from names to values of one shape.
    Map(&'static Shape),
    /// A map from names to numbers or nothing, or a list of names.
    Parameters,
    /// A formula, or a map from start times to formulas.
    Signal,
    /// A number for all names, or a map from names to numbers.
    AllOrEach,
    /// A map from names to values, of one shape but for these names.
    Kinds(&'static [Key], &'static Shape),
    /// A map with these keys.
    Record(&'static [Key]),
    /// A map with these keys, or a number, which stands for the first of them.
    NumberOr(&'static [Key]),
    /// A matrix of formulas: rows, or a plain list, or a single one; what these stand for depends on
    /// the size that is wanted.
    Matrix,
}

/// What the presence of a key means for the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// It must be there.
    Required,
    /// It may be there.
    Optional,
    /// It stands for the keys that a class gives.
    Class,
    /// It must be there unless a class is, which gives it.
    RequiredOrByClass,
    /// It may be there unless a class is, which gives it.
    OptionalOrByClass,
    /// It is searched for if it is not there, unless a class is, which gives it.
    SearchedOrByClass,
}

impl Role {
    /// Whether its value has at least one entry, if it is there.
    pub(crate) fn is_filled(self) -> bool {
        matches!(self, Self::Required | Self::RequiredOrByClass | Self::SearchedOrByClass)
    }
}

/// A key of a record.
#[derive(Debug)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) role: Role,
    pub(crate) shape: Shape,
    /// How to write it.
    pub(crate) example: &'static str,
    /// What it is, in a line that editors show.
    pub(crate) about: &'static str,
}

pub(super) const fn key(
    role: Role,
    name: &'static str,
    shape: Shape,
    (example, about): (&'static str, &'static str),
) -> Key {
    Key { name, role, shape, example, about }
}

pub(super) const fn required(name: &'static str, shape: Shape, example: &'static str, about: &'static str) -> Key {
    key(Role::Required, name, shape, (example, about))
}

pub(super) const fn optional(name: &'static str, shape: Shape, example: &'static str, about: &'static str) -> Key {
    key(Role::Optional, name, shape, (example, about))
}
