//! What is asked after the analysis of variance.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// One family of tests that follows the analysis of variance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum FollowUpPlan {
    /// The effect of `factor` at each level of `at`, each an analysis of variance of its own.
    SimpleEffects {
        /// The factor whose effect is sought.
        factor: String,
        /// The factor at whose levels it is sought.
        at: String,
    },
    /// Every pair of levels of `factor`.
    Pairwise {
        /// The factor.
        factor: String,
        /// At each level of this factor; without it, over all of them.
        #[serde(default)]
        at: Option<String>,
    },
    /// Every other level of `factor` against `control`.
    AgainstControl {
        /// The factor.
        factor: String,
        /// The level that the others are compared with.
        control: String,
        /// At each level of this factor; without it, over all of them.
        #[serde(default)]
        at: Option<String>,
    },
    /// Orthogonal polynomials on the levels of `factor`.
    Trends {
        /// The factor.
        factor: String,
        /// The highest degree; without it 3, or as far as the levels go.
        #[serde(default)]
        degrees: Option<usize>,
    },
    /// Given weights of the levels of `factor`; they sum to zero, levels not named count 0.
    Contrast {
        /// What it is called.
        name: String,
        /// The factor.
        factor: String,
        /// The weight of each level.
        weights: BTreeMap<String, f64>,
        /// At each level of this factor; without it, over all of them.
        #[serde(default)]
        at: Option<String>,
    },
}

impl FollowUpPlan {
    /// The factor whose levels are compared.
    pub fn factor(&self) -> &str {
        match self {
            Self::SimpleEffects { factor, .. }
            | Self::Pairwise { factor, .. }
            | Self::AgainstControl { factor, .. }
            | Self::Trends { factor, .. }
            | Self::Contrast { factor, .. } => factor,
        }
    }

    /// The factor at whose levels they are compared.
    pub fn at(&self) -> Option<&str> {
        match self {
            Self::SimpleEffects { at, .. } => Some(at),
            Self::Pairwise { at, .. }
            | Self::AgainstControl { at, .. }
            | Self::Contrast { at, .. } => at.as_deref(),
            Self::Trends { .. } => None,
        }
    }
}
