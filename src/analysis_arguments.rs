//! The words of the command line that say what is analysed, and how: those of `report` and `anova`.

use std::path::PathBuf;

use analysis::{PrintedF, RowFilter};
use clap::{Args, ValueEnum};
use protocols::{Correction, FollowUpPlan, Missing, Scale, SumsOfSquares};

use crate::command_line::DataFolder;
use crate::follow_up;

#[derive(Debug, Args)]
pub(crate) struct ReportArguments {
    /// The protocol file (.toml); or tables of ratings (CSV, TSV) with their columns named below; or first the one, then the others.
    #[arg(value_name = "PROTOCOL|TABLE", required = true)]
    pub(crate) files: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) data: DataFolder,
    /// Folder for the report [default: reports/STUDY, or reports/STUDY-simulated, or reports/TABLE]
    #[arg(long)]
    pub(crate) out: Option<PathBuf>,
    /// Predictions to draw beside the ratings [default: reports/STUDY-predicted/predictions.csv, if it is there]
    #[arg(long, value_name = "FILE")]
    pub(crate) predictions: Option<PathBuf>,
    /// Analyse trial runs (`run --pilot`) too.
    #[arg(long)]
    pub(crate) include_pilot: bool,
    #[command(flatten)]
    pub(crate) columns: Columns,
    /// The title of a report on tables.
    #[arg(long, help_heading = TABLES)]
    pub(crate) title: Option<String>,
    /// The ends of the scale of the ratings in tables.
    #[arg(long, value_name = "LOW..HIGH", value_parser = scale, help_heading = TABLES)]
    pub(crate) scale: Option<Scale>,
    /// The correction for sphericity that leads [default: gg].
    #[arg(long, value_name = "WHICH", help_heading = TABLES)]
    pub(crate) correction: Option<CorrectionArgument>,
    #[command(flatten)]
    pub(crate) beside: BesideAnova,
}

#[derive(Debug, Args)]
pub(crate) struct AnovaArguments {
    /// The table: CSV or TSV with a header line, one rating a row. Several files, such as one for each subject, are one table.
    #[arg(value_name = "TABLE", required_unless_present = "explain")]
    pub(crate) tables: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) columns: Columns,
    /// Friedman's test, aligned ranks and permutation tests too.
    #[arg(long)]
    pub(crate) distribution_free: bool,
    #[command(flatten)]
    pub(crate) beside: BesideAnova,
    /// Say which designs a printed F value allows, such as "F(12,120)=51.44", and stop.
    #[arg(long, value_name = "F", conflicts_with_all = ["tables", "subject", "rating"])]
    pub(crate) explain: Option<PrintedF>,
    /// Print JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

const TABLES: &str = "Tables";
const FOLLOW_UPS: &str = "After the table";

/// Which column of a table is what.
#[derive(Debug, Args)]
#[command(next_help_heading = TABLES)]
pub(crate) struct Columns {
    /// Column that names the subject; @sub takes it from files named sub-01_..., as BIDS has them.
    #[arg(long, value_name = "COLUMN")]
    pub(crate) subject: Option<String>,
    /// Column with the rating; COLUMN.KEY for a number in a JSON object, as jsPsych's surveys have it.
    #[arg(long, value_name = "COLUMN")]
    pub(crate) rating: Option<String>,
    /// Ratings have a decimal comma: 7,5.
    #[arg(long)]
    pub(crate) decimal_comma: bool,
    /// Only rows whose field is this value (or one of VALUE|VALUE), or with != is not. May be repeated.
    #[arg(long = "where", value_name = "COLUMN=VALUE")]
    pub(crate) filters: Vec<RowFilter>,
    /// Columns of the factors of which every subject has seen every level.
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',')]
    pub(crate) within: Vec<String>,
    /// Columns of the factors of which a subject has one level.
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',')]
    pub(crate) between: Vec<String>,
    /// Factors that were observed and not manipulated, for generalized eta squared.
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',')]
    pub(crate) observed: Vec<String>,
    /// Type of the sums of squares, for unbalanced groups [default: 3].
    #[arg(long = "type", value_name = "TYPE")]
    pub(crate) sums_of_squares: Option<TypeArgument>,
    /// What is done with a subject of whom a rating is missing [default: drop].
    #[arg(long, value_name = "WHAT")]
    pub(crate) missing: Option<MissingArgument>,
}

impl Columns {
    /// The first option that was given, for an error that says that none may be.
    pub(crate) fn first_given(&self) -> Option<&'static str> {
        let given = [
            (self.subject.is_some(), "--subject"),
            (self.rating.is_some(), "--rating"),
            (self.decimal_comma, "--decimal-comma"),
            (!self.filters.is_empty(), "--where"),
            (!self.within.is_empty(), "--within"),
            (!self.between.is_empty(), "--between"),
            (!self.observed.is_empty(), "--observed"),
            (self.sums_of_squares.is_some(), "--type"),
            (self.missing.is_some(), "--missing"),
        ];
        let first = given.into_iter().find(|(is_given, _)| *is_given);
        first.map(|(_, option)| option)
    }
}

/// What is computed beside the analysis of variance.
#[derive(Debug, Args)]
#[command(next_help_heading = FOLLOW_UPS)]
pub(crate) struct BesideAnova {
    /// The effect of one factor at each level of another.
    #[arg(long, value_name = "FACTOR@FACTOR", value_parser = follow_up::simple)]
    pub(crate) simple: Vec<FollowUpPlan>,
    /// Every pair of levels of a factor, over all else or at each level of another.
    #[arg(long, value_name = "FACTOR[@FACTOR]", value_parser = follow_up::pairwise)]
    pub(crate) pairwise: Vec<FollowUpPlan>,
    /// Every other level of a factor against one.
    #[arg(long, value_name = "FACTOR=LEVEL", value_parser = follow_up::control)]
    pub(crate) control: Vec<FollowUpPlan>,
    /// Orthogonal polynomials up to a degree (3, or as far as the levels go).
    #[arg(long, value_name = "FACTOR[:DEGREE]", value_parser = follow_up::trends)]
    pub(crate) trends: Vec<FollowUpPlan>,
    /// A contrast of levels by weights that sum to zero, such as "rays:10K=-1,130K=1".
    #[arg(long, value_name = "FACTOR:LEVEL=WEIGHT,...", value_parser = follow_up::contrast)]
    pub(crate) contrast: Vec<FollowUpPlan>,
    /// Where the curve over a factor flattens, for each level of another.
    #[arg(long, value_name = "FACTOR[@FACTOR]")]
    pub(crate) asymptote: Option<String>,
    /// Ratings closer than this are equivalent.
    #[arg(long, default_value_t = 1.0, value_parser = positive)]
    pub(crate) delta: f64,
    /// The confidence level of intervals.
    #[arg(long, default_value_t = 0.95, value_parser = confidence)]
    pub(crate) confidence: f64,
    /// How many random arrangements a permutation test has where there are too many to try all.
    #[arg(long, default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(100..=10_000_000))]
    pub(crate) permutations: u32,
    /// How often subjects are drawn again for the interval of an asymptote.
    #[arg(long, default_value_t = 20_000, value_parser = clap::value_parser!(u32).range(200..=10_000_000))]
    pub(crate) resamples: u32,
    /// The seed of both.
    #[arg(long, default_value_t = 1992)]
    pub(crate) seed: u64,
}

impl BesideAnova {
    /// Every family of tests that was asked for.
    pub(crate) fn follow_ups(&self) -> Vec<FollowUpPlan> {
        let families = [
            &self.simple,
            &self.pairwise,
            &self.control,
            &self.trends,
            &self.contrast,
        ];
        families.into_iter().flatten().cloned().collect()
    }
}

fn positive(text: &str) -> Result<f64, String> {
    let value = text
        .parse()
        .ok()
        .filter(|value: &f64| *value > 0.0 && value.is_finite());
    value.ok_or_else(|| format!("found {text:?}, expected a number above 0"))
}

fn confidence(text: &str) -> Result<f64, String> {
    let level = text
        .parse()
        .ok()
        .filter(|level: &f64| *level > 0.5 && *level < 1.0);
    level.ok_or_else(|| {
        format!("found {text:?}, expected a level above 0.5 and below 1, such as 0.95")
    })
}

fn scale(text: &str) -> Result<Scale, String> {
    let ends = text
        .split_once("..")
        .and_then(|(low, high)| Some((low.trim().parse().ok()?, high.trim().parse().ok()?)));
    ends.filter(|(lowest, highest)| lowest < highest)
        .map(|(lowest, highest)| Scale { lowest, highest })
        .ok_or_else(|| {
            format!("found {text:?}, expected two whole numbers, the lower first, such as 0..10")
        })
}

/// The correction that a report leads with.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum CorrectionArgument {
    /// No correction.
    None,
    /// Greenhouse and Geisser's.
    Gg,
    /// Huynh and Feldt's, in Lecoutre's form.
    Hf,
    /// Chi and Muller's.
    Cm,
}

impl From<CorrectionArgument> for Correction {
    fn from(argument: CorrectionArgument) -> Self {
        match argument {
            CorrectionArgument::None => Self::None,
            CorrectionArgument::Gg => Self::GreenhouseGeisser,
            CorrectionArgument::Hf => Self::HuynhFeldt,
            CorrectionArgument::Cm => Self::ChiMuller,
        }
    }
}

/// The type of the sums of squares.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum TypeArgument {
    /// Adjusted for terms that do not contain the effect.
    #[value(name = "2", alias = "II")]
    Two,
    /// Adjusted for all other terms.
    #[value(name = "3", alias = "III")]
    Three,
}

impl From<TypeArgument> for SumsOfSquares {
    fn from(argument: TypeArgument) -> Self {
        match argument {
            TypeArgument::Two => Self::TypeTwo,
            TypeArgument::Three => Self::TypeThree,
        }
    }
}

/// What is done with a subject of whom a rating is missing.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum MissingArgument {
    /// The subject is left out, by name.
    Drop,
    /// The analysis stops and names the subjects.
    Fail,
}

impl From<MissingArgument> for Missing {
    fn from(argument: MissingArgument) -> Self {
        match argument {
            MissingArgument::Drop => Self::Drop,
            MissingArgument::Fail => Self::Fail,
        }
    }
}
