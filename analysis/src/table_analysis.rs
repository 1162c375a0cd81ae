//! Everything that is computed of one table of ratings: the analysis of variance and what follows it.

use std::fmt::Write as _;
use std::path::Path;

use protocols::{AnalysisPlan, FollowUpPlan, InputError, SumsOfSquares};
use serde::Serialize;

use crate::permutation::permutation_tests;
use crate::ranks::aligned_rank_transform;
use crate::text_table::{TextTable, decimals, optional_p, p_text};
use crate::{
    AlignedRankEffect, AnalysisError, AnovaTable, AsymptoteSettings, Asymptotes, CellMatrix,
    Design, Estimate, FollowUp, FollowUpSettings, Friedman, PermutationTest, anova,
    read_observations,
};

/// An analysis of variance with what follows it. As JSON, the keys of the table come first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TableAnalysis {
    /// The analysis of variance.
    #[serde(flatten)]
    pub anova: AnovaTable,
    /// The families of tests that were asked for.
    pub follow_ups: Vec<FollowUp>,
    /// The tests that suppose no distribution, where they were asked for.
    pub distribution_free: Option<DistributionFree>,
    /// Where the curves flatten, where that was asked for.
    pub asymptotes: Option<Asymptotes>,
}

/// Tests that suppose no distribution, beside the F tests.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DistributionFree {
    /// Friedman's test of each within factor.
    pub friedman: Vec<Friedman>,
    /// The aligned rank transform of each effect.
    pub aligned_ranks: Vec<AlignedRankEffect>,
    /// The permutation test of each effect.
    pub permutation: Vec<PermutationTest>,
}

/// Which curves are to be followed to their asymptote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AsymptoteOption {
    /// The factor along which they run.
    pub factor: String,
    /// The factor whose levels have a curve each.
    pub by: Option<String>,
}

/// What is computed beside the analysis of variance.
#[derive(Clone, Debug, PartialEq)]
pub struct AnalysisOptions {
    /// The families of tests.
    pub follow_ups: Vec<FollowUpPlan>,
    /// The confidence level of intervals.
    pub confidence: f64,
    /// How many random arrangements a permutation test has; `None` for no distribution-free tests.
    pub n_permutations: Option<u32>,
    /// The curves to follow to their asymptote.
    pub asymptote: Option<AsymptoteOption>,
    /// How often subjects are drawn again for an interval.
    pub n_resamples: u32,
    /// Ratings closer than this are equivalent.
    pub delta: f64,
    /// The seed of permutations and resamples.
    pub seed: u64,
}

impl Default for AnalysisOptions {
    fn default() -> Self {
        Self {
            follow_ups: Vec::new(),
            confidence: 0.95,
            n_permutations: None,
            asymptote: None,
            n_resamples: 20_000,
            delta: 1.0,
            seed: 1992,
        }
    }
}

impl TableAnalysis {
    /// Analyses a table in a file, or in several.
    ///
    /// # Errors
    ///
    /// As [`crate::anova_of_table`], and follow-ups of factors or levels that the table does not have.
    pub fn of_tables(
        paths: &[impl AsRef<Path>],
        design: &Design,
        options: &AnalysisOptions,
    ) -> Result<Self, AnalysisError> {
        let observations = read_observations(paths, design)?;
        let cells = CellMatrix::with_missing(&observations, design.missing)?;
        let table = Self::new(&cells, &design.observed, design.sums_of_squares, options)?;
        Ok(table)
    }

    /// Analyses subjects × cells.
    ///
    /// # Errors
    ///
    /// A follow-up of a factor or level that the cells do not have.
    pub fn new(
        cells: &CellMatrix,
        observed: &[String],
        sums_of_squares: SumsOfSquares,
        options: &AnalysisOptions,
    ) -> Result<Self, InputError> {
        let settings = FollowUpSettings {
            confidence: options.confidence,
            sums_of_squares,
        };
        let follow_ups = options.follow_ups.iter();
        let mut table = anova(cells, observed, sums_of_squares);
        let has_enough = cells.group_sizes().iter().all(|&size| size >= 3);
        let asymptote = options.asymptote.as_ref().filter(|_| has_enough);
        if options.asymptote.is_some() && !has_enough {
            let warning = "no asymptote is sought with fewer than three subjects in a group";
            table.warnings.push(warning.to_owned());
        }
        let n_permutations = options.n_permutations;
        Ok(Self {
            anova: table,
            follow_ups: follow_ups
                .map(|plan| FollowUp::new(plan, cells, settings))
                .collect::<Result<_, _>>()?,
            distribution_free: n_permutations.map(|n_random| DistributionFree {
                friedman: (0..cells.within.len())
                    .filter_map(|factor| Friedman::new(cells, factor))
                    .collect(),
                aligned_ranks: aligned_rank_transform(cells),
                permutation: permutation_tests(cells, sums_of_squares, n_random, options.seed),
            }),
            asymptotes: asymptote
                .map(|asked| options.asymptotes(cells, asked))
                .transpose()?,
        })
    }

    /// All of it as JSON, with a line end.
    pub fn to_json(&self) -> String {
        // A struct of numbers and text cannot fail to be written.
        let mut json = serde_json::to_string_pretty(self).unwrap_or_default();
        json.push('\n');
        json
    }

    /// All of it as text for a terminal.
    pub fn to_text(&self) -> String {
        let mut text = self.anova.to_text();
        for follow_up in &self.follow_ups {
            text.push('\n');
            text.push_str(&follow_up.to_text());
        }
        if let Some(free) = &self.distribution_free {
            text.push('\n');
            text.push_str(&free.to_text());
        }
        if let Some(asymptotes) = &self.asymptotes {
            text.push('\n');
            text.push_str(&asymptotes.to_text());
        }
        text
    }
}

impl AnalysisOptions {
    /// As a protocol plans it, with the distribution-free tests.
    pub(crate) fn planned(plan: &AnalysisPlan) -> Self {
        let asymptote = plan.asymptote.as_ref();
        let defaults = Self::default();
        Self {
            follow_ups: plan.follow_ups.clone(),
            confidence: plan.confidence,
            n_permutations: Some(plan.permutations),
            asymptote: asymptote.map(|plan| AsymptoteOption {
                factor: plan.factor.clone(),
                by: plan.by.clone(),
            }),
            n_resamples: asymptote.map_or(defaults.n_resamples, |plan| plan.resamples),
            delta: asymptote.map_or(defaults.delta, |plan| plan.delta),
            seed: plan.seed,
        }
    }

    fn asymptotes(
        &self,
        cells: &CellMatrix,
        asked: &AsymptoteOption,
    ) -> Result<Asymptotes, InputError> {
        let settings = AsymptoteSettings {
            confidence: self.confidence,
            n_resamples: self.n_resamples,
            seed: self.seed,
            delta: self.delta,
        };
        Asymptotes::new(cells, &asked.factor, asked.by.as_deref(), settings)
    }
}

impl DistributionFree {
    /// The tests as text for a terminal: one line for each effect.
    fn to_text(&self) -> String {
        let mut text = String::from("Tests that suppose no distribution\n");
        let mut table = TextTable::new(&[
            "effect",
            "permutation p",
            "arrangements",
            "aligned ranks F",
            "df",
            "p",
            "p (GG)",
        ]);
        for test in &self.permutation {
            let ranks = self
                .aligned_ranks
                .iter()
                .find(|row| row.effect == test.effect);
            table.row(&[
                test.effect.clone(),
                optional_p(test.p),
                format!(
                    "{}{}",
                    test.n_arrangements,
                    if test.is_exact { " (all)" } else { "" }
                ),
                decimals(ranks.and_then(|row| row.f), 2),
                ranks.map_or_else(String::new, |row| format!("{}, {}", row.df[0], row.df[1])),
                optional_p(ranks.and_then(|row| row.p)),
                optional_p(ranks.and_then(|row| row.p_gg.or(row.p))),
            ]);
        }
        text.push_str(&table.to_text());
        for one in &self.friedman {
            // Writing to a `String` cannot fail.
            _ = writeln!(
                text,
                "Friedman, {}: chi-square({}) = {:.2}, p {}; Kendall W {:.3}; Iman-Davenport F({}, {}) = {}, p {}",
                one.factor,
                one.df,
                one.chi_square,
                p_text(one.p),
                one.kendall_w,
                one.f_df[0],
                one.f_df[1],
                decimals(one.f, 2),
                optional_p(one.f_p)
            );
        }
        text
    }
}

impl Asymptotes {
    /// The plateau points as text for a terminal.
    pub(crate) fn to_text(&self) -> String {
        let unit = &self.unit;
        let percent = 100.0 * self.settings.confidence;
        let mut text = format!("Where the curves over {} flatten\n", self.factor);
        for curve in &self.curves {
            let name = if curve.level.is_empty() {
                "all"
            } else {
                &curve.level
            };
            let Estimate { value, low, high } = curve.psi;
            // Writing to a `String` cannot fail, here and below.
            _ = writeln!(
                text,
                "{name}: {value:.1}{unit}, {percent:.0}% interval {low:.1}{unit} to {high:.1}{unit} ({}); equivalent to the top \
                 within {} rating from {}{unit} on",
                curve.outcome.in_words(),
                self.settings.delta,
                curve.lowest_equivalent
            );
            for shape in &curve.shapes {
                _ = writeln!(
                    text,
                    "  {}: R2 {}, error for a subject left out {}",
                    shape.shape,
                    decimals(shape.r_squared, 3),
                    decimals(shape.left_out_rms, 3)
                );
            }
        }
        if let Some(Estimate { value, low, high }) = self.difference {
            _ = writeln!(
                text,
                "first less second: {value:.1}{unit}, {percent:.0}% interval {low:.1}{unit} to {high:.1}{unit}"
            );
        }
        text
    }
}
