//! The report of tables of ratings that any program wrote: the same page and the same files as a study's own report.

use std::path::{Path, PathBuf};

use protocols::Observer;

use crate::axis::Axis;
use crate::cell_figure::CellFigure;
use crate::figure::Palette;
use crate::report_files::{ReportFiles, write_files};
use crate::table_sections::TableSections;
use crate::table_study::TableNumbers;
use crate::{AnalysisError, ReportSummary, TableStudy};

/// Analyses tables as one and writes the report into `out_dir`: the files of [`crate::report`], the figure as `figure`.
///
/// # Errors
///
/// [`AnalysisError::Input`] for tables and designs that cannot be used; other variants if the system fails to read, draw or
/// write. Nothing is written then.
pub fn report_of_tables(
    tables: &[PathBuf],
    study: &TableStudy,
    out_dir: &Path,
) -> Result<ReportSummary, AnalysisError> {
    let numbers = study.numbers(tables)?;
    let measure = format!("Mean {}", study.design.rating);
    let figure = |palette: Palette| {
        let figure = CellFigure {
            means: &numbers.shown,
            axis: axis(study, &numbers),
            measure: &measure,
            palette,
        };
        figure.to_svg()
    };
    let sections = TableSections {
        study,
        numbers: &numbers,
        figure_svg: figure(Palette::PAGE),
    };
    let files = ReportFiles {
        document: &sections.document(),
        table: &numbers.table,
        to_paste: sections.to_paste_as_text(),
        means_csv: numbers.means.to_csv(study.plan.confidence),
        figures: vec![("figure", figure(Palette::PRINT))],
        observers: (sections.findings().observer_figure(Palette::PRINT))
            .map(|figure| figure.to_svg()),
    };
    let written = write_files(out_dir, files.files()?)?;
    Ok(ReportSummary {
        page: out_dir.join("report.html"),
        files: written,
        observer: if numbers.observations.has_simulated {
            Observer::Simulated
        } else {
            Observer::Person
        },
        n_subjects: numbers.cells.subjects.len(),
        anova: numbers.table.anova.clone(),
        warnings: Vec::new(),
    })
}

/// The ends of the scale, or a part about means and intervals.
fn axis(study: &TableStudy, numbers: &TableNumbers) -> Axis {
    if let Some(scale) = study.scale {
        return Axis::of_scale(scale);
    }
    Axis::around(numbers.shown.cells.iter().flat_map(|cell| {
        let half = cell.half().unwrap_or(0.0);
        [cell.summary.mean - half, cell.summary.mean + half]
    }))
}
