//! The protocol: one TOML file that states a whole study.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{Acuity, AnalysisPlan, InputError, ModelObserver, SessionPlan, StimulusPlan, Viewing};

/// A whole study: its images, its sessions, its analysis. Unknown keys are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Protocol {
    /// The name of the study, and of its folders below `data/` and `reports/`.
    pub study: String,
    /// One line for the head of the report.
    pub title: String,
    /// Where the study comes from: a paper, a pre-registration.
    pub source: String,
    /// Which images are made.
    pub stimuli: StimulusPlan,
    /// Where the subject sits.
    pub viewing: Viewing,
    /// What the eye resolves from there; if it is said, no channel is refined beyond it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acuity: Option<Acuity>,
    /// How the images are shown and rated.
    pub session: SessionPlan,
    /// What a simulated observer is.
    pub simulation: ModelObserver,
    /// How the ratings are analysed.
    pub analysis: AnalysisPlan,
}

impl Protocol {
    /// Reads the text of a protocol; `file` is only named in errors.
    ///
    /// # Errors
    ///
    /// The text is not TOML, has an unknown or missing key, a value out of range, or contradicts itself.
    pub fn from_toml(file: &Path, text: &str) -> Result<Self, InputError> {
        let protocol: Self = toml::from_str(text).map_err(|error| {
            let found = error.to_string();
            InputError::new(file, found.trim_end(), "a protocol (TOML)")
                .remedy("compare it with protocols/meyer-liu-1992.toml")
        })?;
        match protocol.fault() {
            None => Ok(protocol),
            Some((field, found, expected)) => {
                Err(InputError::new(file, found, expected).at(format!("field {field}")))
            }
        }
    }

    fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        let is_plain =
            |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'-';
        if !self.study.bytes().all(is_plain)
            || !self.study.bytes().any(|byte| byte.is_ascii_alphanumeric())
        {
            let expected = "lower-case letters, digits and '-' (it names folders)";
            return Some(("study", format!("{:?}", self.study), expected));
        }
        self.stimuli
            .fault()
            .or_else(|| self.viewing.fault())
            .or_else(|| self.acuity.and_then(Acuity::fault))
            .or_else(|| self.session.fault())
            .or_else(|| self.simulation.fault())
            .or_else(|| self.analysis.fault())
            .or_else(|| self.unknown_practice_image())
    }

    fn unknown_practice_image(&self) -> Option<(&'static str, String, &'static str)> {
        let stimuli = self.stimuli.stimuli();
        let is_unknown =
            |id: &&crate::StimulusId| stimuli.iter().all(|stimulus| stimulus.id != **id);
        let unknown = self.session.practice.iter().find(is_unknown)?;
        Some((
            "session.practice",
            format!("{:?}", unknown.as_str()),
            "images of the set, such as \"a140k_c140k\"",
        ))
    }
}
