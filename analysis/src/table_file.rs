//! A table in a file: CSV or TSV, one row for each rating, columns named in the first line.
//!
//! Missing ratings are empty, `NA`, `N/A`, `n/a` or `NaN`. A byte-order mark is skipped. Labels may hold
//! commas, quotes, spaces and any letters, in quotes as CSV has them.

use std::fs;
use std::path::Path;

use protocols::{InputError, ReadError};

use crate::{AnalysisError, AnovaTable, CellMatrix, Design, Observations, anova};

/// Ratings larger than this have squares that leave the range of numbers.
const LARGEST_RATING: f64 = 1e100;

/// The analysis of variance of a long-format table.
///
/// # Errors
///
/// [`AnalysisError::Input`] names file, line and column of what cannot be used: a file that is missing or
/// no table, a column that is not there, a rating that is no number, a design that the rows do not fill.
pub fn anova_of_table(path: &Path, design: &Design) -> Result<AnovaTable, AnalysisError> {
    let observations = read_observations(path, design)?;
    let cells = CellMatrix::with_missing(&observations, design.missing)?;
    Ok(anova(&cells, &design.observed, design.sums_of_squares))
}

/// Reads the columns of `design` from a table.
///
/// # Errors
///
/// As [`anova_of_table`], without those of the design's cells.
pub fn read_observations(path: &Path, design: &Design) -> Result<Observations, AnalysisError> {
    design.check(path)?;
    let kind = "a table with a header (CSV or TSV)";
    let bytes = fs::read(path).map_err(|error| ReadError::from_io(path, kind, error))?;
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let before = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
        let line = before.matches('\n').count() + 1;
        InputError::new(path, "bytes that are not UTF-8", kind)
            .at(format!("line {line}"))
            .remedy("save the table as UTF-8")
    })?;
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter(path, text))
        .from_reader(text.as_bytes());
    let malformed = |error: csv::Error| malformed_row(path, &error);
    let header = reader.headers().map_err(malformed)?.clone();
    let columns = Columns::new(path, &header, design)?;
    let mut observations = Observations::new(path, &design.between, &design.within);
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(malformed)? {
        columns.read(&record, &mut observations)?;
    }
    if observations.is_empty() {
        return Err(
            InputError::new(path, "no rows below the header", "a row for each rating").into(),
        );
    }
    Ok(observations)
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

/// Where the columns of a design stand in a table.
struct Columns<'a> {
    path: &'a Path,
    design: &'a Design,
    subject: usize,
    factors: Vec<usize>,
    rating: usize,
}

impl<'a> Columns<'a> {
    fn new(
        path: &'a Path,
        header: &csv::StringRecord,
        design: &'a Design,
    ) -> Result<Self, InputError> {
        let index_of = |name: &str| {
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
                (Some(_), Some(_)) => Err(InputError::new(
                    path,
                    format!("more than one column {name:?}"),
                    "each column named once",
                )
                .at("line 1")),
            }
        };
        Ok(Self {
            path,
            design,
            subject: index_of(&design.subject)?,
            factors: design.factors().map(index_of).collect::<Result<_, _>>()?,
            rating: index_of(&design.rating)?,
        })
    }

    fn read(&self, record: &csv::StringRecord, into: &mut Observations) -> Result<(), InputError> {
        let labels = std::iter::once((self.subject, self.design.subject.as_str()))
            .chain(self.factors.iter().copied().zip(self.design.factors()));
        for (place, name) in labels {
            if is_missing(&record[place]) {
                return Err(self.wrong(record, place, name, "a label"));
            }
        }
        let text = record[self.rating].trim();
        let rating = if is_missing(text) {
            None
        } else {
            Some(self.rating(record, text)?)
        };
        let levels = self.factors.iter().map(|&place| record[place].trim());
        into.push(record[self.subject].trim(), levels, rating);
        Ok(())
    }

    fn rating(&self, record: &csv::StringRecord, text: &str) -> Result<f64, InputError> {
        let is_usable = |rating: &f64| rating.abs() <= LARGEST_RATING;
        text.parse().ok().filter(is_usable).ok_or_else(|| {
            let expected = "a number (with a decimal point, not a comma), or NA";
            self.wrong(record, self.rating, &self.design.rating, expected)
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

fn is_missing(text: &str) -> bool {
    matches!(text.trim(), "" | "NA" | "N/A" | "n/a" | "NaN")
}
