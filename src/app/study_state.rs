//! From files to states: how far each step of a study has come.
//!
//! Only the files count; nothing is remembered between two readings. The same functions as in `acuity check`
//! judge them. Not here: what a page makes of a state.

use std::path::{Path, PathBuf};

use analysis::{AnalysisError, ReportAge};
use experiment::{ListedSession, Refresh, Standing, StationFile};
use protocols::{Manifest, Observer, Stimuli, Study};

use super::fault::Fault;

/// A step of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// The images.
    Stimuli,
    /// The screen and the chair.
    Station,
    /// The subjects.
    Sessions,
    /// The analysis.
    Report,
}

impl Step {
    /// All, in their order.
    pub(crate) const ALL: [Self; 4] = [Self::Stimuli, Self::Station, Self::Sessions, Self::Report];

    /// Its name.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Stimuli => "Stimuli",
            Self::Station => "Station",
            Self::Sessions => "Sessions",
            Self::Report => "Report",
        }
    }
}

/// How a state is marked; never by colour alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mark {
    /// Nothing is left to do.
    Done,
    /// There is something to do.
    Due,
    /// Something is wrong.
    Wrong,
    /// Its turn has not come.
    Later,
}

/// Where a study is worked on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    /// The working folder: stimuli, data and reports lie below it.
    pub(crate) root: PathBuf,
    /// The station's file, whether it is there or not.
    pub(crate) station: Option<PathBuf>,
}

/// The folders of a study.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Folders {
    pub(crate) stimuli: PathBuf,
    pub(crate) data: PathBuf,
    pub(crate) report: PathBuf,
    pub(crate) simulated_report: PathBuf,
}

impl Folders {
    /// The usual folders of `study` below `root`.
    pub(crate) fn below(root: &Path, study: &Study) -> Self {
        Self {
            stimuli: root.join(study.default_stimuli_dir()),
            data: root.join(study.default_data_dir(Observer::Person)),
            report: root.join(study.default_report_dir(Observer::Person)),
            simulated_report: root.join(study.default_report_dir(Observer::Simulated)),
        }
    }
}

/// The stimulus set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum StimuliState {
    /// There is none.
    NotMade,
    /// It was made from another protocol or scene.
    Older(Fault),
    /// Files are missing or are not those that were made.
    Damaged(Vec<Fault>),
    /// Every file is as it was made.
    Ready { images: usize },
}

/// The screen and the chair.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum StationState {
    /// Nothing was measured; `is_needed` if the protocol has a tolerance.
    NotMeasured { is_needed: bool },
    /// It cannot be used for this study.
    Unfit(Fault),
    /// It was measured and may be used.
    Measured(Box<StationFile>),
}

/// The sessions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SessionsState {
    /// By subject, trial runs last.
    pub(crate) sessions: Vec<ListedSession>,
    /// Files that cannot be read.
    pub(crate) faults: Vec<Fault>,
}

/// The report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum ReportState {
    /// No subject is done.
    NoRatings,
    /// How the report stands to the data.
    Aged(ReportAge),
    /// The data cannot be analysed.
    Wrong(Fault),
}

/// A study and how far each of its steps has come.
#[derive(Clone, Debug)]
pub(crate) struct StudyState {
    pub(crate) study: Study,
    pub(crate) folders: Folders,
    pub(crate) stimuli: StimuliState,
    pub(crate) station: StationState,
    pub(crate) sessions: SessionsState,
    pub(crate) report: ReportState,
    /// What else would end a session before its first screen.
    pub(crate) hindrances: Vec<Fault>,
    /// The report of simulated observers, if there is one.
    pub(crate) simulated_page: Option<PathBuf>,
}

impl StudyState {
    /// Reads the protocol and all that was made from it.
    pub(crate) fn read(protocol: &Path, place: &Place) -> Result<Self, Fault> {
        let study = Study::read(protocol).map_err(Fault::of)?;
        let folders = Folders::below(&place.root, &study);
        let sessions = SessionsState::read(&study, &folders.data);
        let simulated_page = folders.simulated_report.join("report.html");
        let hindrances = experiment::session_hindrances(&study, &folders.data);
        Ok(Self {
            hindrances: hindrances
                .iter()
                .map(|line| Fault::of_words(line))
                .collect(),
            stimuli: StimuliState::read(&study, &folders.stimuli),
            station: StationState::read(&study, place.station.as_deref()),
            report: ReportState::read(&study, &folders, &sessions),
            simulated_page: Some(simulated_page).filter(|page| page.is_file()),
            sessions,
            folders,
            study,
        })
    }

    /// A step's mark and its state in a few words.
    pub(crate) fn of(&self, step: Step) -> (Mark, String) {
        match step {
            Step::Stimuli => self.stimuli.in_words(),
            Step::Station => self.station.in_words(),
            Step::Sessions => self.sessions.in_words(),
            Step::Report => self.report.in_words(),
        }
    }

    /// The first step that has something to do.
    pub(crate) fn first_due(&self) -> Step {
        let is_due = |step: &Step| matches!(self.of(*step).0, Mark::Due | Mark::Wrong);
        Step::ALL.into_iter().find(is_due).unwrap_or(Step::Sessions)
    }

    /// Why no session may begin; nothing if one may.
    pub(crate) fn hindrance(&self) -> Option<&'static str> {
        if !matches!(self.stimuli, StimuliState::Ready { .. }) {
            return Some("Make the stimuli first: no session begins without all of its images.");
        }
        match self.station {
            StationState::NotMeasured { is_needed: true } => {
                Some("Measure the station first: the protocol allows only a measured distance.")
            }
            StationState::Unfit(_) => {
                Some("Mend the station first: as it is, the protocol does not allow a session.")
            }
            _ if !self.hindrances.is_empty() => {
                Some("Mend what is said above first: no session could begin.")
            }
            _ => None,
        }
    }
}

impl StimuliState {
    fn read(study: &Study, folder: &Path) -> Self {
        if !folder.join(Manifest::FILE_NAME).exists() {
            return Self::NotMade;
        }
        if let Err(fault) = check_origin(study, folder) {
            return Self::Older(fault);
        }
        let faults = experiment::stimulus_faults(study, folder);
        if faults.is_empty() {
            let images = study.protocol.stimuli.images().len();
            return Self::Ready { images };
        }
        Self::Damaged(faults.iter().map(|line| Fault::of_words(line)).collect())
    }

    fn in_words(&self) -> (Mark, String) {
        match self {
            Self::NotMade => (Mark::Due, "Not made yet".to_owned()),
            Self::Older(_) => (Mark::Due, "Made from an older protocol".to_owned()),
            Self::Damaged(faults) => (
                Mark::Wrong,
                counted(faults.len(), "file is", "files are", "not as made"),
            ),
            Self::Ready { images } => (Mark::Done, counted(*images, "image", "images", "ready")),
        }
    }
}

/// Whether the set was made from this protocol and from the scene as it is now.
fn check_origin(study: &Study, folder: &Path) -> Result<(), Fault> {
    let Stimuli::Rendered(_) = study.protocol.stimuli else {
        // A set of pictures has its origin checked with its files.
        return Ok(());
    };
    let manifest = Manifest::read(folder).map_err(Fault::of)?;
    manifest.check_made_for(study, folder).map_err(Fault::of)?;
    let scene = study.scene_path().map_err(Fault::of)?;
    let present = renderer::scene_sha256(&scene).map_err(Fault::of)?;
    if present == manifest.scene_sha256 {
        return Ok(());
    }
    let found = "a scene that was changed after the images were made";
    let expected = "the scene that the images show";
    let error = protocols::InputError::new(scene, found, expected);
    Err(Fault::of(error.remedy("make the stimuli again")))
}

impl StationState {
    fn read(study: &Study, file: Option<&Path>) -> Self {
        let Some(file) = file.filter(|file| file.exists()) else {
            let is_needed = study.protocol.session.viewing_tolerance.is_some();
            return Self::NotMeasured { is_needed };
        };
        match experiment::station_for(study, Some(file)) {
            Ok(Some(station)) => Self::Measured(Box::new(station)),
            Ok(None) => Self::NotMeasured { is_needed: false },
            Err(error) => Self::Unfit(Fault::of(error)),
        }
    }

    fn in_words(&self) -> (Mark, String) {
        match self {
            Self::NotMeasured { is_needed: true } => {
                (Mark::Due, "Not measured, but needed".to_owned())
            }
            Self::NotMeasured { .. } => (Mark::Due, "Not measured".to_owned()),
            Self::Unfit(_) => (Mark::Wrong, "Does not fit the protocol".to_owned()),
            Self::Measured(station) => {
                let words = format!(
                    "Measured: {:.4}\u{b0} per pixel",
                    station.degrees_per_pixel()
                );
                (Mark::Done, words)
            }
        }
    }
}

/// How far a subject has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Progress {
    Done,
    Unfinished,
    Excluded,
}

/// How many subjects have come how far; trial runs do not count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(crate) done: usize,
    pub(crate) unfinished: usize,
    pub(crate) excluded: usize,
}

impl SessionsState {
    /// Reads the data folder.
    pub(crate) fn read(study: &Study, data: &Path) -> Self {
        match experiment::session_list(study, data) {
            Ok(list) => Self {
                sessions: list.sessions,
                faults: list.faults.into_iter().map(Fault::of).collect(),
            },
            Err(error) => Self {
                sessions: Vec::new(),
                faults: vec![Fault::of(error)],
            },
        }
    }

    /// How many subjects have come how far.
    pub(crate) fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        let mut known: Vec<&str> = Vec::new();
        let real = || {
            self.sessions
                .iter()
                .filter(|session| session.pilot.is_none())
        };
        for session in real() {
            let subject = session.subject.as_str();
            if known.contains(&subject) {
                continue;
            }
            known.push(subject);
            let own = real().filter(|other| other.subject.as_str() == subject);
            match progress(own.map(|session| &session.standing)) {
                Progress::Done => counts.done += 1,
                Progress::Unfinished => counts.unfinished += 1,
                Progress::Excluded => counts.excluded += 1,
            }
        }
        counts
    }

    /// The next free code, in the manner of the codes that there are: 01, 02, ...
    pub(crate) fn next_code(&self) -> String {
        let real = (self.sessions.iter()).filter(|session| session.pilot.is_none());
        let codes: Vec<&str> = real.map(|session| session.subject.as_str()).collect();
        next_code(&codes)
    }

    /// The refresh of the display as a session last measured it.
    pub(crate) fn last_refresh(&self) -> Option<Refresh> {
        let latest = (self.sessions.iter())
            .filter(|session| session.refresh.is_some())
            .max_by(|left, right| left.started_at.cmp(&right.started_at));
        latest.and_then(|session| session.refresh)
    }

    fn in_words(&self) -> (Mark, String) {
        if !self.faults.is_empty() {
            let words = counted(self.faults.len(), "file", "files", "cannot be read");
            return (Mark::Wrong, words);
        }
        let Counts {
            done,
            unfinished,
            excluded,
        } = self.counts();
        let begun = done + unfinished;
        if begun + excluded == 0 {
            return (Mark::Due, "No subject yet".to_owned());
        }
        let words = match excluded {
            0 => format!("{done} of {begun} subjects done"),
            _ => format!("{done} of {begun} subjects done, {excluded} excluded"),
        };
        let mark = if unfinished == 0 && done > 0 {
            Mark::Done
        } else {
            Mark::Due
        };
        (mark, words)
    }
}

/// How far a subject with these sessions has come.
fn progress<'a>(standings: impl Iterator<Item = &'a Standing>) -> Progress {
    let mut progress = Progress::Excluded;
    for standing in standings {
        match standing {
            Standing::Unfinished => return Progress::Unfinished,
            Standing::Complete => progress = Progress::Done,
            Standing::Closed { .. } => {}
        }
    }
    progress
}

/// The code after the highest of `codes`, with its letters and its number of digits; 01 is the first.
fn next_code(codes: &[&str]) -> String {
    let digits = |code: &str| {
        let digits = code.bytes().rev().take_while(u8::is_ascii_digit);
        digits.count()
    };
    let number = |code: &str| code[code.len() - digits(code)..].parse::<u32>().ok();
    let numbered = codes.iter().filter_map(|code| Some((number(code)?, *code)));
    let (last, like) = numbered.max().unwrap_or((0, "00"));
    let (letters, width) = (&like[..like.len() - digits(like)], digits(like));
    let mut candidates = (u64::from(last) + 1..).map(|next| format!("{letters}{next:0width$}"));
    let free = candidates.find(|code| !codes.contains(&code.as_str()));
    // A code of 32 characters that ends in nines has no successor.
    free.filter(|code| code.len() <= 32)
        .unwrap_or_else(|| "01".to_owned())
}

impl ReportState {
    fn read(study: &Study, folders: &Folders, sessions: &SessionsState) -> Self {
        if sessions.counts().done == 0 {
            return Self::NoRatings;
        }
        let age = analysis::report_age(study, &folders.data, &folders.report);
        age.map_or_else(
            |error: AnalysisError| Self::Wrong(Fault::of(error)),
            Self::Aged,
        )
    }

    fn in_words(&self) -> (Mark, String) {
        let (mark, words) = match self {
            Self::NoRatings => (Mark::Later, "No complete subject yet"),
            Self::Aged(ReportAge::NotMade) => (Mark::Due, "Not made yet"),
            Self::Aged(ReportAge::OlderThanData) => (Mark::Due, "Older than the data"),
            Self::Aged(ReportAge::OlderThanProtocol) => (Mark::Due, "Older than the protocol"),
            Self::Aged(ReportAge::Current) => (Mark::Done, "Ready"),
            Self::Wrong(_) => (Mark::Wrong, "The data cannot be analysed"),
        };
        (mark, words.to_owned())
    }
}

/// `1 image ready`, `28 images ready`.
fn counted(count: usize, one: &str, many: &str, rest: &str) -> String {
    let noun = if count == 1 { one } else { many };
    format!("{count} {noun} {rest}")
}

#[cfg(test)]
mod tests;
