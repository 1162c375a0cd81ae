//! The report of a study: a page, a figure and the numbers behind them.
//!
//! The same ratings give the same bytes: nothing here reads a clock. Every file is written whole or not at
//! all, and none before all are made.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use protocols::{Observer, Stimuli, Study};

use crate::anova_table::{quoted, shortest};
use crate::axis::Axis;
use crate::cell_figure::CellFigure;
use crate::data_sections::{PLAIN_FIGURE, figure_name};
use crate::document::Document;
use crate::figure::{Figure, Palette};
use crate::picture::FigurePicture;
use crate::picture_analysis::PictureAnalysis;
use crate::picture_sections;
use crate::predictions::Predictions;
use crate::report_files::{ReportFiles, write_files};
use crate::sections::Sections;
use crate::study_analysis::{StudyAnalysis, analysed_scale};
use crate::study_ratings::{Pilots, StudyRatings};
use crate::{AnalysisError, AnovaTable};

/// What a report was made from and where it stands.
#[derive(Clone, Debug)]
pub struct ReportSummary {
    /// The page.
    pub page: PathBuf,
    /// Every file written, the page first.
    pub files: Vec<PathBuf>,
    /// Who rated.
    pub observer: Observer,
    /// How many complete subjects it rests on.
    pub n_subjects: usize,
    /// The analysis of variance, with the subjects left out and the warnings.
    pub anova: AnovaTable,
    /// What was found amiss in the data files.
    pub warnings: Vec<String>,
}

/// Analyses the ratings of `study` in `data_dir` and writes the report into `out_dir`: `report.html`, `report.md`,
/// `tables.tex`, `to-paste.txt`, `anova.json`, `anova.csv`, `follow-ups.csv`, `asymptotes.csv`, `means.csv`, and `figure-10` and
/// `figure-10-plain` (for own pictures `figure`) as `.svg`, `-outlined.svg`, `.pdf` and `.png`.
///
/// Where no `out_dir` is named, simulated observers have a folder of their own, so that their report never
/// takes the place of people's.
///
/// # Errors
///
/// [`AnalysisError::Input`] for ratings that are missing, malformed, mixed or contradict the protocol, and
/// for too few complete subjects; other variants if the system fails to read, draw or write.
pub fn report(
    study: &Study,
    data_dir: &Path,
    out_dir: Option<&Path>,
    pilots: Pilots,
) -> Result<ReportSummary, AnalysisError> {
    report_beside(study, data_dir, out_dir, pilots, None)
}

/// The same report, with the file of predictions that `acuity predict` wrote drawn beside the ratings.
///
/// # Errors
///
/// As [`report`], and predictions that cannot be read.
pub fn report_beside(
    study: &Study,
    data_dir: &Path,
    out_dir: Option<&Path>,
    pilots: Pilots,
    predictions: Option<&Path>,
) -> Result<ReportSummary, AnalysisError> {
    let ratings = StudyRatings::read(study, data_dir, pilots)?;
    let predictions = predictions.map(Predictions::read).transpose()?;
    let Contents { anova_of, files } = match study.protocol.stimuli {
        Stimuli::Rendered(_) => of_rendered(study, &ratings, predictions.as_ref())?,
        Stimuli::Pictures(_) => of_pictures(study, &ratings, predictions.as_ref())?,
    };
    let out_dir = out_dir.map_or_else(
        || study.default_report_dir(ratings.observer),
        Path::to_owned,
    );
    Ok(ReportSummary {
        page: out_dir.join("report.html"),
        files: write_files(&out_dir, files)?,
        observer: ratings.observer,
        n_subjects: anova_of.subjects.len(),
        anova: anova_of.anova,
        warnings: ratings.warnings,
    })
}

/// The files of a report and the analysis that they are of.
struct Contents {
    anova_of: StudyAnalysis,
    files: Vec<(String, Vec<u8>)>,
}

fn of_rendered(
    study: &Study,
    ratings: &StudyRatings,
    predictions: Option<&Predictions>,
) -> Result<Contents, AnalysisError> {
    let analysis = StudyAnalysis::new(study, ratings)?;
    let who = ratings.who(analysis.subjects.len());
    let means = (analysis.conditions.iter())
        .map(|condition| (condition.mean, condition.half_within.unwrap_or(0.0)));
    let axis = figure_axis(study, means);
    let figure = |palette: Palette| Figure {
        analysis: &analysis,
        axis,
        confidence: study.protocol.analysis.confidence,
        who: &who,
        palette,
    };
    let sections = Sections {
        study,
        ratings,
        analysis: &analysis,
        figure_svg: &figure(Palette::PAGE).to_svg(),
        plain_svg: Some(&figure(Palette::PAGE).plain()),
    };
    let means = means_csv(&analysis, study.protocol.analysis.confidence);
    let mut document = sections.document();
    let print = figure(Palette::PRINT);
    let mut more = Vec::new();
    if let Some(predictions) = predictions {
        let of_page = figure(Palette::PAGE).with_predictions(predictions);
        document.add_before_last(sections.predicted(predictions, Some(&of_page)));
        let svg = print.with_predictions(predictions);
        let png = FigurePicture::new(&svg)?.to_png()?;
        more.push(("figure-predicted.png".to_owned(), png));
        more.push(("figure-predicted.svg".to_owned(), svg.into_bytes()));
    }
    let figures = vec![
        (figure_name(study), print.to_svg()),
        (PLAIN_FIGURE, print.plain()),
    ];
    let mut files = files(&sections, &document, means, figures)?;
    files.extend(more);
    Ok(Contents {
        anova_of: analysis,
        files,
    })
}

fn of_pictures(
    study: &Study,
    ratings: &StudyRatings,
    predictions: Option<&Predictions>,
) -> Result<Contents, AnalysisError> {
    let pictures = PictureAnalysis::new(study, ratings)?;
    let means = pictures.means.cells.iter();
    let means = means.map(|cell| (cell.summary.mean, cell.half().unwrap_or(0.0)));
    let axis = figure_axis(study, means);
    let figure = |palette: Palette| {
        let figure = CellFigure {
            means: &pictures.means,
            axis,
            measure: "Mean rating",
            palette,
        };
        figure.to_svg()
    };
    let sections = Sections {
        study,
        ratings,
        analysis: &pictures.study,
        figure_svg: &figure(Palette::PAGE),
        plain_svg: None,
    };
    let mut document = sections.document_of_pictures(&pictures);
    if let Some(predictions) = predictions {
        document.add_before_last(sections.predicted(predictions, None));
    }
    let means = picture_sections::means_csv(study, &pictures);
    let figures = vec![(figure_name(study), figure(Palette::PRINT))];
    let files = files(&sections, &document, means, figures)?;
    Ok(Contents {
        anova_of: pictures.study,
        files,
    })
}

/// Every file of a study's report, the page first.
fn files(
    sections: &Sections<'_>,
    document: &Document,
    means_csv: String,
    figures: Vec<(&'static str, String)>,
) -> Result<Vec<(String, Vec<u8>)>, AnalysisError> {
    let contents = ReportFiles {
        document,
        table: &sections.analysis.table,
        to_paste: sections.to_paste_as_text(),
        means_csv,
        figures,
        observers: (sections.findings().observer_figure(Palette::PRINT))
            .map(|figure| figure.to_svg()),
    };
    contents.files()
}

/// The axis of a figure: the scale, but of differences of pairs a part about the intervals.
fn figure_axis(study: &Study, means: impl Iterator<Item = (f64, f64)>) -> Axis {
    match analysed_scale(study) {
        Some(scale) => Axis::of_scale(scale),
        None => Axis::around(
            means
                .flat_map(|(mean, half)| [mean - half, mean + half])
                .chain([-1.0, 1.0]),
        ),
    }
}

/// One line for each image: its mean, and the ends of both intervals.
fn means_csv(analysis: &StudyAnalysis, confidence: f64) -> String {
    let mut csv = String::from(
        "stimulus_id,channel,rays,n,mean,sd,confidence,between_low,between_high,within_low,within_high\n",
    );
    for condition in &analysis.conditions {
        let ends = |half: Option<f64>| match half {
            Some(half) => [
                shortest(condition.mean - half),
                shortest(condition.mean + half),
            ],
            None => [String::new(), String::new()],
        };
        let levels = condition.stimulus.factors();
        let fields = [
            condition.stimulus.id.to_string(),
            quoted(&levels["channel"]),
            quoted(&levels["rays"]),
            condition.n.to_string(),
            shortest(condition.mean),
            condition.sd.map(shortest).unwrap_or_default(),
            shortest(confidence),
        ];
        let intervals = [ends(condition.half_between), ends(condition.half_within)].concat();
        // Writing to a `String` cannot fail.
        _ = writeln!(csv, "{},{}", fields.join(","), intervals.join(","));
    }
    csv
}
