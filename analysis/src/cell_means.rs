//! The means of a design's cells with their intervals: of every combination of between and within levels.

use crate::anova_table::quoted;
use crate::interval::{CellSummary, cell_summaries};
use crate::{AnalysisError, CellMatrix, Observations};

/// The mean rating of something, over subjects.
#[derive(Clone, Debug)]
pub(crate) struct Mean<T> {
    pub(crate) of: T,
    pub(crate) summary: CellSummary,
}

impl<T> Mean<T> {
    /// Half of the interval within subjects, or where there is none of the one between them.
    pub(crate) fn half(&self) -> Option<f64> {
        self.summary.half_within.or(self.summary.half_between)
    }
}

/// The cells of a design.
#[derive(Clone, Debug)]
pub(crate) struct CellMeans {
    /// The names of the factors, between factors first.
    pub(crate) factors: Vec<String>,
    /// The levels of each, in natural order.
    pub(crate) levels: Vec<Vec<String>>,
    /// Each cell with its levels.
    pub(crate) cells: Vec<Mean<Vec<String>>>,
}

impl CellMeans {
    pub(crate) fn new(cells: &CellMatrix, confidence: f64) -> Self {
        let factors = || cells.between.iter().chain(&cells.within);
        let of_cell = |summary: CellSummary| {
            let levels = [
                cells.group_levels(summary.group),
                cells.cell_levels(summary.cell),
            ];
            let of = levels.into_iter().flatten().map(str::to_owned).collect();
            Mean { of, summary }
        };
        Self {
            factors: factors().map(|factor| factor.name.clone()).collect(),
            levels: factors().map(|factor| factor.levels.clone()).collect(),
            cells: (cell_summaries(cells, confidence).into_iter())
                .map(of_cell)
                .collect(),
        }
    }

    /// One line for each cell: its levels, its mean, and the ends of both intervals.
    pub(crate) fn to_csv(&self, confidence: f64) -> String {
        let names: Vec<String> = self.factors.iter().map(|name| quoted(name)).collect();
        let mut csv = format!("{},n,{}\n", names.join(","), CellSummary::COLUMNS);
        for cell in &self.cells {
            let mut fields: Vec<String> = cell.of.iter().map(|level| quoted(level)).collect();
            fields.push(cell.summary.n.to_string());
            fields.extend(cell.summary.fields(confidence));
            csv.push_str(&fields.join(","));
            csv.push('\n');
        }
        csv
    }

    /// Of some factors only: each subject's ratings are averaged over the others, and subjects of all other groups count alike.
    ///
    /// # Errors
    ///
    /// None of the factors is in the design.
    pub(crate) fn over(
        cells: &CellMatrix,
        shown: &[String],
        confidence: f64,
    ) -> Result<Self, AnalysisError> {
        let kept = |factors: &[crate::Factor]| -> Vec<usize> {
            (0..factors.len())
                .filter(|&place| shown.contains(&factors[place].name))
                .collect()
        };
        let (between, within) = (kept(&cells.between), kept(&cells.within));
        let names = |factors: &[crate::Factor], places: &[usize]| -> Vec<String> {
            (places.iter())
                .map(|&place| factors[place].name.clone())
                .collect()
        };
        let mut observations = Observations::new(
            &cells.source,
            &names(&cells.between, &between),
            &names(&cells.within, &within),
        );
        for (subject, name) in cells.subjects.iter().enumerate() {
            let group = cells.group_levels(cells.groups[subject]);
            for cell in 0..cells.scores.ncols() {
                let levels = cells.cell_levels(cell);
                let of_groups = between.iter().map(|&place| group[place]);
                let of_cell = within.iter().map(|&place| levels[place]);
                let rating = Some(cells.scores[(subject, cell)]);
                observations.push(name, of_groups.chain(of_cell), rating);
            }
        }
        Ok(Self::new(&CellMatrix::new(&observations)?, confidence))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn means_over_some_factors_are_averages_of_the_others() {
        let names =
            |names: &[&str]| -> Vec<String> { names.iter().map(|&name| name.to_owned()).collect() };
        let mut observations = Observations::new(
            Path::new("test"),
            &names(&["group"]),
            &names(&["way", "size"]),
        );
        // Subject 1: a small 1, a large 3, b small 5, b large 9; the others the same and 1, 2, 3 more.
        for (subject, more) in [("1", 0.0), ("2", 1.0), ("3", 2.0), ("4", 3.0)] {
            let group = if more < 2.0 { "g" } else { "h" };
            for (way, size, rating) in [
                ("a", "small", 1.0),
                ("a", "large", 3.0),
                ("b", "small", 5.0),
                ("b", "large", 9.0),
            ] {
                observations.push(subject, [group, way, size], Some(rating + more));
            }
        }
        let cells = CellMatrix::new(&observations).unwrap();
        let all = CellMeans::new(&cells, 0.95);
        assert_eq!(all.factors, ["group", "way", "size"]);
        let first = &all.cells[0];
        // Natural order: large before small; subjects 1 and 2.
        assert_eq!(first.of, ["g", "a", "large"]);
        assert_eq!((first.summary.mean, first.summary.n), (3.5, 2));
        let ways = CellMeans::over(&cells, &names(&["way"]), 0.95).unwrap();
        let found: Vec<(&str, f64)> = (ways.cells.iter())
            .map(|cell| (cell.of[0].as_str(), cell.summary.mean))
            .collect();
        // (1 + 3) / 2 + 1.5 and (5 + 9) / 2 + 1.5.
        assert_eq!(found, [("a", 3.5), ("b", 8.5)]);
    }
}
