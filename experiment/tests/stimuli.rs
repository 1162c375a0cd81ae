//! What a session says of a stimulus set that is missing, cut short, changed or contradictory.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use std::fs;
use std::path::Path;

use common::{small_study, write_stimuli};
use experiment::StimulusSet;
use protocols::{Sha256Digest, Study};

/// What is said of the set after `harm` was done to its folder.
fn refusal(harm: impl FnOnce(&Path, &mut Study)) -> String {
    let folder = tempfile::tempdir().unwrap();
    let mut study = small_study(folder.path());
    let stimuli = write_stimuli(&study, folder.path());
    StimulusSet::read(&study, &stimuli).unwrap();
    harm(&stimuli, &mut study);
    let error = StimulusSet::read(&study, &stimuli).unwrap_err();
    assert!(error.is_input(), "{error}");
    error.to_string()
}

fn replace_in_manifest(stimuli: &Path, old: &str, new: &str) {
    let path = stimuli.join("manifest.json");
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(old));
    fs::write(path, text.replacen(old, new, 1)).unwrap();
}

/// Writes other bytes and their digest, so that only the picture itself is at fault.
fn replace_image(stimuli: &Path, bytes: &[u8]) {
    let path = stimuli.join("a050k_c140k.png");
    let old = Sha256Digest::of_file(&path).unwrap();
    fs::write(&path, bytes).unwrap();
    replace_in_manifest(stimuli, old.as_str(), Sha256Digest::of(bytes).as_str());
}

#[test]
fn a_missing_manifest_is_named_with_the_command_that_makes_it() {
    let text = refusal(|stimuli, _| fs::remove_file(stimuli.join("manifest.json")).unwrap());
    assert!(
        text.contains("manifest.json") && text.contains("acuity render"),
        "{text}"
    );
}

#[test]
fn a_manifest_cut_short_is_refused() {
    let text = refusal(|stimuli, _| {
        let path = stimuli.join("manifest.json");
        let text = fs::read_to_string(&path).unwrap();
        fs::write(path, &text[..text.len() / 2]).unwrap();
    });
    assert!(text.contains("EOF"), "{text}");
}

#[test]
fn a_manifest_with_an_unknown_key_is_refused() {
    let text = refusal(|stimuli, _| replace_in_manifest(stimuli, "\"remarks\"", "\"remark\""));
    assert!(text.contains("unknown field `remark`"), "{text}");
}

#[test]
fn a_manifest_that_points_out_of_its_folder_is_refused() {
    let text = refusal(|stimuli, _| {
        replace_in_manifest(stimuli, "\"a050k_c140k.png\"", "\"../a050k_c140k.png\"");
    });
    assert!(text.contains("a plain file name"), "{text}");
}

#[test]
fn a_set_of_another_plan_is_refused() {
    let text = refusal(|_, study| study.protocol.stimuli.rendered_mut().unwrap().seed += 1);
    assert!(text.contains("another plan"), "{text}");
}

#[test]
fn a_missing_image_is_named() {
    let text = refusal(|stimuli, _| fs::remove_file(stimuli.join("a050k_c140k.png")).unwrap());
    assert!(text.contains("a050k_c140k.png"), "{text}");
}

#[test]
fn an_image_with_one_changed_byte_is_refused() {
    let text = refusal(|stimuli, _| {
        let path = stimuli.join("a050k_c140k.png");
        let mut bytes = fs::read(&path).unwrap();
        *bytes.last_mut().unwrap() ^= 1;
        fs::write(path, bytes).unwrap();
    });
    assert!(
        text.contains("SHA-256") && text.contains("a050k_c140k.png"),
        "{text}"
    );
}

#[test]
fn an_image_that_was_cut_short_when_it_was_made_is_refused() {
    let text = refusal(|stimuli, _| {
        let bytes = fs::read(stimuli.join("a050k_c140k.png")).unwrap();
        replace_image(stimuli, &bytes[..bytes.len() / 2]);
    });
    assert!(text.contains("a050k_c140k.png"), "{text}");
}

#[test]
fn a_file_that_is_no_png_is_refused() {
    let text = refusal(|stimuli, _| replace_image(stimuli, b"GIF89a"));
    assert!(text.contains("an 8-bit RGB image (PNG)"), "{text}");
}

#[test]
fn an_image_of_another_size_is_refused() {
    let text = refusal(|stimuli, _| {
        let folder = tempfile::tempdir().unwrap();
        let mut other = small_study(folder.path());
        other.protocol.stimuli.rendered_mut().unwrap().size_px = [40, 48];
        let made = write_stimuli(&other, folder.path());
        replace_image(stimuli, &fs::read(made.join("a050k_c140k.png")).unwrap());
    });
    assert!(
        text.contains("40 x 48 pixels") && text.contains("48 x 40"),
        "{text}"
    );
}
