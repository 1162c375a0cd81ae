//! What was answered to the plates and letters, and how many answers were right.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::color_plate::ColorPlate;
use super::confusion::Axis;
use super::letter::{Letter, Side};

/// The answer to one plate.
#[derive(Clone, Debug, PartialEq)]
pub struct PlateAnswer {
    /// The confusion axis.
    pub axis: Axis,
    /// Which part of the largest excursion.
    pub grade: f64,
    /// How far along the axis.
    pub excursion: f64,
    /// The digit on the plate.
    pub shown: u8,
    /// The digit that was seen, if one was.
    pub seen: Option<u8>,
    /// From the first frame with the plate to the answer.
    pub response_time_s: f64,
}

impl PlateAnswer {
    pub(super) fn new(plate: &ColorPlate, seen: Option<u8>, response_time_s: f64) -> Self {
        Self {
            axis: plate.axis,
            grade: plate.grade,
            excursion: plate.excursion(),
            shown: plate.digit,
            seen,
            response_time_s,
        }
    }

    /// Whether the digit was seen.
    pub fn is_right(&self) -> bool {
        self.seen == Some(self.shown)
    }
}

/// The answer to one letter.
#[derive(Clone, Debug, PartialEq)]
pub struct LetterAnswer {
    /// The width of a stroke, in pixels.
    pub stroke_px: u32,
    /// The side that was open.
    pub shown: Side,
    /// The side that was named, if one was.
    pub seen: Option<Side>,
    /// From the first frame with the letter to the answer.
    pub response_time_s: f64,
}

impl LetterAnswer {
    pub(super) fn new(letter: Letter, seen: Option<Side>, response_time_s: f64) -> Self {
        Self {
            stroke_px: letter.stroke_px,
            shown: letter.side,
            seen,
            response_time_s,
        }
    }

    /// Whether the side was named rightly.
    pub fn is_right(&self) -> bool {
        self.seen == Some(self.shown)
    }
}

/// How many plates of one axis were read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AxisScore {
    /// How many were shown.
    pub shown: u32,
    /// How many were read rightly.
    pub right: u32,
}

/// How many letters of one size were read.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LetterScore {
    /// The width of a stroke, in pixels.
    pub stroke_px: u32,
    /// The angle of a stroke at the eye, in minutes of arc.
    pub stroke_arcmin: f64,
    /// How many were shown.
    pub shown: u32,
    /// How many were read rightly; one in four by chance.
    pub right: u32,
}

/// The screening in short. Counts only: what they mean for a subject is for people to judge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScreeningScore {
    /// For each axis; one in ten is read by chance.
    pub plates: BTreeMap<Axis, AxisScore>,
    /// For each size, in the order of showing.
    pub letters: Vec<LetterScore>,
    /// Whether the angles are those of a measured station, or those that the protocol asks for.
    pub has_measured_angle: bool,
    /// What this is not.
    pub remark: String,
}

/// What every score says of itself.
const REMARK: &str = "screening only, never a diagnosis; plates on a display find strong deficiencies and miss mild ones";

impl ScreeningScore {
    /// Counts the answers.
    pub(crate) fn of(plates: &[PlateAnswer], letters: &[LetterAnswer], angle: PixelAngle) -> Self {
        let mut of_axes: BTreeMap<Axis, AxisScore> = BTreeMap::new();
        for answer in plates {
            let score = of_axes.entry(answer.axis).or_default();
            score.shown += 1;
            score.right += u32::from(answer.is_right());
        }
        let mut of_sizes: Vec<LetterScore> = Vec::new();
        for answer in letters {
            let stroke_px = answer.stroke_px;
            let known = of_sizes
                .iter()
                .position(|score| score.stroke_px == stroke_px);
            let index = known.unwrap_or(of_sizes.len());
            if known.is_none() {
                of_sizes.push(LetterScore {
                    stroke_px,
                    stroke_arcmin: angle.stroke_arcmin(stroke_px),
                    shown: 0,
                    right: 0,
                });
            }
            of_sizes[index].shown += 1;
            of_sizes[index].right += u32::from(answer.is_right());
        }
        Self {
            plates: of_axes,
            letters: of_sizes,
            has_measured_angle: angle.is_measured,
            remark: REMARK.to_owned(),
        }
    }
}

/// The angle of a pixel at the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PixelAngle {
    pub(crate) degrees: f64,
    /// At the station; else it is what the protocol asks for.
    pub(crate) is_measured: bool,
}

impl PixelAngle {
    /// The angle of a stroke in minutes of arc: `60 atan(n tan a)` with `a` the angle of a pixel.
    pub(crate) fn stroke_arcmin(self, stroke_px: u32) -> f64 {
        let tangent = f64::from(stroke_px) * libm::tan(self.degrees.to_radians());
        60.0 * libm::atan(tangent).to_degrees()
    }
}
