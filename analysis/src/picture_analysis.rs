//! What the ratings of own pictures say: the analysis of variance over the factors of their table, the means
//! of its cells and of every picture.
//!
//! Every subject sees every picture, so that all factors are within subjects. Pictures that differ only in
//! factors which the design leaves out are averaged.
//!
//! Not here: how it is worded (`picture_sections`) and drawn (`cell_figure`).

use std::collections::BTreeMap;

use protocols::{InputError, Missing, StimulusId, Study, StudyImage};

use crate::cell_matrix::missing_ratings;
use crate::cell_means::{CellMeans, Mean};
use crate::fragility::Fragility;
use crate::study_analysis::{
    Incomplete, StudyAnalysis, SubjectRatings, analysed_scale, ratings_by_subject, screening,
};
use crate::study_ratings::StudyRatings;
use crate::{
    AnalysisOptions, CellMatrix, CellSummary, Observations, TableAnalysis, cell_summaries,
};

/// The numbers of a report on own pictures.
#[derive(Clone, Debug)]
pub(crate) struct PictureAnalysis {
    /// Subjects, those left out, and the analysis of variance.
    pub(crate) study: StudyAnalysis,
    /// Each cell of the design.
    pub(crate) means: CellMeans,
    /// Each picture that is rated.
    pub(crate) images: Vec<Mean<StudyImage>>,
}

impl PictureAnalysis {
    /// Analyses the ratings as the protocol says.
    ///
    /// # Errors
    ///
    /// A plan with factors between subjects; no complete subject, or too few for an error term.
    pub(crate) fn new(study: &Study, ratings: &StudyRatings) -> Result<Self, InputError> {
        let plan = &study.protocol.analysis;
        if let Some(between) = plan.between.first() {
            let expected = "factors within subjects: everybody sees every picture";
            let found = format!("the factor {between:?} between subjects");
            return Err(InputError::new(&study.path, found, expected).at("field analysis.between"));
        }
        let mut images = study.protocol.stimuli.images();
        images.retain(|image| image.is_rated);
        let (members, incomplete) = complete(&images, ratings_by_subject(&ratings.rows));
        let cells = analysed_cells(study, ratings, &images, (&members, &incomplete))?;
        let mut subjects: Vec<String> = members.keys().cloned().collect();
        subjects.sort_by(|left, right| crate::natural_order(left, right));
        let options = AnalysisOptions::planned(plan);
        let table = TableAnalysis::new(&cells, &[], plan.sums_of_squares, &options)?;
        let fragility = Fragility::new(&cells, &table.anova, plan, analysed_scale(study));
        let ids: Vec<&StimulusId> = images.iter().map(|image| &image.id).collect();
        let means = image_means(study, ratings, &images, &members);
        let opinions = (means.iter())
            .map(|mean| (mean.of.id.clone(), mean.summary.mean))
            .collect();
        Ok(Self {
            means: CellMeans::new(&cells, plan.confidence),
            images: means,
            study: StudyAnalysis {
                observers: screening(&ids, &members, study.protocol.session.layout),
                opinions,
                ..StudyAnalysis::of_effects(subjects, incomplete, table, fragility, cells)
            },
        })
    }
}

/// The design's cells of those who rated every picture; `incomplete` are named in a warning, or refused if the protocol
/// says so.
fn analysed_cells(
    study: &Study,
    ratings: &StudyRatings,
    images: &[StudyImage],
    (members, incomplete): (&BTreeMap<String, SubjectRatings>, &[Incomplete]),
) -> Result<CellMatrix, InputError> {
    let plan = &study.protocol.analysis;
    let observations = observations(study, ratings, images, members);
    if members.is_empty() || observations.is_empty() {
        let found = format!("no complete subject ({} unfinished)", incomplete.len());
        let expected = "subjects who rated every picture";
        return Err(InputError::new(&ratings.folder, found, expected));
    }
    let names: Vec<String> = incomplete.iter().map(ToString::to_string).collect();
    if plan.missing == Missing::Fail && !names.is_empty() {
        return Err(missing_ratings(&ratings.folder, &names));
    }
    let mut cells = CellMatrix::with_missing(&observations, plan.missing)?;
    if !names.is_empty() {
        let unfinished = incomplete.iter().map(|one| one.subject.clone());
        cells.dropped_subjects.extend(unfinished);
        let warning = format!(
            "left out, because ratings are missing: {}",
            names.join(", ")
        );
        cells.warnings.push(warning);
    }
    Ok(cells)
}

/// Who rated every picture, and who did not.
fn complete(
    images: &[StudyImage],
    mut members: BTreeMap<String, SubjectRatings>,
) -> (BTreeMap<String, SubjectRatings>, Vec<Incomplete>) {
    let mut incomplete = Vec::new();
    members.retain(|subject, ratings| {
        let n_rated = images
            .iter()
            .filter(|image| ratings.contains_key(&image.id))
            .count();
        if n_rated < images.len() {
            incomplete.push(Incomplete {
                subject: subject.clone(),
                n_rated,
                n_images: images.len(),
            });
        }
        n_rated == images.len()
    });
    incomplete.sort_by(|left, right| crate::natural_order(&left.subject, &right.subject));
    (members, incomplete)
}

/// The ratings of the design, without the levels that the protocol excludes.
fn observations(
    study: &Study,
    ratings: &StudyRatings,
    images: &[StudyImage],
    members: &BTreeMap<String, SubjectRatings>,
) -> Observations {
    let plan = &study.protocol.analysis;
    let names = study.protocol.stimuli.factors();
    let level = |image: &StudyImage, factor: &str| {
        let place = names.iter().position(|name| name == factor);
        place.map_or("", |place| &image.levels[place]).to_owned()
    };
    let is_excluded = |image: &&StudyImage| {
        let excludes = |level: &String, levels: &[String]| levels.contains(level);
        plan.exclude
            .iter()
            .any(|exclusion| excludes(&level(image, &exclusion.factor), &exclusion.levels))
    };
    let mut observations = Observations::new(&ratings.folder, &[], &plan.within);
    for (subject, means) in members {
        for image in images.iter().filter(|image| !is_excluded(image)) {
            let levels: Vec<String> = plan.within.iter().map(|name| level(image, name)).collect();
            let levels = levels.iter().map(String::as_str);
            observations.push(subject, levels, means.get(&image.id).copied());
        }
    }
    observations
}

fn image_means(
    study: &Study,
    ratings: &StudyRatings,
    images: &[StudyImage],
    members: &BTreeMap<String, SubjectRatings>,
) -> Vec<Mean<StudyImage>> {
    let mut observations = Observations::new(&ratings.folder, &[], &["picture".to_owned()]);
    for (subject, means) in members {
        for image in images {
            observations.push(subject, [image.id.as_str()], means.get(&image.id).copied());
        }
    }
    let Ok(cells) = CellMatrix::new(&observations) else {
        return Vec::new(); // A single picture makes no table.
    };
    let summaries = cell_summaries(&cells, study.protocol.analysis.confidence);
    let by_id: BTreeMap<StimulusId, StudyImage> = images
        .iter()
        .map(|image| (image.id.clone(), image.clone()))
        .collect();
    let of_image = |summary: CellSummary| {
        let id = StimulusId::try_from(cells.cell_levels(summary.cell).concat()).ok()?;
        let of = by_id.get(&id)?.clone();
        Some(Mean { of, summary })
    };
    let mut means: Vec<Mean<StudyImage>> = summaries.into_iter().filter_map(of_image).collect();
    means.sort_by_key(|mean| images.iter().position(|image| image.id == mean.of.id));
    means
}
