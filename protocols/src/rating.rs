//! One rating: one trial of one session, one row of a ratings file.
//!
//! The columns, with unit and meaning, are declared here once; the writer, the reader and the data set's
//! description all follow them. The factors of the study stand between `repetition` and `rating`, one
//! column each.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{InputError, Observer, ReadError, StimulusId, SubjectId};

/// A column of a ratings file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Column {
    /// The name in the header; it ends in the unit, where there is one.
    pub name: String,
    /// What it says.
    pub description: String,
    /// The unit, where there is one.
    pub unit: Option<&'static str>,
}

/// Whether a trial counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Phase {
    /// A trial for getting used to the scale; never analysed.
    Practice,
    /// A trial of the study.
    Test,
}

/// Which picture of a pair came first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShownFirst {
    /// The test image.
    Test,
    /// The reference.
    Reference,
}

impl ShownFirst {
    /// The word in the table.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Test => "test",
            Self::Reference => "reference",
        }
    }
}

/// What stands in a column that does not apply.
const NOT_APPLICABLE: &str = "n/a";

/// One trial as it was shown and rated.
#[derive(Clone, Debug, PartialEq)]
pub struct RatingRow {
    /// Who rated.
    pub subject_id: SubjectId,
    /// Which sitting of that subject.
    pub session_id: u32,
    /// Which trial of the session, practice included, from 1.
    pub trial_id: u32,
    /// Whether the trial counts.
    pub phase: Phase,
    /// What was rated.
    pub stimulus_id: StimulusId,
    /// The how-manieth time in this phase that the subject sees this stimulus, from 1.
    pub repetition: u32,
    /// The level of each factor, in the order of the header.
    pub levels: Vec<String>,
    /// The answer.
    pub rating: i32,
    /// The rating of the reference, where both pictures of a pair are rated.
    pub reference_rating: Option<i32>,
    /// Which picture of a pair came first, where the order is by lot: `test` or `reference`.
    pub shown_first: Option<ShownFirst>,
    /// From the first frame with the scale to the answer.
    pub response_time_s: f64,
    /// For how long the protocol wants the images shown.
    pub exposure_requested_s: f64,
    /// From the first frame submitted with the test image to the first without it.
    pub exposure_submitted_s: f64,
    /// Frames that came later than one and a half frame times after the one before, while the image stood.
    pub missed_frames: u32,
    /// How often the trial was begun: more than once if it was interrupted or answered too late.
    pub showings: u32,
    /// When the trial began: UTC, ISO 8601.
    pub started_at: String,
    /// A person or a model.
    pub observer: Observer,
    /// Whether this was a trial run with shortened times.
    pub pilot: bool,
}

/// Name, unit and meaning of the columns before and after the factors.
const BEFORE_FACTORS: [(&str, Option<&str>, &str); 6] = [
    ("subject_id", None, "code of the subject"),
    ("session_id", None, "sitting of the subject, from 1"),
    (
        "trial_id",
        None,
        "trial of the session, practice included, from 1",
    ),
    ("phase", None, "practice (never analysed) or test"),
    (
        "stimulus_id",
        None,
        "stimulus rated, as in the manifest of the stimulus set",
    ),
    (
        "repetition",
        None,
        "how-manieth time in this phase that the subject sees this stimulus, from 1",
    ),
];
const AFTER_FACTORS: [(&str, Option<&str>, &str); 11] = [
    (
        "rating",
        None,
        "quality on the scale of the protocol, higher is better",
    ),
    (
        "reference_rating",
        None,
        "rating of the reference where both pictures of a pair are rated, else n/a",
    ),
    (
        "shown_first",
        None,
        "picture of a pair that came first by lot: test or reference; else n/a",
    ),
    (
        "response_time_s",
        Some("s"),
        "from the first frame submitted with the scale to the answer",
    ),
    (
        "exposure_requested_s",
        Some("s"),
        "exposure of the test image that the protocol asks for",
    ),
    (
        "exposure_submitted_s",
        Some("s"),
        "from the first frame submitted with the test image to the first without it; the onset of light was not measured",
    ),
    (
        "missed_frames",
        None,
        "frames later than one and a half frame times after the one before, during the exposure",
    ),
    (
        "showings",
        None,
        "how often the trial was begun in this sitting; more than 1 if it was interrupted or answered too late",
    ),
    ("started_at", None, "start of the trial, UTC, ISO 8601"),
    ("observer", None, "person or simulated"),
    ("pilot", None, "true for a trial run with shortened times"),
];

/// The columns of a ratings file of a study with these factors.
pub fn columns(factors: &[String]) -> Vec<Column> {
    let fixed = |&(name, unit, description): &(&str, Option<&'static str>, &str)| Column {
        name: name.to_owned(),
        description: description.to_owned(),
        unit,
    };
    let factor = |name: &String| Column {
        name: name.clone(),
        description: match name.as_str() {
            "channel" => {
                "group of channels that was varied: achromatic, chromatic, both or neither"
                    .to_owned()
            }
            "rays" => "ray count of the varied group; 10K = 10000".to_owned(),
            _ => format!("level of the factor {name}"),
        },
        unit: None,
    };
    BEFORE_FACTORS
        .iter()
        .map(fixed)
        .chain(factors.iter().map(factor))
        .chain(AFTER_FACTORS.iter().map(fixed))
        .collect()
}

/// The header line of a ratings file, with its line end.
pub fn header_line(factors: &[String]) -> String {
    csv_line(columns(factors).into_iter().map(|column| column.name))
}

impl RatingRow {
    /// The row as one line of CSV, with its line end.
    pub fn to_line(&self) -> String {
        let phase = match self.phase {
            Phase::Practice => "practice",
            Phase::Test => "test",
        };
        let before = [
            self.subject_id.to_string(),
            self.session_id.to_string(),
            self.trial_id.to_string(),
            phase.to_owned(),
            self.stimulus_id.to_string(),
            self.repetition.to_string(),
        ];
        let reference = self.reference_rating.map(|rating| rating.to_string());
        let first = self.shown_first.map(|first| first.as_str().to_owned());
        let or_not = |text: Option<String>| text.unwrap_or_else(|| NOT_APPLICABLE.to_owned());
        let after = [
            self.rating.to_string(),
            or_not(reference),
            or_not(first),
            format!("{:.4}", self.response_time_s),
            format!("{:.4}", self.exposure_requested_s),
            format!("{:.4}", self.exposure_submitted_s),
            self.missed_frames.to_string(),
            self.showings.to_string(),
            self.started_at.clone(),
            self.observer.as_str().to_owned(),
            self.pilot.to_string(),
        ];
        csv_line(
            before
                .into_iter()
                .chain(self.levels.iter().cloned())
                .chain(after),
        )
    }
}

/// Fields as one line of CSV with its line end; a field is quoted where it must be.
pub fn csv_line(fields: impl Iterator<Item = String>) -> String {
    let quoted = fields.map(|field| {
        if field.contains([',', '"', '\n', '\r']) {
            format!("\"{}\"", field.replace('"', "\"\""))
        } else {
            field
        }
    });
    let mut line = quoted.collect::<Vec<_>>().join(",");
    line.push('\n');
    line
}

/// A ratings file as it was found.
#[derive(Clone, Debug, PartialEq)]
pub struct RatingsFile {
    /// Every whole row.
    pub rows: Vec<RatingRow>,
    /// How many bytes from the start are whole lines; what lies beyond is a line that a crash tore, and
    /// was never acknowledged to the subject.
    pub whole_bytes: u64,
    /// Whether there was such a line.
    pub is_torn: bool,
}

/// Reads a ratings file; a torn last line is reported, not an error.
///
/// # Errors
///
/// [`ReadError::Input`] names the line and column of what is not a rating, and refuses a file with other
/// columns than those of the study.
pub fn read_ratings(path: &Path, factors: &[String]) -> Result<RatingsFile, ReadError> {
    let kind = "a ratings file (CSV)";
    let mut text = fs::read(path).map_err(|error| ReadError::from_io(path, kind, error))?;
    let whole = text
        .iter()
        .rposition(|&byte| byte == b'\n')
        .map_or(0, |last| last + 1);
    let is_torn = whole < text.len();
    text.truncate(whole);
    let text = String::from_utf8(text).map_err(|error| {
        InputError::new(
            path,
            format!("bytes that are not UTF-8 ({})", error.utf8_error()),
            kind,
        )
    })?;
    Ok(RatingsFile {
        rows: parse_rows(path, &text, factors)?,
        whole_bytes: whole as u64,
        is_torn,
    })
}

fn parse_rows(path: &Path, text: &str, factors: &[String]) -> Result<Vec<RatingRow>, InputError> {
    if text.is_empty() {
        return Ok(Vec::new());
    }
    let expected: Vec<String> = columns(factors)
        .into_iter()
        .map(|column| column.name)
        .collect();
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .from_reader(text.as_bytes());
    let malformed = |error: csv::Error| InputError::new(path, error.to_string(), "CSV");
    let header = reader.headers().map_err(malformed)?.clone();
    if header.iter().ne(expected.iter().map(String::as_str)) {
        let found = format!(
            "the columns {}",
            header.iter().collect::<Vec<_>>().join(",")
        );
        return Err(InputError::new(path, found, expected.join(","))
            .at("line 1")
            .remedy("it belongs to another study or version"));
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(malformed)?;
        rows.push(
            Fields {
                path,
                record: &record,
                names: &expected,
                factors,
            }
            .row()?,
        );
    }
    Ok(rows)
}

/// One line of a ratings file, by the names of its columns.
struct Fields<'a> {
    path: &'a Path,
    record: &'a csv::StringRecord,
    names: &'a [String],
    factors: &'a [String],
}

impl Fields<'_> {
    fn line(&self) -> u64 {
        self.record.position().map_or(0, csv::Position::line)
    }

    fn text(&self, name: &str) -> Result<&str, InputError> {
        let index = self.names.iter().position(|column| column == name);
        index
            .and_then(|index| self.record.get(index))
            .ok_or_else(|| {
                let found = format!("{} fields", self.record.len());
                InputError::new(self.path, found, format!("{} fields", self.names.len()))
                    .at(format!("line {}", self.line()))
            })
    }

    fn value<T>(
        &self,
        name: &str,
        expected: &str,
        parse: impl FnOnce(&str) -> Option<T>,
    ) -> Result<T, InputError> {
        let text = self.text(name)?;
        parse(text).ok_or_else(|| {
            InputError::new(self.path, format!("{text:?}"), expected)
                .at(format!("line {}, column {name}", self.line()))
                .remedy("restore the file as the session wrote it")
        })
    }

    fn number(&self, name: &str) -> Result<u32, InputError> {
        self.value(name, "a whole number", |text| text.parse().ok())
    }

    fn seconds(&self, name: &str) -> Result<f64, InputError> {
        let is_time = |seconds: &f64| seconds.is_finite() && *seconds >= 0.0;
        self.value(name, "a time in seconds", |text| {
            text.parse().ok().filter(is_time)
        })
    }

    fn row(&self) -> Result<RatingRow, InputError> {
        if self.record.len() != self.names.len() {
            let found = format!("{} fields", self.record.len());
            return Err(
                InputError::new(self.path, found, format!("{} fields", self.names.len()))
                    .at(format!("line {}", self.line())),
            );
        }
        let levels = self
            .factors
            .iter()
            .map(|factor| self.text(factor).map(str::to_owned));
        Ok(RatingRow {
            subject_id: self.value("subject_id", "1 to 32 letters and digits", |text| {
                text.parse().ok()
            })?,
            session_id: self.number("session_id")?,
            trial_id: self.number("trial_id")?,
            phase: self.value("phase", "practice or test", |text| match text {
                "practice" => Some(Phase::Practice),
                "test" => Some(Phase::Test),
                _ => None,
            })?,
            stimulus_id: self.value("stimulus_id", "a stimulus id", |text| {
                text.to_owned().try_into().ok()
            })?,
            repetition: self.number("repetition")?,
            levels: levels.collect::<Result<_, _>>()?,
            rating: self.value("rating", "a whole number", |text| text.parse().ok())?,
            reference_rating: self.value("reference_rating", "a whole number or n/a", |text| {
                match text {
                    NOT_APPLICABLE => Some(None),
                    number => number.parse().ok().map(Some),
                }
            })?,
            shown_first: self.value(
                "shown_first",
                "test, reference or n/a",
                |text| match text {
                    NOT_APPLICABLE => Some(None),
                    "test" => Some(Some(ShownFirst::Test)),
                    "reference" => Some(Some(ShownFirst::Reference)),
                    _ => None,
                },
            )?,
            response_time_s: self.seconds("response_time_s")?,
            exposure_requested_s: self.seconds("exposure_requested_s")?,
            exposure_submitted_s: self.seconds("exposure_submitted_s")?,
            missed_frames: self.number("missed_frames")?,
            showings: self.number("showings")?,
            started_at: self.text("started_at")?.to_owned(),
            observer: self.value("observer", "person or simulated", |text| match text {
                "person" => Some(Observer::Person),
                "simulated" => Some(Observer::Simulated),
                _ => None,
            })?,
            pilot: self.value("pilot", "true or false", |text| text.parse().ok())?,
        })
    }
}
