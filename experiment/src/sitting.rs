//! One sitting: the session machine, its ratings on disk, and its sidecar.
//!
//! Not here: the window. It passes events to the session and calls [`Sitting::save`] after them.

use std::fmt;
use std::path::{Path, PathBuf};

use jiff::Timestamp;
use protocols::{DataSet, InputError, Observer, Study, SubjectId};

use crate::rating_row::{rating_row, utc};
use crate::ratings_log::RatingsLog;
use crate::sidecar::{self, SessionKey, Sidecar, Station, ending_word};
use crate::{Ending, Event, ExperimentError, Rules, Session, StimulusSet, data_set_files, trials};

/// Which session is run, and on what.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// The subject.
    pub subject: SubjectId,
    /// The folder of the stimulus set.
    pub stimuli_dir: PathBuf,
    /// The folder of people's ratings.
    pub data_dir: PathBuf,
    /// How many times shorter the times are, to try the session out; `None` for a session that counts.
    pub pilot: Option<f64>,
}

/// How a session ended, and where its ratings are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SessionEnd {
    /// The subject.
    pub subject: SubjectId,
    /// Complete or stopped.
    pub ending: Ending,
    /// How many trials are rated, practice included.
    pub rated: usize,
    /// How many trials there are.
    pub trials: usize,
    /// The ratings file.
    pub ratings_path: PathBuf,
}

impl fmt::Display for SessionEnd {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            subject,
            rated,
            trials,
            ..
        } = self;
        let path = self.ratings_path.display();
        match self.ending {
            Ending::Complete => write!(
                formatter,
                "subject {subject}: all {trials} trials rated, in {path}"
            ),
            Ending::Stopped => write!(
                formatter,
                "subject {subject}: stopped after {rated} of {trials} trials, in {path}; the same command goes on from there"
            ),
        }
    }
}

/// One sitting of one person.
#[derive(Debug)]
pub(crate) struct Sitting {
    pub(crate) session: Session,
    log: RatingsLog,
    sidecar: Sidecar,
    sidecar_path: PathBuf,
    exposure_requested_s: f64,
    clock_zero: Timestamp,
    is_begun: bool,
}

impl Drop for Sitting {
    /// A session that no window ever showed leaves no file.
    fn drop(&mut self) {
        if !self.is_begun && self.log.rated() == 0 && !self.sidecar_path.exists() {
            // What cannot be removed is an empty session, which the next start resumes.
            _ = std::fs::remove_file(self.log.path());
        }
    }
}

impl Sitting {
    /// Opens the subject's ratings, or resumes them. `clock_zero` is when the session's clock reads zero.
    pub(crate) fn open(
        study: &Study,
        set: &StimulusSet,
        options: &RunOptions,
        clock_zero: Timestamp,
    ) -> Result<Self, ExperimentError> {
        let key = SessionKey {
            subject_id: options.subject.clone(),
            session_id: 1,
            observer: Observer::Person,
            pilot_speed: options.pilot,
        };
        let data_set = DataSet::new(&options.data_dir, &study.protocol.study);
        data_set_files::prepare(&data_set, study, Observer::Person)?;
        let trials = trials(study, &key.subject_id, key.session_id)?;
        let factors = study.protocol.stimuli.factors();
        let log = RatingsLog::open(&data_set, &key, &trials, &factors)?;
        if log.rated() == trials.len() {
            let found = format!("all {} trials rated", trials.len());
            return Err(
                InputError::new(log.path(), found, "a session to begin or to resume")
                    .remedy("take another subject code")
                    .into(),
            );
        }
        let sidecar_path = DataSet::sidecar_path(log.path());
        let fresh = Sidecar::new(study, set.manifest_sha256(), &key);
        let sidecar = if log.rated() == 0 {
            fresh
        } else {
            Sidecar::read_same_session(&sidecar_path, &fresh)?
        };
        let rules = Rules::of(&study.protocol.session).faster(options.pilot.unwrap_or(1.0));
        Ok(Self {
            session: Session::new(trials, log.rated(), rules),
            log,
            sidecar,
            sidecar_path,
            exposure_requested_s: study.protocol.session.exposure_s,
            clock_zero,
            is_begun: false,
        })
    }

    /// Notes on disk that the sitting has begun on this computer.
    pub(crate) fn begin(&mut self, station: Station, at_s: f64) -> Result<(), ExperimentError> {
        self.is_begun = true;
        self.sidecar.sittings.push(sidecar::Sitting {
            started_at: utc(self.clock_zero, at_s),
            first_trial_id: self.session.rated() + 1,
            ended_at: None,
            ending: None,
            station: Some(station),
            frames: None,
            focus_losses: 0,
        });
        self.sidecar.write(&self.sidecar_path)
    }

    /// Puts the answer that waits, if one does, on disk; only then the session goes on.
    pub(crate) fn save(&mut self, at_s: f64) -> Result<(), ExperimentError> {
        let Some(answer) = self.session.to_save().copied() else {
            return Ok(());
        };
        let trial = &self.session.trials()[answer.trial];
        let row = rating_row(
            &self.sidecar.key,
            trial,
            &answer,
            self.exposure_requested_s,
            self.clock_zero,
        );
        self.log.append(&row)?;
        self.session.on(Event::Saved, at_s);
        Ok(())
    }

    /// Notes on disk how the sitting ended.
    pub(crate) fn finish(
        &mut self,
        ending: Ending,
        focus_losses: u32,
        at_s: f64,
    ) -> Result<SessionEnd, ExperimentError> {
        if let Some(sitting) = self.sidecar.sittings.last_mut() {
            sitting.ended_at = Some(utc(self.clock_zero, at_s));
            sitting.ending = Some(ending_word(ending));
            sitting.frames = self.session.frame_clock().summary().map(Into::into);
            sitting.focus_losses = focus_losses;
        }
        self.sidecar.write(&self.sidecar_path)?;
        Ok(SessionEnd {
            subject: self.sidecar.key.subject_id.clone(),
            ending,
            rated: self.session.rated(),
            trials: self.session.trials().len(),
            ratings_path: self.ratings_path().to_owned(),
        })
    }

    pub(crate) fn ratings_path(&self) -> &Path {
        self.log.path()
    }
}

#[cfg(test)]
mod tests;
