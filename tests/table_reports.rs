//! `acuity report` of tables: exports of other programs, with options or a protocol of the analysis alone.

mod acuity;

use std::fs;
use std::path::Path;

use acuity::{PROTOCOL, acuity, stderr, text_of};

const PLAN: &str = "study = \"exports\"\ntitle = \"Two pictures\"\n[table]\nsubject = \"who\"\nrating = \"response\"\n\
    where = [\"task=rating\"]\nscale = { lowest = 0, highest = 10 }\n[analysis]\nwithin = [\"rays\"]\n\
    correction = \"greenhouse-geisser\"\nconfidence = 0.95\n";

fn export(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("analysis/tests/exports");
    path.join(name).to_string_lossy().into_owned()
}

/// Runs `report` with words parted by blanks (P is the paper's protocol, those that begin with `#` are exports); stdout.
fn report(folder: &Path, words: &str) -> Result<String, String> {
    let mut arguments = vec!["report".to_owned()];
    for word in words.split(' ') {
        let word = if word == "P" { PROTOCOL } else { word };
        let name = word.strip_prefix('#');
        arguments.push(name.map_or_else(|| word.to_owned(), export));
    }
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let output = acuity(folder, &arguments);
    match output.status.code() {
        Some(0) => Ok(text_of(&output.stdout)),
        Some(2) => Err(stderr(&output)),
        _ => panic!("{arguments:?}: {}", stderr(&output)),
    }
}

#[test]
fn exports_have_a_report_by_options_and_by_a_protocol() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("plan.toml"), PLAN).expect("written");
    let psychopy = "#psychopy-2026.2.5/01_rating.csv #psychopy-2026.2.5/02_rating.csv #psychopy-2026.2.5/03_rating.csv";
    for words in [
        "#jspsych-8.3.0.csv --subject who --rating response --within rays --where task=rating --out found".to_owned(),
        "plan.toml #jspsych-8.3.0.csv --out found".to_owned(),
        format!("{psychopy} --subject participant --rating trials.slider.response --within rays --where trials.thisN!= --out found"),
    ] {
        let printed = report(folder.path(), &words).expect("a report");
        assert!(printed.trim_end().ends_with("report.html"), "{printed}");
        // Differences 4.5, 6, 7.25: F = 5041 / 91.
        let found = fs::read_to_string(folder.path().join("found/anova.csv")).expect("read");
        assert!(found.contains("\nrays,1,2,"), "{found}");
        assert!(found.contains(",55.395604"), "{found}");
    }
    let default = report(folder.path(), "plan.toml #jspsych-8.3.0.csv").expect("a report");
    assert!(default.trim_end().ends_with("reports/exports/report.html"));
}

#[test]
fn options_that_contradict_a_protocol_or_a_table_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("plan.toml"), PLAN).expect("written");
    for (words, named) in [
        (
            "#jspsych-8.3.0.csv --rating response --within rays",
            "--subject",
        ),
        ("#jspsych-8.3.0.csv --subject who --within rays", "--rating"),
        (
            "#jspsych-8.3.0.csv --subject who --rating response",
            "without factors",
        ),
        ("plan.toml #jspsych-8.3.0.csv --within rays", "--within"),
        ("plan.toml #jspsych-8.3.0.csv --pairwise rays", "--pairwise"),
        ("plan.toml #jspsych-8.3.0.csv --data x", "--data"),
        (
            "P #jspsych-8.3.0.csv --subject who --rating response",
            "a column \"channel\"",
        ),
        ("plan.toml plan.toml", "second protocol"),
        ("plan.toml", "name the tables"),
        ("plan.toml --subject who", "--subject"),
        ("plan.toml nowhere.csv", "no such file"),
        ("nowhere.toml #jspsych-8.3.0.csv", "no such file"),
        ("#jspsych-8.3.0.csv --scale 10..0", "the lower first"),
        ("#jspsych-8.3.0.csv --where task", "COLUMN=VALUE"),
    ] {
        let message = report(folder.path(), words).expect_err(words);
        assert!(message.contains(named), "{words}: {message}");
    }
    let left = fs::read_dir(folder.path()).expect("read").count();
    assert_eq!(left, 1, "nothing is written");
}
