//! Where the ratings of a study stand: a Psych-DS data set, one file for each session.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::SubjectId;

/// Who rated: a person or a model. The two are never mixed in one data set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Observer {
    /// A human subject.
    Person,
    /// A simulated observer.
    Simulated,
}

impl Observer {
    /// The word in the ratings and their sidecars.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Person => "person",
            Self::Simulated => "simulated",
        }
    }
}

/// The tasks of tables without ratings, of sessions that count and of trial runs.
const OTHER_TASKS: [&str; 4] = ["form", "screening", "pilotform", "pilotscreening"];

/// The folder of a Psych-DS data set and the names in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataSet {
    root: PathBuf,
    study_key: String,
}

impl DataSet {
    /// The data set of `study` in the folder `root`.
    pub fn new(root: impl Into<PathBuf>, study: &str) -> Self {
        let study_key = study.chars().filter(char::is_ascii_alphanumeric).collect();
        Self {
            root: root.into(),
            study_key,
        }
    }

    /// The folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// `dataset_description.json`.
    pub fn description_path(&self) -> PathBuf {
        self.root.join("dataset_description.json")
    }

    /// The folder of the sessions' files.
    pub fn data_folder(&self) -> PathBuf {
        self.root.join("data")
    }

    /// The ratings of one session; a trial run (`--pilot`) has the task `pilot`, so that it never stands
    /// in the way of the subject's real session.
    ///
    /// ```
    /// let data_set = protocols::DataSet::new("data/meyer-liu-1992", "meyer-liu-1992");
    /// let path = data_set.ratings_path(&"01".parse()?, 1, "rating");
    /// assert!(path.ends_with("data/study-meyerliu1992_subject-01_session-1_task-rating_data.csv"));
    /// # Ok::<(), String>(())
    /// ```
    pub fn ratings_path(&self, subject: &SubjectId, session: u32, task: &str) -> PathBuf {
        let name = format!(
            "study-{}_subject-{subject}_session-{session}_task-{task}_data.csv",
            self.study_key
        );
        self.data_folder().join(name)
    }

    /// Whether a file of the data folder, by its name, holds ratings.
    ///
    /// ```
    /// assert!(protocols::DataSet::has_ratings("study-a_subject-01_session-1_task-rating_data.csv"));
    /// assert!(!protocols::DataSet::has_ratings("study-a_subject-01_session-1_task-form_data.csv"));
    /// ```
    pub fn has_ratings(file_name: &str) -> bool {
        let is_of = |task: &str| file_name.ends_with(&format!("_task-{task}_data.csv"));
        file_name.ends_with("_data.csv") && !OTHER_TASKS.iter().any(|task| is_of(task))
    }

    /// The sidecar of a ratings file: the same name, ending in `.json`.
    pub fn sidecar_path(ratings_path: &Path) -> PathBuf {
        ratings_path.with_extension("json")
    }
}
