//! Keys as files are read by them: name, obligation, and the shape of the value.

/// The shape that a value must have.
#[derive(Clone, Copy, Debug)]
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
    /// True if its formulas may have estimates, as `hat(x)`.
    pub(crate) hat: bool,
    /// An example.
    pub(crate) example: &'static str,
    /// A description, in a line that editors show.
    pub(crate) about: &'static str,
}

impl Key {
    /// A key that may be there.
    pub(crate) const fn new(name: &'static str, shape: Shape, example: &'static str, about: &'static str) -> Self {
        Self { name, role: Role::Optional, shape, hat: false, example, about }
    }

    pub(crate) const fn role(self, role: Role) -> Self {
        Self { role, ..self }
    }

    pub(crate) const fn required(self) -> Self {
        self.role(Role::Required)
    }

    pub(crate) const fn hat(self) -> Self {
        Self { hat: true, ..self }
    }

    /// A list may also be written as its only item.
    pub(crate) const fn or_one(self) -> Self {
        let shape = if let Shape::List(item) = self.shape { Shape::OneOrMore(item) } else { self.shape };
        Self { shape, ..self }
    }

    /// A section may also be written as the number under its first key.
    pub(crate) const fn or_number(self) -> Self {
        let shape = if let Shape::Record(keys) = self.shape { Shape::NumberOr(keys) } else { self.shape };
        Self { shape, ..self }
    }
}
