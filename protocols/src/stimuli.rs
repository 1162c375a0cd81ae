//! The images of a study, whichever way they come: rendered from a scene, or brought along as pictures.

use crate::{PictureSet, StimulusId, StimulusPlan};

/// The images of a study.
#[derive(Clone, Debug, PartialEq)]
pub enum Stimuli {
    /// Rendered from one scene with different ray counts.
    Rendered(StimulusPlan),
    /// Pictures that were made elsewhere, with factors from a table.
    Pictures(PictureSet),
}

/// One image of a study, as sessions and analyses see it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StudyImage {
    /// The name.
    pub id: StimulusId,
    /// The level of each factor, in the order of [`Stimuli::factors`].
    pub levels: Vec<String>,
    /// Whether it is rated; an image that is only an anchor or a reference is not.
    pub is_rated: bool,
}

impl Stimuli {
    /// The name of the set, and of its folder below `stimuli/`.
    pub fn set(&self) -> &str {
        match self {
            Self::Rendered(plan) => &plan.set,
            Self::Pictures(pictures) => &pictures.plan.set,
        }
    }

    /// The factors in which the images differ, as columns of the ratings.
    pub fn factors(&self) -> Vec<String> {
        match self {
            Self::Rendered(_) => StimulusPlan::factors(),
            Self::Pictures(pictures) => pictures.table.factors.clone(),
        }
    }

    /// Every image, in the order of the plan or of the table.
    pub fn images(&self) -> Vec<StudyImage> {
        match self {
            Self::Rendered(plan) => {
                let image = |stimulus: crate::Stimulus| StudyImage {
                    levels: stimulus.factors().into_values().collect(),
                    is_rated: !stimulus.sequences.is_empty(),
                    id: stimulus.id,
                };
                plan.stimuli().into_iter().map(image).collect()
            }
            Self::Pictures(pictures) => {
                let image = |picture: &crate::Picture| StudyImage {
                    id: picture.id.clone(),
                    is_rated: picture.is_rated(),
                    levels: picture.levels.clone(),
                };
                pictures.table.pictures.iter().map(image).collect()
            }
        }
    }

    /// The image of the lowest quality, if the study shows one.
    pub fn zero_anchor(&self) -> Option<StimulusId> {
        match self {
            Self::Rendered(plan) => Some(plan.zero_anchor()),
            Self::Pictures(pictures) => pictures.anchors.as_ref().map(|[zero, _]| zero.clone()),
        }
    }

    /// The image of the highest quality, if the study shows one.
    pub fn ten_anchor(&self) -> Option<StimulusId> {
        match self {
            Self::Rendered(plan) => Some(plan.ten_anchor()),
            Self::Pictures(pictures) => pictures.anchors.as_ref().map(|[_, ten]| ten.clone()),
        }
    }

    /// What an image is compared with: the reference that the table of pictures names, or else the ten anchor.
    pub fn reference_of(&self, id: &StimulusId) -> Option<StimulusId> {
        let pictures = self.pictures().map(|set| &set.table.pictures);
        let mut pictures = pictures.into_iter().flatten();
        let named = pictures.find(|picture| picture.id == *id);
        named
            .and_then(|picture| picture.reference.clone())
            .or_else(|| self.ten_anchor())
    }

    /// The plan, if the images are rendered.
    pub const fn rendered(&self) -> Option<&StimulusPlan> {
        match self {
            Self::Rendered(plan) => Some(plan),
            Self::Pictures(_) => None,
        }
    }

    /// The plan, if the images are rendered, to be changed.
    pub const fn rendered_mut(&mut self) -> Option<&mut StimulusPlan> {
        match self {
            Self::Rendered(plan) => Some(plan),
            Self::Pictures(_) => None,
        }
    }

    /// The pictures, if they were made elsewhere.
    pub const fn pictures(&self) -> Option<&PictureSet> {
        match self {
            Self::Rendered(_) => None,
            Self::Pictures(pictures) => Some(pictures),
        }
    }
}
