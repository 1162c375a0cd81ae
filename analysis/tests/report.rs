//! The report of a study, from ratings files to the page.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod simulated_study;

use std::fs;
use std::path::Path;

use analysis::{AnalysisError, Design, Pilots, ReportSummary, anova_of_table, report};
use protocols::{Observer, Study};
use simulated_study::{paper, session, write_people, write_session};
use tempfile::TempDir;

/// A data set and the report made from it.
struct Trial {
    study: Study,
    folder: TempDir,
}

impl Trial {
    fn new() -> Self {
        Self {
            study: paper(),
            folder: tempfile::tempdir().unwrap(),
        }
    }

    fn with_people(n: u64) -> Self {
        let trial = Self::new();
        write_people(&trial.study, &trial.data(), n);
        trial
    }

    fn data(&self) -> std::path::PathBuf {
        self.folder.path().join("data")
    }

    fn out(&self) -> std::path::PathBuf {
        self.folder.path().join("report")
    }

    fn report(&self) -> Result<ReportSummary, AnalysisError> {
        report(&self.study, &self.data(), &self.out(), Pilots::LeftOut)
    }

    fn page(&self) -> String {
        fs::read_to_string(self.out().join("report.html")).unwrap()
    }

    fn refusal(&self) -> String {
        let error = self.report().unwrap_err();
        assert!(error.is_input(), "{error}");
        assert!(
            !self.out().exists(),
            "nothing is written of a report that is refused"
        );
        error.to_string()
    }
}

#[test]
fn every_file_is_written_and_no_other() {
    let trial = Trial::with_people(12);
    let summary = trial.report().unwrap();
    assert_eq!(summary.n_subjects, 12);
    let mut names: Vec<String> = fs::read_dir(trial.out())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(
        names,
        [
            "anova.csv",
            "anova.json",
            "figure-10.png",
            "figure-10.svg",
            "means.csv",
            "report.html"
        ]
    );
    // Kept for the eye: target/tmp/report.
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report");
    fs::create_dir_all(&kept).unwrap();
    for name in names {
        fs::copy(trial.out().join(&name), kept.join(&name)).unwrap();
    }
}
