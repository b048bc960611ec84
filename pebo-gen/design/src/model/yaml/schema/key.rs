//! The columns of the table of keys: name, obligation, and the shape of the value.

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
    /// A list, or a single value in place of a list of one.
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
    /// A map with these keys, or a number in place of the first of them.
    NumberOr(&'static [Key]),
    /// A map with these keys, or a formula.
    FormulaOr(&'static [Key]),
    /// A matrix of formulas: rows, or a plain list, or a single one; the meaning of these depends on the size that is
    /// wanted.
    Matrix,
}

/// The effect of a key on the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// It must be there.
    Required,
    /// It may be there.
    Optional,
    /// A class: it replaces the keys that it gives.
    Class,
    /// It must be there unless a class is, which gives it.
    RequiredOrByClass,
    /// It may be there unless a class is, which gives it.
    OptionalOrByClass,
    /// It is searched for if it is not there, unless a class is, which gives it.
    SearchedOrByClass,
}

impl Role {
    /// Tests whether its value has at least one entry, if it is there.
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
    /// An example.
    pub(crate) example: &'static str,
    /// A description, in a line that editors show.
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
