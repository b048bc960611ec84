//! Signs of values throughout a domain.

/// The sign of a value throughout a domain.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::tower) enum Sign {
    /// Greater than zero.
    Positive,
    /// Greater than or equal to zero.
    NonNegative,
    /// Zero.
    Zero,
    /// Less than zero.
    Negative,
}

impl Sign {
    pub(in crate::tower) fn is_positive_or_zero(self) -> bool {
        self != Self::Negative
    }

    /// The sign of the negated value, where there is one for it.
    pub(in crate::tower) fn negated(self) -> Option<Self> {
        match self {
            Self::Positive => Some(Self::Negative),
            Self::Negative => Some(Self::Positive),
            Self::Zero => Some(Self::Zero),
            Self::NonNegative => None,
        }
    }

    pub(in crate::tower) fn times(self, other: Self) -> Option<Self> {
        match (self, other) {
            (Self::Zero, _) | (_, Self::Zero) => Some(Self::Zero),
            (Self::Positive, sign) | (sign, Self::Positive) => Some(sign),
            (Self::Negative, Self::Negative) => Some(Self::Positive),
            (Self::NonNegative, Self::NonNegative) => Some(Self::NonNegative),
            _ => None,
        }
    }
}
