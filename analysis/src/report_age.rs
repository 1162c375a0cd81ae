//! Whether a report that was made still says what the data say.

use std::fs;
use std::path::Path;
use std::time::SystemTime;

use protocols::{DataSet, ReadError, Study};

use crate::study_ratings::StudyRatings;
use crate::{AnalysisError, Pilots};

/// How a report stands to the ratings and to the protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReportAge {
    /// There is none.
    NotMade,
    /// The protocol has changed since.
    OlderThanProtocol,
    /// Ratings or the facts of a session have changed since.
    OlderThanData,
    /// It is of this protocol and of these ratings.
    Current,
}

/// How the report in `report_dir` stands to the ratings of `study` in `data_dir`, trial runs left out.
///
/// A report names the SHA-256 of its protocol and of its ratings, so neither copies nor clocks deceive here. What
/// sessions note beside the ratings, such as that one was closed, is compared by the times of the files.
///
/// # Errors
///
/// The ratings cannot be used, as for [`report`](crate::report()), or the report cannot be read.
pub fn report_age(
    study: &Study,
    data_dir: &Path,
    report_dir: &Path,
) -> Result<ReportAge, AnalysisError> {
    let ratings = StudyRatings::read(study, data_dir, Pilots::LeftOut)?;
    let page = report_dir.join("report.html");
    if !page.exists() {
        return Ok(ReportAge::NotMade);
    }
    let kind = "a report (HTML)";
    let text = fs::read_to_string(&page).map_err(|error| ReadError::from_io(&page, kind, error))?;
    if !text.contains(study.sha256.as_str()) {
        return Ok(ReportAge::OlderThanProtocol);
    }
    let is_of_these = text.contains(ratings.sha256().as_str());
    if is_of_these && !has_newer_facts(study, data_dir, &page) {
        return Ok(ReportAge::Current);
    }
    Ok(ReportAge::OlderThanData)
}

/// Whether a session noted something after the report was written.
fn has_newer_facts(study: &Study, data_dir: &Path, page: &Path) -> bool {
    let changed = |path: &Path| -> Option<SystemTime> { fs::metadata(path).ok()?.modified().ok() };
    let Some(made) = changed(page) else {
        return true;
    };
    let folder = DataSet::new(data_dir, &study.protocol.study).data_folder();
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let is_sidecar = |path: &Path| path.extension().is_some_and(|ending| ending == "json");
    entries
        .map(|entry| entry.path())
        .filter(|path| is_sidecar(path))
        .any(|path| changed(&path).is_some_and(|at| at > made))
}
