//! The part of a protocol that says how the images are shown and rated.

use serde::{Deserialize, Serialize};

use crate::StimulusId;

/// How the images are shown and rated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SessionPlan {
    /// How the anchors stand to the test image.
    pub layout: Layout,
    /// For how long the images are shown; in a sequence, each of the three.
    pub exposure_s: f64,
    /// Neutral grey between the rating and the next images.
    pub pause_s: f64,
    /// The gap between two images of the flanking layout, in pixels.
    pub gap_px: u32,
    /// The grey of everything that is not a stimulus, as an 8-bit sRGB value.
    pub background_srgb: u8,
    /// The rating scale.
    pub scale: Scale,
    /// The images of the practice trials, in the order in which they come.
    pub practice: Vec<StimulusId>,
    /// How often each image is rated: once in each block.
    pub blocks: u32,
    /// With the subject's id, the seed of the order of trials.
    pub order_seed: u64,
    /// All words that the subject reads.
    pub texts: SessionTexts,
}

impl SessionPlan {
    pub(crate) fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        if !(self.exposure_s.is_finite() && (0.05..=3600.0).contains(&self.exposure_s)) {
            return Some((
                "session.exposure_s",
                self.exposure_s.to_string(),
                "a time from 0.05 to 3600 s",
            ));
        }
        if !(self.pause_s.is_finite() && (0.0..=60.0).contains(&self.pause_s)) {
            return Some((
                "session.pause_s",
                self.pause_s.to_string(),
                "a time from 0 to 60 s",
            ));
        }
        if !(1..=100).contains(&self.blocks) {
            return Some((
                "session.blocks",
                self.blocks.to_string(),
                "a number from 1 to 100",
            ));
        }
        let Scale { lowest, highest } = self.scale;
        if !(lowest < highest && i64::from(highest) - i64::from(lowest) <= 20) {
            let expected = "a lowest rating below the highest, with at most 21 steps";
            return Some(("session.scale", format!("{lowest} to {highest}"), expected));
        }
        None
    }
}

/// How the anchors stand to the test image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Layout {
    /// Zero anchor left, test image centre, ten anchor right, all at once (the paper's).
    Flanking,
    /// Zero anchor, test image, ten anchor, one after another in the centre.
    Sequence,
}

/// A rating scale of whole numbers, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scale {
    /// The worst rating.
    pub lowest: i32,
    /// The best rating.
    pub highest: i32,
}

impl Scale {
    /// Whether `rating` is on the scale.
    pub fn contains(self, rating: i32) -> bool {
        (self.lowest..=self.highest).contains(&rating)
    }

    /// Every rating, from the worst to the best.
    pub fn ratings(self) -> std::ops::RangeInclusive<i32> {
        self.lowest..=self.highest
    }

    /// The rating nearest to `value`; halves go to the even neighbour, what is off the scale to its end.
    pub fn nearest(self, value: f64) -> i32 {
        let clamped = value.clamp(f64::from(self.lowest), f64::from(self.highest));
        let rounded = clamped.round_ties_even();
        self.ratings()
            .find(|&rating| f64::from(rating) >= rounded)
            .unwrap_or(self.highest)
    }
}

/// All words that the subject reads, in any language.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SessionTexts {
    /// Shown first; blank lines part its paragraphs.
    pub instructions: String,
    /// Shown after the practice trials.
    pub practice_over: String,
    /// Above the rating scale.
    pub question: String,
    /// Under the lowest rating.
    pub lowest: String,
    /// Under the highest rating.
    pub highest: String,
    /// Shown last.
    pub thanks: String,
    /// On the button that goes on.
    #[serde(default = "continue_button")]
    pub continue_button: String,
    /// Asked when the subject wants to stop.
    #[serde(default = "stop_question")]
    pub stop_question: String,
    /// On the button that stops.
    #[serde(default = "stop_button")]
    pub stop_button: String,
}

fn continue_button() -> String {
    "Continue".to_owned()
}

fn stop_question() -> String {
    "Stop the session? The ratings so far are kept.".to_owned()
}

fn stop_button() -> String {
    "Stop".to_owned()
}
