//! Exports of jsPsych, `PsychoPy` and BIDS, read as they are: `exports/README.md`.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::fs;
use std::path::{Path, PathBuf};

use analysis::{AnalysisOptions, Design, TableAnalysis};

fn files(name: &str) -> Vec<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/exports")
        .join(name);
    if path.is_file() {
        return vec![path];
    }
    let mut files: Vec<PathBuf> = fs::read_dir(path)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    files
}

fn design(subject: &str, rating: &str, filters: &[&str]) -> Design {
    Design {
        subject: subject.to_owned(),
        rating: rating.to_owned(),
        within: vec!["rays".to_owned()],
        filters: filters.iter().map(|text| text.parse().unwrap()).collect(),
        ..Design::default()
    }
}

fn analyse(files: &[PathBuf], design: &Design) -> Result<TableAnalysis, String> {
    TableAnalysis::of_tables(files, design, &AnalysisOptions::default()).map_err(|error| {
        assert!(error.is_input(), "{error}");
        error.to_string()
    })
}

#[test]
fn each_program_s_export_holds_the_same_ratings() {
    let cases = [
        ("jspsych.csv", design("who", "response", &["task=rating"])),
        ("jspsych.csv", design("who", "response.Q0", &["task=again"])),
        (
            "jspsych.csv",
            design(
                "who",
                "response",
                &[
                    "trial_type=image-slider-response",
                    "task!=practice|fixation",
                ],
            ),
        ),
        (
            "psychopy",
            design("participant", "slider.response", &["trials.thisN!="]),
        ),
        ("bids", design("@sub", "value", &["trial_type=rating"])),
        (
            "jspsych-8.3.0.csv",
            design("who", "response", &["task=rating"]),
        ),
    ];
    for (name, design) in cases {
        let found = analyse(&files(name), &design).unwrap();
        let [rays] = found.anova.effects.as_slice() else {
            panic!("one effect");
        };
        // Differences 4.5, 6, 7.25: mean 71/12, variance 91/48, so F = n mean^2 / variance = 5041 / 91.
        assert!(
            (rays.f.unwrap() - 5041.0 / 91.0).abs() < 1e-11,
            "{name}: {rays:?}"
        );
        assert_eq!((found.anova.n_subjects, rays.df_den), (3, 2), "{name}");
        assert_eq!(found.anova.n_averaged_cells, 0, "{name}");
    }
}

#[test]
fn files_that_the_programs_wrote_themselves_are_read() {
    // Each picture twice, half a step above and below the rating, so that the averages are the ratings.
    let of_psychopy = design("participant", "trials.slider.response", &["trials.thisN!="]);
    let found = analyse(&files("psychopy-2026.2.5"), &of_psychopy).unwrap();
    let rays = &found.anova.effects[0];
    assert!((rays.f.unwrap() - 5041.0 / 91.0).abs() < 1e-11, "{rays:?}");
    assert_eq!(found.anova.n_averaged_cells, 6);
    // The survey: only the level 10K was asked for.
    let of_survey = design("who", "response.Q0", &["task=again"]);
    let message = analyse(&files("jspsych-8.3.0.csv"), &of_survey).unwrap_err();
    assert!(message.contains("one level (\"10K\")"), "{message}");
}

#[test]
fn without_a_filter_the_rows_of_other_kinds_are_named_and_the_filter_too() {
    let message = analyse(
        &files("psychopy"),
        &design("participant", "slider.response", &[]),
    )
    .unwrap_err();
    assert!(
        message.contains("line 2, column rays") && message.contains("--where"),
        "{message}"
    );
    // A practice trial is a rating like any other unless it is left out.
    let all = analyse(
        &files("psychopy"),
        &design("participant", "slider.response", &["rays!="]),
    )
    .unwrap();
    assert_eq!(all.anova.n_averaged_cells, 3);
}

#[test]
fn a_filter_that_keeps_nothing_says_what_is_there() {
    let message = analyse(
        &files("bids"),
        &design("@sub", "value", &["trial_type=ratings"]),
    )
    .unwrap_err();
    for said in [
        "no row with trial_type=ratings among 6",
        "\"exposure\"",
        "\"rating\"",
        "sub-01_ses-1",
    ] {
        assert!(message.contains(said), "{said}: {message}");
    }
    let message = analyse(&files("bids"), &design("@sub", "value", &["kind=rating"])).unwrap_err();
    assert!(message.contains("a column \"kind\""), "{message}");
}

#[test]
fn what_cannot_be_read_is_named_with_its_place() {
    let message = analyse(
        &files("psychopy"),
        &design("@sub", "slider.response", &["trials.thisN!="]),
    )
    .unwrap_err();
    assert!(
        message.contains("sub-01_task-rating_events.tsv") && message.contains("--subject"),
        "{message}"
    );
    let message = analyse(
        &files("jspsych.csv"),
        &design("who", "response.Q7", &["task=again"]),
    )
    .unwrap_err();
    assert!(message.contains("a JSON object with this key"), "{message}");
    let message = analyse(
        &files("jspsych.csv"),
        &design("who", "response.Q0", &["task=rating"]),
    )
    .unwrap_err();
    assert!(message.contains("a JSON object with this key"), "{message}");
    let message = analyse(
        &files("jspsych.csv"),
        &design("who", "stimulus", &["task=rating"]),
    )
    .unwrap_err();
    assert!(message.contains("a number"), "{message}");
}

#[test]
fn several_files_are_named_together_where_their_cells_are_wanting() {
    let folder = tempfile::tempdir().unwrap();
    let mut copies = Vec::new();
    for file in files("bids") {
        let copy = folder.path().join(file.file_name().unwrap());
        let text = fs::read_to_string(&file).unwrap();
        fs::write(&copy, text.replace("\t100K\t", "\t10K\t")).unwrap();
        copies.push(copy);
    }
    let message = analyse(&copies, &design("@sub", "value", &["trial_type=rating"])).unwrap_err();
    assert!(message.contains("and 2 more"), "{message}");
}
