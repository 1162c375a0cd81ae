//! Whether a report still says what the data say.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod simulated_study;

use std::fs::{self, File};
use std::path::Path;
use std::time::{Duration, SystemTime};

use analysis::{Pilots, ReportAge, report, report_age};
use protocols::Study;
use simulated_study::{paper, session, write_people, write_session};

fn age(study: &Study, folder: &Path) -> ReportAge {
    report_age(study, &folder.join("data"), &folder.join("report")).unwrap()
}

fn make(study: &Study, folder: &Path) {
    let out = folder.join("report");
    report(study, &folder.join("data"), Some(&out), Pilots::LeftOut).unwrap();
}

#[test]
fn a_report_is_current_until_a_subject_is_added() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let study = paper();
    write_people(&study, &folder.join("data"), 3);
    assert_eq!(age(&study, folder), ReportAge::NotMade);
    make(&study, folder);
    assert_eq!(age(&study, folder), ReportAge::Current);
    let rows = session(&study, "new", 77);
    write_session(&study, &folder.join("data"), &rows);
    assert_eq!(age(&study, folder), ReportAge::OlderThanData);
    make(&study, folder);
    assert_eq!(age(&study, folder), ReportAge::Current);
}

#[test]
fn a_comment_in_the_protocol_makes_a_report_older() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut study = paper();
    write_people(&study, &folder.join("data"), 2);
    make(&study, folder);
    study.sha256 = protocols::Sha256Digest::of(b"another protocol");
    assert_eq!(age(&study, folder), ReportAge::OlderThanProtocol);
}

/// A session that was closed has a sidecar that is newer than the report.
#[test]
fn a_sidecar_that_is_newer_makes_a_report_older() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let study = paper();
    write_people(&study, &folder.join("data"), 2);
    make(&study, folder);
    let note = folder.join("data/data/of-a-session_data.json");
    fs::write(&note, "{}").unwrap();
    let page = folder.join("report/report.html");
    let at = |path: &Path, seconds: u64| {
        let time = SystemTime::UNIX_EPOCH + Duration::from_secs(seconds);
        let file = File::options().append(true).open(path).unwrap();
        file.set_modified(time).unwrap();
    };
    for entry in fs::read_dir(folder.join("data/data")).unwrap() {
        at(&entry.unwrap().path(), 1_000_000_000);
    }
    at(&page, 1_000_000_000);
    assert_eq!(age(&study, folder), ReportAge::Current);
    at(&note, 1_000_000_001);
    assert_eq!(age(&study, folder), ReportAge::OlderThanData);
}

#[test]
fn without_ratings_there_is_an_error_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let refused = report_age(&paper(), &folder.path().join("data"), folder.path());
    let error = refused.unwrap_err();
    assert!(error.is_input() && error.to_string().contains("acuity run"));
}
