//! The BIDS export, judged by the standard's own validator where it is installed, and by plain reading.

use std::env;
use std::process::Command;

use super::*;
use crate::sitting::tests::Place;

/// A study of which one subject is complete and one was cut off.
fn export() -> (Place, PathBuf) {
    let mut place = Place::new();
    place.rate(30);
    place.options.subject = "S2".parse().unwrap();
    place.rate(4);
    let bids = place.folder().join("bids");
    let options = &place.options;
    let count = export_bids(&place.study, &options.stimuli_dir, &options.data_dir, &bids);
    assert_eq!(count.unwrap(), 2);
    (place, bids)
}

#[test]
fn the_validator_of_the_standard_finds_no_error() {
    let validator = "bids-validator-deno";
    let path = env::var_os("PATH").unwrap_or_default();
    if !env::split_paths(&path).any(|folder| folder.join(validator).exists()) {
        let line = format!("SKIPPED: the test of the BIDS export needs {validator} (PyPI)\n");
        std::io::Write::write_all(&mut std::io::stderr(), line.as_bytes()).unwrap();
        return;
    }
    let (_place, bids) = export();
    let output = Command::new(validator).arg(&bids).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{text}");
    // What it says of a folder that is none, so that its silence means something.
    fs::remove_file(bids.join("dataset_description.json")).unwrap();
    assert!(
        !Command::new(validator)
            .arg(&bids)
            .output()
            .unwrap()
            .status
            .success()
    );
}

#[test]
fn every_trial_is_an_event_with_its_onset_its_exposure_and_its_picture() {
    let (place, bids) = export();
    let path = bids.join("sub-S1/ses-1/beh/sub-S1_ses-1_task-rating_events.tsv");
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(b'\t')
        .from_path(path)
        .unwrap();
    let header = reader.headers().unwrap().clone();
    assert!(
        header.iter().take(2).eq(["onset", "duration"]),
        "{header:?}"
    );
    let column = |name: &str| header.iter().position(|column| column == name).unwrap();
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    place_rows_match(&place, &rows, column("rating"));
    assert_eq!(&rows[0][0], "0.000");
    let onsets: Vec<f64> = rows.iter().map(|row| row[0].parse().unwrap()).collect();
    assert!(onsets.is_sorted());
    // 0.2 s at 60 frames a second.
    assert!(
        rows.iter()
            .all(|row| row[1].parse::<f64>().is_ok_and(|s| (s - 0.2).abs() < 0.009))
    );
    for row in &rows {
        assert!(
            bids.join("stimuli")
                .join(&row[column("stim_file")])
                .exists()
        );
    }
    let about = fs::read(bids.join("sub-S1/ses-1/beh/sub-S1_ses-1_task-rating_events.json"));
    let about: Value = serde_json::from_slice(&about.unwrap()).unwrap();
    let standard = ["onset", "duration", "response_time", "stim_file"];
    for name in header.iter().filter(|name| !standard.contains(name)) {
        assert!(
            about[name]["Description"].is_string(),
            "{name} is not described"
        );
    }
    assert_eq!(about["StimulusPresentation"]["ScreenDistance"], 1.016);
}

fn place_rows_match(place: &Place, events: &[csv::StringRecord], rating: usize) {
    let path = place.ratings_path();
    let path = path.with_file_name(
        path.file_name()
            .unwrap()
            .to_string_lossy()
            .replace("S2", "S1"),
    );
    let rows = read_ratings(&path, &place.study.protocol.stimuli.factors())
        .unwrap()
        .rows;
    assert_eq!((rows.len(), events.len()), (30, 30));
    for (row, event) in rows.iter().zip(events) {
        assert_eq!(event[rating].parse(), Ok(row.rating));
        assert!(event[4].contains(row.stimulus_id.as_str()));
    }
}

#[test]
fn nothing_is_exported_into_a_folder_with_files_or_from_one_without_sessions() {
    let (place, bids) = export();
    let options = &place.options;
    let again = export_bids(&place.study, &options.stimuli_dir, &options.data_dir, &bids);
    assert!(
        again
            .unwrap_err()
            .to_string()
            .contains("new or empty folder")
    );
    let fresh = Place::new();
    let none = fresh.folder().join("none");
    let options = &fresh.options;
    let error = export_bids(&fresh.study, &options.stimuli_dir, &options.data_dir, &none);
    let error = error.unwrap_err();
    assert!(
        error.is_input() && error.to_string().contains("no such file"),
        "{error}"
    );
    assert!(!none.exists());
}

#[test]
fn nothing_is_left_of_an_export_that_lacks_a_picture() {
    let place = Place::new();
    place.rate(5);
    let options = &place.options;
    let bids = place.folder().join("bids");
    let rated = place.rows()[4].stimulus_id.clone();
    fs::write(options.stimuli_dir.join(format!("{rated}.png")), "torn").unwrap();
    let error = export_bids(&place.study, &options.stimuli_dir, &options.data_dir, &bids);
    let text = error.unwrap_err().to_string();
    assert!(text.contains(rated.as_str()), "{text}");
    assert!(!bids.exists());
}

#[test]
fn a_malformed_session_stops_the_export_and_is_named() {
    let place = Place::new();
    place.rate(3);
    let sidecar = DataSet::sidecar_path(&place.ratings_path());
    fs::write(&sidecar, "{").unwrap();
    let options = &place.options;
    let bids = place.folder().join("bids");
    let error = export_bids(&place.study, &options.stimuli_dir, &options.data_dir, &bids);
    let error = error.unwrap_err();
    assert!(
        error.is_input() && error.to_string().contains("_data.json"),
        "{error}"
    );
    assert!(!bids.exists());
}
