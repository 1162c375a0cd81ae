//! The sessions of a study as they stand on disk: who is done, who is not, and who was closed.
//!
//! It only reads, and takes no lock, so it may look while a session runs. A file that cannot be read is named
//! and hides no other.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use protocols::rating::read_ratings;
use protocols::{DataSet, InputError, ReadError, Study, SubjectId};

use crate::sidecar::Sidecar;
use crate::{ExperimentError, Refresh};

/// Whether a session is complete.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Standing {
    /// Every trial is rated.
    Complete,
    /// It goes on where it stopped.
    Unfinished,
    /// The experimenter closed it; it is kept, never resumed, and the report leaves its subject out.
    Closed {
        /// When: UTC, ISO 8601.
        at: String,
        /// Why.
        reason: String,
    },
}

/// One session.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedSession {
    /// Who sat it.
    pub subject: SubjectId,
    /// Which sitting of that subject, from 1.
    pub session: u32,
    /// How many times faster than the protocol, for a trial run; `None` for a session that counts.
    pub pilot: Option<f64>,
    /// How many trials are rated, practice included.
    pub rated: usize,
    /// How many trials there are.
    pub trials: usize,
    /// Whether it is complete.
    pub standing: Standing,
    /// When it was begun: UTC, ISO 8601; `None` if no window ever showed it.
    pub started_at: Option<String>,
    /// Whether it was begun with the protocol as it is now.
    pub is_of_this_protocol: bool,
    /// The frames before the first screen, as last measured.
    pub refresh: Option<Refresh>,
    /// The ratings file.
    pub ratings_path: PathBuf,
}

/// Every session of a study.
#[derive(Debug, Default)]
pub struct SessionList {
    /// By subject, trial runs last.
    pub sessions: Vec<ListedSession>,
    /// Files that cannot be used.
    pub faults: Vec<ReadError>,
}

/// Lists the sessions of people in the data set of `study` in `data_dir`; none where there is no such folder.
///
/// # Errors
///
/// The folder is there but cannot be read.
pub fn session_list(study: &Study, data_dir: &Path) -> Result<SessionList, ExperimentError> {
    let data_set = DataSet::new(data_dir, &study.protocol.study);
    let folder = data_set.data_folder();
    let mut list = SessionList::default();
    let entries = match fs::read_dir(&folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(list),
        Err(error) => return Err(ReadError::from_io(&folder, "a data folder", error).into()),
    };
    for entry in entries {
        let path = entry.map_err(ExperimentError::io("read", &folder))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if !DataSet::has_ratings(&name) {
            continue;
        }
        match listed(study, &data_set, &path, &name) {
            Ok(session) => list.sessions.push(session),
            Err(fault) => list.faults.push(fault),
        }
    }
    list.sessions.sort_by(|left, right| {
        let key = |session: &ListedSession| {
            let number = session.subject.number();
            (session.pilot.is_some(), number, session.subject.clone())
        };
        (key(left), left.session).cmp(&(key(right), right.session))
    });
    list.faults.sort_by_key(ToString::to_string);
    Ok(list)
}

fn listed(
    study: &Study,
    data_set: &DataSet,
    path: &Path,
    name: &str,
) -> Result<ListedSession, ReadError> {
    let (subject, session, task) = parts(name)
        .filter(|(subject, session, task)| data_set.ratings_path(subject, *session, task) == path)
        .ok_or_else(|| {
            let expected = format!("a ratings file of the study {}", study.protocol.study);
            InputError::new(path, "a name that this study gives no file", expected)
                .remedy("move it out of the data folder")
        })?;
    let rated = read_ratings(path, &study.protocol.stimuli.factors())?;
    let sidecar = match Sidecar::read(&DataSet::sidecar_path(path)) {
        Ok(sidecar) => Some(sidecar),
        // Nothing was rated, and nothing was shown: the window had not opened yet.
        Err(_) if rated.rows.is_empty() && !DataSet::sidecar_path(path).exists() => None,
        Err(error) => return Err(error),
    };
    let rated = rated.rows.len();
    let trials = trial_count(study);
    let closed = sidecar.as_ref().and_then(|sidecar| sidecar.closed.clone());
    let sittings = || sidecar.iter().flat_map(|sidecar| &sidecar.sittings);
    let mut refreshes = sittings().filter_map(|sitting| sitting.station.as_ref()?.refresh);
    Ok(ListedSession {
        subject,
        session,
        pilot: sidecar.as_ref().map_or_else(
            || (task == PILOT).then_some(1.0),
            |sidecar| sidecar.key.pilot_speed,
        ),
        rated,
        trials,
        standing: match closed {
            Some(closed) => Standing::Closed {
                at: closed.at,
                reason: closed.reason,
            },
            None if rated >= trials => Standing::Complete,
            None => Standing::Unfinished,
        },
        started_at: sittings().next().map(|sitting| sitting.started_at.clone()),
        is_of_this_protocol: sidecar
            .as_ref()
            .is_none_or(|sidecar| sidecar.protocol_sha256 == study.sha256),
        refresh: refreshes.next_back(),
        ratings_path: path.to_owned(),
    })
}

/// The task in the file names of trial runs, as the sidecar has it.
const PILOT: &str = "pilot";

/// Subject, session and task by the name of a ratings file.
fn parts(name: &str) -> Option<(SubjectId, u32, &str)> {
    let mut parts = name.strip_suffix("_data.csv")?.split('_').skip(1);
    let mut part = |key: &str| parts.next()?.strip_prefix(key);
    let subject = part("subject-")?.parse().ok()?;
    let session = part("session-")?.parse().ok()?;
    Some((subject, session, part("task-")?))
}

/// How many trials a session of the study has, practice included.
fn trial_count(study: &Study) -> usize {
    let images = study.protocol.stimuli.images();
    let rated = images.iter().filter(|image| image.is_rated).count();
    study.protocol.session.trial_count(rated)
}

#[cfg(test)]
mod tests;
