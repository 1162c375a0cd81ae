//! Where the answers before the first trial are written.
//!
//! The shared tables have a row for the form and one for each plate and letter; answers that may tell who the
//! subject is go to a file of their own below `private/`, outside `data/`, which no export reads. All files are
//! for their owner only, and are written whole or not at all.

use std::collections::BTreeMap;
use std::path::PathBuf;

use protocols::rating::{Column, csv_line};
use protocols::{Access, DataSet, FieldKind, FormField, SessionPlan, write_atomically};
use serde::{Deserialize, Serialize};

use crate::intake::{LetterAnswer, PixelAngle, PlateAnswer, ScreeningScore};
use crate::sidecar::SessionKey;
use crate::{ExperimentError, data_set_files};

/// What a missing answer is written as.
const NONE: &str = "n/a";

/// The columns of the screening, with unit and meaning.
pub(crate) const SCREENING_COLUMNS: [(&str, Option<&str>, &str); 11] = [
    ("item", None, "the screening's items, from 1"),
    (
        "item_kind",
        None,
        "plate (a digit in dots) or letter (an E)",
    ),
    (
        "axis",
        None,
        "confusion axis of a plate: protan, deutan, tritan, or control (luminance)",
    ),
    (
        "grade",
        None,
        "part of the largest excursion along the axis that an sRGB display shows",
    ),
    (
        "excursion",
        None,
        "the digit's colour is white plus so much of the axis's copunctal point",
    ),
    ("stroke_px", Some("px"), "width of a stroke of the letter"),
    (
        "stroke_arcmin",
        Some("arcmin"),
        "the same as an angle at the eye",
    ),
    ("shown", None, "the digit, or the open side of the letter"),
    (
        "seen",
        None,
        "what the subject answered; n/a: none, or cannot tell",
    ),
    (
        "correct",
        None,
        "whether that was right; a screening, never a diagnosis",
    ),
    (
        "answer_time_s",
        Some("s"),
        "from the first frame with the item to the answer",
    ),
];

/// What the sidecar says of the steps before the first trial.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct IntakeRecord {
    /// The SHA-256 of the text that was agreed to, and of its buttons' words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) consent_sha256: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) consent_at: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) form_at: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) screening_at: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) screening: Option<ScreeningScore>,
}

/// The tables of one session.
#[derive(Clone, Debug)]
pub(crate) struct IntakeFiles {
    data_set: DataSet,
    key: SessionKey,
}

/// The columns that a protocol's form and screening add to the data set.
pub(crate) fn columns(plan: &SessionPlan) -> Vec<Column> {
    let shared = plan.form.iter().filter(|field| !field.identifies);
    let mut columns: Vec<Column> = shared.map(form_column).collect();
    if plan.screening.is_some() {
        columns.extend(SCREENING_COLUMNS.map(|(name, unit, description)| Column {
            name: name.to_owned(),
            description: description.to_owned(),
            unit,
        }));
    }
    columns
}

fn form_column(field: &FormField) -> Column {
    let what = match field.kind {
        FieldKind::Number => field.unit.as_ref().map_or_else(
            || "a number".to_owned(),
            |unit| format!("a number of {unit}"),
        ),
        FieldKind::Choice => format!("one of: {}", field.choices.join(", ")),
        FieldKind::Text => "words".to_owned(),
    };
    Column {
        name: field.key.clone(),
        description: format!("answer to \"{}\" ({what})", field.label),
        unit: None,
    }
}

impl IntakeFiles {
    pub(crate) fn new(data_set: &DataSet, key: &SessionKey) -> Self {
        Self {
            data_set: data_set.clone(),
            key: key.clone(),
        }
    }

    fn table_path(&self, table: &str) -> PathBuf {
        let task = match self.key.pilot_speed {
            Some(_) => format!("pilot{table}"),
            None => table.to_owned(),
        };
        let SessionKey {
            subject_id,
            session_id,
            ..
        } = &self.key;
        self.data_set.ratings_path(subject_id, *session_id, &task)
    }

    fn write(
        &self,
        table: &str,
        names: &[&str],
        rows: Vec<Vec<String>>,
    ) -> Result<(), ExperimentError> {
        let head = ["subject_id", "session_id", "pilot"];
        let names = head.iter().chain(names).map(|&name| name.to_owned());
        let mut text = csv_line(names);
        for row in rows {
            let key = [
                self.key.subject_id.to_string(),
                self.key.session_id.to_string(),
                self.key.pilot_speed.is_some().to_string(),
            ];
            text.push_str(&csv_line(key.into_iter().chain(row)));
        }
        let path = self.table_path(table);
        write_atomically(&path, text.as_bytes(), Access::Owner)
            .map_err(ExperimentError::io("write", &path))
    }

    /// Writes the form: what does not identify into the shared table, the rest apart.
    pub(crate) fn write_form(
        &self,
        form: &[FormField],
        answers: &[String],
    ) -> Result<(), ExperimentError> {
        let pairs = || form.iter().zip(answers);
        let private: BTreeMap<&String, &String> = pairs()
            .filter(|(field, _)| field.identifies)
            .map(|(field, answer)| (&field.key, answer))
            .collect();
        if !private.is_empty() {
            self.write_private(&private)?;
        }
        let shared: Vec<_> = pairs().filter(|(field, _)| !field.identifies).collect();
        let names: Vec<&str> = shared.iter().map(|(field, _)| field.key.as_str()).collect();
        let or_none = |answer: &String| match answer.as_str() {
            "" => NONE.to_owned(),
            words => words.to_owned(),
        };
        let row = shared.iter().map(|(_, answer)| or_none(answer)).collect();
        self.write("form", &names, vec![row])
    }

    fn write_private(&self, answers: &BTreeMap<&String, &String>) -> Result<(), ExperimentError> {
        let folder = self.data_set.root().join("private");
        data_set_files::create_private_folder(&folder)?;
        let path = self.table_path("form").with_extension("json");
        let path = folder.join(path.file_name().unwrap_or_default());
        let text = match serde_json::to_string_pretty(answers) {
            Ok(text) => text + "\n",
            Err(error) => return Err(ExperimentError::io("write", &path)(error.into())),
        };
        write_atomically(&path, text.as_bytes(), Access::Owner)
            .map_err(ExperimentError::io("write", &path))
    }

    /// Writes the answers to plates and letters.
    pub(crate) fn write_screening(
        &self,
        plates: &[PlateAnswer],
        letters: &[LetterAnswer],
        angle: PixelAngle,
    ) -> Result<(), ExperimentError> {
        let none = || NONE.to_owned();
        let of_plate = |answer: &PlateAnswer| {
            vec![
                "plate".to_owned(),
                answer.axis.as_str().to_owned(),
                answer.grade.to_string(),
                format!("{:.5}", answer.excursion),
                none(),
                none(),
                answer.shown.to_string(),
                answer.seen.map_or_else(none, |digit| digit.to_string()),
                answer.is_right().to_string(),
                format!("{:.4}", answer.response_time_s),
            ]
        };
        let of_letter = |answer: &LetterAnswer| {
            vec![
                "letter".to_owned(),
                none(),
                none(),
                none(),
                answer.stroke_px.to_string(),
                format!("{:.3}", angle.stroke_arcmin(answer.stroke_px)),
                answer.shown.as_str().to_owned(),
                answer
                    .seen
                    .map_or_else(none, |side| side.as_str().to_owned()),
                answer.is_right().to_string(),
                format!("{:.4}", answer.response_time_s),
            ]
        };
        let rows = plates
            .iter()
            .map(of_plate)
            .chain(letters.iter().map(of_letter));
        let numbered = (1..)
            .zip(rows)
            .map(|(number, row): (u32, Vec<String>)| [vec![number.to_string()], row].concat());
        self.write(
            "screening",
            &SCREENING_COLUMNS.map(|column| column.0),
            numbered.collect(),
        )
    }
}
