//! Tables in files: CSV or TSV, one row for each rating, columns named in the first line; several files are one table.
//!
//! Exports of other programs are read as they are: rows of other kinds are left out by filters, a subject that no column
//! names is taken from the file's name (`@sub` is `01` in `sub-01_task-rating_events.tsv`), and a rating inside a JSON
//! object (jsPsych's surveys) is `COLUMN.KEY`.
//!
//! Missing ratings are empty, `NA`, `N/A`, `n/a`, `NaN`, `None` or `null`. A byte-order mark is skipped. Labels may hold
//! commas, quotes, spaces and any letters, in quotes as CSV has them.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use protocols::{InputError, ReadError};

use crate::{
    AnalysisError, AnovaTable, CellMatrix, Decimal, Design, Observations, RowFilter, anova,
};

/// Ratings larger than this have squares that leave the range of numbers.
const LARGEST_RATING: f64 = 1e100;

/// The analysis of variance of a long-format table.
///
/// # Errors
///
/// [`AnalysisError::Input`] names file, line and column of what cannot be used: a file that is missing or
/// no table, a column that is not there, a rating that is no number, a design that the rows do not fill.
pub fn anova_of_table(path: &Path, design: &Design) -> Result<AnovaTable, AnalysisError> {
    let observations = read_observations(&[path], design)?;
    let cells = CellMatrix::with_missing(&observations, design.missing)?;
    Ok(anova(&cells, &design.observed, design.sums_of_squares))
}

/// Reads the columns of `design` from tables, as if they were one.
///
/// # Errors
///
/// As [`anova_of_table`], without those of the design's cells; no file.
pub fn read_observations(
    paths: &[impl AsRef<Path>],
    design: &Design,
) -> Result<Observations, AnalysisError> {
    let first = paths.first().map_or(Path::new(""), AsRef::as_ref);
    design.check(first)?;
    let source = match paths.len() {
        0 | 1 => first.to_owned(),
        n => format!("{} and {} more", first.display(), n - 1).into(),
    };
    let mut observations = Observations::new(&source, &design.between, &design.within);
    for path in paths {
        read_table(path.as_ref(), design, &mut observations)?;
    }
    Ok(observations)
}

/// Reads one table.
fn read_table(
    path: &Path,
    design: &Design,
    observations: &mut Observations,
) -> Result<(), AnalysisError> {
    let kind = "a table with a header (CSV or TSV)";
    let bytes = fs::read(path).map_err(|error| ReadError::from_io(path, kind, error))?;
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let text = text_of(path, bytes)?;
    let delimiter = delimiter(path, text);
    if let Some(line) = open_quote(text, delimiter) {
        let error = InputError::new(path, "a quote that is never closed", "a second quote");
        let error = error.at(format!("line {line}"));
        return Err(error
            .remedy("close it, or write a quote that is meant as \"\"")
            .into());
    }
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .from_reader(text.as_bytes());
    let malformed = |error: csv::Error| malformed_row(path, &error);
    let header = reader.headers().map_err(malformed)?.clone();
    let columns = Columns::new(path, &header, design)?;
    let mut record = csv::StringRecord::new();
    let (before, mut n_rows) = (observations.len(), 0);
    let mut values = vec![BTreeSet::new(); columns.filters.len()];
    while reader.read_record(&mut record).map_err(malformed)? {
        n_rows += 1;
        if columns.is_kept(&record) {
            columns.read(&record, observations)?;
        } else {
            observations.n_filtered += 1;
        }
        for ((place, _), values) in columns.filters.iter().zip(&mut values) {
            if values.len() < 8 {
                values.insert(record[*place].trim().to_owned());
            }
        }
    }
    if observations.len() > before {
        return Ok(());
    }
    if n_rows == 0 {
        let expected = "a row for each rating";
        return Err(InputError::new(path, "no rows below the header", expected).into());
    }
    let seen: Vec<String> = (columns.filters.iter().zip(&values))
        .map(|((_, filter), values)| format!("{} is {:?} there", filter.column, values))
        .collect();
    let filters: Vec<String> = design.filters.iter().map(ToString::to_string).collect();
    let found = format!("no row with {} among {n_rows}", filters.join(" and "));
    let error = InputError::new(path, found, "a row for each rating");
    Err(error
        .remedy(format!("mend --where: {}", seen.join("; ")))
        .into())
}

/// The text of a file; a workbook, UTF-16 and other encodings are refused by name.
fn text_of<'b>(path: &Path, bytes: &'b [u8]) -> Result<&'b str, InputError> {
    let kind = "a table with a header (CSV or TSV) in UTF-8";
    match bytes {
        [b'P', b'K', 3, 4, ..] | [0xd0, 0xcf, 0x11, 0xe0, ..] => {
            let error = InputError::new(path, "a workbook or another packed file", kind);
            Err(error.remedy("save the sheet as CSV (UTF-8)"))
        }
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => {
            let error = InputError::new(path, "text in UTF-16", kind);
            Err(error.remedy("save the table as UTF-8"))
        }
        _ => std::str::from_utf8(bytes).map_err(|error| {
            let before = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
            let line = before.matches('\n').count() + 1;
            InputError::new(path, "bytes that are not UTF-8", kind)
                .at(format!("line {line}"))
                .remedy("save the table as UTF-8")
        }),
    }
}

/// What parts the columns: a tab, a comma, or a semicolon, by the name and the first line.
fn delimiter(path: &Path, text: &str) -> u8 {
    let is_tsv = path.extension().is_some_and(|extension| {
        extension.eq_ignore_ascii_case("tsv") || extension.eq_ignore_ascii_case("tab")
    });
    let header = text.lines().next().unwrap_or_default();
    if is_tsv || (header.contains('\t') && !header.contains(',')) {
        b'\t'
    } else if header.contains(';') && !header.contains(',') {
        b';'
    } else {
        b','
    }
}

/// The line of a quote that opens a field and is not closed before the end.
fn open_quote(text: &str, delimiter: u8) -> Option<usize> {
    if !text.contains('"') {
        return None;
    }
    let (mut line, mut is_start, mut opened) = (1, true, None);
    let mut bytes = text.bytes().peekable();
    while let Some(byte) = bytes.next() {
        let is_quote = byte == b'"';
        match opened {
            Some(_) if is_quote && bytes.peek() == Some(&b'"') => _ = bytes.next(),
            Some(_) if is_quote => opened = None,
            None if is_quote && is_start => opened = Some(line),
            _ => {}
        }
        is_start = opened.is_none() && (byte == delimiter || byte == b'\n' || byte == b'\r');
        line += usize::from(byte == b'\n');
    }
    opened
}

fn malformed_row(path: &Path, error: &csv::Error) -> InputError {
    match error.kind() {
        csv::ErrorKind::UnequalLengths {
            pos,
            expected_len,
            len,
        } => InputError::new(
            path,
            format!("{len} fields"),
            format!("{expected_len}, as in the header"),
        )
        .at(format!(
            "line {}",
            pos.as_ref().map_or(0, csv::Position::line)
        )),
        _ => InputError::new(path, error.to_string(), "CSV"),
    }
}

/// Who rated: a column, or a part of the file's name.
enum Subject {
    Column(usize),
    Named(String),
}

/// Where a rating stands: a column, or a key of the JSON object in it.
struct Rating {
    column: usize,
    key: Option<String>,
}

/// Where the columns of a design stand in a table.
struct Columns<'a> {
    path: &'a Path,
    design: &'a Design,
    subject: Subject,
    factors: Vec<usize>,
    rating: Rating,
    filters: Vec<(usize, &'a RowFilter)>,
    /// Where our own files say whether a person rated.
    observer: Option<usize>,
}

impl<'a> Columns<'a> {
    fn new(
        path: &'a Path,
        header: &csv::StringRecord,
        design: &'a Design,
    ) -> Result<Self, InputError> {
        let index_of = |name: &str| index_of(path, header, name);
        let subject = match design.subject.strip_prefix('@') {
            Some(entity) => Subject::Named(entity_of_name(path, entity)?),
            None => Subject::Column(index_of(&design.subject)?),
        };
        let filters = design.filters.iter();
        Ok(Self {
            path,
            design,
            subject,
            factors: design.factors().map(index_of).collect::<Result<_, _>>()?,
            rating: Rating::new(path, header, &design.rating)?,
            filters: filters
                .map(|filter| Ok((index_of(&filter.column)?, filter)))
                .collect::<Result<_, InputError>>()?,
            observer: header.iter().position(|name| name == "observer"),
        })
    }

    fn is_kept(&self, record: &csv::StringRecord) -> bool {
        let mut filters = self.filters.iter();
        filters.all(|(place, filter)| filter.keeps(&record[*place]))
    }

    fn read(&self, record: &csv::StringRecord, into: &mut Observations) -> Result<(), InputError> {
        let subject = match &self.subject {
            Subject::Column(place) => self.label(record, *place, &self.design.subject)?,
            Subject::Named(name) => name,
        };
        let mut levels = Vec::new();
        for (&place, name) in self.factors.iter().zip(self.design.factors()) {
            levels.push(self.label(record, place, name)?);
        }
        let text = self.rating.text(record).ok_or_else(|| {
            let expected = "a JSON object with this key";
            self.wrong(record, self.rating.column, &self.design.rating, expected)
        })?;
        let rating = if is_missing(&text) {
            None
        } else {
            Some(self.rating(record, text.trim())?)
        };
        let is_simulated = |place: usize| &record[place] == "simulated";
        into.has_simulated |= self.observer.is_some_and(is_simulated);
        into.push(subject, levels, rating);
        Ok(())
    }

    fn label<'r>(
        &self,
        record: &'r csv::StringRecord,
        place: usize,
        name: &str,
    ) -> Result<&'r str, InputError> {
        let label = record[place].trim();
        if !is_missing(label) {
            return Ok(label);
        }
        let error = self.wrong(record, place, name, "a label");
        Err(if self.filters.is_empty() {
            error.remedy(
                "leave rows that are no ratings out with --where, such as trial_type=rating",
            )
        } else {
            error
        })
    }

    fn rating(&self, record: &csv::StringRecord, text: &str) -> Result<f64, InputError> {
        let is_usable = |rating: &f64| rating.abs() <= LARGEST_RATING;
        let parsed = |text: &str| text.parse().ok().filter(is_usable);
        let with_point = || parsed(&text.replacen(',', ".", 1));
        let rating = match self.design.decimal {
            Decimal::Point => parsed(text),
            Decimal::Comma => with_point(),
        };
        rating.ok_or_else(|| {
            let expected = "a number (with a decimal point, not a comma), or NA";
            let error = self.wrong(record, self.rating.column, &self.design.rating, expected);
            match with_point() {
                Some(_) => error.remedy("if the comma is a decimal one, say --decimal-comma"),
                None => error,
            }
        })
    }

    fn wrong(
        &self,
        record: &csv::StringRecord,
        place: usize,
        name: &str,
        expected: &str,
    ) -> InputError {
        let line = record.position().map_or(0, csv::Position::line);
        InputError::new(self.path, format!("{:?}", &record[place]), expected)
            .at(format!("line {line}, column {name}"))
    }
}

/// Where a column stands that is named once.
fn index_of(path: &Path, header: &csv::StringRecord, name: &str) -> Result<usize, InputError> {
    let mut places = (0..header.len()).filter(|&place| header[place].trim() == name);
    match (places.next(), places.next()) {
        (Some(place), None) => Ok(place),
        (None, _) => {
            let present: Vec<&str> = header.iter().collect();
            let found = match present.join(", ") {
                none if none.is_empty() => "no columns".to_owned(),
                names => format!("the columns {names}"),
            };
            Err(InputError::new(path, found, format!("a column {name:?}")).at("line 1"))
        }
        (Some(_), Some(_)) => {
            let found = format!("more than one column {name:?}");
            Err(InputError::new(path, found, "each column named once").at("line 1"))
        }
    }
}

/// The value of an entity in a file's name, as BIDS and Psych-DS have them: `sub-01` or `subject-01` between underscores.
fn entity_of_name(path: &Path, entity: &str) -> Result<String, InputError> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut parts = stem.split('_');
    let value = parts.find_map(|part| part.strip_prefix(entity)?.strip_prefix('-'));
    value.map(str::to_owned).ok_or_else(|| {
        let expected =
            format!("a name with {entity}-LABEL in it, such as {entity}-01_task-rating_events.tsv");
        InputError::new(path, "no subject in the file's name", expected)
            .remedy("name the column of the subject with --subject")
    })
}

impl Rating {
    fn new(path: &Path, header: &csv::StringRecord, name: &str) -> Result<Self, InputError> {
        let is_there = |name: &str| header.iter().any(|column| column.trim() == name);
        match name.rsplit_once('.') {
            Some((column, key)) if !is_there(name) && is_there(column) => Ok(Self {
                column: index_of(path, header, column)?,
                key: Some(key.to_owned()),
            }),
            _ => Ok(Self {
                column: index_of(path, header, name)?,
                key: None,
            }),
        }
    }

    /// The text of the rating; `None` for no JSON object with its key.
    fn text<'r>(&self, record: &'r csv::StringRecord) -> Option<Cow<'r, str>> {
        let field = &record[self.column];
        let Some(key) = &self.key else {
            return Some(Cow::Borrowed(field));
        };
        if is_missing(field) {
            return Some(Cow::Borrowed(""));
        }
        let value: serde_json::Value = serde_json::from_str(field).ok()?;
        Some(match value.get(key)? {
            serde_json::Value::String(text) => Cow::Owned(text.clone()),
            other => Cow::Owned(other.to_string()),
        })
    }
}

fn is_missing(text: &str) -> bool {
    matches!(
        text.trim(),
        "" | "NA" | "N/A" | "n/a" | "NaN" | "None" | "null"
    )
}
