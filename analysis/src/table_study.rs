//! A study of which there are only tables: what its columns are, how it is analysed, and what that gives.
//!
//! Not here: how it is worded (`table_sections`) and which files a report has (`table_report`).

use std::fs;
use std::path::{Path, PathBuf};

use protocols::{AnalysisPlan, InputError, ReadError, Scale, Sha256Digest};

use crate::cell_means::CellMeans;
use crate::fragility::Fragility;
use crate::screening::ObserverScreening;
use crate::{
    AnalysisError, AnalysisOptions, CellMatrix, Design, FilterKind, Observations, RowFilter,
    TableAnalysis, read_observations,
};

/// A study in tables of ratings, whichever program wrote them.
#[derive(Clone, Debug)]
pub struct TableStudy {
    /// Its name.
    pub study: String,
    /// One line for the head of the report.
    pub title: String,
    /// Where it comes from; may be empty.
    pub source: String,
    /// Which column is what.
    pub design: Design,
    /// What is computed; its factors are those of the design.
    pub plan: AnalysisPlan,
    /// The ends of the ratings' scale, where they are known.
    pub scale: Option<Scale>,
    /// The protocol that says so, where there is one.
    pub protocol: Option<(PathBuf, Sha256Digest)>,
}

/// The most lines of a figure; more are averaged.
const MOST_LINES: usize = 8;

/// The numbers of a report on tables.
#[derive(Debug)]
pub(crate) struct TableNumbers {
    /// Name and digest of each file.
    pub(crate) files: Vec<(String, Sha256Digest)>,
    pub(crate) observations: Observations,
    pub(crate) cells: CellMatrix,
    pub(crate) table: TableAnalysis,
    pub(crate) fragility: Fragility,
    pub(crate) observers: Option<ObserverScreening>,
    pub(crate) means: CellMeans,
    /// The means of the figure: of all factors, or of the two with the most levels.
    pub(crate) shown: CellMeans,
}

impl TableStudy {
    pub(crate) fn numbers(&self, tables: &[PathBuf]) -> Result<TableNumbers, AnalysisError> {
        let observations = read_observations(tables, &self.filtered())?;
        let cells = CellMatrix::with_missing(&observations, self.design.missing)?;
        let (plan, design) = (&self.plan, &self.design);
        let options = AnalysisOptions::planned(plan);
        let table = TableAnalysis::new(&cells, &design.observed, design.sums_of_squares, &options)?;
        let means = CellMeans::new(&cells, plan.confidence);
        Ok(TableNumbers {
            files: tables
                .iter()
                .map(|file| digest(file))
                .collect::<Result<_, _>>()?,
            fragility: Fragility::new(&cells, &table.anova, plan, self.scale),
            observers: agreement(&cells),
            shown: shown(&cells, &means, plan.confidence)?,
            means,
            table,
            cells,
            observations,
        })
    }

    /// The design, without the rows of levels that the plan excludes.
    fn filtered(&self) -> Design {
        let mut design = self.design.clone();
        let excluded = self.plan.exclude.iter().map(|exclusion| RowFilter {
            column: exclusion.factor.clone(),
            kind: FilterKind::Without,
            values: exclusion.levels.clone(),
        });
        design.filters.extend(excluded);
        design
    }
}

fn digest(file: &Path) -> Result<(String, Sha256Digest), AnalysisError> {
    let bytes =
        fs::read(file).map_err(|error| ReadError::from_io(file, "a table of ratings", error))?;
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    Ok((name.into_owned(), Sha256Digest::of(&bytes)))
}

/// How subjects agree who rated the same cells.
fn agreement(cells: &CellMatrix) -> Option<ObserverScreening> {
    let (n, n_cells) = (cells.subjects.len(), cells.scores.ncols());
    if !cells.between.is_empty() || n < 3 || n_cells < 3 {
        return None;
    }
    let ratings: Vec<Vec<Option<f64>>> = (0..n_cells)
        .map(|cell| {
            cells
                .scores
                .column(cell)
                .iter()
                .copied()
                .map(Some)
                .collect()
        })
        .collect();
    Some(ObserverScreening::new(
        cells.subjects.clone(),
        &ratings,
        0.7,
    ))
}

fn shown(
    cells: &CellMatrix,
    means: &CellMeans,
    confidence: f64,
) -> Result<CellMeans, AnalysisError> {
    let mut sizes: Vec<(usize, &String)> = (means.levels.iter().map(Vec::len))
        .zip(&means.factors)
        .collect();
    sizes.sort_by_key(|(size, _)| *size);
    let along_x = sizes.last().map_or(1, |(size, _)| *size);
    if means.cells.len() <= MOST_LINES * along_x {
        return Ok(means.clone());
    }
    let mut kept: Vec<String> = vec![];
    for (size, name) in sizes.iter().rev() {
        if kept.is_empty() || (kept.len() == 1 && *size <= MOST_LINES) {
            kept.push((*name).clone());
        }
    }
    CellMeans::over(cells, &kept, confidence)
}

/// A name for folders out of any text: lower-case letters, digits and `-`.
///
/// # Errors
///
/// No letter or digit is left.
pub fn folder_name(text: &str) -> Result<String, InputError> {
    let mut name = String::new();
    for sign in text.chars() {
        if sign.is_ascii_alphanumeric() {
            name.push(sign.to_ascii_lowercase());
        } else if !name.ends_with('-') {
            name.push('-');
        }
    }
    let name = name.trim_matches('-');
    if name.is_empty() {
        let expected = "a name with letters or digits";
        return Err(InputError::new(text, "a name without them", expected)
            .remedy("say where the report goes with --out"));
    }
    Ok(name.to_owned())
}
