//! The ratings of a study as they stand on disk: every session file of its data set, checked against the
//! protocol.
//!
//! Practice trials are never kept, trial runs only when asked for; people and simulated observers are never
//! mixed.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use protocols::rating::{Phase, RatingRow, read_ratings};
use protocols::{
    DataSet, InputError, Observer, ReadError, Sha256Digest, StimulusId, Study, SubjectId,
};

use crate::AnalysisError;
use crate::sidecar_facts::SidecarFacts;

/// Whether trial runs are analysed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pilots {
    /// They are left out, and said.
    LeftOut,
    /// They are analysed like sessions, and said.
    Included,
}

/// Every rating of a study that counts, and where it came from.
#[derive(Clone, Debug)]
pub(crate) struct StudyRatings {
    /// The folder of the session files.
    pub(crate) folder: PathBuf,
    /// Who rated.
    pub(crate) observer: Observer,
    /// The ratings of test trials, by subject, session and trial.
    pub(crate) rows: Vec<RatingRow>,
    /// One record for each file that holds a rating that counts.
    pub(crate) sessions: Vec<SessionRecord>,
    /// Files of trial runs that were left out.
    pub(crate) pilots_left_out: Vec<String>,
    /// What the reader of the report must know.
    pub(crate) warnings: Vec<String>,
}

/// One session file.
#[derive(Clone, Debug)]
pub(crate) struct SessionRecord {
    pub(crate) file_name: String,
    pub(crate) sha256: Sha256Digest,
    pub(crate) subject: SubjectId,
    pub(crate) session: u32,
    pub(crate) started_at: String,
    pub(crate) n_rated: usize,
    pub(crate) missed_frames: u32,
    pub(crate) trials_with_missed_frames: usize,
    /// The largest difference of the exposure submitted from the one requested.
    pub(crate) largest_exposure_error_s: f64,
    pub(crate) median_response_time_s: f64,
    pub(crate) is_pilot: bool,
    pub(crate) sidecar: SidecarFacts,
}

impl StudyRatings {
    /// Reads the data set of `study` in `data_dir`.
    ///
    /// # Errors
    ///
    /// No ratings, a file that is not one of this study's, a rating that contradicts the protocol or
    /// another one, people and simulated observers side by side.
    pub(crate) fn read(
        study: &Study,
        data_dir: &Path,
        pilots: Pilots,
    ) -> Result<Self, AnalysisError> {
        let folder = DataSet::new(data_dir, &study.protocol.study).data_folder();
        let mut ratings = Self {
            folder: folder.clone(),
            observer: Observer::Person,
            rows: Vec::new(),
            sessions: Vec::new(),
            pilots_left_out: Vec::new(),
            warnings: Vec::new(),
        };
        let mut observers: BTreeMap<&str, (Observer, String)> = BTreeMap::new();
        for path in ratings_files(&folder, study)? {
            let rows = ratings.read_file(study, &path, pilots)?;
            for row in &rows {
                observers
                    .entry(row.observer.as_str())
                    .or_insert_with(|| (row.observer, file_name(&path)));
            }
            ratings.rows.extend(rows);
        }
        match observers.into_values().collect::<Vec<_>>().as_slice() {
            [] => return Err(ratings.nothing_to_analyse(study).into()),
            [(observer, _)] => ratings.observer = *observer,
            [(_, person), (_, simulated), ..] => {
                let found = format!(
                    "ratings of people ({person}) and of simulated observers ({simulated})"
                );
                return Err(
                    InputError::new(folder, found, "one kind of observer in a data set")
                        .remedy("move one kind to a data set of its own")
                        .into(),
                );
            }
        }
        ratings.rows.sort_by(|left, right| {
            let key = |row: &RatingRow| (row.session_id, row.trial_id);
            crate::natural_order(left.subject_id.as_str(), right.subject_id.as_str())
                .then_with(|| key(left).cmp(&key(right)))
        });
        ratings.check_each_trial_once(study)?;
        ratings.note_other_images();
        ratings.note_repeated_sittings();
        Ok(ratings)
    }

    /// The ratings of one file that count.
    fn read_file(
        &mut self,
        study: &Study,
        path: &Path,
        pilots: Pilots,
    ) -> Result<Vec<RatingRow>, AnalysisError> {
        let file = read_ratings(path, &study.protocol.stimuli.factors())?;
        if file.is_torn {
            self.warnings.push(format!(
                "{}: the last line is torn (the program was stopped while it wrote); it was never confirmed and is left out",
                file_name(path)
            ));
        }
        let stimuli = StimulusLevels::new(study);
        for (index, row) in file.rows.iter().enumerate() {
            check_row(study, path, index, row)?;
            stimuli.check(path, index, row)?;
        }
        let is_test = |row: &RatingRow| row.phase == Phase::Test;
        let is_pilot = file.rows.iter().any(|row| row.pilot);
        if is_pilot && pilots == Pilots::LeftOut {
            self.pilots_left_out.push(file_name(path));
        }
        let kept: Vec<RatingRow> = (file.rows.into_iter())
            .filter(|row| is_test(row) && (pilots == Pilots::Included || !row.pilot))
            .collect();
        if let Some(first) = kept.first() {
            let session = session_record(path, first, &kept)?;
            if let Some((key, found, rated)) = session.sidecar.contradiction(first) {
                let sidecar = DataSet::sidecar_path(path);
                let expected = format!("{rated}, as in the rows of the ratings file");
                return Err(InputError::new(sidecar, found, expected)
                    .at(format!("key {key}"))
                    .remedy("restore both files as the session wrote them")
                    .into());
            }
            if let Some(complaint) = session.sidecar.complaint(study.sha256.as_str()) {
                self.warnings
                    .push(format!("{}: {complaint}", session.file_name));
            }
            self.sessions.push(session);
        } else if !is_pilot && !file_name(path).contains("_task-pilot_") {
            let name = file_name(path);
            self.warnings.push(format!(
                "{name}: a session was begun, but no test trial is rated; its subject is left out"
            ));
        }
        Ok(kept)
    }

    /// `n` of those who rated, in words: `12 subjects`.
    pub(crate) fn who(&self, n: usize) -> String {
        let noun = match self.observer {
            Observer::Person => "subject",
            Observer::Simulated => "simulated observer",
        };
        let plural = if n == 1 { "" } else { "s" };
        format!("{n} {noun}{plural}")
    }

    /// Says where the images of one session were not those of another.
    fn note_other_images(&mut self) {
        let mut manifests: Vec<&str> = (self.sessions.iter())
            .filter_map(|session| session.sidecar.manifest_sha256.as_deref())
            .collect();
        manifests.sort_unstable();
        manifests.dedup();
        if manifests.len() > 1 {
            self.warnings.push(format!(
                "the sessions showed {} different stimulus sets (by the digests of their manifests)",
                manifests.len()
            ));
        }
    }

    /// Says whose ratings come from more than one session.
    fn note_repeated_sittings(&mut self) {
        let mut sittings: BTreeMap<&SubjectId, usize> = BTreeMap::new();
        for session in &self.sessions {
            *sittings.entry(&session.subject).or_default() += 1;
        }
        let repeated = sittings.into_iter().filter(|&(_, count)| count > 1);
        let warnings = repeated.map(|(subject, count)| {
            format!(
                "subject {subject} sat {count} sessions; the ratings of each image are averaged"
            )
        });
        let warnings: Vec<String> = warnings.collect();
        self.warnings.extend(warnings);
    }

    /// The digest of the digests of all files, in the order of their names.
    pub(crate) fn sha256(&self) -> Sha256Digest {
        let lines: Vec<String> = (self.sessions.iter())
            .map(|session| format!("{}  {}\n", session.sha256, session.file_name))
            .collect();
        Sha256Digest::of(lines.concat().as_bytes())
    }

    fn nothing_to_analyse(&self, study: &Study) -> InputError {
        let (found, or_pilots) = if self.pilots_left_out.is_empty() {
            ("no ratings".to_owned(), "")
        } else {
            let files = self.pilots_left_out.join(", ");
            let or_pilots = ", or analyse the trial runs with --include-pilot";
            (format!("only trial runs ({files})"), or_pilots)
        };
        let protocol = study.path.display();
        InputError::new(&self.folder, found, "at least one session's ratings").remedy(format!(
            "run `acuity run {protocol} --subject ID` first, or name another data set with --data{or_pilots}"
        ))
    }

    fn check_each_trial_once(&self, study: &Study) -> Result<(), InputError> {
        let key = |row: &RatingRow| {
            (
                row.subject_id.clone(),
                row.session_id,
                row.trial_id,
                row.pilot,
            )
        };
        let same = |pair: &&[RatingRow]| key(&pair[0]) == key(&pair[1]);
        let Some(row) = self.rows.windows(2).find(same).and_then(<[_]>::first) else {
            return Ok(());
        };
        let place = format!(
            "subject {}, session {}, trial {}",
            row.subject_id, row.session_id, row.trial_id
        );
        let expected = format!("each trial of {} once", study.protocol.study);
        Err(InputError::new(&self.folder, "two ratings", expected)
            .at(place)
            .remedy("remove the copy"))
    }
}

/// The ratings files in a folder, by name.
fn ratings_files(folder: &Path, study: &Study) -> Result<Vec<PathBuf>, AnalysisError> {
    let kind = "the folder of a data set";
    let entries = fs::read_dir(folder).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory => {
            let protocol = study.path.display();
            let remedy = format!(
                "run `acuity run {protocol} --subject ID` first, or name another data set with --data"
            );
            InputError::new(folder, format!("no such folder ({error})"), kind)
                .remedy(remedy)
                .into()
        }
        _ => AnalysisError::from(ReadError::from_io(folder, kind, error)),
    })?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry
            .map_err(|error| AnalysisError::from(ReadError::from_io(folder, kind, error)))?
            .path();
        if DataSet::has_ratings(&file_name(&path)) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// The line of a row: the header is line 1.
fn line(index: usize) -> usize {
    index + 2
}

fn check_row(study: &Study, path: &Path, index: usize, row: &RatingRow) -> Result<(), InputError> {
    let scale = study.protocol.session.scale;
    if !scale.contains(row.rating) {
        let expected = format!("a whole number from {} to {}", scale.lowest, scale.highest);
        return Err(InputError::new(path, row.rating.to_string(), expected)
            .at(format!("line {}, column rating", line(index)))
            .remedy("the session was run with another scale, or the file was changed"));
    }
    check_name(study, path, index, row)?;
    let session = &study.protocol.session;
    let n_rated = study
        .protocol
        .stimuli
        .images()
        .iter()
        .filter(|image| image.is_rated)
        .count();
    let n_trials = session.trial_count(n_rated);
    let out_of_range = |column: &str, found: u32, most: usize| {
        Err(InputError::new(
            path,
            found.to_string(),
            format!("a number from 1 to {most}"),
        )
        .at(format!("line {}, column {column}", line(index)))
        .remedy("restore the file as the session wrote it"))
    };
    if !(1..=n_trials).contains(&(row.trial_id as usize)) {
        return out_of_range("trial_id", row.trial_id, n_trials);
    }
    let most = session.most_repetitions();
    if row.phase == Phase::Test && !(1..=most).contains(&row.repetition) {
        return out_of_range("repetition", row.repetition, most as usize);
    }
    Ok(())
}

/// Checks that the row belongs to the subject, the session and the task that the file is named for.
fn check_name(study: &Study, path: &Path, index: usize, row: &RatingRow) -> Result<(), InputError> {
    let task = if row.pilot { "pilot" } else { "rating" };
    let data_set = DataSet::new("", &study.protocol.study);
    let named = data_set.ratings_path(&row.subject_id, row.session_id, task);
    if file_name(&named) == file_name(path) {
        return Ok(());
    }
    let found = format!(
        "subject {}, session {}, pilot {}",
        row.subject_id, row.session_id, row.pilot
    );
    Err(InputError::new(path, found, "what the file name says")
        .at(format!(
            "line {}, columns subject_id, session_id and pilot",
            line(index)
        ))
        .remedy(format!(
            "these belong in a file named {}",
            file_name(&named)
        )))
}

/// The level of each factor of each stimulus, by the protocol.
struct StimulusLevels {
    factors: Vec<String>,
    levels: BTreeMap<StimulusId, Vec<String>>,
}

impl StimulusLevels {
    fn new(study: &Study) -> Self {
        let stimuli = &study.protocol.stimuli;
        let images = stimuli.images().into_iter();
        Self {
            factors: stimuli.factors(),
            levels: images.map(|image| (image.id, image.levels)).collect(),
        }
    }

    /// Checks that a row's levels are those of its stimulus.
    fn check(&self, path: &Path, index: usize, row: &RatingRow) -> Result<(), InputError> {
        let place = |column: &str| format!("line {}, column {column}", line(index));
        match self.levels.get(&row.stimulus_id) {
            None => Err(InputError::new(
                path,
                format!("the stimulus {}", row.stimulus_id),
                "a stimulus of the protocol",
            )
            .at(place("stimulus_id"))
            .remedy("the session belongs to another study")),
            Some(levels) if *levels != row.levels => Err(InputError::new(
                path,
                row.levels.join(", "),
                format!("{}, the levels of {}", levels.join(", "), row.stimulus_id),
            )
            .at(place(&self.factors.join(" and ")))),
            Some(_) => Ok(()),
        }
    }
}

fn session_record(
    path: &Path,
    first: &RatingRow,
    rows: &[RatingRow],
) -> Result<SessionRecord, AnalysisError> {
    let sha256 = Sha256Digest::of_file(path).map_err(|source| AnalysisError::Read {
        file: path.to_owned(),
        source,
    })?;
    let exposure_error =
        |row: &RatingRow| (row.exposure_submitted_s - row.exposure_requested_s).abs();
    let mut response_times: Vec<f64> = rows.iter().map(|row| row.response_time_s).collect();
    response_times.sort_by(f64::total_cmp);
    Ok(SessionRecord {
        file_name: file_name(path),
        sha256,
        subject: first.subject_id.clone(),
        session: first.session_id,
        started_at: first.started_at.clone(),
        n_rated: rows.len(),
        missed_frames: rows.iter().map(|row| row.missed_frames).sum(),
        trials_with_missed_frames: rows.iter().filter(|row| row.missed_frames > 0).count(),
        largest_exposure_error_s: rows.iter().map(exposure_error).fold(0.0, f64::max),
        median_response_time_s: median_of_sorted(&response_times),
        is_pilot: first.pilot,
        sidecar: SidecarFacts::read(path),
    })
}

fn median_of_sorted(values: &[f64]) -> f64 {
    let middle = values.len() / 2;
    if values.len().is_multiple_of(2) {
        f64::midpoint(values[middle - 1], values[middle])
    } else {
        values[middle]
    }
}
