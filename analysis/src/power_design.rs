//! A study that nobody has rated yet: which image stands in which cell of its analysis of variance, and how large
//! each effect is in the qualities of the images.
//!
//! Not here: who rates the images (a function that the caller brings) and what the ratings then show (`power`).

use std::collections::BTreeMap;

use protocols::{AnalysisPlan, InputError, StimulusId, Study};

use crate::Observations;
use crate::cell_matrix::CellMatrix;
use crate::contrasts::factor_sets;

/// The design of a study, before anybody took part.
#[derive(Clone, Debug)]
pub struct PowerDesign {
    pub(crate) plan: AnalysisPlan,
    /// Cells and groups, with two subjects in each group.
    template: CellMatrix,
    images: Vec<PlacedImage>,
}

/// Where an image stands.
#[derive(Clone, Debug)]
struct PlacedImage {
    id: StimulusId,
    group: usize,
    cell: usize,
}

/// An effect made larger or smaller than the qualities of the images say.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectScale {
    /// The effect: its factors joined by `:`.
    pub effect: String,
    /// What it is multiplied by: 1 leaves it, 0 takes it away.
    pub factor: f64,
}

impl PowerDesign {
    /// The design of the analysis of variance of `study`, without the levels that its protocol excludes.
    ///
    /// # Errors
    ///
    /// A cell without an image, or a factor with one level.
    pub fn new(study: &Study) -> Result<Self, InputError> {
        let plan = study.protocol.analysis.clone();
        let names = study.protocol.stimuli.factors();
        let mut images = study.protocol.stimuli.images();
        images.retain(|image| {
            let level = |factor: &String| {
                let place = names.iter().position(|name| name == factor);
                place.map(|place| &image.levels[place])
            };
            let is_excluded = plan.exclude.iter().any(|exclusion| {
                level(&exclusion.factor).is_some_and(|level| exclusion.levels.contains(level))
            });
            image.is_rated && !is_excluded
        });
        let level_of = |levels: &[String], factor: &str| {
            let place = names.iter().position(|name| name == factor);
            place.map(|place| levels[place].clone()).unwrap_or_default()
        };
        let levels_of = |factors: &[String], image: &protocols::StudyImage| -> Vec<String> {
            (factors.iter())
                .map(|factor| level_of(&image.levels, factor))
                .collect()
        };
        let mut observations = Observations::new(&study.path, &plan.between, &plan.within);
        for image in &images {
            let between = levels_of(&plan.between, image);
            let within = levels_of(&plan.within, image);
            let levels: Vec<&str> = between.iter().chain(&within).map(String::as_str).collect();
            for place in ["a", "b"] {
                let subject = format!("{} {place}", between.join(":"));
                observations.push(&subject, levels.iter().copied(), Some(0.0));
            }
        }
        let template = CellMatrix::new(&observations)?;
        let place = |image: protocols::StudyImage| {
            let groups = 0..template.n_groups();
            let cells = 0..template.scores.ncols();
            PlacedImage {
                group: position(
                    groups,
                    |group| template.group_levels(group),
                    &levels_of(&plan.between, &image),
                ),
                cell: position(
                    cells,
                    |cell| template.cell_levels(cell),
                    &levels_of(&plan.within, &image),
                ),
                id: image.id,
            }
        };
        Ok(Self {
            images: images.into_iter().map(place).collect(),
            template,
            plan,
        })
    }

    /// The images whose ratings are analysed, in the order in which a rater gives them.
    pub fn images(&self) -> impl Iterator<Item = &StimulusId> {
        self.images.iter().map(|image| &image.id)
    }

    /// The fewest subjects that leave an error term, and three for each curve where an asymptote is sought.
    pub fn fewest_subjects(&self) -> u32 {
        let n_groups = u32::try_from(self.template.n_groups()).unwrap_or(u32::MAX);
        let each = if self.plan.asymptote.is_some() { 3 } else { 2 };
        n_groups.saturating_mul(each)
    }

    /// The ratings of a study as subjects × cells: subject *i* (from 0) is in group *i* mod the number of groups,
    /// and `rate` gives one rating for each image.
    pub(crate) fn rated(&self, n_subjects: u32, rate: impl Fn(u32) -> Vec<f64>) -> CellMatrix {
        let n_groups = self.template.n_groups();
        let rows = n_subjects as usize;
        let mut cells = CellMatrix {
            subjects: (1..=n_subjects).map(|number| number.to_string()).collect(),
            groups: (0..rows).map(|row| row % n_groups).collect(),
            scores: nalgebra::DMatrix::zeros(rows, self.template.scores.ncols()),
            n_averaged_cells: 0,
            warnings: Vec::new(),
            ..self.template.clone()
        };
        let mut counts = vec![0.0; n_groups * cells.scores.ncols()];
        for image in &self.images {
            counts[image.group * cells.scores.ncols() + image.cell] += 1.0;
        }
        for (row, number) in (0..n_subjects).enumerate() {
            let group = row % n_groups;
            for (image, rating) in self.images.iter().zip(rate(number)) {
                if image.group == group {
                    let count = counts[group * cells.scores.ncols() + image.cell];
                    cells.scores[(row, image.cell)] += rating / count;
                }
            }
        }
        cells
    }

    /// The qualities with each effect in `scales` multiplied by its factor.
    ///
    /// The mean of each cell is the sum of the grand mean and of one component for each effect; an image moves by
    /// what the component of its cell changes. Images that are not analysed stay as they are.
    ///
    /// # Errors
    ///
    /// An effect that the design does not have, or a factor that is no number from 0 to 100.
    pub fn scaled(
        &self,
        qualities: &BTreeMap<StimulusId, f64>,
        scales: &[EffectScale],
    ) -> Result<BTreeMap<StimulusId, f64>, InputError> {
        let quality = |image: &PlacedImage| qualities.get(&image.id).copied().unwrap_or(f64::NAN);
        let mut by_cell: BTreeMap<Vec<usize>, Vec<f64>> = BTreeMap::new();
        for image in &self.images {
            by_cell
                .entry(self.codes(image))
                .or_default()
                .push(quality(image));
        }
        let means: Vec<(Vec<usize>, f64)> = by_cell
            .into_iter()
            .map(|(codes, values)| (codes, crate::interval::mean(&values)))
            .collect();
        let mut scaled = qualities.clone();
        for scale in scales {
            let held = self.held_by(scale)?;
            for image in &self.images {
                let component = component(&means, &self.codes(image), &held);
                if let Some(quality) = scaled.get_mut(&image.id) {
                    *quality += (scale.factor - 1.0) * component;
                }
            }
        }
        Ok(scaled)
    }

    /// The place of the level of each factor, between factors first.
    fn codes(&self, image: &PlacedImage) -> Vec<usize> {
        let place = |levels: &[String], level: &str| levels.iter().position(|one| one == level);
        let of_group = self.template.group_levels(image.group);
        let of_cell = self.template.cell_levels(image.cell);
        (self.template.between.iter().chain(&self.template.within))
            .zip(of_group.into_iter().chain(of_cell))
            .map(|(factor, level)| place(&factor.levels, level).unwrap_or(0))
            .collect()
    }

    /// Which factors the effect of a scale holds.
    fn held_by(&self, scale: &EffectScale) -> Result<Vec<bool>, InputError> {
        let factors: Vec<&str> = (self.template.between.iter().chain(&self.template.within))
            .map(|factor| factor.name.as_str())
            .collect();
        let name = |held: &Vec<bool>| -> String {
            let names = factors.iter().zip(held).filter(|(_, held)| **held);
            names.map(|(name, _)| *name).collect::<Vec<_>>().join(":")
        };
        if !(0.0..=100.0).contains(&scale.factor) {
            let found = format!("{} times the effect {}", scale.factor, scale.effect);
            return Err(InputError::new(
                &self.template.source,
                found,
                "0 to 100 times",
            ));
        }
        let mut sets = factor_sets(factors.len());
        sets.retain(|set| set.contains(&true));
        let known: Vec<String> = sets.iter().map(name).collect();
        let place = known.iter().position(|known| *known == scale.effect);
        place.map(|place| sets.swap_remove(place)).ok_or_else(|| {
            let found = format!("the effect {:?}", scale.effect);
            let expected = format!("an effect of the design: {}", known.join(", "));
            InputError::new(&self.template.source, found, expected)
        })
    }
}

fn position<'a>(
    mut places: std::ops::Range<usize>,
    levels: impl Fn(usize) -> Vec<&'a str>,
    wanted: &[String],
) -> usize {
    places.find(|&place| levels(place) == wanted).unwrap_or(0)
}

/// The component of one effect in one cell: over all subsets of its factors, the mean of the cells that agree in
/// them, with alternating signs.
fn component(means: &[(Vec<usize>, f64)], codes: &[usize], held: &[bool]) -> f64 {
    let factors: Vec<usize> = (0..held.len()).filter(|&factor| held[factor]).collect();
    (0..1_usize << factors.len())
        .map(|bits| {
            let fixed = || {
                (0..factors.len())
                    .filter(|place| bits >> place & 1 == 1)
                    .map(|place| factors[place])
            };
            let agree: Vec<f64> = (means.iter())
                .filter(|(other, _)| fixed().all(|factor| other[factor] == codes[factor]))
                .map(|(_, mean)| *mean)
                .collect();
            let sign = if (factors.len() - fixed().count()).is_multiple_of(2) {
                1.0
            } else {
                -1.0
            };
            sign * crate::interval::mean(&agree)
        })
        .sum()
}
