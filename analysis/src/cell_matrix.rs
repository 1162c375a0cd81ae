//! The subjects × cells matrix that the multivariate linear model starts from.
//!
//! A row is a subject with a rating in every cell; a column is one combination of levels of the within
//! factors, the last factor changing fastest. Ratings of one cell are averaged. A subject that lacks a cell
//! is left out by name.
//!
//! Not here: contrasts and sums of squares (`anova`).

use std::path::{Path, PathBuf};

use nalgebra::{DMatrix, DVector};
use protocols::{InputError, Missing};

use crate::Observations;

/// A factor and its levels in natural order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Factor {
    /// What it is called.
    pub name: String,
    /// Its levels; at least two.
    pub levels: Vec<String>,
}

/// Complete subjects, their groups and their mean rating in each cell.
#[derive(Clone, Debug)]
pub struct CellMatrix {
    /// The subjects, in natural order.
    pub subjects: Vec<String>,
    /// The between factors.
    pub between: Vec<Factor>,
    /// The within factors.
    pub within: Vec<Factor>,
    /// For each subject its group: the combination of between levels, the last factor changing fastest.
    pub groups: Vec<usize>,
    /// Subjects × cells.
    pub scores: DMatrix<f64>,
    /// Subjects left out because a cell is missing, in natural order.
    pub dropped_subjects: Vec<String>,
    /// How many cells of these subjects were rated more than once, and averaged.
    pub n_averaged_cells: usize,
    /// The file or folder that errors name.
    pub source: PathBuf,
    /// What the reader of a result must know.
    pub warnings: Vec<String>,
}

impl CellMatrix {
    /// Sorts observations into cells.
    ///
    /// # Errors
    ///
    /// A factor with one level, a subject in two groups, a cell that nobody rated, no complete subject, a
    /// group without subjects, or no more subjects than groups. Each names its factor, cell or subjects.
    pub fn new(observations: &Observations) -> Result<Self, InputError> {
        let coded = Coded::new(observations)?;
        let groups = coded.group_of_each_subject()?;
        let Complete {
            of_subject: complete,
            means,
            n_averaged,
        } = coded.complete_subjects()?;
        let names = |wanted: bool| -> Vec<String> {
            (coded.subjects.iter().zip(&complete))
                .filter(|(_, is_complete)| **is_complete == wanted)
                .map(|(name, _)| name.clone())
                .collect()
        };
        let subjects = names(true);
        let dropped_subjects = names(false);
        let kept_groups = (groups.into_iter().zip(&complete))
            .filter(|(_, is_complete)| **is_complete)
            .map(|(group, _)| group)
            .collect();
        let mut matrix = Self {
            scores: DMatrix::from_row_slice(subjects.len(), coded.n_cells, &means),
            groups: kept_groups,
            n_averaged_cells: n_averaged,
            source: observations.source().to_owned(),
            warnings: warnings(&dropped_subjects, n_averaged),
            between: coded.between,
            within: coded.within,
            subjects,
            dropped_subjects,
        };
        matrix.forget_empty_levels();
        matrix.check_groups(observations)?;
        Ok(matrix)
    }

    /// Sorts observations into cells, and refuses them where a subject would be left out though `missing`
    /// forbids it.
    ///
    /// # Errors
    ///
    /// As [`Self::new`], and subjects with missing ratings under [`Missing::Fail`].
    pub fn with_missing(observations: &Observations, missing: Missing) -> Result<Self, InputError> {
        let cells = Self::new(observations)?;
        match missing {
            Missing::Fail if !cells.dropped_subjects.is_empty() => Err(missing_ratings(
                observations.source(),
                &cells.dropped_subjects,
            )),
            _ => Ok(cells),
        }
    }

    /// How many groups the between factors make.
    pub fn n_groups(&self) -> usize {
        self.between
            .iter()
            .map(|factor| factor.levels.len())
            .product()
    }

    /// How many subjects each group holds.
    pub fn group_sizes(&self) -> Vec<usize> {
        let mut sizes = vec![0; self.n_groups()];
        for &group in &self.groups {
            sizes[group] += 1;
        }
        sizes
    }

    /// The standard deviation, within groups, of the subjects' sums of cells by `weights`.
    pub(crate) fn sd_within_groups(&self, weights: &DVector<f64>) -> f64 {
        let scores = &self.scores * weights;
        let (sizes, mut means) = (self.group_sizes(), vec![0.0; self.n_groups()]);
        for (score, &group) in scores.iter().zip(&self.groups) {
            means[group] += score / sizes[group] as f64;
        }
        let squares = scores.iter().zip(&self.groups);
        let ss: f64 = squares
            .map(|(score, &group)| (score - means[group]).powi(2))
            .sum();
        (ss / (self.subjects.len() - sizes.len()) as f64).sqrt()
    }

    /// The levels of cell `cell`, one for each within factor.
    pub fn cell_levels(&self, cell: usize) -> Vec<&str> {
        levels_of(&self.within, cell)
    }

    /// The levels of group `group`, one for each between factor.
    pub fn group_levels(&self, group: usize) -> Vec<&str> {
        levels_of(&self.between, group)
    }

    /// Leaves out between levels of which no complete subject is left.
    fn forget_empty_levels(&mut self) {
        let sizes: Vec<usize> = self.between.iter().map(|f| f.levels.len()).collect();
        let mut codes: Vec<Vec<usize>> = self.groups.iter().map(|&g| digits(&sizes, g)).collect();
        for (index, factor) in self.between.iter_mut().enumerate() {
            let is_used = |level: usize| codes.iter().any(|code| code[index] == level);
            let used: Vec<usize> = (0..factor.levels.len()).filter(|&l| is_used(l)).collect();
            if used.len() == factor.levels.len() {
                continue;
            }
            for level in (0..factor.levels.len()).filter(|level| !used.contains(level)) {
                self.warnings.push(format!(
                    "no complete subject is left in the level {:?} of {}: the level is left out",
                    factor.levels[level], factor.name
                ));
            }
            for code in &mut codes {
                code[index] = used.iter().position(|&l| l == code[index]).unwrap_or(0);
            }
            factor.levels = used
                .iter()
                .map(|&level| factor.levels[level].clone())
                .collect();
        }
        let sizes: Vec<usize> = self.between.iter().map(|f| f.levels.len()).collect();
        self.groups = codes.iter().map(|code| index_of(&sizes, code)).collect();
    }

    fn check_groups(&self, observations: &Observations) -> Result<(), InputError> {
        let source = observations.source();
        for factor in &self.between {
            check_levels(observations, factor)?;
        }
        let sizes = self.group_sizes();
        let empty: Vec<String> = (sizes.iter().enumerate())
            .filter(|(_, size)| **size == 0)
            .map(|(group, _)| self.group_levels(group).join(":"))
            .collect();
        if !empty.is_empty() {
            let names: Vec<&str> = self.between.iter().map(|f| f.name.as_str()).collect();
            return Err(InputError::new(
                source,
                format!("no complete subject in the cell {}", empty.join(", ")),
                format!("subjects in every combination of {}", names.join(" and ")),
            )
            .remedy("type III sums of squares do not exist with an empty cell: leave a level or a factor out"));
        }
        if self.subjects.len() <= sizes.len() {
            let found = match self.subjects.as_slice() {
                [only] => format!("one complete subject ({only})"),
                several => format!(
                    "{} complete subjects in {} groups",
                    several.len(),
                    sizes.len()
                ),
            };
            return Err(InputError::new(
                source,
                found,
                format!("at least {} complete subjects", sizes.len() + 1),
            )
            .remedy("with fewer there is no error term to test against"));
        }
        Ok(())
    }
}

/// The subjects that have every cell.
struct Complete {
    /// For each subject, whether it has.
    of_subject: Vec<bool>,
    /// The cell means of those that have, subject by subject.
    means: Vec<f64>,
    /// How many of these means are of more than one rating.
    n_averaged: usize,
}

/// Observations with every label as a number.
struct Coded<'a> {
    observations: &'a Observations,
    subjects: Vec<String>,
    subject_of_row: Vec<usize>,
    between: Vec<Factor>,
    group_of_row: Vec<usize>,
    within: Vec<Factor>,
    cell_of_row: Vec<usize>,
    n_cells: usize,
}

impl<'a> Coded<'a> {
    fn new(observations: &'a Observations) -> Result<Self, InputError> {
        if observations.is_empty() {
            return Err(InputError::new(
                observations.source(),
                "no observations",
                "a row for each rating",
            ));
        }
        let (subjects, subject_of_row) = observations.subjects.ordered();
        let (between, group_of_row) = coded_factors(observations, &observations.between)?;
        let (within, cell_of_row) = coded_factors(observations, &observations.within)?;
        let n_cells = (within.iter())
            .try_fold(1_usize, |cells, factor| {
                cells.checked_mul(factor.levels.len())
            })
            .filter(|&cells| cells <= observations.len())
            .ok_or_else(|| {
                InputError::new(
                    observations.source(),
                    format!("{} rows", observations.len()),
                    "a rating by every subject for every combination of the within levels",
                )
                .remedy("no subject can be complete: check which columns are factors")
            })?;
        Ok(Self {
            observations,
            subjects,
            subject_of_row,
            between,
            group_of_row,
            within,
            cell_of_row,
            n_cells,
        })
    }

    fn group_of_each_subject(&self) -> Result<Vec<usize>, InputError> {
        let mut groups = vec![None; self.subjects.len()];
        let mut in_two = vec![false; self.subjects.len()];
        for (&subject, &group) in self.subject_of_row.iter().zip(&self.group_of_row) {
            in_two[subject] |= *groups[subject].get_or_insert(group) != group;
        }
        let doubles: Vec<&str> = (self.subjects.iter().zip(&in_two))
            .filter(|(_, is_double)| **is_double)
            .map(|(name, _)| name.as_str())
            .collect();
        if doubles.is_empty() {
            return Ok(groups.into_iter().map(|group| group.unwrap_or(0)).collect());
        }
        let names: Vec<&str> = self.between.iter().map(|f| f.name.as_str()).collect();
        Err(InputError::new(
            self.observations.source(),
            format!("the subjects {} in more than one group", doubles.join(", ")),
            format!("each subject at one level of {}", names.join(" and of ")),
        )
        .remedy("give different people different ids, or name the factor in --within"))
    }

    fn nobody_is_complete(&self) -> InputError {
        let error = InputError::new(
            self.observations.source(),
            "no subject with a rating in every cell",
            format!("subjects with all {} ratings", self.n_cells),
        );
        let sizes: Vec<usize> = self.within.iter().map(|f| f.levels.len()).collect();
        let is_of_groups = |place: usize| {
            let mut levels = vec![None; self.subjects.len()];
            (self.subject_of_row.iter().zip(&self.cell_of_row)).all(|(&subject, &cell)| {
                let level = digits(&sizes, cell)[place];
                *levels[subject].get_or_insert(level) == level
            })
        };
        let of_groups = (0..sizes.len()).find(|&place| is_of_groups(place));
        match of_groups.map(|place| &self.within[place].name) {
            Some(name) => error.remedy(format!(
                "every subject has one level of {name}: name it in --between"
            )),
            None => error.remedy(
                "check which columns are factors; leave a factor out, and its levels are averaged",
            ),
        }
    }

    fn complete_subjects(&self) -> Result<Complete, InputError> {
        let mut sums = vec![Vec::new(); self.subjects.len()];
        let mut n_rows = vec![0_usize; self.subjects.len()];
        for &subject in &self.subject_of_row {
            n_rows[subject] += 1;
        }
        let mut rated = vec![false; self.n_cells];
        for (row, rating) in self.observations.ratings.iter().enumerate() {
            let (Some(rating), cell) = (*rating, self.cell_of_row[row]) else {
                continue;
            };
            rated[cell] = true;
            let subject = self.subject_of_row[row];
            if n_rows[subject] < self.n_cells {
                continue; // Cannot be complete; keeps the memory below the number of rows.
            }
            if sums[subject].is_empty() {
                sums[subject] = vec![(0.0, 0_u32); self.n_cells];
            }
            let (sum, count) = &mut sums[subject][cell];
            *sum += rating;
            *count += 1;
        }
        if let Some(cell) = rated.iter().position(|is_rated| !is_rated) {
            return Err(self.nobody_rated(cell));
        }
        let complete: Vec<bool> = (sums.iter())
            .map(|cells| !cells.is_empty() && cells.iter().all(|&(_, count)| count > 0))
            .collect();
        if !complete.contains(&true) {
            return Err(self.nobody_is_complete());
        }
        let kept = sums
            .iter()
            .zip(&complete)
            .filter(|(_, is_complete)| **is_complete);
        let cells = kept.flat_map(|(cells, _)| cells);
        let means: Vec<f64> = (cells.clone())
            .map(|&(sum, count)| sum / f64::from(count))
            .collect();
        let n_averaged = cells.filter(|&&(_, count)| count > 1).count();
        Ok(Complete {
            of_subject: complete,
            means,
            n_averaged,
        })
    }

    fn nobody_rated(&self, cell: usize) -> InputError {
        let names: Vec<&str> = self.within.iter().map(|f| f.name.as_str()).collect();
        InputError::new(
            self.observations.source(),
            format!(
                "no rating in the cell {}",
                levels_of(&self.within, cell).join(":")
            ),
            format!("ratings for every combination of {}", names.join(" and ")),
        )
        .remedy("leave a level or a factor out")
    }
}

/// Says that `subjects` may not be left out.
pub(crate) fn missing_ratings(source: &Path, subjects: &[String]) -> InputError {
    InputError::new(
        source,
        format!("ratings missing of: {}", subjects.join(", ")),
        "a rating in every cell of every subject, because missing = \"fail\"",
    )
    .remedy("complete these subjects, or say missing = \"drop\" to leave them out")
}

fn warnings(dropped: &[String], n_averaged: usize) -> Vec<String> {
    let mut warnings = Vec::new();
    if !dropped.is_empty() {
        warnings.push(format!(
            "left out, because a rating is missing: {}",
            dropped.join(", ")
        ));
    }
    if n_averaged > 0 {
        warnings.push(format!(
            "{n_averaged} cells were rated more than once by a subject: their ratings were averaged"
        ));
    }
    warnings
}

/// The factors, and for each row the combination of their levels.
fn coded_factors(
    observations: &Observations,
    columns: &[crate::label_column::LabelColumn],
) -> Result<(Vec<Factor>, Vec<usize>), InputError> {
    let mut factors = Vec::new();
    let mut combined = vec![0_usize; observations.len()];
    for column in columns {
        let (levels, codes) = column.ordered();
        for (combination, code) in combined.iter_mut().zip(codes) {
            *combination = combination
                .saturating_mul(levels.len())
                .saturating_add(code);
        }
        let factor = Factor {
            name: column.name.clone(),
            levels,
        };
        check_levels(observations, &factor)?;
        factors.push(factor);
    }
    Ok((factors, combined))
}

fn check_levels(observations: &Observations, factor: &Factor) -> Result<(), InputError> {
    match factor.levels.as_slice() {
        [only] => Err(InputError::new(
            observations.source(),
            format!("one level ({only:?}) of the factor {}", factor.name),
            "at least two levels",
        )
        .remedy("leave the factor out")),
        _ => Ok(()),
    }
}

fn levels_of(factors: &[Factor], index: usize) -> Vec<&str> {
    let sizes: Vec<usize> = factors.iter().map(|factor| factor.levels.len()).collect();
    (factors.iter().zip(digits(&sizes, index)))
        .map(|(factor, level)| factor.levels[level].as_str())
        .collect()
}

/// The digits of `index` in the mixed base `sizes`, the last changing fastest.
fn digits(sizes: &[usize], mut index: usize) -> Vec<usize> {
    let mut digits = vec![0; sizes.len()];
    for (digit, &size) in digits.iter_mut().zip(sizes).rev() {
        *digit = index % size;
        index /= size;
    }
    digits
}

fn index_of(sizes: &[usize], digits: &[usize]) -> usize {
    (sizes.iter().zip(digits)).fold(0, |index, (&size, &digit)| index * size + digit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observations(rows: &[(&str, &str, &str, Option<f64>)]) -> Observations {
        let names = |name: &str| vec![name.to_owned()];
        let mut all = Observations::new("a test".as_ref(), &names("group"), &names("rays"));
        for &(subject, group, rays, rating) in rows {
            all.push(subject, [group, rays], rating);
        }
        all
    }

    #[test]
    fn cells_are_subjects_by_levels_in_natural_order() {
        let rows = [
            ("b", "y", "100K", Some(4.0)),
            ("b", "y", "20K", Some(3.0)),
            ("a", "x", "20K", Some(1.0)),
            ("a", "x", "100K", Some(2.0)),
            ("c", "x", "20K", Some(5.0)),
            ("c", "x", "100K", Some(6.0)),
            ("c", "x", "100K", Some(8.0)),
        ];
        let cells = CellMatrix::new(&observations(&rows)).unwrap();
        assert_eq!(cells.subjects, ["a", "b", "c"]);
        assert_eq!(cells.groups, [0, 1, 0]);
        assert_eq!(cells.cell_levels(1), ["100K"]);
        let expected = DMatrix::from_row_slice(3, 2, &[1.0, 2.0, 3.0, 4.0, 5.0, 7.0]);
        assert_eq!(cells.scores, expected);
        assert_eq!(cells.warnings.len(), 1, "{:?}", cells.warnings);
    }

    #[test]
    fn a_group_whose_subjects_are_all_incomplete_is_left_out_and_said() {
        let mut rows = vec![("d", "z", "20K", Some(1.0)), ("d", "z", "100K", None)];
        for (subject, group) in [("a", "x"), ("b", "y"), ("c", "y")] {
            rows.push((subject, group, "20K", Some(2.0)));
            rows.push((subject, group, "100K", Some(3.0)));
        }
        let cells = CellMatrix::new(&observations(&rows)).unwrap();
        assert_eq!(cells.dropped_subjects, ["d"]);
        assert_eq!(cells.between[0].levels, ["x", "y"]);
        assert_eq!(cells.group_sizes(), [1, 2]);
        assert!(
            cells
                .warnings
                .iter()
                .any(|warning| warning.contains("\"z\"")),
            "{:?}",
            cells.warnings
        );
    }

    #[test]
    fn two_groups_that_shrink_to_one_are_refused() {
        let rows = [
            ("a", "x", "20K", Some(1.0)),
            ("a", "x", "100K", Some(2.0)),
            ("b", "x", "20K", Some(1.0)),
            ("b", "x", "100K", Some(2.0)),
            ("c", "y", "20K", Some(5.0)),
        ];
        let message = CellMatrix::new(&observations(&rows))
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("one level (\"x\") of the factor group"),
            "{message}"
        );
    }
}
