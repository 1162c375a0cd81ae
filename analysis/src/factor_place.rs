//! Where a factor stands in a matrix of cells: among the within or the between factors.

use std::path::Path;

use nalgebra::DVector;
use protocols::InputError;

use crate::cell_matrix::{CellMatrix, Factor};
use crate::comparison::Weights;

/// A factor of a [`CellMatrix`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FactorPlace {
    /// The within factor of this index.
    Within(usize),
    /// The between factor of this index.
    Between(usize),
}

impl FactorPlace {
    /// The factor called `name`.
    pub(crate) fn find(cells: &CellMatrix, name: &str) -> Result<Self, InputError> {
        let place_in = |factors: &[Factor]| factors.iter().position(|factor| factor.name == name);
        (place_in(&cells.within).map(Self::Within))
            .or_else(|| place_in(&cells.between).map(Self::Between))
            .ok_or_else(|| {
                let names: Vec<&str> = (cells.between.iter().chain(&cells.within))
                    .map(|factor| factor.name.as_str())
                    .collect();
                let expected = format!("a factor of the analysis: {}", names.join(", "));
                Self::error(cells, format!("the factor {name:?}"), expected)
            })
    }

    /// An error about a follow-up on `cells`.
    pub(crate) fn error(
        cells: &CellMatrix,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> InputError {
        let path: &Path = &cells.source;
        InputError::new(path, found.into(), expected.into()).at("a follow-up")
    }

    pub(crate) fn is_within(self) -> bool {
        matches!(self, Self::Within(_))
    }

    fn factor(self, cells: &CellMatrix) -> &Factor {
        match self {
            Self::Within(index) => &cells.within[index],
            Self::Between(index) => &cells.between[index],
        }
    }

    pub(crate) fn name(self, cells: &CellMatrix) -> &str {
        &self.factor(cells).name
    }

    pub(crate) fn levels(self, cells: &CellMatrix) -> &[String] {
        &self.factor(cells).levels
    }

    /// The index of a level.
    pub(crate) fn level(self, cells: &CellMatrix, level: &str) -> Result<usize, InputError> {
        let levels = self.levels(cells);
        let place = levels.iter().position(|one| one == level);
        place.ok_or_else(|| {
            let expected = format!("a level of {}: {}", self.name(cells), levels.join(", "));
            Self::error(cells, format!("the level {level:?}"), expected)
        })
    }

    /// The weights of cells and groups that compare the levels by `weights`, over equal means of all else.
    pub(crate) fn weights(self, cells: &CellMatrix, weights: &[f64]) -> Weights {
        let (n_cells, n_groups) = (cells.scores.ncols(), cells.n_groups());
        let n_levels = weights.len() as f64;
        let share = |count: usize| n_levels / count as f64;
        match self {
            Self::Within(index) => Weights {
                cells: DVector::from_fn(n_cells, |cell, _| {
                    weights[level_of(&cells.within, index, cell)] * share(n_cells)
                }),
                groups: vec![(n_groups as f64).recip(); n_groups],
            },
            Self::Between(index) => Weights {
                cells: DVector::from_element(n_cells, (n_cells as f64).recip()),
                groups: (0..n_groups)
                    .map(|group| weights[level_of(&cells.between, index, group)] * share(n_groups))
                    .collect(),
            },
        }
    }

    /// Confines `weights` of another factor to one level of this one.
    pub(crate) fn restrict(self, cells: &CellMatrix, weights: &mut Weights, level: usize) {
        let n_levels = self.levels(cells).len() as f64;
        let share = |is_here: bool| if is_here { n_levels } else { 0.0 };
        match self {
            Self::Within(index) => {
                for (cell, weight) in weights.cells.iter_mut().enumerate() {
                    *weight *= share(level_of(&cells.within, index, cell) == level);
                }
            }
            Self::Between(index) => {
                for (group, weight) in weights.groups.iter_mut().enumerate() {
                    *weight *= share(level_of(&cells.between, index, group) == level);
                }
            }
        }
    }

    /// The cells at one level of the factor, which they then no longer have.
    pub(crate) fn restricted(self, cells: &CellMatrix, level: usize) -> CellMatrix {
        let mut part = cells.clone();
        match self {
            Self::Within(index) => {
                part.within.remove(index);
                let kept: Vec<usize> = (0..cells.scores.ncols())
                    .filter(|&cell| level_of(&cells.within, index, cell) == level)
                    .collect();
                part.scores = cells.scores.select_columns(&kept);
            }
            Self::Between(index) => {
                part.between.remove(index);
                let kept: Vec<usize> = (0..cells.subjects.len())
                    .filter(|&row| level_of(&cells.between, index, cells.groups[row]) == level)
                    .collect();
                let inner: usize = (cells.between[index + 1..].iter())
                    .map(|factor| factor.levels.len())
                    .product();
                let n_levels = cells.between[index].levels.len();
                let group_without =
                    |group: usize| group / (inner * n_levels) * inner + group % inner;
                part.scores = cells.scores.select_rows(&kept);
                part.subjects = kept
                    .iter()
                    .map(|&row| cells.subjects[row].clone())
                    .collect();
                part.groups = (kept.iter())
                    .map(|&row| group_without(cells.groups[row]))
                    .collect();
            }
        }
        part
    }
}

/// The level of factor `index` in combination `combination`, the last factor changing fastest.
pub(crate) fn level_of(factors: &[Factor], index: usize, combination: usize) -> usize {
    let inner: usize = (factors[index + 1..].iter())
        .map(|factor| factor.levels.len())
        .product();
    combination / inner % factors[index].levels.len()
}
