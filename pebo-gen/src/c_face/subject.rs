//! What all files of the crate are written from: the plant, the emitted module, and the names on both sides.

use super::module::Module;
use super::samples::Samples;
use super::size::mentions;
use crate::emit::Scalar;
use pebo_design::plant::Plant;

/// What all files are written from.
pub(super) struct Face<'a> {
    pub(super) plant: &'a Plant,
    pub(super) scalar: Scalar,
    /// The emitted module.
    pub(super) module: Module,
    /// The name in front of all that the header declares.
    pub(super) prefix: String,
    pub(super) x: Vec<Signal>,
    pub(super) y: Vec<Signal>,
    pub(super) u: Vec<Signal>,
    pub(super) parameters: Vec<Signal>,
    /// The words of 64 bits that an observer takes at most.
    pub(super) words: usize,
    pub(super) samples: &'a Samples,
}

/// A field of a structure on both sides.
pub(super) struct Signal {
    /// Its name in C: the author's, if C has no other use for it.
    pub(super) c: String,
    /// Its name in the emitted module.
    pub(super) rust: String,
    /// Its name in the model.
    pub(super) written: String,
    pub(super) unit: Option<String>,
}

impl Face<'_> {
    /// A text with the names of this face for those between at signs.
    pub(super) fn filled(&self, template: &str, more: &[(&str, &str)]) -> String {
        let upper = self.prefix.to_uppercase();
        let words = self.words.to_string();
        let library = self.library();
        let own = [
            ("name", self.prefix.as_str()),
            ("NAME", &upper),
            ("model", &self.plant.name),
            ("version", env!("CARGO_PKG_VERSION")),
            ("scalar", self.scalar.name()),
            ("c_scalar", self.c_scalar()),
            ("words", &words),
            ("library", &library),
        ];
        let all = more.iter().chain(&own);
        all.fold(template.to_owned(), |text, (name, value)| text.replace(&format!("@{name}@"), value))
    }

    /// The name of the crate and of its library, in lower case as Rust wants it.
    pub(super) fn library(&self) -> String {
        format!("{}_observer", self.prefix.to_lowercase())
    }

    /// The floating-point type in C.
    pub(super) fn c_scalar(&self) -> &'static str {
        match self.scalar {
            Scalar::F32 => "float",
            Scalar::F64 => "double",
        }
    }

    /// A number as a literal of C, rounded to the scalar.
    pub(super) fn c_literal(&self, value: f64) -> String {
        match self.scalar {
            #[expect(clippy::cast_possible_truncation, reason = "rounded to the scalar of the face")]
            Scalar::F32 => format!("{:?}f", value as f32),
            Scalar::F64 => format!("{value:?}"),
        }
    }

    /// Tests whether the estimator has a covariance.
    pub(super) fn has_standard_error(&self) -> bool {
        let has = |name| mentions(&self.module.tuned, name);
        (has("LeastSquares") || has("AdaptiveLeastSquares")) && !has("Drem") && !has("FiniteTime")
    }

    /// Tests whether outputs arrive late.
    pub(super) fn is_late(&self) -> bool {
        mentions(&self.module.tuned, "LateObserver")
    }

    /// Tests whether the covariance is that of sensors.
    pub(super) fn is_sampled(&self) -> bool {
        mentions(&self.module.tuned, "SampledRegression")
    }
}
