//! A study in a folder of its own, for the tests of the app.

use std::fs;
use std::path::{Path, PathBuf};

use analysis::Pilots;
use experiment::ListedSession;
use renderer::Watch;

use super::study_state::{Place, StudyState};

/// The paper's study with small images, in a folder that goes away with it.
pub(crate) struct Fixture {
    _folder: tempfile::TempDir,
    pub(crate) place: Place,
    pub(crate) protocol: PathBuf,
}

impl Fixture {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().to_owned();
        let source = Path::new(env!("CARGO_MANIFEST_DIR"));
        for part in ["protocols", "stimuli/scenes"] {
            fs::create_dir_all(root.join(part)).unwrap();
        }
        let scene = "stimuli/scenes/opponent-solids.toml";
        fs::copy(source.join(scene), root.join(scene)).unwrap();
        let text = fs::read_to_string(source.join("protocols/meyer-liu-1992.toml")).unwrap();
        let text = text.replace("size_px = [320, 320]", "size_px = [48, 48]");
        let text = text.replace("resamples = 20000", "resamples = 200");
        let protocol = root.join("protocols/small.toml");
        fs::write(&protocol, text).unwrap();
        let place = Place {
            station: Some(root.join("config/station.toml")),
            root,
        };
        Self {
            _folder: folder,
            place,
            protocol,
        }
    }

    pub(crate) fn state(&self) -> StudyState {
        StudyState::read(&self.protocol, &self.place).unwrap()
    }

    pub(crate) fn replace_in_protocol(&self, old: &str, new: &str) {
        let text = fs::read_to_string(&self.protocol).unwrap();
        assert!(text.contains(old), "{old}");
        fs::write(&self.protocol, text.replacen(old, new, 1)).unwrap();
    }

    pub(crate) fn make_stimuli(&self) {
        let StudyState { study, folders, .. } = self.state();
        renderer::render_set(&study, &folders.stimuli, None, &Watch::UNWATCHED).unwrap();
    }

    /// Whole sessions, made up to look like people's; says whose.
    pub(crate) fn simulate_people(&self, number: u32) -> Vec<ListedSession> {
        let StudyState { study, folders, .. } = self.state();
        let (stimuli, data) = (&folders.stimuli, &folders.data);
        experiment::simulate(&study, stimuli, data, number, 1, &|_, _| ()).unwrap();
        let mut files = vec![data.join("dataset_description.json")];
        let entries = fs::read_dir(data.join("data")).unwrap();
        files.extend(entries.map(|entry| entry.unwrap().path()));
        for file in files {
            let text = fs::read_to_string(&file).unwrap();
            let text = text.replace("\"simulated\"", "\"person\"");
            fs::write(&file, text.replace(",simulated,", ",person,")).unwrap();
        }
        self.state().sessions.sessions
    }

    /// Leaves a session with so many ratings.
    pub(crate) fn cut_to(session: &ListedSession, rated: usize) {
        let text = fs::read_to_string(&session.ratings_path).unwrap();
        let lines: Vec<&str> = text.lines().take(rated + 1).collect();
        fs::write(&session.ratings_path, lines.join("\n") + "\n").unwrap();
    }

    pub(crate) fn make_report(&self) {
        let StudyState { study, folders, .. } = self.state();
        let out = Some(folders.report.as_path());
        analysis::report(&study, &folders.data, out, Pilots::LeftOut).unwrap();
    }
}
