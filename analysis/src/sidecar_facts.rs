//! What a report takes from the sidecar of a ratings file.
//!
//! Read leniently: a sidecar that is missing or says less costs a warning, never the ratings.

use std::fs;
use std::path::Path;

use protocols::DataSet;
use protocols::rating::RatingRow;
use serde_json::Value;

/// The facts of one session that its rows do not hold; `None` where the sidecar is silent.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct SidecarFacts {
    /// Whether there is a sidecar that can be read.
    pub(crate) is_readable: bool,
    /// Who rated, as the sidecar says it: `person` or `simulated`.
    pub(crate) observer: Option<String>,
    /// The code of the subject.
    pub(crate) subject_id: Option<String>,
    /// The sitting.
    pub(crate) session_id: Option<u64>,
    /// The digest of the protocol that the session followed.
    pub(crate) protocol_sha256: Option<String>,
    /// The digest of the manifest of the images shown.
    pub(crate) manifest_sha256: Option<String>,
    /// The version of the program that took the ratings.
    pub(crate) acuity_version: Option<String>,
}

impl SidecarFacts {
    /// The facts in the sidecar of `ratings_path`.
    pub(crate) fn read(ratings_path: &Path) -> Self {
        let value = fs::read(DataSet::sidecar_path(ratings_path))
            .ok()
            .and_then(|bytes| serde_json::from_slice::<Value>(&bytes).ok());
        let Some(value) = value else {
            return Self::default();
        };
        let text = |key: &str| value.get(key).and_then(Value::as_str).map(str::to_owned);
        Self {
            is_readable: true,
            observer: text("observer"),
            subject_id: text("subject_id"),
            session_id: value.get("session_id").and_then(Value::as_u64),
            protocol_sha256: text("protocol_sha256"),
            manifest_sha256: text("manifest_sha256"),
            acuity_version: text("acuity_version"),
        }
    }

    /// What the sidecar says of itself that its rows deny: the key, what it has, what the rows have.
    pub(crate) fn contradiction(&self, row: &RatingRow) -> Option<(&'static str, String, String)> {
        let session_id = self.session_id.map(|session| session.to_string());
        let observer = row.observer.as_str();
        [
            ("observer", self.observer.clone(), observer.to_owned()),
            (
                "subject_id",
                self.subject_id.clone(),
                row.subject_id.to_string(),
            ),
            ("session_id", session_id, row.session_id.to_string()),
        ]
        .into_iter()
        .filter_map(|(key, said, rated)| Some((key, said?, rated)))
        .find(|(_, said, rated)| said != rated)
    }

    /// What is amiss for a session of the protocol with this digest.
    pub(crate) fn complaint(&self, protocol_sha256: &str) -> Option<String> {
        let start = |sha256: &str| sha256.chars().take(12).collect::<String>();
        if !self.is_readable {
            return Some(
                "no readable sidecar, so it is not known under which protocol it was run"
                    .to_owned(),
            );
        }
        match self.protocol_sha256.as_deref() {
            Some(sha256) if sha256 == protocol_sha256 => None,
            Some(sha256) => Some(format!(
                "run under another version of the protocol (SHA-256 {}…, this one is {}…)",
                start(sha256),
                start(protocol_sha256)
            )),
            None => Some("the sidecar does not name the protocol".to_owned()),
        }
    }
}
