//! Simulated observers sit the session: the same machine, a virtual clock, a data set of their own.
//!
//! The same seed gives the same bytes on any number of threads. A simulated data set is written into a
//! folder beside its place and then moved there whole; only an older simulated data set of the same study
//! is ever replaced.

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use jiff::Timestamp;
use protocols::rating::header_line;
use protocols::{
    Access, DataSet, InputError, Observer, StimulusId, Study, SubjectId, write_atomically,
};
use rayon::prelude::*;

use crate::rating_row::{rating_row, utc};
use crate::sidecar::{SessionKey, Sidecar, Sitting, ending_word};
use crate::simulated_observer::SimulatedObserver;
use crate::{Ending, ExperimentError, Quality, StimulusSet, data_set_files, qualities, trials};

/// What a simulation did.
#[derive(Clone, Debug)]
pub struct SimulationSummary {
    /// How many observers rated.
    pub subjects: u32,
    /// How many ratings there are, practice included.
    pub ratings: usize,
    /// What the model of vision said of each image.
    pub qualities: BTreeMap<StimulusId, Quality>,
    /// Where the ratings stand.
    pub data_dir: PathBuf,
}

impl fmt::Display for SimulationSummary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{} ratings by {} simulated observers in {}",
            self.ratings,
            self.subjects,
            self.data_dir.display()
        )
    }
}

/// Lets `subjects` model observers rate the images of `study`; replaces the simulated data set in
/// `data_dir`.
///
/// `progress` is told how many steps of how many are done.
///
/// # Errors
///
/// The stimulus set cannot be used, `data_dir` holds something other than simulated ratings of this study,
/// or the system will not take the files.
#[expect(
    clippy::too_many_arguments,
    reason = "two places, two numbers, one study, one listener"
)]
pub fn simulate(
    study: &Study,
    stimuli_dir: &Path,
    data_dir: &Path,
    subjects: u32,
    seed: u64,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<SimulationSummary, ExperimentError> {
    let place = DataSet::new(data_dir, &study.protocol.study);
    check_replaceable(&place, study)?;
    let set = StimulusSet::read(study, stimuli_dir)?;
    let qualities = qualities(study, &set)?;

    let parent = match data_dir.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    fs::create_dir_all(parent).map_err(ExperimentError::io("create", parent))?;
    let workshop = tempfile::Builder::new()
        .prefix(".simulating-")
        .tempdir_in(parent)
        .map_err(ExperimentError::io("create a folder in", parent))?;
    let fresh = DataSet::new(workshop.path().join("new"), &study.protocol.study);
    data_set_files::prepare(&fresh, study, Observer::Simulated)?;

    let width = subjects.to_string().len().max(2);
    let done = AtomicU64::new(0);
    let simulation = Simulation {
        study,
        set: &set,
        qualities: &qualities,
        data_set: &fresh,
        seed,
    };
    let counts: Vec<usize> = (1..=subjects)
        .into_par_iter()
        .map(|number| {
            let name = format!("{number:0width$}");
            let rated = simulation.sit(&name)?;
            let so_far = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress(so_far, u64::from(subjects));
            Ok(rated)
        })
        .collect::<Result<_, ExperimentError>>()?;
    replace(data_dir, fresh.root(), &workshop.path().join("old"))?;
    Ok(SimulationSummary {
        subjects,
        ratings: counts.iter().sum(),
        qualities,
        data_dir: data_dir.to_owned(),
    })
}

/// What every simulated session needs.
struct Simulation<'a> {
    study: &'a Study,
    set: &'a StimulusSet,
    qualities: &'a BTreeMap<StimulusId, Quality>,
    data_set: &'a DataSet,
    seed: u64,
}

impl Simulation<'_> {
    /// One observer sits the session; says how many trials were rated.
    fn sit(&self, name: &str) -> Result<usize, ExperimentError> {
        let parse =
            |reason: String| InputError::new(self.data_set.root(), reason, "fewer observers");
        let subject: SubjectId = name.parse().map_err(parse)?;
        let key = SessionKey {
            subject_id: subject.clone(),
            session_id: 1,
            observer: Observer::Simulated,
            pilot_speed: None,
        };
        let trials = trials(self.study, &subject, key.session_id)?;
        let observer = SimulatedObserver::new(&self.study.protocol, &subject, self.seed);
        let traits = observer.traits();
        let session = observer.sit(&trials, self.qualities)?;

        let mut text = header_line(&self.study.protocol.stimuli.factors());
        for answer in &session.answers {
            let requested_s = self.study.protocol.session.exposure_s;
            let row = rating_row(
                &key,
                &trials[answer.trial],
                answer,
                requested_s,
                Timestamp::UNIX_EPOCH,
            );
            text.push_str(&row.to_line());
        }
        let path = self
            .data_set
            .ratings_path(&subject, key.session_id, key.task());
        write_atomically(&path, text.as_bytes(), Access::Owner)
            .map_err(ExperimentError::io("write", &path))?;

        let mut sidecar = Sidecar::new(self.study, self.set.manifest_sha256(), &key);
        sidecar.model = Some(traits);
        sidecar.sittings.push(Sitting {
            started_at: utc(Timestamp::UNIX_EPOCH, 0.0),
            first_trial_id: 1,
            ended_at: Some(utc(Timestamp::UNIX_EPOCH, session.ended_s)),
            ending: Some(ending_word(Ending::Complete)),
            station: None,
            frames: None,
            focus_losses: 0,
            notes: Vec::new(),
        });
        sidecar.write(&DataSet::sidecar_path(&path))?;
        Ok(session.answers.len())
    }
}

/// Whether the folder is free, or holds nothing but simulated ratings of this study.
fn check_replaceable(place: &DataSet, study: &Study) -> Result<(), ExperimentError> {
    let root = place.root();
    if !root.exists() || (root.is_dir() && !data_set_files::has_entries(root)?) {
        return Ok(());
    }
    data_set_files::check(place, study, Observer::Simulated)?;
    let entries = fs::read_dir(root).map_err(ExperimentError::io("read", root))?;
    for entry in entries {
        let entry = entry.map_err(ExperimentError::io("read", root))?;
        let name = entry.file_name();
        if name != "data" && name != "dataset_description.json" {
            let expected = "nothing but the simulated ratings, which are replaced as a whole";
            return Err(
                InputError::new(root, format!("{}", name.display()), expected)
                    .remedy("move it, or name another folder with --data")
                    .into(),
            );
        }
    }
    Ok(())
}

/// Moves `fresh` to `place`; what was there goes to `old`, and away with the workshop.
fn replace(place: &Path, fresh: &Path, old: &Path) -> Result<(), ExperimentError> {
    if place.exists() {
        fs::rename(place, old).map_err(ExperimentError::io("replace", place))?;
    }
    fs::rename(fresh, place).map_err(ExperimentError::io("create", place))
}
