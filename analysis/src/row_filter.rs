//! Which rows of a table are ratings: exports of other programs hold instructions, practice and fixations too.

use std::fmt;
use std::str::FromStr;

/// Rows whose field in one column is, or is not, one of some values.
///
/// ```
/// let filter: analysis::RowFilter = "trial_type=rating|probe".parse().unwrap();
/// assert!(filter.keeps("probe") && !filter.keeps("fixation"));
/// let filter: analysis::RowFilter = "slider.response!=".parse().unwrap();
/// assert!(filter.keeps("7") && !filter.keeps(" "));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowFilter {
    /// The column.
    pub column: String,
    /// Whether the values are those that are kept or those that are left out.
    pub kind: FilterKind,
    /// The values, without blanks at their ends.
    pub values: Vec<String>,
}

/// What a filter does with the values that it names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilterKind {
    /// It keeps rows with one of them.
    Only,
    /// It leaves out rows with one of them.
    Without,
}

impl RowFilter {
    /// Whether a row with this field is kept.
    pub fn keeps(&self, field: &str) -> bool {
        let is_named = self.values.iter().any(|value| value == field.trim());
        is_named == (self.kind == FilterKind::Only)
    }
}

impl FromStr for RowFilter {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (kind, parts) = match text.split_once("!=") {
            Some(parts) => (FilterKind::Without, Some(parts)),
            None => (FilterKind::Only, text.split_once('=')),
        };
        let (column, values) = parts.unwrap_or_default();
        if column.trim().is_empty() {
            return Err(format!(
                "found {text:?}, expected COLUMN=VALUE, COLUMN=VALUE|VALUE or COLUMN!=VALUE, such as trial_type=rating"
            ));
        }
        Ok(Self {
            column: column.trim().to_owned(),
            kind,
            values: values
                .split('|')
                .map(|value| value.trim().to_owned())
                .collect(),
        })
    }
}

impl fmt::Display for RowFilter {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = match self.kind {
            FilterKind::Only => "=",
            FilterKind::Without => "!=",
        };
        write!(formatter, "{}{sign}{}", self.column, self.values.join("|"))
    }
}
