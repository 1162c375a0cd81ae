//! The report of a study: a page, a figure and the numbers behind them.
//!
//! The same ratings give the same bytes: nothing here reads a clock. Every file is written whole or not at
//! all, and none before all are made.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use protocols::{Access, Observer, Study, write_atomically};

use crate::anova_table::{quoted, shortest};
use crate::figure::{Figure, Palette};
use crate::page::page;
use crate::picture::png_from_svg;
use crate::sections::Sections;
use crate::study_analysis::StudyAnalysis;
use crate::study_ratings::{Pilots, StudyRatings};
use crate::{AnalysisError, AnovaTable};

/// Pixels of the PNG for each unit of the SVG: 1520 pixels wide.
const PNG_SCALE: f32 = 2.0;

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

/// Analyses the ratings of `study` in `data_dir` and writes the report into `out_dir`: `report.html`,
/// `anova.json`, `anova.csv`, `means.csv`, `figure-10.svg`, `figure-10.png`.
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
    let ratings = StudyRatings::read(study, data_dir, pilots)?;
    let analysis = StudyAnalysis::new(study, &ratings)?;
    let who = ratings.who(analysis.subjects.len());
    let figure = |palette: Palette| {
        let figure = Figure {
            analysis: &analysis,
            scale: study.protocol.session.scale,
            confidence: study.protocol.analysis.confidence,
            who: &who,
            palette,
        };
        figure.to_svg()
    };
    let svg = figure(Palette::PRINT);
    let sections = Sections {
        study,
        ratings: &ratings,
        analysis: &analysis,
        figure_svg: &figure(Palette::PAGE),
    };
    let title = format!("Report: {}", study.protocol.study);
    let contents = [
        (
            "report.html",
            page(&title, &sections.to_html()).into_bytes(),
        ),
        ("anova.json", analysis.anova.to_json().into_bytes()),
        ("anova.csv", analysis.anova.to_csv().into_bytes()),
        (
            "means.csv",
            means_csv(&analysis, study.protocol.analysis.confidence).into_bytes(),
        ),
        ("figure-10.png", png_from_svg(&svg, PNG_SCALE)?),
        ("figure-10.svg", svg.into_bytes()),
    ];
    let out_dir = out_dir.map_or_else(
        || study.default_report_dir(ratings.observer),
        Path::to_owned,
    );
    let mut files = Vec::new();
    for (name, bytes) in contents {
        let file = out_dir.join(name);
        if let Err(source) = write_atomically(&file, &bytes, Access::Owner) {
            return Err(AnalysisError::Write { file, source });
        }
        files.push(file);
    }
    Ok(ReportSummary {
        page: out_dir.join("report.html"),
        files,
        observer: ratings.observer,
        n_subjects: analysis.subjects.len(),
        anova: analysis.anova,
        warnings: ratings.warnings,
    })
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
