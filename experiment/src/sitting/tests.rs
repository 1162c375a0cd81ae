//! A sitting on disk: resumed, torn, changed, locked.

use std::fs::{self, OpenOptions};
use std::io::Write as _;

use protocols::StimulusPlan;
use protocols::rating::{RatingRow, header_line, read_ratings};
use serde_json::Value;

use super::*;
use crate::common::{small_study, write_stimuli};
use crate::{Button, Key, Screen, simulate};

/// A folder with a small study, in which people sit on a clock of 60 frames a second.
pub(crate) struct Place {
    folder: Folder,
    pub(crate) study: Study,
    pub(crate) options: RunOptions,
}

/// A folder of this test, or one that another process lent.
enum Folder {
    Own(tempfile::TempDir),
    Lent(PathBuf),
}

impl Place {
    pub(crate) fn new() -> Self {
        Self::made_in(tempfile::tempdir().unwrap())
    }

    /// The same where syncing a file costs nothing, if there is such a place: for whole sessions by the dozen.
    pub(crate) fn in_memory() -> Self {
        let folder = tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir());
        Self::made_in(folder.unwrap())
    }

    fn made_in(folder: tempfile::TempDir) -> Self {
        write_stimuli(&small_study(folder.path()), folder.path());
        let place = Self::at(folder.path());
        Self {
            folder: Folder::Own(folder),
            ..place
        }
    }

    /// The place in a folder that has its study and its stimuli already.
    pub(crate) fn at(folder: &Path) -> Self {
        Self {
            study: Study::read(&folder.join("small.toml")).unwrap(),
            options: RunOptions {
                subject: "S1".parse().unwrap(),
                stimuli_dir: folder.join("stimuli"),
                data_dir: folder.join("data"),
                pilot: None,
                view: None,
                session: 1,
                monitor: None,
                station: None,
            },
            folder: Folder::Lent(folder.to_owned()),
        }
    }

    pub(crate) fn folder(&self) -> &Path {
        match &self.folder {
            Folder::Own(folder) => folder.path(),
            Folder::Lent(folder) => folder,
        }
    }

    pub(crate) fn open(&self) -> Result<Sitting, ExperimentError> {
        let set = StimulusSet::read(&self.study, &self.options.stimuli_dir)?;
        let mut sitting = Sitting::open(&self.study, &set, &self.options, Timestamp::UNIX_EPOCH)?;
        let station = Station {
            operating_system: "none".to_owned(),
            window_px: [1, 1],
            monitor_px: [1, 1],
            pixels_per_point: 1.0,
            monitor: None,
            native_px: None,
            refresh: None,
            compared_px: 0,
            tells_swaps: false,
            measured: None,
            out_of_gamut_px: std::collections::BTreeMap::new(),
            white_luminance: None,
        };
        sitting.begin(station, 0.0)?;
        Ok(sitting)
    }

    /// Rates `count` trials more with 7 and leaves without a farewell, as a crash would.
    pub(crate) fn rate(&self, count: usize) {
        let mut sitting = self.open().unwrap();
        let goal = sitting.session.rated() + count;
        for frame in 0..100_000 {
            let at_s = f64::from(frame) / 60.0;
            sitting.session.on(Event::Frame, at_s);
            match sitting.session.screen() {
                Screen::Rating => {
                    let button = Some(Button::Rating(7));
                    sitting.session.on(Event::Press(button), at_s);
                    sitting.session.on(Event::Release(button), at_s);
                    sitting.save(|| at_s).unwrap();
                }
                Screen::Instructions | Screen::Resumed | Screen::PracticeOver => {
                    sitting.session.on(Event::Key(Key::Enter), at_s);
                }
                _ => {}
            }
            if sitting.session.rated() == goal {
                return;
            }
        }
        panic!("the session is stuck at {:?}", sitting.session.screen());
    }

    pub(crate) fn ratings_path(&self) -> PathBuf {
        let data_set = DataSet::new(&self.options.data_dir, &self.study.protocol.study);
        let task = if self.options.pilot.is_some() {
            "pilot"
        } else {
            "rating"
        };
        data_set.ratings_path(&self.options.subject, 1, task)
    }

    pub(crate) fn rows(&self) -> Vec<RatingRow> {
        read_ratings(&self.ratings_path(), &StimulusPlan::factors())
            .unwrap()
            .rows
    }

    fn append(&self, bytes: &[u8]) {
        let path = self.ratings_path();
        let mut file = OpenOptions::new().append(true).open(path).unwrap();
        file.write_all(bytes).unwrap();
    }

    fn refusal(&self) -> String {
        let before = fs::read(self.ratings_path()).unwrap();
        let error = self.open().unwrap_err();
        assert!(error.is_input(), "{error}");
        let after = fs::read(self.ratings_path()).unwrap();
        assert_eq!(before, after, "a file that is refused is left as it is");
        error.to_string()
    }

    fn replace_in_ratings(&self, old: &str, new: &str) {
        let text = fs::read_to_string(self.ratings_path()).unwrap();
        assert!(text.contains(old));
        fs::write(self.ratings_path(), text.replacen(old, new, 1)).unwrap();
    }
}

#[test]
fn a_session_that_was_cut_off_goes_on_and_has_every_trial_once() {
    let place = Place::new();
    for count in [2, 1, 0, 9, 18] {
        place.rate(count);
    }
    let order = trials(&place.study, &place.options.subject, 1).unwrap();
    let rows = place.rows();
    assert_eq!(rows.len(), 30);
    for (row, trial) in rows.iter().zip(&order) {
        assert_eq!(
            (row.trial_id, &row.stimulus_id),
            (trial.trial_id, &trial.stimulus_id)
        );
        assert_eq!(
            (row.rating, row.pilot, row.observer),
            (7, false, Observer::Person)
        );
    }
    let text = place.refusal();
    assert!(text.contains("all 30 trials rated"), "{text}");
}

#[test]
fn a_torn_last_line_is_cut_off_and_its_trial_is_shown_again() {
    let place = Place::new();
    place.rate(5);
    place.append(b"S1,1,6,test,a0");
    place.rate(1);
    assert_eq!(place.rows().len(), 6);
    assert_eq!(place.rows()[5].trial_id, 6);
}

#[test]
fn a_torn_header_is_written_again() {
    let place = Place::new();
    drop(place.open().unwrap());
    let header = header_line(&StimulusPlan::factors());
    for bytes in [&header.as_bytes()[..20], b""] {
        fs::write(place.ratings_path(), bytes).unwrap();
        drop(place.open().unwrap());
        assert_eq!(fs::read_to_string(place.ratings_path()).unwrap(), header);
    }
}

#[test]
fn a_second_window_for_the_same_subject_is_refused() {
    let place = Place::new();
    let first = place.open().unwrap();
    let error = place.open().unwrap_err();
    assert!(matches!(error, ExperimentError::Busy { .. }), "{error}");
    // A program that another thread is just starting keeps the open file for a moment longer.
    let held = first.log.held_elsewhere();
    drop(first);
    drop(place.open().unwrap());
    drop(held);
}

#[test]
fn a_trial_run_has_a_file_of_its_own_and_says_so_in_every_row() {
    let mut place = Place::new();
    place.rate(2);
    place.options.pilot = Some(4.0);
    place.rate(3);
    assert_eq!(place.rows().len(), 3);
    assert!(place.rows().iter().all(|row| row.pilot));
    // A quarter of 0.2 s, to half a frame.
    assert!(
        place
            .rows()
            .iter()
            .all(|row| (row.exposure_submitted_s - 0.05).abs() <= 0.5 / 60.0)
    );
    place.options.pilot = Some(5.0);
    assert!(place.refusal().contains("--pilot speed"));
}

#[test]
fn ratings_that_are_not_the_beginning_of_the_order_are_refused() {
    let place = Place::new();
    place.rate(5);
    let line = place.rows()[4].to_line();
    let whole = fs::read_to_string(place.ratings_path()).unwrap();
    let third = place.rows()[2].to_line();
    let cases: [(&str, &str, &str); 4] = [
        ("a010k_c140k", "a020k_c140k", "line 2"),
        ("S1,1,3,", "S2,1,3,", "line 4"),
        (&third, "", "line 4"),
        (",person,false", ",person,true", "line 2"),
    ];
    for (old, new, place_named) in cases {
        place.replace_in_ratings(old, new);
        let text = place.refusal();
        assert!(
            text.contains(place_named) && text.contains("order"),
            "{text}"
        );
        fs::write(place.ratings_path(), &whole).unwrap();
    }
    place.append(line.as_bytes());
    assert!(place.refusal().contains("line 7"));
}

#[test]
fn malformed_ratings_are_refused_with_line_and_column() {
    let place = Place::new();
    place.rate(3);
    place.replace_in_ratings(",7,", ",seven,");
    let text = place.refusal();
    assert!(text.contains("line 2, column rating"), "{text}");
    fs::write(place.ratings_path(), "subject,rating\nS1,7\n").unwrap();
    let text = place.refusal();
    assert!(text.contains("line 1"), "{text}");
}

#[test]
fn a_session_goes_on_only_with_the_protocol_and_the_images_that_it_began_with() {
    let mut place = Place::new();
    place.rate(3);
    let sidecar_path = DataSet::sidecar_path(&place.ratings_path());
    let sidecar = fs::read_to_string(&sidecar_path).unwrap();

    fs::remove_file(&sidecar_path).unwrap();
    assert!(place.refusal().contains("no such file"));
    fs::write(&sidecar_path, &sidecar[..sidecar.len() / 2]).unwrap();
    assert!(place.refusal().contains("EOF"));
    fs::write(&sidecar_path, &sidecar).unwrap();

    let path = place.folder().join("small.toml");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text + "# changed\n").unwrap();
    place.study = Study::read(&path).unwrap();
    assert!(place.refusal().contains("protocol_sha256"));
}

#[test]
fn people_and_simulated_observers_never_share_a_data_set() {
    let place = Place::new();
    let data = &place.options.data_dir;
    simulate(
        &place.study,
        &place.options.stimuli_dir,
        data,
        1,
        1,
        &|_, _| {},
    )
    .unwrap();
    let error = place.open().unwrap_err();
    assert!(
        error.is_input() && error.to_string().contains("observer"),
        "{error}"
    );
}

#[test]
fn the_sidecar_says_what_was_run_and_how_it_ended() {
    let place = Place::new();
    place.rate(1);
    let mut sitting = place.open().unwrap();
    sitting.session.on(Event::Frame, 1.0);
    let end = sitting.finish(Ending::Stopped, 2, 3.0).unwrap();
    assert_eq!((end.rated, end.trials), (1, 30));
    let path = DataSet::sidecar_path(&place.ratings_path());
    let sidecar: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    assert_eq!(sidecar["protocol_sha256"], place.study.sha256.as_str());
    assert_eq!(sidecar["order_seed"], 1992);
    assert!(
        sidecar["timing_source"]
            .as_str()
            .unwrap()
            .contains("was not measured")
    );
    assert_eq!(sidecar["sittings"][0]["ending"], Value::Null);
    assert_eq!(sidecar["sittings"][1]["ending"], "stopped");
    assert_eq!(
        sidecar["sittings"][1]["ended_at"],
        "1970-01-01T00:00:03.000Z"
    );
    assert_eq!(sidecar["sittings"][1]["first_trial_id"], 2);
    assert_eq!(sidecar["sittings"][1]["focus_losses"], 2);
}

#[test]
fn a_session_that_was_closed_is_not_resumed_and_the_next_one_is_free() {
    let mut place = Place::new();
    place.rate(3);
    let end = close_session(&place.study, &place.options, "felt ill").unwrap();
    assert_eq!((end.rated, end.trials), (3, 30));
    let text = place.refusal();
    assert!(
        text.contains("felt ill") && text.contains("--session"),
        "{text}"
    );
    let again = close_session(&place.study, &place.options, "twice").unwrap_err();
    assert!(
        again.is_input() && again.to_string().contains("closed already"),
        "{again}"
    );
    place.options.session = 2;
    let none = close_session(&place.study, &place.options, "none").unwrap_err();
    assert!(
        none.is_input() && none.to_string().contains("no such session"),
        "{none}"
    );
    let sitting = place.open().unwrap();
    assert_eq!(sitting.session.rated(), 0);
    assert!(
        sitting
            .ratings_path()
            .to_string_lossy()
            .contains("_session-2_")
    );
    let order = trials(&place.study, &place.options.subject, 2).unwrap();
    assert_eq!(sitting.session.trials(), order);
}

#[test]
fn a_session_that_was_killed_has_its_frames_its_events_and_its_summary_so_far() {
    let place = Place::new();
    place.rate(3);
    let path = DataSet::sidecar_path(&place.ratings_path());
    let sidecar: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    let summary = &sidecar["sittings"][0];
    assert_eq!(summary["ending"], Value::Null);
    // Three exposures of 0.2 s at 60 frames a second: 12 intervals each.
    assert_eq!(summary["frames"]["measured"], 36);
    assert_eq!(summary["frames"]["median_ms"], 16.667);

    let timing = place.options.data_dir.join("timing");
    let read = |ending: &str| {
        let name = format!("study-meyerliu1992_subject-S1_session-1_task-rating_{ending}.csv");
        let mut rows = csv::Reader::from_path(timing.join(name)).unwrap();
        let rows: Vec<csv::StringRecord> = rows.records().map(Result::unwrap).collect();
        rows
    };
    let frames = read("frames");
    let exposures: Vec<_> = frames.iter().filter(|row| &row[2] == "flanked").collect();
    assert_eq!(exposures.len(), 3);
    for (trial, row) in (1..).zip(exposures) {
        assert_eq!(row[1].parse(), Ok(trial));
        let intervals: Vec<u64> = row[4].split(' ').map(|us| us.parse().unwrap()).collect();
        assert_eq!(intervals.len(), 11);
        assert!(intervals.iter().all(|us| us.abs_diff(16_667) <= 1));
    }
    let events = read("events");
    let saved = events.iter().filter(|row| &row[4] == "rating_on_disk");
    assert_eq!(saved.count(), 3);
}
