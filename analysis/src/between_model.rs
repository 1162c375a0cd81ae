//! The between-subjects side of the linear model: what each term of the groups adds to the others.
//!
//! Group means and group sizes say all that a hypothesis on the groups needs. A term's *directions* are
//! orthonormal in the space of group means weighted by the root of the group size, so that the sum of
//! squares of the term is the squared length of the weighted means along them.

use nalgebra::DMatrix;
use protocols::SumsOfSquares;

use crate::cell_matrix::{CellMatrix, Factor};
use crate::contrasts::{effect_contrasts, factor_sets};

/// Whether a hypothesis on `term` is adjusted for `other`.
fn adjusts(kind: SumsOfSquares, term: &[bool], other: &[bool]) -> bool {
    let contains_term = term.iter().zip(other).all(|(held, by)| !held || *by);
    match kind {
        SumsOfSquares::TypeTwo => !contains_term,
        SumsOfSquares::TypeThree => term != other,
    }
}

/// One term of the between factors: the factors that it holds, and its directions (groups × df).
#[derive(Clone, Debug)]
pub(crate) struct BetweenTerm {
    pub(crate) holds: Vec<bool>,
    pub(crate) directions: DMatrix<f64>,
    /// The directions of the terms that it is adjusted for.
    others: DMatrix<f64>,
}

/// All terms of the between factors, the constant first.
#[derive(Clone, Debug)]
pub(crate) struct BetweenModel {
    pub(crate) terms: Vec<BetweenTerm>,
    root_sizes: Vec<f64>,
}

impl BetweenModel {
    pub(crate) fn new(cells: &CellMatrix, kind: SumsOfSquares) -> Self {
        let root_sizes: Vec<f64> = (cells.group_sizes().iter())
            .map(|&size| (size as f64).sqrt())
            .collect();
        let n_levels = level_counts(&cells.between);
        let sets = factor_sets(cells.between.len());
        let columns = |term: &[bool]| weighted(&effect_contrasts(&n_levels, term), &root_sizes);
        let terms = (sets.iter())
            .map(|term| {
                let adjusted_for = sets.iter().filter(|other| adjusts(kind, term, other));
                let mut all: Vec<DMatrix<f64>> = adjusted_for.map(|other| columns(other)).collect();
                let own = columns(term);
                let df = own.ncols();
                all.push(own);
                let (others, directions) = directions(&all, df);
                BetweenTerm {
                    holds: term.clone(),
                    directions,
                    others,
                }
            })
            .collect();
        Self { terms, root_sizes }
    }

    /// What `term` explains of group means (groups × contrasts): df × contrasts, whose squared length is the
    /// sum of squares.
    pub(crate) fn explained(&self, term: &BetweenTerm, means: &DMatrix<f64>) -> DMatrix<f64> {
        term.directions.tr_mul(&weighted(means, &self.root_sizes))
    }

    /// What the terms that `term` is adjusted for explain of group means (groups × contrasts), again as group
    /// means.
    pub(crate) fn fitted_by_others(
        &self,
        term: &BetweenTerm,
        means: &DMatrix<f64>,
    ) -> DMatrix<f64> {
        let inverse: Vec<f64> = self.root_sizes.iter().map(|root| root.recip()).collect();
        let along = term.others.tr_mul(&weighted(means, &self.root_sizes));
        weighted(&(&term.others * along), &inverse)
    }
}

pub(crate) fn level_counts(factors: &[Factor]) -> Vec<usize> {
    factors.iter().map(|factor| factor.levels.len()).collect()
}

/// `rows`, each multiplied by its weight.
fn weighted(rows: &DMatrix<f64>, weights: &[f64]) -> DMatrix<f64> {
    let mut weighted = rows.clone();
    for (mut row, weight) in weighted.row_iter_mut().zip(weights) {
        row *= *weight;
    }
    weighted
}

/// Orthonormal directions that the columns of `blocks` span in their order: all but the last `df`, and those.
fn directions(blocks: &[DMatrix<f64>], df: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let n_columns = blocks.iter().map(DMatrix::ncols).sum();
    let mut design = DMatrix::zeros(blocks[0].nrows(), n_columns);
    let mut start = 0;
    for block in blocks {
        design.columns_mut(start, block.ncols()).copy_from(block);
        start += block.ncols();
    }
    let all = design.qr().q();
    let first = n_columns - df;
    (
        all.columns(0, first).into_owned(),
        all.columns(first, df).into_owned(),
    )
}
