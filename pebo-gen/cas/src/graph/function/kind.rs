//! The functions of the expression language, one by one.

/// A function of the expression language.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Function {
    /// Sine of an angle in radians.
    Sin,
    /// Cosine of an angle in radians.
    Cos,
    /// Tangent of an angle in radians.
    Tan,
    /// Inverse sine on [-1, 1].
    Asin,
    /// Inverse cosine on [-1, 1].
    Acos,
    /// Inverse tangent.
    Atan,
    /// Angle of the point (second argument, first argument), in (-pi, pi].
    Atan2,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// Inverse hyperbolic sine.
    Asinh,
    /// Inverse hyperbolic cosine, not negative.
    Acosh,
    /// Inverse hyperbolic tangent.
    Atanh,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Log,
    /// Positive square root; kept as a power in the graph.
    Sqrt,
    /// Absolute value.
    Abs,
    /// 1 of a positive argument, -1 of a negative one.
    Sign,
    /// The smaller of two.
    Min,
    /// The larger of two.
    Max,
    /// Saturation at -1 and 1.
    Sat,
    /// A table of the first argument, whose points are the others.
    Table,
}
