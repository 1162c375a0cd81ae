//! What a study's ratings say: means of the conditions, the analysis of variance, the difference of the two
//! channel groups at each ray count.
//!
//! Not here: how it is worded and drawn.

use std::collections::BTreeMap;
use std::fmt;

use protocols::rating::RatingRow;
use protocols::{
    AnalysisPlan, ChannelGroup, InputError, Layout, Missing, RayCount, Scale, Stimulus, StimulusId,
    StimulusPlan, Study,
};

use crate::cell_matrix::missing_ratings;
use crate::fragility::Fragility;
use crate::interval::{mean, standard_deviation};
use crate::p_adjustment::holm;
use crate::screening::ObserverScreening;
use crate::study_ratings::StudyRatings;
use crate::tail::{f_tail, t_quantile};
use crate::{AnalysisOptions, AnovaTable, CellMatrix, Observations, TableAnalysis, cell_summaries};

/// The numbers of a report.
#[derive(Clone, Debug)]
pub(crate) struct StudyAnalysis {
    /// Complete subjects.
    pub(crate) subjects: Vec<String>,
    /// Subjects left out, and how many of their images they had rated.
    pub(crate) incomplete: Vec<Incomplete>,
    /// Every image that a sequence shows, in the order of the protocol.
    pub(crate) conditions: Vec<ConditionMean>,
    /// The analysis of variance, without the levels that the protocol excludes.
    pub(crate) anova: AnovaTable,
    /// The same with all that follows it.
    pub(crate) table: TableAnalysis,
    /// The cells that it rests on.
    pub(crate) cells: CellMatrix,
    /// Who rated how, where everyone rated the same images.
    pub(crate) observers: Option<ObserverScreening>,
    /// The mean of each image over these observers.
    pub(crate) opinions: BTreeMap<StimulusId, f64>,
    /// What the result hangs on.
    pub(crate) fragility: Fragility,
    /// Chromatic less achromatic, by rising ray count; empty unless subjects rated both.
    pub(crate) differences: Vec<Difference>,
    /// The same over all ray counts of the analysis of variance.
    pub(crate) overall_difference: Option<Difference>,
}

/// A subject without a rating of every image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Incomplete {
    pub(crate) subject: String,
    pub(crate) n_rated: usize,
    pub(crate) n_images: usize,
}

impl fmt::Display for Incomplete {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{} ({} of {} images)",
            self.subject, self.n_rated, self.n_images
        )
    }
}

/// The mean rating of one image.
#[derive(Clone, Debug)]
pub(crate) struct ConditionMean {
    pub(crate) stimulus: Stimulus,
    /// The groups whose curves it lies on.
    pub(crate) curves: Vec<ChannelGroup>,
    /// The ray count of the varied group.
    pub(crate) rays: RayCount,
    pub(crate) n: usize,
    pub(crate) mean: f64,
    pub(crate) sd: Option<f64>,
    pub(crate) half_between: Option<f64>,
    pub(crate) half_within: Option<f64>,
}

/// The mean paired difference, chromatic less achromatic.
#[derive(Clone, Debug)]
pub(crate) struct Difference {
    /// `None` for the mean over ray counts.
    pub(crate) rays: Option<RayCount>,
    pub(crate) mean: f64,
    /// Half the width of its *t* interval; `None` without variance or with one subject.
    pub(crate) half: Option<f64>,
    /// Two-sided paired *t* test; `None` without variance.
    pub(crate) p: Option<f64>,
    /// `p` by Holm's method over all ray counts.
    pub(crate) p_holm: Option<f64>,
}

/// The mean rating of each image by one subject.
pub(crate) type SubjectRatings = BTreeMap<StimulusId, f64>;

impl StudyAnalysis {
    /// Analyses the ratings as the protocol says.
    ///
    /// # Errors
    ///
    /// No complete subject, or too few for an error term; a plan with ray counts between subjects.
    pub(crate) fn new(study: &Study, ratings: &StudyRatings) -> Result<Self, InputError> {
        let plan = &study.protocol.analysis;
        if plan.between.iter().any(|factor| factor == "rays") {
            return Err(InputError::new(
                &study.path,
                "ray counts between subjects",
                "ray counts within subjects",
            )
            .at("field analysis.between"));
        }
        let by_subject = ratings_by_subject(&ratings.rows);
        let mut groups = subject_groups(study, &by_subject);
        let incomplete = leave_out_incomplete(&mut groups);
        let (cells, table) = analysis_as_planned(plan, ratings, &groups, &incomplete)?;
        let fragility = Fragility::new(&cells, &table.anova, plan, analysed_scale(study));
        let layout = study.protocol.session.layout;
        let observers = match groups.as_slice() {
            [Group { images, members }] => {
                let ids: Vec<&StimulusId> = images.iter().map(|image| &image.id).collect();
                screening(&ids, members, layout)
            }
            _ => None,
        };
        let conditions = condition_means(study, ratings, &groups);
        let both_by_all = plan.between.is_empty();
        let differences = if both_by_all {
            differences(study, &groups)
        } else {
            Vec::new()
        };
        let overall_difference = both_by_all
            .then(|| overall_difference(study, &groups))
            .flatten();
        let mut subjects: Vec<String> = (groups.iter())
            .flat_map(|group| group.members.keys().cloned())
            .collect();
        subjects.sort_by(|left, right| crate::natural_order(left, right));
        Ok(Self {
            subjects,
            incomplete,
            anova: table.anova.clone(),
            table,
            cells,
            observers,
            opinions: (conditions.iter())
                .map(|condition| (condition.stimulus.id.clone(), condition.mean))
                .collect(),
            fragility,
            conditions,
            differences,
            overall_difference,
        })
    }

    /// Only the analysis of variance and what follows it, of images that were not rendered.
    pub(crate) fn of_effects(
        subjects: Vec<String>,
        incomplete: Vec<Incomplete>,
        table: TableAnalysis,
        fragility: Fragility,
        cells: CellMatrix,
    ) -> Self {
        Self {
            subjects,
            incomplete,
            conditions: Vec::new(),
            anova: table.anova.clone(),
            table,
            cells,
            observers: None,
            opinions: BTreeMap::new(),
            fragility,
            differences: Vec::new(),
            overall_difference: None,
        }
    }

    /// The image that is on the curve of `group` at `rays`.
    pub(crate) fn condition(&self, group: ChannelGroup, rays: RayCount) -> Option<&ConditionMean> {
        self.conditions
            .iter()
            .find(|condition| condition.rays == rays && condition.curves.contains(&group))
    }

    /// Every ray count of any curve, rising.
    pub(crate) fn ray_counts(&self) -> Vec<RayCount> {
        let mut counts: Vec<RayCount> = self.conditions.iter().map(|c| c.rays).collect();
        counts.sort_unstable();
        counts.dedup();
        counts
    }
}

/// What a row says of its image: the rating; of a pair of which both were rated, test less reference.
pub(crate) fn opinion_score(row: &RatingRow) -> f64 {
    let reference = row.reference_rating.unwrap_or_default();
    f64::from(row.rating - reference)
}

/// The scale of what is analysed; differences of pairs have no ends of their own.
pub(crate) fn analysed_scale(study: &Study) -> Option<Scale> {
    let session = &study.protocol.session;
    (session.layout != Layout::Dscqs).then_some(session.scale)
}

pub(crate) fn ratings_by_subject(rows: &[RatingRow]) -> BTreeMap<String, SubjectRatings> {
    let mut all: BTreeMap<String, BTreeMap<StimulusId, Vec<f64>>> = BTreeMap::new();
    for row in rows {
        let subject = all.entry(row.subject_id.to_string()).or_default();
        subject
            .entry(row.stimulus_id.clone())
            .or_default()
            .push(opinion_score(row));
    }
    let means = |ratings: BTreeMap<StimulusId, Vec<f64>>| {
        (ratings.into_iter())
            .map(|(id, ratings)| (id, mean(&ratings)))
            .collect()
    };
    all.into_iter()
        .map(|(subject, ratings)| (subject, means(ratings)))
        .collect()
}

/// Subjects who rate the same images.
struct Group {
    images: Vec<Stimulus>,
    members: BTreeMap<String, SubjectRatings>,
}

/// All subjects in one group, or one group for each channel group where that is between subjects.
fn subject_groups(study: &Study, by_subject: &BTreeMap<String, SubjectRatings>) -> Vec<Group> {
    let shown: Vec<Stimulus> = (rendered_stimuli(study).into_iter())
        .filter(|stimulus| !stimulus.sequences.is_empty())
        .collect();
    if study.protocol.analysis.between.is_empty() {
        return vec![Group {
            images: shown,
            members: by_subject.clone(),
        }];
    }
    let group = |channels: ChannelGroup| {
        let images: Vec<Stimulus> = (shown.iter())
            .filter(|stimulus| stimulus.sequences.contains(&channels))
            .cloned()
            .collect();
        let is_theirs = |ratings: &SubjectRatings| {
            (images.iter())
                .any(|image| image.sequences == [channels] && ratings.contains_key(&image.id))
        };
        let members = (by_subject.iter())
            .filter(|(_, ratings)| is_theirs(ratings))
            .map(|(subject, ratings)| (subject.clone(), ratings.clone()))
            .collect();
        Group { images, members }
    };
    ChannelGroup::ALL.map(group).into()
}

/// The images of a study that renders its own.
fn rendered_stimuli(study: &Study) -> Vec<Stimulus> {
    let plan = study.protocol.stimuli.rendered();
    plan.map(StimulusPlan::stimuli).unwrap_or_default()
}

fn leave_out_incomplete(groups: &mut [Group]) -> Vec<Incomplete> {
    let mut incomplete = Vec::new();
    for group in groups {
        let n_images = group.images.len();
        group.members.retain(|subject, ratings| {
            let n_rated = (group.images.iter())
                .filter(|image| ratings.contains_key(&image.id))
                .count();
            if n_rated < n_images {
                incomplete.push(Incomplete {
                    subject: subject.clone(),
                    n_rated,
                    n_images,
                });
            }
            n_rated == n_images
        });
    }
    incomplete.sort_by(|left, right| crate::natural_order(&left.subject, &right.subject));
    incomplete
}

/// Observers as screened by how their ratings agree; `None` with fewer than three observers.
pub(crate) fn screening(
    images: &[&StimulusId],
    members: &BTreeMap<String, SubjectRatings>,
    layout: Layout,
) -> Option<ObserverScreening> {
    let ratings: Vec<Vec<Option<f64>>> = (images.iter())
        .map(|image| {
            (members.values())
                .map(|ratings| ratings.get(*image).copied())
                .collect()
        })
        .collect();
    let criterion = match layout {
        Layout::Dscqs => 0.85,
        Layout::Flanking | Layout::Sequence | Layout::Single | Layout::Dsis => 0.7,
    };
    (members.len() >= 3)
        .then(|| ObserverScreening::new(members.keys().cloned().collect(), &ratings, criterion))
}

fn analysis_as_planned(
    plan: &AnalysisPlan,
    ratings: &StudyRatings,
    groups: &[Group],
    incomplete: &[Incomplete],
) -> Result<(CellMatrix, TableAnalysis), InputError> {
    let names = StimulusPlan::factors();
    let is_excluded = |factor: &str, level: &str| {
        (plan.exclude.iter()).any(|exclusion| {
            exclusion.factor == factor && exclusion.levels.iter().any(|excluded| excluded == level)
        })
    };
    let mut observations = Observations::new(&ratings.folder, &plan.between, &plan.within);
    for group in groups {
        for (subject, means) in &group.members {
            for image in &group.images {
                let levels = image.factors();
                if names.iter().any(|name| is_excluded(name, &levels[name])) {
                    continue;
                }
                let of_design = plan.factors().map(|factor| levels[factor].as_str());
                observations.push(subject, of_design, means.get(&image.id).copied());
            }
        }
    }
    if observations.is_empty() {
        let found = match incomplete {
            [] => "no ratings".to_owned(),
            some => format!("no complete subject ({} unfinished)", some.len()),
        };
        return Err(InputError::new(
            &ratings.folder,
            found,
            "subjects who rated every image",
        ));
    }
    if plan.missing == Missing::Fail && !incomplete.is_empty() {
        let names: Vec<String> = incomplete.iter().map(ToString::to_string).collect();
        return Err(missing_ratings(&ratings.folder, &names));
    }
    let mut cells = CellMatrix::with_missing(&observations, plan.missing)?;
    let unfinished = incomplete.iter().map(|one| one.subject.clone());
    cells.dropped_subjects.extend(unfinished);
    if !incomplete.is_empty() {
        let names: Vec<String> = incomplete.iter().map(ToString::to_string).collect();
        cells.warnings.push(format!(
            "left out, because ratings are missing: {}",
            names.join(", ")
        ));
    }
    let options = AnalysisOptions::planned(plan);
    let table = TableAnalysis::new(&cells, &[], plan.sums_of_squares, &options)?;
    Ok((cells, table))
}

/// Mean and intervals of every image; each group of subjects has its own normalisation.
fn condition_means(study: &Study, ratings: &StudyRatings, groups: &[Group]) -> Vec<ConditionMean> {
    let mut conditions = Vec::new();
    let channel_is_between = groups.len() > 1;
    for (group, channels) in groups.iter().zip(ChannelGroup::ALL) {
        let factor = ["stimulus".to_owned()];
        let mut observations = Observations::new(&ratings.folder, &[], &factor);
        for (subject, means) in &group.members {
            for image in &group.images {
                observations.push(subject, [image.id.as_str()], means.get(&image.id).copied());
            }
        }
        let Ok(cells) = CellMatrix::new(&observations) else {
            continue; // A group without a complete subject has no means.
        };
        for summary in cell_summaries(&cells, study.protocol.analysis.confidence) {
            let id = cells.cell_levels(summary.cell).concat();
            let Some(stimulus) = group.images.iter().find(|image| image.id.as_str() == id) else {
                continue;
            };
            let curves = if channel_is_between {
                vec![channels]
            } else {
                stimulus.sequences.clone()
            };
            conditions.push(ConditionMean {
                rays: varied_rays(stimulus, curves.first().copied()),
                curves,
                stimulus: stimulus.clone(),
                n: summary.n,
                mean: summary.mean,
                sd: summary.sd,
                half_between: summary.half_between,
                half_within: summary.half_within,
            });
        }
    }
    conditions.sort_by_key(|condition| (condition.curves.clone(), condition.rays));
    conditions.sort_by_key(|condition| condition.curves.len());
    conditions
}

fn varied_rays(stimulus: &Stimulus, group: Option<ChannelGroup>) -> RayCount {
    match group {
        Some(ChannelGroup::Chromatic) => stimulus.rays_c1c2,
        _ => stimulus.rays_a,
    }
}

/// For each ray count that both groups have an image of their own for: each subject's difference.
fn subject_differences(study: &Study, groups: &[Group]) -> Vec<(RayCount, Vec<f64>)> {
    let Some(group) = groups.first() else {
        return Vec::new();
    };
    let of = |channels: ChannelGroup| -> BTreeMap<RayCount, &StimulusId> {
        (group.images.iter())
            .filter(|image| image.sequences == [channels])
            .map(|image| (varied_rays(image, Some(channels)), &image.id))
            .collect()
    };
    let achromatic = of(ChannelGroup::Achromatic);
    let excluded: Vec<&String> = (study.protocol.analysis.exclude.iter())
        .filter(|exclusion| exclusion.factor == "rays")
        .flat_map(|exclusion| &exclusion.levels)
        .collect();
    (of(ChannelGroup::Chromatic).into_iter())
        .filter(|(rays, _)| !excluded.contains(&&rays.to_string()))
        .filter_map(|(rays, chromatic)| {
            let achromatic = achromatic.get(&rays)?;
            let difference = |ratings: &SubjectRatings| ratings[chromatic] - ratings[*achromatic];
            Some((rays, group.members.values().map(difference).collect()))
        })
        .collect()
}

fn differences(study: &Study, groups: &[Group]) -> Vec<Difference> {
    let confidence = study.protocol.analysis.confidence;
    let mut differences: Vec<Difference> = (subject_differences(study, groups).into_iter())
        .map(|(rays, values)| Difference::of(Some(rays), &values, confidence))
        .collect();
    adjust_by_holm(&mut differences);
    differences
}

fn overall_difference(study: &Study, groups: &[Group]) -> Option<Difference> {
    let by_rays = subject_differences(study, groups);
    let n_subjects = by_rays.first()?.1.len();
    let of_subject = |subject: usize| {
        let values: Vec<f64> = by_rays.iter().map(|(_, values)| values[subject]).collect();
        mean(&values)
    };
    let values: Vec<f64> = (0..n_subjects).map(of_subject).collect();
    Some(Difference::of(
        None,
        &values,
        study.protocol.analysis.confidence,
    ))
}

impl Difference {
    fn of(rays: Option<RayCount>, values: &[f64], confidence: f64) -> Self {
        let n = values.len() as f64;
        let mean = mean(values);
        let error = standard_deviation(values)
            .map(|sd| sd / n.sqrt())
            .filter(|&error| error > 1e-12);
        let t_squared = error.map(|error| (mean / error).powi(2));
        Self {
            rays,
            mean,
            half: error.map(|error| t_quantile((1.0 - confidence) / 2.0, n - 1.0) * error),
            p: t_squared.map(|t_squared| f_tail(t_squared, 1.0, n - 1.0)),
            p_holm: None,
        }
    }

    /// Whether its interval leaves out zero; `None` without an interval.
    pub(crate) fn excludes_zero(&self) -> Option<bool> {
        self.half.map(|half| self.mean.abs() > half)
    }
}

fn adjust_by_holm(differences: &mut [Difference]) {
    let p_values: Vec<Option<f64>> = differences.iter().map(|one| one.p).collect();
    for (one, adjusted) in differences.iter_mut().zip(holm(&p_values)) {
        one.p_holm = adjusted;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_paired_difference_has_the_interval_of_student() {
        // Student (1908), the sleep data, in hours: mean 1.58, t(9) = 4.0621, p = .002833,
        // 95% interval [.7001, 2.4599] (R: t.test(Pair(...)), the standard worked example).
        let values = [1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4];
        let difference = Difference::of(None, &values, 0.95);
        assert!((difference.mean - 1.58).abs() < 1e-12);
        assert!((difference.p.unwrap() - 0.002_833).abs() < 5e-7);
        assert!((difference.mean - difference.half.unwrap() - 0.700_1).abs() < 5e-5);
    }
}
