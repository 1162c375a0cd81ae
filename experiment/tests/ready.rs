//! What is said before the first subject comes.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use std::fs;
use std::path::Path;

use common::{small_study, write_stimuli};
use experiment::{check_ready, simulate};
use protocols::Study;

/// What is not ready, but for the display, which a test may or may not have.
fn faults(study: &Study, stimuli: &Path, data: &Path) -> Vec<String> {
    let mut faults = check_ready(study, stimuli, data);
    faults.retain(|fault| !fault.starts_with("display: "));
    faults
}

#[test]
fn a_verified_set_and_a_folder_that_takes_files_are_ready() {
    let folder = tempfile::tempdir().unwrap();
    let study = small_study(folder.path());
    let stimuli = write_stimuli(&study, folder.path());
    let data = folder.path().join("not/there/yet");
    assert_eq!(faults(&study, &stimuli, &data), [""; 0]);
    assert!(
        !folder.path().join("not").exists(),
        "a check leaves nothing behind"
    );
}

#[test]
fn each_thing_that_is_not_ready_has_a_line() {
    let folder = tempfile::tempdir().unwrap();
    let study = small_study(folder.path());
    let missing = folder.path().join("missing");
    let found = faults(&study, &missing, folder.path());
    assert!(
        found.len() == 1 && found[0].contains("manifest.json"),
        "{found:?}"
    );

    let stimuli = write_stimuli(&study, folder.path());
    fs::write(stimuli.join("a010k_c140k.exr"), "changed").unwrap();
    fs::remove_file(stimuli.join("a140k_c010k.png")).unwrap();
    let data = folder.path().join("simulated");
    let found = faults(&study, &stimuli, &data);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].contains("a010k_c140k.exr") && found[0].contains("SHA-256"));
    assert!(found[1].contains("a140k_c010k.png") && found[1].contains("no such file"));

    let stimuli = write_stimuli(&study, folder.path());
    simulate(&study, &stimuli, &data, 1, 1, &|_, _| {}).unwrap();
    let found = faults(&study, &stimuli, &data);
    assert!(
        found.len() == 1 && found[0].contains("field observer"),
        "{found:?}"
    );

    let file = folder.path().join("a-file");
    fs::write(&file, "").unwrap();
    let found = faults(&study, &stimuli, &file);
    assert!(
        found.len() == 1 && found[0].contains("takes no file"),
        "{found:?}"
    );
}
