//! The report of a study: a page, a figure and the numbers behind them.
//!
//! The same ratings give the same bytes: nothing here reads a clock. Every file is written whole or not at
//! all, and none before all are made.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use protocols::{Access, Observer, Stimuli, Study, write_atomically};

use crate::anova_table::{quoted, shortest};
use crate::cell_figure::CellFigure;
use crate::data_sections::figure_name;
use crate::figure::{Figure, Palette};
use crate::page::page;
use crate::picture::png_from_svg;
use crate::picture_analysis::PictureAnalysis;
use crate::picture_sections;
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
/// `anova.json`, `anova.csv`, `means.csv`, `figure-10.svg`, `figure-10.png` (for own pictures `figure.svg` and `.png`).
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
    let Contents { anova_of, files } = match study.protocol.stimuli {
        Stimuli::Rendered(_) => of_rendered(study, &ratings)?,
        Stimuli::Pictures(_) => of_pictures(study, &ratings)?,
    };
    let out_dir = out_dir.map_or_else(
        || study.default_report_dir(ratings.observer),
        Path::to_owned,
    );
    let mut written = Vec::new();
    for (name, bytes) in files {
        let file = out_dir.join(name);
        if let Err(source) = write_atomically(&file, &bytes, Access::Owner) {
            return Err(AnalysisError::Write { file, source });
        }
        written.push(file);
    }
    Ok(ReportSummary {
        page: out_dir.join("report.html"),
        files: written,
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

fn of_rendered(study: &Study, ratings: &StudyRatings) -> Result<Contents, AnalysisError> {
    let analysis = StudyAnalysis::new(study, ratings)?;
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
        ratings,
        analysis: &analysis,
        figure_svg: &figure(Palette::PAGE),
    };
    let title = format!("Report: {}", study.protocol.study);
    let files = vec![
        (
            "report.html".to_owned(),
            page(&title, &sections.to_html()).into_bytes(),
        ),
        (
            "anova.json".to_owned(),
            analysis.table.to_json().into_bytes(),
        ),
        ("anova.csv".to_owned(), analysis.anova.to_csv().into_bytes()),
        (
            "means.csv".to_owned(),
            means_csv(&analysis, study.protocol.analysis.confidence).into_bytes(),
        ),
        ("figure-10.png".to_owned(), png_from_svg(&svg, PNG_SCALE)?),
        ("figure-10.svg".to_owned(), svg.into_bytes()),
    ];
    Ok(Contents {
        anova_of: analysis,
        files,
    })
}

fn of_pictures(study: &Study, ratings: &StudyRatings) -> Result<Contents, AnalysisError> {
    let pictures = PictureAnalysis::new(study, ratings)?;
    let figure = |palette: Palette| {
        let figure = CellFigure {
            pictures: &pictures,
            scale: study.protocol.session.scale,
            palette,
        };
        figure.to_svg()
    };
    let svg = figure(Palette::PRINT);
    let sections = Sections {
        study,
        ratings,
        analysis: &pictures.study,
        figure_svg: &figure(Palette::PAGE),
    };
    let title = format!("Report: {}", study.protocol.study);
    let html = page(&title, &sections.to_html_of_pictures(&pictures));
    let (anova, table) = (&pictures.study.anova, &pictures.study.table);
    let name = figure_name(study);
    let files = vec![
        ("report.html".to_owned(), html.into_bytes()),
        ("anova.json".to_owned(), table.to_json().into_bytes()),
        ("anova.csv".to_owned(), anova.to_csv().into_bytes()),
        (
            "means.csv".to_owned(),
            picture_sections::means_csv(study, &pictures).into_bytes(),
        ),
        (format!("{name}.png"), png_from_svg(&svg, PNG_SCALE)?),
        (format!("{name}.svg"), svg.into_bytes()),
    ];
    Ok(Contents {
        anova_of: pictures.study,
        files,
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
