//! The part of a protocol that says how the images are shown and rated.

use serde::{Deserialize, Serialize};

use crate::intake_plan::form_fault;
use crate::{
    BreakPlan, ConsentPlan, FormField, InstructionPage, OrderPlan, RatingTime, ResponseStyle,
    ScreeningPlan, StimulusId,
};

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
    /// The form of the scale.
    #[serde(default)]
    pub response: ResponseStyle,
    /// When the scale is there.
    #[serde(default)]
    pub rating: RatingTime,
    /// An answer sooner than this after the scale came is not taken.
    #[serde(default)]
    pub shortest_response_s: Option<f64>,
    /// Without an answer by then the pictures are shown again.
    #[serde(default)]
    pub longest_response_s: Option<f64>,
    /// By which part the angle of a pixel at the station may differ from the protocol's; without it any station
    /// will do.
    #[serde(default)]
    pub viewing_tolerance: Option<f64>,
    /// The fewest frames a second that a session may be shown with; without it every rate is recorded and none is
    /// refused.
    #[serde(default)]
    pub lowest_refresh_hz: Option<f64>,
    /// Whether a corner of the screen is white while the test image stands, and black otherwise, for a
    /// photodiode.
    #[serde(default)]
    pub photodiode: bool,
    /// What the subject must agree to first.
    #[serde(default)]
    pub consent: Option<ConsentPlan>,
    /// The questions of the form, in their order.
    #[serde(default)]
    pub form: Vec<FormField>,
    /// Screening of colour vision and acuity.
    #[serde(default)]
    pub screening: Option<ScreeningPlan>,
    /// Pages that follow the instructions.
    #[serde(default)]
    pub pages: Vec<InstructionPage>,
    /// Breaks between the test trials.
    #[serde(default)]
    pub breaks: Option<BreakPlan>,
    /// Whether the scale and the breaks say how much is done.
    #[serde(default)]
    pub progress: bool,
    /// The images of the practice trials, in the order in which they come.
    pub practice: Vec<StimulusId>,
    /// How often each image is rated: once in each block.
    pub blocks: u32,
    /// With the subject's id, the seed of the order of trials.
    pub order_seed: u64,
    /// Which orders are allowed.
    #[serde(default)]
    pub order: OrderPlan,
    /// All words that the subject reads.
    pub texts: SessionTexts,
}

impl SessionPlan {
    pub(crate) fn fault(&self, factors: &[String]) -> Option<(&'static str, String, &'static str)> {
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
        self.response_fault()
            .or_else(|| self.response_time_fault())
            .or_else(|| self.tolerance_fault())
            .or_else(|| self.refresh_fault())
            .or_else(|| self.order.fault())
            .or_else(|| self.consent.as_ref()?.fault())
            .or_else(|| form_fault(&self.form, factors))
            .or_else(|| self.screening.as_ref()?.fault())
            .or_else(|| self.pages.iter().find_map(InstructionPage::fault))
            .or_else(|| self.breaks.as_ref()?.fault())
    }

    fn response_fault(&self) -> Option<(&'static str, String, &'static str)> {
        let Scale { lowest, highest } = self.scale;
        let is_continuous = self.response == ResponseStyle::Continuous;
        let (most, expected) = if is_continuous {
            (
                1000,
                "a lowest rating below the highest, with at most 1001 steps",
            )
        } else {
            (
                20,
                "a lowest rating below the highest, with at most 21 steps",
            )
        };
        if !(lowest < highest && i64::from(highest) - i64::from(lowest) <= most) {
            return Some(("session.scale", format!("{lowest} to {highest}"), expected));
        }
        let labels = self.texts.labels.len();
        if self.response == ResponseStyle::Labelled && labels != self.scale.ratings().count() {
            let expected = "a word for each rating, from the lowest to the highest";
            return Some(("session.texts.labels", format!("{labels} words"), expected));
        }
        if self.layout == Layout::Dscqs && !is_continuous {
            let expected = "\"continuous\", which the layout \"dscqs\" needs";
            return Some(("session.response", format!("{:?}", self.response), expected));
        }
        (is_continuous && self.rating == RatingTime::DuringExposure).then(|| {
            let expected = "\"after-exposure\" with a continuous scale";
            ("session.rating", "\"during-exposure\"".to_owned(), expected)
        })
    }

    fn tolerance_fault(&self) -> Option<(&'static str, String, &'static str)> {
        let tolerance = self.viewing_tolerance?;
        (!(0.001..=1.0).contains(&tolerance)).then(|| {
            let expected = "a part from 0.001 to 1, such as 0.02 for 2 %";
            ("session.viewing_tolerance", tolerance.to_string(), expected)
        })
    }

    fn refresh_fault(&self) -> Option<(&'static str, String, &'static str)> {
        let lowest_hz = self.lowest_refresh_hz?;
        (!(1.0..=1000.0).contains(&lowest_hz)).then(|| {
            let expected = "a rate from 1 to 1000 Hz";
            ("session.lowest_refresh_hz", lowest_hz.to_string(), expected)
        })
    }

    fn response_time_fault(&self) -> Option<(&'static str, String, &'static str)> {
        let is_time = |time: f64| time.is_finite() && (0.0..=3600.0).contains(&time);
        let shortest_s = self.shortest_response_s.unwrap_or(0.0);
        if !is_time(shortest_s) {
            let expected = "a time from 0 to 3600 s";
            return Some((
                "session.shortest_response_s",
                shortest_s.to_string(),
                expected,
            ));
        }
        let longest_s = self.longest_response_s?;
        (!is_time(longest_s) || longest_s <= shortest_s).then(|| {
            let expected = "a time above the shortest and up to 3600 s";
            (
                "session.longest_response_s",
                longest_s.to_string(),
                expected,
            )
        })
    }

    /// How often an image is rated at most: once in each block, an anchor more often.
    pub fn most_repetitions(&self) -> u32 {
        self.blocks * (1 + self.order.anchor_repeats)
    }

    /// How many trials a session has if a block has `images` different images.
    pub fn trial_count(&self, images: usize) -> usize {
        let repeats = 2 * self.order.anchor_repeats as usize;
        self.practice.len() + (images + repeats) * self.blocks as usize
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
    /// The test image alone (absolute category rating, ITU-T P.910).
    Single,
    /// The ten anchor as the reference, then the test image (double-stimulus impairment scale, ITU-R BT.500).
    Dsis,
    /// Test image and ten anchor, in an order by lot that the subject is not told, twice; both are rated
    /// (double-stimulus continuous quality scale, ITU-R BT.500).
    Dscqs,
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
    /// Shown instead of the instructions when a session goes on that was cut off.
    #[serde(default = "resumed")]
    pub resumed: String,
    /// The words of a labelled or continuous scale, from the lowest rating to the highest.
    #[serde(default)]
    pub labels: Vec<String>,
    /// The names of the two pictures of the layout `dscqs`.
    #[serde(default = "pair")]
    pub pair: [String; 2],
    /// Shown when the longest response time is over.
    #[serde(default = "too_slow")]
    pub too_slow: String,
    /// Shown while the session rests (the key P).
    #[serde(default = "paused")]
    pub paused: String,
    /// Above the form.
    #[serde(default = "form")]
    pub form: String,
    /// Under a question whose answer cannot stand.
    #[serde(default = "form_fault_text")]
    pub form_fault: String,
    /// On the button that goes on.
    #[serde(default = "continue_button")]
    pub continue_button: String,
    /// Below a number that is being typed: the key that gives it.
    #[serde(default = "enter_key")]
    pub enter_key: String,
    /// Asked when the subject wants to stop.
    #[serde(default = "stop_question")]
    pub stop_question: String,
    /// On the button that stops.
    #[serde(default = "stop_button")]
    pub stop_button: String,
}

fn resumed() -> String {
    "The session goes on where it stopped.".to_owned()
}

fn pair() -> [String; 2] {
    ["A".to_owned(), "B".to_owned()]
}

fn too_slow() -> String {
    "That took too long. The pictures are shown again.".to_owned()
}

fn paused() -> String {
    "A rest. Go on when you are ready.".to_owned()
}

fn form() -> String {
    "Please answer a few questions.".to_owned()
}

fn form_fault_text() -> String {
    "Please check this answer.".to_owned()
}

fn continue_button() -> String {
    "Continue".to_owned()
}

fn enter_key() -> String {
    "Enter".to_owned()
}

fn stop_question() -> String {
    "Stop the session? The ratings so far are kept.".to_owned()
}

fn stop_button() -> String {
    "Stop".to_owned()
}
