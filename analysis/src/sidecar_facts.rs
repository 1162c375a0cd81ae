//! What a report takes from the sidecar of a ratings file.
//!
//! Read leniently: a sidecar that is missing or says less costs a warning, never the ratings.

use std::fs;
use std::path::Path;

use protocols::DataSet;
use protocols::rating::RatingRow;
use serde_json::Value;

/// The facts of one session that its rows do not hold; `None` where the sidecar is silent.
#[derive(Clone, Debug, Default, PartialEq)]
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
    /// Why the session was closed before its end, if it was.
    pub(crate) closed: Option<String>,
    /// How many sittings it took.
    pub(crate) sittings: usize,
    /// How many of them have no end.
    pub(crate) sittings_cut_off: usize,
    /// How often the window lost the keyboard.
    pub(crate) focus_losses: u64,
    /// The different stations of its sittings.
    pub(crate) stations: Vec<StationFacts>,
}

/// Where a session was sat.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StationFacts {
    pub(crate) monitor: Option<String>,
    pub(crate) monitor_px: Option<[u64; 2]>,
    pub(crate) operating_system: Option<String>,
    /// From the eye to the screen, where it was measured.
    pub(crate) distance_cm: Option<f64>,
    /// The angle of a pixel, where it was measured.
    pub(crate) degrees_per_pixel: Option<f64>,
}

impl StationFacts {
    /// The facts in the `station` of a sitting.
    fn of(station: &Value) -> Self {
        let text = |key: &str| station.get(key).and_then(Value::as_str).map(str::to_owned);
        let measured = |key: &str| station.get("measured")?.get(key)?.as_f64();
        let side = |place: usize| station.get("monitor_px")?.get(place)?.as_u64();
        let pitch_mm = measured("width_mm")
            .zip(measured("width_px"))
            .map(|(mm, px)| mm / px);
        let distance_cm = measured("distance_cm");
        Self {
            monitor: text("monitor"),
            monitor_px: side(0).zip(side(1)).map(|(width, height)| [width, height]),
            operating_system: text("operating_system"),
            degrees_per_pixel: pitch_mm.zip(distance_cm).map(|(pitch_mm, distance_cm)| {
                libm::atan(pitch_mm / (10.0 * distance_cm)).to_degrees()
            }),
            distance_cm,
        }
    }

    /// The monitor, its pixels, the distance and the system, as far as they are known.
    pub(crate) fn in_words(&self) -> String {
        let parts = [
            self.monitor.clone(),
            self.monitor_px
                .map(|[width, height]| format!("{width} × {height} pixels")),
            self.distance_cm
                .map(|distance| format!("at {distance:.1} cm")),
            self.operating_system.clone(),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
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
        let sittings: Vec<&Value> = (value.get("sittings").and_then(Value::as_array))
            .into_iter()
            .flatten()
            .collect();
        let is_missing = |sitting: &&&Value| sitting.get("ended_at").is_none_or(Value::is_null);
        let focus_losses = |sitting: &&Value| sitting.get("focus_losses")?.as_u64();
        let described = sittings.iter().filter_map(|sitting| sitting.get("station"));
        let mut stations: Vec<StationFacts> = described
            .filter(|station| station.is_object())
            .map(StationFacts::of)
            .collect();
        stations.dedup();
        Self {
            is_readable: true,
            closed: (value.get("closed").and_then(|closed| closed.get("reason")))
                .and_then(Value::as_str)
                .map(str::to_owned),
            sittings: sittings.len(),
            sittings_cut_off: sittings.iter().filter(is_missing).count(),
            focus_losses: sittings.iter().filter_map(focus_losses).sum(),
            stations,
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
