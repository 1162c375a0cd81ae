//! What a sitting keeps of the steps before the first trial, and what it does not.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;

use protocols::{ConsentPlan, FieldKind, FormField, SessionPlan};

use super::tests::Place;
use crate::intake_files::SCREENING_COLUMNS;
use crate::{Axis, Ending, Finished, LetterAnswer, Order, PlateAnswer, Side, Step};

fn field(key: &str) -> FormField {
    FormField {
        key: key.to_owned(),
        label: format!("Your {key}?"),
        kind: FieldKind::Text,
        lowest: None,
        highest: None,
        unit: None,
        choices: Vec::new(),
        required: false,
        identifies: key == "email",
    }
}

/// A study with consent, a form and screening.
pub(super) fn place() -> Place {
    let mut place = Place::new();
    ask(&mut place.study.protocol.session);
    place
}

/// Puts consent, a form and screening into a protocol.
pub(super) fn ask(session: &mut SessionPlan) {
    session.consent = Some(ConsentPlan {
        text: "Agree?".to_owned(),
        agree: "Yes".to_owned(),
        decline: "No".to_owned(),
    });
    session.form = vec![field("glasses"), field("email")];
    session.screening = toml::from_str("seed = 1").ok();
}

pub(super) fn answers() -> Finished {
    Finished::Form(vec!["yes, \"thick\"".to_owned(), "me@x.org".to_owned()])
}

/// Every file below a folder that holds these words.
fn holding(folder: &Path, words: &str) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(holding(&path, words));
        } else if String::from_utf8(fs::read(&path).unwrap())
            .unwrap()
            .contains(words)
        {
            found.push(path.to_string_lossy().into_owned());
        }
    }
    found
}

#[test]
fn who_declines_leaves_no_file_and_who_agreed_is_not_asked_again() {
    let place = place();
    let mut sitting = place.open().unwrap();
    let end = sitting.leave(1.0).unwrap();
    assert_eq!(end.ending, Ending::Declined);
    assert!(end.to_string().contains("nothing was kept"));
    drop(sitting);
    assert!(!place.ratings_path().exists());
    assert!(!place.ratings_path().with_extension("json").exists());

    let mut sitting = place.open().unwrap();
    let consent = place.study.protocol.session.consent.clone().unwrap();
    sitting
        .keep(Finished::Consent(consent.sha256()), 2.0)
        .unwrap();
    let end = sitting.leave(3.0).unwrap();
    assert_eq!(end.ending, Ending::Stopped);
    drop(sitting);
    let sitting = place.open().unwrap();
    assert_eq!(sitting.intake.step(), Step::Form);
    let sidecar = fs::read_to_string(place.ratings_path().with_extension("json")).unwrap();
    assert!(sidecar.contains(consent.sha256().as_str()), "{sidecar}");
}

#[test]
fn an_answer_that_identifies_is_in_no_file_but_its_own_and_all_are_private() {
    let place = place();
    let mut sitting = place.open().unwrap();
    sitting.keep(answers(), 2.0).unwrap();
    let root = place.options.data_dir.clone();
    let found = holding(&root, "me@x.org");
    assert_eq!(found.len(), 1, "{found:?}");
    let file = Path::new(&found[0]);
    assert!(file.starts_with(root.join("private")), "{file:?}");
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    assert_eq!(mode(file), 0o600);
    assert_eq!(mode(&root.join("private")), 0o700);
    let shared = place.ratings_path();
    let name = shared.to_string_lossy().replace("task-rating", "task-form");
    let text = fs::read_to_string(&name).unwrap();
    assert_eq!(
        text,
        "subject_id,session_id,pilot,glasses\nS1,1,false,\"yes, \"\"thick\"\"\"\n"
    );
    assert_eq!(mode(Path::new(&name)), 0o600);
    drop(sitting);
    assert_eq!(place.open().unwrap().intake.step(), Step::Consent);
}

#[test]
fn the_screening_is_a_row_for_each_item_and_a_score_in_the_sidecar() {
    let place = place();
    let mut sitting = place.open().unwrap();
    let plate = |seen| PlateAnswer {
        axis: Axis::Deutan,
        grade: 0.5,
        excursion: 0.12,
        shown: 4,
        seen,
        response_time_s: 1.25,
    };
    let letter = LetterAnswer {
        stroke_px: 2,
        shown: Side::Up,
        seen: None,
        response_time_s: 0.5,
    };
    let screening = Finished::Screening(vec![plate(Some(4)), plate(None)], vec![letter]);
    sitting.keep(screening, 2.0).unwrap();
    let name = place.ratings_path();
    let name = name
        .to_string_lossy()
        .replace("task-rating", "task-screening");
    let text = fs::read_to_string(&name).unwrap();
    // 2 pixels of 0.019 degrees: 2.28 minutes of arc, by hand.
    let rows = "S1,1,false,1,plate,deutan,0.5,0.12000,n/a,n/a,4,4,true,1.2500\n\
        S1,1,false,2,plate,deutan,0.5,0.12000,n/a,n/a,4,n/a,false,1.2500\n\
        S1,1,false,3,letter,n/a,n/a,n/a,2,2.280,up,n/a,false,0.5000\n";
    assert!(text.ends_with(rows), "{text}");
    let sidecar = fs::read_to_string(place.ratings_path().with_extension("json")).unwrap();
    let sidecar: serde_json::Value = serde_json::from_str(&sidecar).unwrap();
    let score = &sidecar["intake"]["screening"];
    assert_eq!(score["plates"]["deutan"]["right"], 1);
    assert_eq!(score["has_measured_angle"], false);
    assert!(
        score["remark"]
            .as_str()
            .unwrap()
            .contains("never a diagnosis")
    );
}

#[test]
fn a_question_cannot_have_the_name_of_a_column() {
    let place = place();
    let path = place.folder().join("asked.toml");
    let protocol = fs::read_to_string(&place.study.path).unwrap();
    let asks = |key: &str| {
        let question =
            format!("[[session.form]]\nkey = \"{key}\"\nlabel = \"?\"\nkind = \"text\"\n");
        fs::write(&path, format!("{protocol}\n{question}")).unwrap();
        protocols::Study::read(&path)
    };
    assert!(asks("handedness").is_ok());
    let factors = place.study.protocol.stimuli.factors();
    let names = protocols::rating::columns(&factors).into_iter();
    let names = names
        .chain(crate::timing_log::columns())
        .map(|column| column.name);
    let names = names.chain(SCREENING_COLUMNS.map(|column| column.0.to_owned()));
    for name in names {
        let text = asks(&name).unwrap_err().to_string();
        let is_named = text.contains("session.form.key") && text.contains(&format!("{name:?}"));
        assert!(is_named && text.contains("no column"), "{text}");
    }
}

#[test]
fn a_note_of_the_experimenter_is_in_the_sidecar_and_in_the_events() {
    let place = Place::new();
    place.rate(2);
    let mut sitting = place.open().unwrap();
    sitting.order(&Order::Note("coughs, \"badly\"".to_owned()), 1.5);
    sitting.keep_words().unwrap();
    drop(sitting);
    let sidecar = fs::read_to_string(place.ratings_path().with_extension("json")).unwrap();
    let sidecar: serde_json::Value = serde_json::from_str(&sidecar).unwrap();
    let note = serde_json::json!({
        "at": "1970-01-01T00:00:01.500Z", "trial_id": 3, "text": "coughs, \"badly\""
    });
    assert_eq!(sidecar["sittings"][1]["notes"], serde_json::json!([note]));
    let events = "study-meyerliu1992_subject-S1_session-1_task-rating_events.csv";
    let events = fs::read_to_string(place.options.data_dir.join("timing").join(events)).unwrap();
    // Quotes would end the field.
    assert!(events.contains(",3,note,\"coughs,  badly \"\n"), "{events}");
}

/// The rule of Psych-DS: every column of every table is described.
#[test]
fn every_column_of_every_table_is_in_the_description_also_one_that_was_added() {
    let mut place = place();
    let rows = |place: &Place| {
        let path = place.options.data_dir.join("dataset_description.json");
        let text = fs::read_to_string(path).unwrap();
        let description: serde_json::Value = serde_json::from_str(&text).unwrap();
        let variables = description["variableMeasured"].as_array().unwrap().clone();
        let name = |value: serde_json::Value| value["name"].as_str().unwrap().to_owned();
        variables.into_iter().map(name).collect::<Vec<_>>()
    };
    drop(place.open().unwrap());
    let before = rows(&place);
    place.study.protocol.session.form.push(field("hand"));
    let mut sitting = place.open().unwrap();
    let Finished::Form(mut words) = answers() else {
        panic!("a form");
    };
    words.push("left".to_owned());
    sitting.keep(Finished::Form(words), 1.0).unwrap();
    sitting
        .keep(Finished::Screening(Vec::new(), Vec::new()), 1.0)
        .unwrap();
    let described = rows(&place);
    assert_eq!(described.len(), before.len() + 1);
    for entry in fs::read_dir(place.options.data_dir.join("data")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "csv") {
            let text = fs::read_to_string(&path).unwrap();
            for column in text.lines().next().unwrap().split(',') {
                assert!(
                    described.iter().any(|name| name == column),
                    "{column} of {path:?}"
                );
            }
        }
    }
    let email = described.iter().any(|name| name == "email");
    assert!(!email, "what identifies is in no shared table");
}
