//! Which column of a table is what.

use std::path::Path;

use protocols::{InputError, Missing, SumsOfSquares};

use crate::RowFilter;

/// The roles of a table's columns in an analysis of variance.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Design {
    /// The column that says who rated, or `@` and an entity of the files' names, such as `@sub`.
    pub subject: String,
    /// The column of the measured values; `COLUMN.KEY` for a number in a JSON object.
    pub rating: String,
    /// The factors of which every subject has every level.
    pub within: Vec<String>,
    /// The factors of which a subject has one level.
    pub between: Vec<String>,
    /// The factors that were observed and not manipulated; they only change generalized eta squared.
    pub observed: Vec<String>,
    /// The type of the sums of squares.
    pub sums_of_squares: SumsOfSquares,
    /// What is done with a subject of whom a rating is missing.
    pub missing: Missing,
    /// Which rows are ratings: those that every filter keeps.
    pub filters: Vec<RowFilter>,
    /// What parts the whole from the fraction in a rating.
    pub decimal: Decimal,
}

/// The sign between the whole and the fraction of a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Decimal {
    /// 7.5
    #[default]
    Point,
    /// 7,5
    Comma,
}

impl Design {
    /// Between factors first, then within factors, each in the order given.
    pub fn factors(&self) -> impl Iterator<Item = &str> {
        self.between.iter().chain(&self.within).map(String::as_str)
    }

    /// Checks that the design says one thing of each column; `table` is only named in the error.
    ///
    /// # Errors
    ///
    /// No factor at all, a column with two roles, or an observed factor that is not a factor.
    pub fn check(&self, table: &Path) -> Result<(), InputError> {
        if self.factors().next().is_none() {
            return Err(
                InputError::new(table, "a design without factors", "at least one factor")
                    .remedy("name columns with --within or --between"),
            );
        }
        let mut columns = vec![self.subject.as_str(), self.rating.as_str()];
        columns.extend(self.factors());
        columns.sort_unstable();
        let twice = columns
            .iter()
            .zip(&columns[1..])
            .find(|(one, next)| one == next);
        if let Some((column, _)) = twice {
            let found = format!("the column {column:?} in two roles");
            return Err(InputError::new(
                table,
                found,
                "one role for each column: subject, rating, within or between",
            ));
        }
        if let Some(name) = self.factors().find(|name| name.contains(':')) {
            let found = format!("the factor name {name:?}");
            return Err(InputError::new(
                table,
                found,
                "a name without ':', which joins the factors of an effect",
            )
            .remedy("rename the column"));
        }
        match self
            .observed
            .iter()
            .find(|name| self.factors().all(|factor| factor != name.as_str()))
        {
            Some(name) => Err(InputError::new(
                table,
                format!("the observed factor {name:?}"),
                "one of the within or between factors",
            )),
            None => Ok(()),
        }
    }
}
