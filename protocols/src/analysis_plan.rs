//! The part of a protocol that says how the ratings are analysed.

use serde::{Deserialize, Serialize};

use crate::FollowUpPlan;

/// How the ratings are analysed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AnalysisPlan {
    /// The factors of which every subject has seen every level, in the order of the report.
    pub within: Vec<String>,
    /// The factors of which a subject has one level.
    #[serde(default)]
    pub between: Vec<String>,
    /// Levels that the analysis of variance leaves out.
    #[serde(default)]
    pub exclude: Vec<Exclusion>,
    /// The type of the sums of squares; it matters with unbalanced groups only.
    #[serde(default)]
    pub sums_of_squares: SumsOfSquares,
    /// What is done with a subject of whom a rating is missing.
    #[serde(default)]
    pub missing: Missing,
    /// The sphericity correction that the report leads with.
    pub correction: Correction,
    /// The confidence level of intervals, between 0 and 1.
    pub confidence: f64,
    /// What is asked after the analysis of variance.
    #[serde(default)]
    pub follow_ups: Vec<FollowUpPlan>,
    /// The curves that are followed to where they flatten.
    #[serde(default)]
    pub asymptote: Option<AsymptotePlan>,
    /// How many random arrangements a permutation test has where there are too many to try all.
    #[serde(default = "ten_thousand")]
    pub permutations: u32,
    /// The seed of permutations and of resampled subjects.
    #[serde(default)]
    pub seed: u64,
    /// Test statistics printed elsewhere, shown beside ours.
    #[serde(default)]
    pub published: Vec<PublishedEffect>,
}

fn ten_thousand() -> u32 {
    10_000
}

/// Where curves of means flatten.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AsymptotePlan {
    /// The factor along which the curves run; its levels are numbers.
    pub factor: String,
    /// The factor whose levels have a curve each.
    #[serde(default)]
    pub by: Option<String>,
    /// Ratings closer than this are equivalent.
    pub delta: f64,
    /// How often subjects are drawn again for the interval.
    pub resamples: u32,
}

impl AnalysisPlan {
    /// Between factors first, then within factors, each in the order given.
    pub fn factors(&self) -> impl Iterator<Item = &str> {
        self.between.iter().chain(&self.within).map(String::as_str)
    }

    /// What is wrong with the plan, given the factors of the stimulus set.
    pub(crate) fn fault(&self, known: &[String]) -> Option<(&'static str, String, &'static str)> {
        let is_known = |factor: &str| known.iter().any(|known| known == factor);
        if let Some(unknown) = self.factors().find(|factor| !is_known(factor)) {
            let found = format!("the factor {unknown:?} ({} are known)", known.join(", "));
            return Some(("analysis", found, "factors of the stimulus set"));
        }
        let mut factors: Vec<&str> = self.factors().collect();
        factors.sort_unstable();
        if factors.is_empty() || factors.windows(2).any(|pair| pair[0] == pair[1]) {
            return Some((
                "analysis",
                format!("the factors {factors:?}"),
                "at least one factor, and none twice",
            ));
        }
        if let Some(exclusion) = self
            .exclude
            .iter()
            .find(|exclusion| !is_known(&exclusion.factor))
        {
            let found = format!("the factor {:?}", exclusion.factor);
            return Some(("analysis.exclude", found, "a factor of the stimulus set"));
        }
        self.fault_in_numbers()
            .or_else(|| self.fault_after_the_table())
    }

    fn fault_in_numbers(&self) -> Option<(&'static str, String, &'static str)> {
        if !(self.confidence > 0.5 && self.confidence < 1.0) {
            return Some((
                "analysis.confidence",
                self.confidence.to_string(),
                "a level above 0.5 and below 1",
            ));
        }
        if !(100..=10_000_000).contains(&self.permutations) {
            let found = self.permutations.to_string();
            return Some(("analysis.permutations", found, "100 to 10000000"));
        }
        None
    }

    /// What is wrong with what is asked after the analysis of variance.
    fn fault_after_the_table(&self) -> Option<(&'static str, String, &'static str)> {
        let is_analysed = |name: &str| self.factors().any(|factor| factor == name);
        let asked = self.follow_ups.iter();
        let factors = asked.flat_map(|plan| std::iter::once(plan.factor()).chain(plan.at()));
        if let Some(unknown) = factors.into_iter().find(|factor| !is_analysed(factor)) {
            let found = format!("the factor {unknown:?}");
            return Some(("analysis.follow_ups", found, "a factor of this analysis"));
        }
        let plan = self.asymptote.as_ref()?;
        let mut factors = std::iter::once(&plan.factor).chain(&plan.by);
        if let Some(unknown) = factors.find(|factor| !is_analysed(factor)) {
            let found = format!("the factor {unknown:?}");
            return Some(("analysis.asymptote", found, "a factor of this analysis"));
        }
        let is_usable = plan.delta > 0.0 && plan.delta.is_finite();
        if !is_usable || !(200..=10_000_000).contains(&plan.resamples) {
            let found = format!("delta = {}, resamples = {}", plan.delta, plan.resamples);
            return Some((
                "analysis.asymptote",
                found,
                "a delta above 0, and 200 to 10000000 resamples",
            ));
        }
        None
    }
}

/// Levels of one factor that the analysis of variance leaves out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exclusion {
    /// The factor.
    pub factor: String,
    /// Its levels that are left out.
    pub levels: Vec<String>,
    /// Why, for the report.
    pub reason: String,
}

/// A correction of the degrees of freedom for a covariance that is not spherical.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Correction {
    /// None: the F test as it stands.
    None,
    /// Greenhouse & Geisser (1959).
    GreenhouseGeisser,
    /// Huynh & Feldt (1976) in the form of Lecoutre (1991).
    HuynhFeldt,
    /// Chi & Muller (2012): best calibrated with more contrasts than error degrees of freedom.
    ChiMuller,
}

/// For which other terms a hypothesis on unbalanced groups is adjusted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum SumsOfSquares {
    /// For all terms that do not contain it: most powerful where there is no interaction.
    #[serde(rename = "II")]
    TypeTwo,
    /// For all other terms: hypotheses on the unweighted means of the groups.
    #[default]
    #[serde(rename = "III")]
    TypeThree,
}

impl SumsOfSquares {
    /// `II` or `III`.
    pub fn numeral(self) -> &'static str {
        match self {
            Self::TypeTwo => "II",
            Self::TypeThree => "III",
        }
    }
}

/// What is done with a subject of whom a rating is missing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Missing {
    /// The subject is left out, by name.
    #[default]
    Drop,
    /// The analysis stops and names the subjects.
    Fail,
}

/// A test statistic printed elsewhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedEffect {
    /// The effect: its factors joined by `:`.
    pub effect: String,
    /// Degrees of freedom of the numerator.
    pub df_num: f64,
    /// Degrees of freedom of the denominator.
    pub df_den: f64,
    /// The F value.
    pub f: f64,
}
