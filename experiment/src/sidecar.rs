//! The sidecar of a ratings file: what the rows do not say of their session.
//!
//! It is written before the first rating, and again when a sitting ends. A sitting without an end was
//! cut off: by a crash, or by the mains.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use protocols::{
    Access, InputError, Observer, ReadError, Sha256Digest, StimulusId, Study, SubjectId,
    write_atomically,
};
use serde::{Deserialize, Serialize};

use crate::intake_files::IntakeRecord;
use crate::{DoneBefore, Ending, ExperimentError, FrameSummary, Refresh, StationFile};

/// What the times in the ratings are, in the words that the data can bear.
pub(crate) const TIMING_SOURCE: &str = "Onset and offset are software times after the buffer swap \
(submitted, never seen on the screen); the duration error is within one frame plus the logged missed \
frames; the onset of light was not measured.";
/// The same for a simulated session.
pub(crate) const VIRTUAL_TIMING: &str = "Virtual clock of a simulated session, 60 frames a second from \
1970-01-01T00:00:00Z; nothing was shown.";

/// Which session a file belongs to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SessionKey {
    pub(crate) subject_id: SubjectId,
    pub(crate) session_id: u32,
    pub(crate) observer: Observer,
    /// How much faster than the protocol says; `None` for a session that counts.
    pub(crate) pilot_speed: Option<f64>,
}

impl SessionKey {
    /// The task in the file's name.
    pub(crate) fn task(&self) -> &'static str {
        match self.pilot_speed {
            Some(_) => "pilot",
            None => "rating",
        }
    }
}

/// The sidecar.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sidecar {
    pub(crate) study: String,
    #[serde(flatten)]
    pub(crate) key: SessionKey,
    pub(crate) task: String,
    pub(crate) acuity_version: String,
    pub(crate) protocol_sha256: Sha256Digest,
    pub(crate) manifest_sha256: Sha256Digest,
    pub(crate) order_seed: u64,
    pub(crate) timing_source: String,
    /// Bias and gain of a simulated observer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) model: Option<ModelTraits>,
    pub(crate) sittings: Vec<Sitting>,
    /// Consent, form and screening, where the protocol has them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) intake: Option<IntakeRecord>,
    /// Set when the experimenter closed the session although it is not complete.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) closed: Option<Closed>,
}

/// When and why a session was closed before its end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Closed {
    pub(crate) at: String,
    pub(crate) reason: String,
}

/// What makes one simulated observer differ from the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ModelTraits {
    pub(crate) seed: u64,
    pub(crate) bias: f64,
    pub(crate) gain: f64,
}

/// From opening the window to closing it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sitting {
    pub(crate) started_at: String,
    pub(crate) first_trial_id: usize,
    pub(crate) ended_at: Option<String>,
    pub(crate) ending: Option<String>,
    pub(crate) station: Option<Station>,
    pub(crate) frames: Option<Frames>,
    /// How often the window lost the keyboard while a trial ran.
    #[serde(default)]
    pub(crate) focus_losses: u32,
    /// What the experimenter noted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) notes: Vec<Words>,
}

/// A note of the experimenter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Words {
    pub(crate) at: String,
    pub(crate) trial_id: usize,
    pub(crate) text: String,
}

/// The computer and its screen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Station {
    pub(crate) operating_system: String,
    pub(crate) window_px: [u32; 2],
    pub(crate) monitor_px: [u32; 2],
    pub(crate) pixels_per_point: f32,
    #[serde(default)]
    pub(crate) monitor: Option<String>,
    /// The monitor's own resolution, if the X server knows it.
    #[serde(default)]
    pub(crate) native_px: Option<[u32; 2]>,
    /// The frames before the first screen.
    #[serde(default)]
    pub(crate) refresh: Option<Refresh>,
    /// Whether the driver told when it swapped each frame; the table of events then has `exposure_swapped`.
    #[serde(default)]
    pub(crate) tells_swaps: bool,
    /// The measured screen and chair.
    #[serde(default)]
    pub(crate) measured: Option<StationFile>,
    /// How many pixels of the window were found equal to the images before the first screen.
    #[serde(default)]
    pub(crate) compared_px: u64,
    /// For each image how many pixels the display's gamut lacks; empty where the display is sRGB by declaration
    /// (the manifest has the counts of sRGB).
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub(crate) out_of_gamut_px: BTreeMap<StimulusId, u64>,
    /// The luminance of the stimuli's white as a part of the display's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) white_luminance: Option<f64>,
}

/// The frames with a test image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Frames {
    pub(crate) measured: usize,
    pub(crate) median_ms: f64,
    pub(crate) p99_ms: f64,
    pub(crate) longest_ms: f64,
    pub(crate) missed: u32,
}

impl From<FrameSummary> for Frames {
    fn from(summary: FrameSummary) -> Self {
        let milliseconds = |seconds: f64| (seconds * 1e6).round() / 1e3;
        Self {
            measured: summary.intervals,
            median_ms: milliseconds(summary.median_s),
            p99_ms: milliseconds(summary.p99_s),
            longest_ms: milliseconds(summary.longest_s),
            missed: summary.missed,
        }
    }
}

pub(crate) fn ending_word(ending: Ending) -> String {
    match ending {
        Ending::Complete => "complete".to_owned(),
        Ending::Stopped => "stopped".to_owned(),
        Ending::Declined => "declined".to_owned(),
    }
}

impl Sidecar {
    /// The sidecar of a session without sittings.
    pub(crate) fn new(study: &Study, manifest_sha256: &Sha256Digest, key: &SessionKey) -> Self {
        let timing_source = match key.observer {
            Observer::Person => TIMING_SOURCE,
            Observer::Simulated => VIRTUAL_TIMING,
        };
        Self {
            study: study.protocol.study.clone(),
            key: key.clone(),
            task: key.task().to_owned(),
            acuity_version: env!("CARGO_PKG_VERSION").to_owned(),
            protocol_sha256: study.sha256.clone(),
            manifest_sha256: manifest_sha256.clone(),
            order_seed: study.protocol.session.order_seed,
            timing_source: timing_source.to_owned(),
            model: None,
            sittings: Vec::new(),
            intake: None,
            closed: None,
        }
    }

    /// Which steps before the first trial are done.
    pub(crate) fn done_before(&self) -> DoneBefore {
        let record = self.intake.clone().unwrap_or_default();
        DoneBefore {
            has_consent: record.consent_at.is_some(),
            has_form: record.form_at.is_some(),
            has_screening: record.screening_at.is_some(),
        }
    }

    /// Reads a sidecar.
    pub(crate) fn read(path: &Path) -> Result<Self, ReadError> {
        let kind = "the sidecar of a ratings file (JSON)";
        let text =
            fs::read_to_string(path).map_err(|error| ReadError::from_io(path, kind, error))?;
        let read = serde_json::from_str(&text);
        Ok(read.map_err(|error| InputError::new(path, error.to_string(), kind))?)
    }

    /// Reads the sidecar of a session that is to be resumed, and checks that nothing has changed since.
    pub(crate) fn read_same_session(path: &Path, expected: &Self) -> Result<Self, ExperimentError> {
        let found = Self::read(path)?;
        if let Some(closed) = &found.closed {
            let found = format!(
                "a session closed as incomplete at {} ({})",
                closed.at, closed.reason
            );
            return Err(
                InputError::new(path, found, "a session to begin or to resume")
                    .at("field closed")
                    .remedy("take another subject code, or another session with --session")
                    .into(),
            );
        }
        let facts = found.identity().into_iter().zip(expected.identity());
        let mut contradictions = facts.filter(|(found, expected)| found != expected);
        match contradictions.next() {
            None => Ok(found),
            Some(((field, begun_with), (_, expected))) => {
                let found = format!("a session that was begun with {begun_with}");
                Err(InputError::new(path, found, expected)
                    .at(format!("field {field}"))
                    .remedy("resume with what it was begun with, or take another subject code")
                    .into())
            }
        }
    }

    /// What may not change while a session is resumed: fields and their values.
    fn identity(&self) -> [(&'static str, String); 5] {
        let speed = self.key.pilot_speed;
        let speed = speed.map_or_else(|| "none".to_owned(), |speed| speed.to_string());
        let SessionKey {
            subject_id,
            session_id,
            observer,
            ..
        } = &self.key;
        let session = format!("subject {subject_id}, session {session_id}, {observer:?}");
        [
            ("study", self.study.clone()),
            ("protocol_sha256", self.protocol_sha256.to_string()),
            ("manifest_sha256", self.manifest_sha256.to_string()),
            ("pilot_speed (--pilot speed)", speed),
            ("subject_id, session_id, observer", session),
        ]
    }

    /// Writes the sidecar, whole or not at all.
    pub(crate) fn write(&self, path: &Path) -> Result<(), ExperimentError> {
        let to_error = ExperimentError::io("write", path);
        let mut text = match serde_json::to_string_pretty(self) {
            Ok(text) => text,
            Err(error) => return Err(to_error(error.into())),
        };
        text.push('\n');
        write_atomically(path, text.as_bytes(), Access::Owner)
            .map_err(ExperimentError::io("write", path))
    }
}
