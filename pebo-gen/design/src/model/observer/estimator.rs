//! The estimators of the runtime library, with their settings.

use crate::model::choice::choices;

choices! {
    /// The estimators of the runtime library.
    #[derive(Default)]
    #[cfg_attr(feature = "yaml", derive(serde::Deserialize), serde(rename_all = "kebab-case"))]
    pub enum Estimator {
        /// The paper's.
        #[default]
        Gradient = "gradient",
        /// The same, of a speed that does not depend on the size of the regressor.
        NormalisedGradient = "normalised-gradient",
        /// With forgetting and bounded covariance.
        LeastSquares = "least-squares",
        /// On Kreisselmeier's regressor extension.
        Drem = "drem",
        /// The same, exact after a finite time.
        FiniteTimeDrem = "finite-time-drem",
        /// On the response of a gradient.
        GradientDrem = "gradient-drem",
        /// On the response of least squares.
        LeastSquaresDrem = "least-squares-drem",
    }
}

impl Estimator {
    /// The settings without which it cannot run.
    pub fn needs(self) -> &'static [&'static str] {
        match self {
            Self::Gradient => &["gain"],
            Self::NormalisedGradient => &["gain", "normalisation"],
            Self::LeastSquares => &["covariance"],
            Self::Drem | Self::GradientDrem => &["gain", "regressor_gain"],
            Self::FiniteTimeDrem => &["gain", "regressor_gain", "clip"],
            Self::LeastSquaresDrem => &["gain", "covariance"],
        }
    }

    /// The settings that it may have besides.
    pub fn admits(self) -> &'static [&'static str] {
        match self {
            Self::Gradient | Self::NormalisedGradient | Self::GradientDrem => &[],
            Self::LeastSquares => &["forgetting", "process_noise"],
            Self::LeastSquaresDrem | Self::Drem => &["forgetting"],
            Self::FiniteTimeDrem => &["forgetting", "period"],
        }
    }

    pub(super) fn has(self, key: &str) -> bool {
        self.needs().contains(&key) || self.admits().contains(&key)
    }
}
