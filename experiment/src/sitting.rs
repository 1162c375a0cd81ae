//! One sitting: the session machine, its ratings on disk, and its sidecar.
//!
//! Not here: the window. It passes events to the session and calls [`Sitting::save`] after them.

use std::fmt;
use std::path::{Path, PathBuf};

use jiff::Timestamp;
use protocols::{Access, DataSet, InputError, Observer, Study, SubjectId, write_atomically};

use crate::intake::PixelAngle;
use crate::intake_files::IntakeFiles;
use crate::rating_row::{rating_row, utc};
use crate::ratings_log::RatingsLog;
use crate::sidecar::{self, Closed, SessionKey, Sidecar, Station, Words, ending_word};
use crate::timing_log::TimingLog;
use crate::{
    Ending, Event, ExperimentError, Finished, Intake, Noted, Order, Refresh, Rules, Screen,
    ScreeningScore, Session, StationFile, StimulusSet, data_set_files, trials,
};

/// Which session is run, and on what.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// The subject.
    pub subject: SubjectId,
    /// The folder of the stimulus set.
    pub stimuli_dir: PathBuf,
    /// The folder of people's ratings.
    pub data_dir: PathBuf,
    /// Which sitting of the subject, from 1.
    pub session: u32,
    /// The monitor by its name, or the one that the desktop chooses.
    pub monitor: Option<String>,
    /// The measured screen and chair, if there are any.
    pub station: Option<StationFile>,
    /// How many times shorter the times are, to try the session out; `None` for a session that counts.
    pub pilot: Option<f64>,
    /// Opens the experimenter's view, if there shall be one.
    pub view: Option<ViewProgram>,
}

/// The program that shows the experimenter's view: it calls [`crate::experimenters_view`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ViewProgram {
    /// The file.
    pub program: PathBuf,
    /// What it is called with.
    pub arguments: Vec<String>,
}

impl RunOptions {
    /// The session of a person, and the data set that it belongs to.
    fn session_of(&self, study: &Study) -> (SessionKey, DataSet) {
        let key = SessionKey {
            subject_id: self.subject.clone(),
            session_id: self.session,
            observer: Observer::Person,
            pilot_speed: self.pilot,
        };
        (key, DataSet::new(&self.data_dir, &study.protocol.study))
    }
}

/// How a session ended, and where its ratings are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SessionEnd {
    /// The subject.
    pub subject: SubjectId,
    /// Complete, stopped or declined.
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
            Ending::Declined => write!(
                formatter,
                "subject {subject}: did not agree to take part; nothing was kept"
            ),
        }
    }
}

/// One sitting of one person.
#[derive(Debug)]
pub(crate) struct Sitting {
    pub(crate) session: Session,
    /// What comes before the first trial.
    pub(crate) intake: Intake,
    log: RatingsLog,
    sidecar: Sidecar,
    sidecar_path: PathBuf,
    study: Study,
    data_set: DataSet,
    timing: TimingLog,
    exposure_requested_s: f64,
    pixel_angle: PixelAngle,
    clock_zero: Timestamp,
    is_begun: bool,
    /// Whether there are notes that are not on disk.
    has_new_words: bool,
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
        let (key, data_set) = options.session_of(study);
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
        let is_fresh = log.rated() == 0 && !is_closed(&sidecar_path);
        let sidecar = if is_fresh {
            // What was answered before the first trial stands, if nothing else has changed.
            Sidecar::read_same_session(&sidecar_path, &fresh).unwrap_or(fresh)
        } else {
            Sidecar::read_same_session(&sidecar_path, &fresh)?
        };
        let plan = &study.protocol.session;
        let intake = Intake::new(plan, &key.subject_id, key.session_id, sidecar.done_before());
        let rules = Rules::of(&study.protocol.session).faster(options.pilot.unwrap_or(1.0));
        let timing = TimingLog::beside(&data_set, log.path(), clock_zero)?;
        Ok(Self {
            session: Session::new(trials, log.rated(), rules),
            intake,
            study: study.clone(),
            data_set,
            timing,
            log,
            sidecar,
            sidecar_path,
            exposure_requested_s: study.protocol.session.exposure_s,
            pixel_angle: pixel_angle(study, options),
            clock_zero,
            is_begun: false,
            has_new_words: false,
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
            notes: Vec::new(),
        });
        self.timing.begin(self.sidecar.sittings.len());
        self.sidecar.write(&self.sidecar_path)
    }

    /// Puts on disk what was finished before the first trial.
    pub(crate) fn keep(&mut self, finished: Finished, at_s: f64) -> Result<(), ExperimentError> {
        let at = utc(self.clock_zero, at_s);
        let files = IntakeFiles::new(&self.data_set, &self.sidecar.key);
        let record = self.sidecar.intake.get_or_insert_default();
        match finished {
            Finished::Consent(sha256) => {
                record.consent_sha256 = Some(sha256.to_string());
                record.consent_at = Some(at);
            }
            Finished::Form(answers) => {
                files.write_form(&self.study.protocol.session.form, &answers)?;
                record.form_at = Some(at);
            }
            Finished::Screening(plates, letters) => {
                let angle = self.pixel_angle;
                files.write_screening(&plates, &letters, angle)?;
                record.screening = Some(ScreeningScore::of(&plates, &letters, angle));
                record.screening_at = Some(at);
            }
        }
        self.sidecar.write(&self.sidecar_path)
    }

    /// The subject left before the first trial: without consent nothing is kept.
    pub(crate) fn leave(&mut self, at_s: f64) -> Result<SessionEnd, ExperimentError> {
        let has_consent = self.sidecar.done_before().has_consent;
        if self.study.protocol.session.consent.is_none() || has_consent {
            return self.finish(Ending::Stopped, 0, at_s);
        }
        std::fs::remove_file(&self.sidecar_path)
            .map_err(ExperimentError::io("remove", &self.sidecar_path))?;
        // Now no window ever showed the session, and the empty table of ratings goes with it.
        self.is_begun = false;
        Ok(self.end(Ending::Declined))
    }

    /// Puts the answer that waits, if one does, on disk; only then the session goes on. `now_s` tells the time.
    ///
    /// The rating comes first; the frames, the events and the summary in the sidecar follow.
    pub(crate) fn save(&mut self, now_s: impl Fn() -> f64) -> Result<(), ExperimentError> {
        let at_s = now_s();
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
        if !self.log.is_in_place() {
            return Err(self.rescue()?);
        }
        let saved_s = now_s();
        let took = format!("{:.3} ms", (saved_s - at_s) * 1e3);
        self.session.note(Noted::RatingOnDisk, saved_s, took);
        self.session.on(Event::Saved, saved_s);
        self.log_timing()?;
        if let Some(sitting) = self.sidecar.sittings.last_mut() {
            sitting.frames = self.session.frame_clock().summary().map(Into::into);
        }
        self.sidecar.write(&self.sidecar_path)
    }

    /// Takes an order of the experimenter; a note goes into the sidecar too.
    pub(crate) fn order(&mut self, order: &Order, at_s: f64) {
        self.session.order(order, at_s);
        if let (Order::Note(words), Some(sitting)) = (order, self.sidecar.sittings.last_mut()) {
            sitting.notes.push(Words {
                at: utc(self.clock_zero, at_s),
                trial_id: self.session.rated() + 1,
                text: words.clone(),
            });
            self.has_new_words = true;
        }
    }

    /// Puts new notes on disk, unless an image stands or is awaited: no frame waits for the disk.
    pub(crate) fn keep_words(&mut self) -> Result<(), ExperimentError> {
        let screen = self.session.screen();
        let is_timed = screen == Screen::Blank || screen.picture().is_some();
        if !self.has_new_words || is_timed {
            return Ok(());
        }
        self.has_new_words = false;
        self.log_timing()?;
        self.sidecar.write(&self.sidecar_path)
    }

    /// What the frames before the first screen were like, once they are timed.
    pub(crate) fn refresh_in_words(&self) -> String {
        let station = self
            .sidecar
            .sittings
            .last()
            .and_then(|sitting| sitting.station.as_ref());
        let refresh = station.and_then(|station| station.refresh);
        refresh.map_or_else(String::new, Refresh::in_words)
    }

    /// The ratings on disk, in the order of the trials.
    pub(crate) fn ratings(&self) -> &[i32] {
        self.log.ratings()
    }

    /// Puts frames and events so far into their tables.
    pub(crate) fn log_timing(&mut self) -> Result<(), ExperimentError> {
        let (frames, notes) = (self.session.take_frames(), self.session.take_notes());
        self.timing.append(&frames, &notes)
    }

    /// The ratings file was taken away: writes every rating again, beside whatever stands in its place now.
    fn rescue(&mut self) -> Result<ExperimentError, ExperimentError> {
        let bytes = self.log.read_back()?;
        let lost = self.log.path().to_owned();
        data_set_files::prepare(&self.data_set, &self.study, Observer::Person)?;
        let kept = if lost.exists() {
            lost.with_extension("csv.rescued")
        } else {
            self.sidecar.write(&self.sidecar_path)?;
            lost.clone()
        };
        write_atomically(&kept, &bytes, Access::Owner)
            .map_err(ExperimentError::io("write", &kept))?;
        Ok(ExperimentError::Removed {
            lost,
            kept,
            ratings: self.log.rated(),
        })
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
        self.session.note(Noted::Ended, at_s, ending_word(ending));
        self.log_timing()?;
        self.sidecar.write(&self.sidecar_path)?;
        Ok(self.end(ending))
    }

    fn end(&self, ending: Ending) -> SessionEnd {
        SessionEnd {
            subject: self.sidecar.key.subject_id.clone(),
            ending,
            rated: self.session.rated(),
            trials: self.session.trials().len(),
            ratings_path: self.ratings_path().to_owned(),
        }
    }

    pub(crate) fn ratings_path(&self) -> &Path {
        self.log.path()
    }
}

/// The angle of a pixel at the station, or where nothing was measured the one that the protocol asks for.
fn pixel_angle(study: &Study, options: &RunOptions) -> PixelAngle {
    let measured = options.station.as_ref().map(StationFile::degrees_per_pixel);
    PixelAngle {
        degrees: measured.unwrap_or(study.protocol.viewing.degrees_per_pixel),
        is_measured: measured.is_some(),
    }
}

/// Whether there is a sidecar that says that its session was closed.
fn is_closed(sidecar_path: &Path) -> bool {
    Sidecar::read(sidecar_path).is_ok_and(|sidecar| sidecar.closed.is_some())
}

/// Closes a session that is not complete, so that it is never resumed; its ratings are kept, and the report
/// leaves it out by name.
///
/// # Errors
///
/// There is no such session, it is complete or closed already, another program runs it, or the file cannot be
/// written.
pub fn close_session(
    study: &Study,
    options: &RunOptions,
    reason: &str,
) -> Result<SessionEnd, ExperimentError> {
    let (key, data_set) = options.session_of(study);
    let path = data_set.ratings_path(&key.subject_id, key.session_id, key.task());
    if !path.exists() {
        let found = "no such session";
        return Err(InputError::new(path, found, "a session that was begun")
            .remedy("check the subject code, --session and --data")
            .into());
    }
    let trials = trials(study, &key.subject_id, key.session_id)?;
    let log = RatingsLog::open(&data_set, &key, &trials, &study.protocol.stimuli.factors())?;
    if log.rated() == trials.len() {
        let found = format!("all {} trials rated", trials.len());
        return Err(InputError::new(path, found, "a session that is not complete").into());
    }
    let sidecar_path = DataSet::sidecar_path(&path);
    let mut sidecar = Sidecar::read(&sidecar_path)?;
    if let Some(closed) = &sidecar.closed {
        let found = format!("closed already at {} ({})", closed.at, closed.reason);
        return Err(InputError::new(sidecar_path, found, "a session that is open").into());
    }
    sidecar.closed = Some(Closed {
        at: utc(crate::window::utc_now(), 0.0),
        reason: reason.to_owned(),
    });
    sidecar.write(&sidecar_path)?;
    Ok(SessionEnd {
        subject: key.subject_id,
        ending: Ending::Stopped,
        rated: log.rated(),
        trials: trials.len(),
        ratings_path: path,
    })
}

#[cfg(test)]
mod crash;
#[cfg(test)]
mod disks;
#[cfg(test)]
mod intake_kept;
#[cfg(test)]
mod power_loss;
#[cfg(test)]
mod psych_ds;
#[cfg(test)]
mod resumed;
#[cfg(test)]
pub(crate) mod tests;
