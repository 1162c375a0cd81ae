//! The part of a protocol that comes before the first trial: consent, a form, and screening of the eyes.
//!
//! Not here: the pages themselves and where the answers are written (`experiment`).

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use crate::Sha256Digest;
use crate::rating::columns;

/// A fault: the field, what was found, what was expected.
type Fault = (&'static str, String, &'static str);

/// Columns of the tables of screening, frames and events, which the crate `experiment` writes. A data set describes
/// each name once, so a question can have none of them, nor one of the ratings' own.
const TAKEN: [&str; 19] = [
    "answer_time_s",
    "at_us",
    "at_utc",
    "axis",
    "began_us",
    "correct",
    "detail",
    "event",
    "excursion",
    "grade",
    "intervals_us",
    "item",
    "item_kind",
    "screen",
    "seen",
    "shown",
    "sitting",
    "stroke_arcmin",
    "stroke_px",
];

/// What a subject must agree to before anything else.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConsentPlan {
    /// The whole text; blank lines part its paragraphs.
    pub text: String,
    /// On the button that agrees.
    #[serde(default = "agree")]
    pub agree: String,
    /// On the button that does not.
    #[serde(default = "decline")]
    pub decline: String,
}

impl ConsentPlan {
    /// The digest of the text and both buttons: which version was agreed to.
    ///
    /// It is the SHA-256 of the three, a line feed between them.
    pub fn sha256(&self) -> Sha256Digest {
        let version = [
            self.text.as_str(),
            self.agree.as_str(),
            self.decline.as_str(),
        ];
        Sha256Digest::of(version.join("\n").as_bytes())
    }

    pub(crate) fn fault(&self) -> Option<Fault> {
        let words = [&self.text, &self.agree, &self.decline];
        words.iter().any(|text| text.trim().is_empty()).then(|| {
            let expected = "a text, and words on both buttons";
            ("session.consent", "an empty text".to_owned(), expected)
        })
    }
}

/// A question of the form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FormField {
    /// The name of its column in the data.
    pub key: String,
    /// The question as the subject reads it.
    pub label: String,
    /// What is answered.
    pub kind: FieldKind,
    /// The least number that is taken.
    #[serde(default)]
    pub lowest: Option<f64>,
    /// The largest number that is taken.
    #[serde(default)]
    pub highest: Option<f64>,
    /// The unit of a number.
    #[serde(default)]
    pub unit: Option<String>,
    /// What can be chosen.
    #[serde(default)]
    pub choices: Vec<String>,
    /// Whether the form is not complete without it.
    #[serde(default = "yes")]
    pub required: bool,
    /// Whether the answer may tell who the subject is. Such answers never enter the shared tables.
    #[serde(default)]
    pub identifies: bool,
}

/// What a question is answered with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FieldKind {
    /// A number.
    Number,
    /// One of `choices`.
    Choice,
    /// Words.
    Text,
}

impl FormField {
    /// Whether this answer, without spaces around it, can stand.
    pub fn takes(&self, answer: &str) -> bool {
        let answer = answer.trim();
        if answer.is_empty() {
            return !self.required;
        }
        match self.kind {
            FieldKind::Number => answer.parse().is_ok_and(|number: f64| {
                let lowest = self.lowest.unwrap_or(f64::NEG_INFINITY);
                let highest = self.highest.unwrap_or(f64::INFINITY);
                number.is_finite() && (lowest..=highest).contains(&number)
            }),
            FieldKind::Choice => self.choices.iter().any(|choice| choice == answer),
            FieldKind::Text => answer.chars().count() <= 1000,
        }
    }

    fn fault(&self) -> Option<Fault> {
        let is_plain =
            |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
        let begins = self
            .key
            .bytes()
            .next()
            .is_some_and(|b| b.is_ascii_lowercase());
        if !begins || !self.key.bytes().all(is_plain) {
            let expected = "lower-case letters, digits and '_', a letter first";
            return Some(("session.form.key", format!("{:?}", self.key), expected));
        }
        if self.label.trim().is_empty() {
            return Some(("session.form.label", "no words".to_owned(), "a question"));
        }
        let is_number = self.kind == FieldKind::Number;
        if !is_number && (self.lowest.is_some() || self.highest.is_some() || self.unit.is_some()) {
            let found = format!("lowest, highest or unit for {:?}", self.key);
            return Some(("session.form", found, "these only with kind = \"number\""));
        }
        if self
            .lowest
            .zip(self.highest)
            .is_some_and(|(low, high)| low > high)
        {
            let expected = "a lowest number below the highest";
            return Some(("session.form.lowest", format!("{:?}", self.key), expected));
        }
        let distinct: BTreeSet<&String> = self.choices.iter().collect();
        let has_choices = distinct.len() >= 2 && distinct.len() == self.choices.len();
        let is_choice = self.kind == FieldKind::Choice;
        if is_choice && !has_choices || !is_choice && !self.choices.is_empty() {
            let expected = "two or more different choices with kind = \"choice\", and none else";
            let found = format!("{} choices for {:?}", self.choices.len(), self.key);
            return Some(("session.form.choices", found, expected));
        }
        None
    }
}

/// Checks every question, and that none has the name of another or of a column of the study's data.
pub(crate) fn form_fault(form: &[FormField], factors: &[String]) -> Option<Fault> {
    let place = "session.form.key";
    let ratings = columns(factors);
    let mut keys = BTreeSet::new();
    form.iter().find_map(|field| {
        let key = &field.key;
        let is_taken = TAKEN.contains(&key.as_str()) || ratings.iter().any(|c| c.name == *key);
        field
            .fault()
            .or_else(|| {
                let expected = "a name that no column of the study's data has already; take another, such as \"your_\" before it";
                is_taken.then(|| (place, format!("{key:?}"), expected))
            })
            .or_else(|| {
                let expected = "a name of its own for each question";
                (!keys.insert(key)).then(|| (place, format!("{key:?} twice"), expected))
            })
    })
}

/// Screening of colour vision and of acuity: scored and written down, never a diagnosis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScreeningPlan {
    /// For each confusion axis a plate with so large a part of the colour difference that the display can show.
    #[serde(default = "grades")]
    pub grades: Vec<f64>,
    /// The strokes of the letter E, in pixels: one size after the other.
    #[serde(default = "strokes_px")]
    pub strokes_px: Vec<u32>,
    /// How often each size of the E is shown.
    #[serde(default = "letters_each")]
    pub letters_each: u32,
    /// With the subject's code, the seed of digits, dots and directions.
    pub seed: u64,
    /// Above each plate.
    #[serde(default = "plate_question")]
    pub plate_question: String,
    /// On the button for no digit.
    #[serde(default = "no_digit")]
    pub no_digit: String,
    /// Above each E.
    #[serde(default = "letter_question")]
    pub letter_question: String,
    /// On the button for no direction.
    #[serde(default = "no_direction")]
    pub no_direction: String,
}

impl ScreeningPlan {
    pub(crate) fn fault(&self) -> Option<Fault> {
        let is_part = |grade: &f64| (0.05..=1.0).contains(grade);
        if self.grades.len() > 8 || !self.grades.iter().all(is_part) {
            let expected = "up to 8 parts from 0.05 to 1";
            return Some((
                "session.screening.grades",
                format!("{:?}", self.grades),
                expected,
            ));
        }
        let is_stroke = |stroke: &u32| (1..=100).contains(stroke);
        if self.strokes_px.len() > 12 || !self.strokes_px.iter().all(is_stroke) {
            let found = format!("{:?}", self.strokes_px);
            let expected = "up to 12 strokes of 1 to 100 pixels";
            return Some(("session.screening.strokes_px", found, expected));
        }
        if self.grades.is_empty() && self.strokes_px.is_empty() {
            let expected = "grades, strokes_px or both";
            return Some(("session.screening", "nothing to show".to_owned(), expected));
        }
        (!(1..=20).contains(&self.letters_each)).then(|| {
            let expected = "a number from 1 to 20";
            (
                "session.screening.letters_each",
                self.letters_each.to_string(),
                expected,
            )
        })
    }
}

fn agree() -> String {
    "I agree".to_owned()
}

fn decline() -> String {
    "I do not agree".to_owned()
}

fn yes() -> bool {
    true
}

fn grades() -> Vec<f64> {
    vec![1.0, 0.6, 0.35]
}

fn strokes_px() -> Vec<u32> {
    vec![6, 4, 3, 2, 1]
}

fn letters_each() -> u32 {
    2
}

fn plate_question() -> String {
    "Which digit do you see?".to_owned()
}

fn no_digit() -> String {
    "None".to_owned()
}

fn letter_question() -> String {
    "To which side is the E open? If you are not sure, guess.".to_owned()
}

fn no_direction() -> String {
    "I cannot tell".to_owned()
}
