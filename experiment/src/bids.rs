//! The ratings of a study as a BIDS data set: `sub-01/ses-1/beh/sub-01_ses-1_task-rating_events.tsv`.
//!
//! Only people's sessions that count are exported, as they are: complete or not, with a line for each trial. The
//! onset of an event is the start of its trial, counted from that of the session's first trial; its duration is
//! the exposure that was submitted. The pictures that were rated stand below `stimuli/`.
//!
//! Source: Brain Imaging Data Structure 1.10, "Behavioral experiments (with no neural recordings)" and "Task
//! events".

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use jiff::Timestamp;
use protocols::rating::{Phase, RatingRow, ShownFirst, columns, read_ratings};
use protocols::{
    Access, DataSet, InputError, Manifest, ManifestFile, Observer, StimulusId, Study,
    write_atomically,
};
use serde_json::{Map, Value, json};

use crate::sidecar::Sidecar;
use crate::stimulus_set::ShownFiles;
use crate::{ExperimentError, data_set_files};

/// The version of the standard that the export follows.
const BIDS_VERSION: &str = "1.10.0";

/// Writes people's sessions of `study` from `data_dir` as a BIDS data set into the new folder `bids_dir`; says
/// how many sessions there are.
///
/// # Errors
///
/// There are no sessions, one cannot be read, the stimulus set is not there, `bids_dir` has something in it, or the
/// system will not take the files. Nothing is left of an export that failed.
pub fn export_bids(
    study: &Study,
    stimuli_dir: &Path,
    data_dir: &Path,
    bids_dir: &Path,
) -> Result<usize, ExperimentError> {
    let data_set = DataSet::new(data_dir, &study.protocol.study);
    data_set_files::check(&data_set, study, Observer::Person)?;
    if bids_dir.exists() && data_set_files::has_entries(bids_dir)? {
        let found = "a folder with files in it";
        return Err(InputError::new(bids_dir, found, "a new or empty folder").into());
    }
    let sessions = sessions(study, &data_set)?;
    if sessions.is_empty() {
        let found = "no session";
        return Err(
            InputError::new(data_set.data_folder(), found, "ratings to export")
                .remedy("run `acuity run` first")
                .into(),
        );
    }
    let export = Export {
        study,
        bids_dir,
        files: ShownFiles::of(study, stimuli_dir)?
            .files
            .into_iter()
            .collect(),
    };
    let written = export.all(stimuli_dir, &sessions);
    if written.is_err() {
        // The folder was new or empty: all that is in it is half an export. What cannot be removed is named by the error.
        _ = fs::remove_dir_all(bids_dir);
    }
    written.map(|()| sessions.len())
}

/// One session as it was read.
struct Session {
    rows: Vec<RatingRow>,
    sidecar: Sidecar,
}

/// Every session with ratings that count, by file name.
fn sessions(study: &Study, data_set: &DataSet) -> Result<Vec<Session>, ExperimentError> {
    let folder = data_set.data_folder();
    let entries = fs::read_dir(&folder).map_err(ExperimentError::io("read", &folder))?;
    let mut paths: Vec<PathBuf> = Vec::new();
    for entry in entries {
        let path = entry.map_err(ExperimentError::io("read", &folder))?.path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if name.ends_with("_task-rating_data.csv") {
            paths.push(path);
        }
    }
    paths.sort();
    let factors = study.protocol.stimuli.factors();
    let mut sessions = Vec::new();
    for path in paths {
        let rows = read_ratings(&path, &factors)?.rows;
        let sidecar = Sidecar::read(&DataSet::sidecar_path(&path))?;
        if sidecar.study != study.protocol.study {
            let expected = format!("{:?}", study.protocol.study);
            return Err(
                InputError::new(path, format!("{:?}", sidecar.study), expected)
                    .at("field study of its sidecar")
                    .into(),
            );
        }
        if !rows.is_empty() {
            sessions.push(Session { rows, sidecar });
        }
    }
    Ok(sessions)
}

struct Export<'a> {
    study: &'a Study,
    bids_dir: &'a Path,
    /// The file of each picture.
    files: BTreeMap<StimulusId, ManifestFile>,
}

impl Export<'_> {
    fn all(&self, stimuli_dir: &Path, sessions: &[Session]) -> Result<(), ExperimentError> {
        self.head(sessions)?;
        for session in sessions {
            self.session(session)?;
        }
        self.stimuli(stimuli_dir, sessions)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), ExperimentError> {
        let path = self.bids_dir.join(name);
        if let Some(folder) = path.parent() {
            data_set_files::create_private_folder(folder)?;
        }
        write_atomically(&path, bytes, Access::Owner).map_err(ExperimentError::io("write", &path))
    }

    fn write_json(&self, name: &str, value: &Value) -> Result<(), ExperimentError> {
        self.write(name, format!("{value:#}\n").as_bytes())
    }

    /// What stands at the root.
    fn head(&self, sessions: &[Session]) -> Result<(), ExperimentError> {
        let protocol = &self.study.protocol;
        let description = json!({
            "Name": protocol.title,
            "BIDSVersion": BIDS_VERSION,
            "DatasetType": "raw",
            "ReferencesAndLinks": [protocol.source],
            "GeneratedBy": [{ "Name": "acuity", "Version": env!("CARGO_PKG_VERSION") }],
        });
        self.write_json("dataset_description.json", &description)?;
        let readme = format!(
            "# {}\n\nRatings of image quality, exported by acuity {}. Study: {}. Source: {}.\n\nThe protocol has the SHA-256 {}. \
             Times are software times: the onset of light was not measured.\n",
            protocol.title,
            env!("CARGO_PKG_VERSION"),
            protocol.study,
            protocol.source,
            self.study.sha256
        );
        self.write("README.md", readme.as_bytes())?;
        let subjects: BTreeSet<String> = sessions
            .iter()
            .map(|session| session.sidecar.key.subject_id.to_string())
            .collect();
        let mut participants = "participant_id\n".to_owned();
        for subject in subjects {
            participants.push_str("sub-");
            participants.push_str(&subject);
            participants.push('\n');
        }
        self.write("participants.tsv", participants.as_bytes())?;
        let about = json!({ "participant_id": { "Description": "code of the subject" } });
        self.write_json("participants.json", &about)
    }

    fn session(&self, session: &Session) -> Result<(), ExperimentError> {
        let key = &session.sidecar.key;
        let (subject, number) = (&key.subject_id, key.session_id);
        let stem =
            format!("sub-{subject}/ses-{number}/beh/sub-{subject}_ses-{number}_task-rating_events");
        self.write(&format!("{stem}.tsv"), self.events(session)?.as_bytes())?;
        self.write_json(&format!("{stem}.json"), &self.about(session))
    }

    /// The table of events; what stands in no column of the standard follows by its own name.
    fn events(&self, session: &Session) -> Result<String, ExperimentError> {
        let factors = self.study.protocol.stimuli.factors();
        let mut header: Vec<String> = [
            "onset",
            "duration",
            "trial_type",
            "response_time",
            "stim_file",
        ]
        .map(str::to_owned)
        .to_vec();
        header.extend(own_columns(&factors));
        let mut text = header.join("\t") + "\n";
        let first = session.rows.first().map(started).transpose()?;
        for row in &session.rows {
            let since = started(row)?.duration_since(first.unwrap_or_default());
            let phase = match row.phase {
                Phase::Practice => "practice",
                Phase::Test => "test",
            };
            let or_not =
                |rating: Option<i32>| rating.map_or_else(|| "n/a".to_owned(), |r| r.to_string());
            let mut fields = vec![
                format!("{:.3}", since.as_secs_f64()),
                format!("{:.4}", row.exposure_submitted_s),
                phase.to_owned(),
                format!("{:.4}", row.response_time_s),
                self.stimulus(&row.stimulus_id)?.1,
                row.trial_id.to_string(),
                row.repetition.to_string(),
            ];
            fields.extend(row.levels.iter().cloned());
            fields.extend([
                row.rating.to_string(),
                or_not(row.reference_rating),
                row.shown_first.map_or("n/a", ShownFirst::as_str).to_owned(),
                row.missed_frames.to_string(),
                row.showings.to_string(),
            ]);
            text.push_str(&fields.join("\t"));
            text.push('\n');
        }
        Ok(text)
    }

    /// The sidecar of the events: task, presentation, and every column of its own.
    fn about(&self, session: &Session) -> Value {
        let protocol = &self.study.protocol;
        let factors = self.study.protocol.stimuli.factors();
        let own = own_columns(&factors);
        let mut about = Map::new();
        about.insert("TaskName".to_owned(), "rating".into());
        about.insert("TaskDescription".to_owned(), protocol.title.clone().into());
        about.insert(
            "Instructions".to_owned(),
            protocol.session.texts.instructions.clone().into(),
        );
        let described = columns(&factors).into_iter();
        for column in described.filter(|column| own.contains(&column.name)) {
            let mut description = json!({ "Description": column.description });
            if let Some(unit) = column.unit {
                description["Units"] = unit.into();
            }
            about.insert(column.name, description);
        }
        about.insert(
            "trial_type".to_owned(),
            json!({
                "Description": "whether the trial counts",
                "Levels": { "practice": "never analysed", "test": "a trial of the study" },
            }),
        );
        about.insert(
            "StimulusPresentation".to_owned(),
            presentation(session, protocol.viewing),
        );
        Value::Object(about)
    }

    /// The pictures that were rated.
    fn stimuli(&self, stimuli_dir: &Path, sessions: &[Session]) -> Result<(), ExperimentError> {
        let rows = sessions.iter().flat_map(|session| &session.rows);
        let rated: BTreeSet<_> = rows.map(|row| &row.stimulus_id).collect();
        for id in rated {
            let (file, place) = self.stimulus(id)?;
            let bytes = file.read_verified(stimuli_dir)?;
            self.write(&format!("stimuli/{place}"), &bytes)?;
        }
        Ok(())
    }

    /// The file of a picture, and its place below `stimuli/`.
    fn stimulus(&self, id: &StimulusId) -> Result<(&ManifestFile, String), InputError> {
        let file = self.files.get(id).ok_or_else(|| {
            let expected = format!("the stimulus {id}");
            InputError::new(Manifest::FILE_NAME, "no such entry", expected)
        })?;
        Ok((
            file,
            format!("{}/{}", self.study.protocol.stimuli.set(), file.name),
        ))
    }
}

/// The columns that are Acuity's own, in their order.
fn own_columns(factors: &[String]) -> Vec<String> {
    let before = ["trial_id", "repetition"].map(str::to_owned);
    let after = [
        "rating",
        "reference_rating",
        "shown_first",
        "missed_frames",
        "showings",
    ];
    let after = after.map(str::to_owned);
    before
        .into_iter()
        .chain(factors.iter().cloned())
        .chain(after)
        .collect()
}

fn started(row: &RatingRow) -> Result<Timestamp, InputError> {
    row.started_at.parse().map_err(|error: jiff::Error| {
        let place = format!("subject {}, trial {}", row.subject_id, row.trial_id);
        InputError::new("column started_at", error.to_string(), "a time in ISO 8601").at(place)
    })
}

/// What showed the pictures, by the latest sitting. The distance is that of the station, or where none was measured
/// the protocol's.
fn presentation(session: &Session, viewing: protocols::Viewing) -> Value {
    let mut presentation = json!({
        "SoftwareName": "acuity",
        "SoftwareVersion": session.sidecar.acuity_version,
        "ScreenDistance": viewing.distance_cm / 100.0,
        "ScreenOrigin": ["top", "left"],
    });
    let station = session
        .sidecar
        .sittings
        .last()
        .and_then(|sitting| sitting.station.as_ref());
    if let Some(station) = station {
        presentation["OperatingSystem"] = station.operating_system.clone().into();
        presentation["ScreenResolution"] = json!(station.monitor_px);
        if let Some(measured) = &station.measured {
            let metres = |mm: f64| (mm * 100.0).round() / 1e5;
            let size = station
                .monitor_px
                .map(|pixels| metres(f64::from(pixels) * measured.pixel_pitch_mm()));
            presentation["ScreenDistance"] = json!(metres(measured.distance_cm * 10.0));
            presentation["ScreenSize"] = json!(size);
        }
        if let Some(hz) = station.refresh.and_then(|refresh| refresh.nominal_hz) {
            presentation["ScreenRefreshRate"] = json!(hz);
        }
    }
    presentation
}

#[cfg(test)]
mod tests;
