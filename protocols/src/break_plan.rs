//! The parts of a protocol that stand between the trials: pages of instructions, breaks, progress.

use serde::{Deserialize, Serialize};

use crate::StimulusId;

/// A page of the instructions, with up to three pictures of the study at their own size.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InstructionPage {
    /// Above the pictures; blank lines part its paragraphs.
    pub text: String,
    /// The pictures, from left to right.
    #[serde(default)]
    pub pictures: Vec<StimulusId>,
    /// The words under each picture; none, or one for each.
    #[serde(default)]
    pub captions: Vec<String>,
}

impl InstructionPage {
    pub(crate) fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        if self.pictures.len() > 3 {
            let found = format!("{} pictures", self.pictures.len());
            return Some(("session.pages.pictures", found, "at most three pictures"));
        }
        let (captions, pictures) = (self.captions.len(), self.pictures.len());
        (captions != 0 && captions != pictures).then(|| {
            let found = format!("{captions} captions for {pictures} pictures");
            let expected = "no caption, or one for each picture";
            ("session.pages.captions", found, expected)
        })
    }
}

/// Breaks between the test trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BreakPlan {
    /// After so many test trials comes a break; none after the last.
    pub every: u32,
    /// How long it is; a countdown tells.
    pub seconds: f64,
    /// Whether the subject may go on before it is over.
    #[serde(default)]
    pub can_be_cut_short: bool,
    /// Above the countdown.
    #[serde(default = "text")]
    pub text: String,
}

impl BreakPlan {
    pub(crate) fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        if self.every == 0 {
            let expected = "a number of trials from 1";
            return Some(("session.breaks.every", "0".to_owned(), expected));
        }
        (!(1.0..=3600.0).contains(&self.seconds)).then(|| {
            let expected = "a time from 1 to 3600 s";
            ("session.breaks.seconds", self.seconds.to_string(), expected)
        })
    }
}

fn text() -> String {
    "A short break. Look away from the screen for a moment.".to_owned()
}
