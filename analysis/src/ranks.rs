//! Tests on ranks: Friedman's, and the aligned rank transform.
//!
//! They ask whether a result hangs on the ratings being numbers with equal steps.

use nalgebra::DMatrix;
use protocols::SumsOfSquares;
use serde::Serialize;

use crate::anova::anova;
use crate::cell_matrix::{CellMatrix, Factor};
use crate::contrasts::factor_sets;
use crate::factor_place::{FactorPlace, level_of};
use crate::tail::{chi_square_tail, f_tail};

/// Friedman's test of one within factor, on the subjects' means over all other cells.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Friedman {
    /// The factor.
    pub factor: String,
    /// The statistic, corrected for ties.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub df: usize,
    /// Its p value.
    pub p: f64,
    /// Kendall's coefficient of concordance, from 0 to 1.
    pub kendall_w: f64,
    /// The form of Iman & Davenport, better with few subjects; `None` where all subjects rank alike.
    pub f: Option<f64>,
    /// Degrees of freedom of `f`.
    pub f_df: [usize; 2],
    /// The p value of `f`.
    pub f_p: Option<f64>,
}

impl Friedman {
    /// Tests the within factor `index`; `None` where every subject rates all levels alike.
    ///
    /// With `R_j` the rank sum of level *j* over *n* subjects and *t* the sizes of the ties within subjects:
    ///
    /// ```text
    /// chi2 = 12 sum (R_j - n (k+1) / 2)^2 / (n k (k+1) - sum (t^3 - t) / (k-1))
    /// W    = chi2 / (n (k-1)),   F = (n-1) chi2 / (n (k-1) - chi2) on k-1 and (k-1)(n-1)
    /// ```
    ///
    /// # Source
    ///
    /// Friedman (1937); Iman & Davenport (1980), *Comm. Stat.* A9, 571–595.
    pub(crate) fn new(cells: &CellMatrix, index: usize) -> Option<Self> {
        let factor = &cells.within[index];
        let place = FactorPlace::Within(index);
        let k = factor.levels.len();
        let of_level = |level: usize| {
            let mut weights = vec![0.0; k];
            weights[level] = 1.0;
            &cells.scores * place.weights(cells, &weights).cells
        };
        let columns: Vec<_> = (0..k).map(of_level).collect();
        let n = cells.subjects.len();
        let mut sums = vec![0.0; k];
        let mut ties = 0.0;
        for subject in 0..n {
            let ratings: Vec<f64> = columns.iter().map(|column| column[subject]).collect();
            let (ranks, subject_ties) = midranks(&ratings);
            ties += subject_ties;
            for (sum, rank) in sums.iter_mut().zip(ranks) {
                *sum += rank;
            }
        }
        let (n, levels) = (n as f64, k as f64);
        let expected = n * (levels + 1.0) / 2.0;
        let spread: f64 = sums.iter().map(|sum| (sum - expected).powi(2)).sum();
        let scale = n * levels * (levels + 1.0) - ties / (levels - 1.0);
        if scale <= 1e-9 * n * levels * (levels + 1.0) {
            return None;
        }
        let chi_square = 12.0 * spread / scale;
        let most = n * (levels - 1.0);
        let f =
            (most - chi_square > 1e-9 * most).then(|| (n - 1.0) * chi_square / (most - chi_square));
        let f_df = [k - 1, (k - 1) * (cells.subjects.len() - 1)];
        Some(Self {
            factor: factor.name.clone(),
            chi_square,
            df: k - 1,
            p: chi_square_tail(chi_square, levels - 1.0),
            kendall_w: chi_square / most,
            f,
            f_df,
            f_p: f.map(|f| f_tail(f, f_df[0] as f64, f_df[1] as f64)),
        })
    }
}

/// One effect after the aligned rank transform.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AlignedRankEffect {
    /// Its factors joined by `:`.
    pub effect: String,
    /// The F of the ranks.
    pub f: Option<f64>,
    /// Degrees of freedom, uncorrected.
    pub df: [usize; 2],
    /// The p value without correction.
    pub p: Option<f64>,
    /// The Greenhouse–Geisser epsilon of the ranks.
    pub gg_epsilon: Option<f64>,
    /// p with that epsilon.
    pub p_gg: Option<f64>,
}

/// The analysis of variance of aligned ranks, one alignment for each effect.
///
/// For an effect, every rating is replaced by its residual from the mean of its cell and group plus the estimate
/// of that effect alone; these are ranked together (midranks), and of the analysis of variance of the ranks only
/// that effect is read. Ties make it blunt on coarse ratings.
///
/// # Source
///
/// Wobbrock, Findlater, Gergle & Higgins (2011), *Proc. CHI*, 143–146.
pub(crate) fn aligned_rank_transform(cells: &CellMatrix) -> Vec<AlignedRankEffect> {
    let factors: Vec<&Factor> = cells.between.iter().chain(&cells.within).collect();
    let means = MeansTable::new(cells);
    let mut effects = Vec::new();
    for set in factor_sets(factors.len()) {
        let names: Vec<&str> = (factors.iter().zip(&set))
            .filter(|(_, held)| **held)
            .map(|(factor, _)| factor.name.as_str())
            .collect();
        if names.is_empty() {
            continue;
        }
        let aligned = means.aligned(cells, &set);
        let (ranks, _) = midranks(aligned.as_slice());
        let mut ranked = cells.clone();
        ranked.scores = DMatrix::from_column_slice(aligned.nrows(), aligned.ncols(), &ranks);
        let table = anova(&ranked, &[], SumsOfSquares::TypeThree);
        if let Some(row) = table.effect(&names.join(":")) {
            effects.push(AlignedRankEffect {
                effect: row.effect.clone(),
                f: row.f,
                df: [row.df_num, row.df_den],
                p: row.p,
                gg_epsilon: row.gg_epsilon,
                p_gg: row.p_gg,
            });
        }
    }
    // In the order of the analysis of variance: by the within factors first.
    let order = anova(cells, &[], SumsOfSquares::TypeThree).effects;
    let place = |name: &str| order.iter().position(|row| row.effect == name);
    effects.sort_by_key(|effect| place(&effect.effect));
    effects
}

/// Means of every group in every cell, and over any of the factors.
struct MeansTable {
    /// Groups × cells.
    means: DMatrix<f64>,
    /// For each group and each cell (column by column), the level of each factor, between factors first.
    levels: Vec<Vec<usize>>,
}

impl MeansTable {
    fn new(cells: &CellMatrix) -> Self {
        let sizes = cells.group_sizes();
        let n_cells = cells.scores.ncols();
        let mut means = DMatrix::zeros(sizes.len(), n_cells);
        for (row, &group) in cells.groups.iter().enumerate() {
            let mut mean = means.row_mut(group);
            mean += cells.scores.row(row) / sizes[group] as f64;
        }
        let of = |factors: &[Factor], combination: usize| -> Vec<usize> {
            (0..factors.len())
                .map(|index| level_of(factors, index, combination))
                .collect()
        };
        let levels = (0..n_cells)
            .flat_map(|cell| (0..sizes.len()).map(move |group| (group, cell)))
            .map(|(group, cell)| [of(&cells.between, group), of(&cells.within, cell)].concat())
            .collect();
        Self { means, levels }
    }

    /// The estimate of the effect `set` in each group and cell: by inclusion and exclusion of the means over all
    /// factors outside each part of it.
    fn effect(&self, set: &[bool]) -> DMatrix<f64> {
        let mut effect = DMatrix::zeros(self.means.nrows(), self.means.ncols());
        let size = |set: &[bool]| set.iter().filter(|&&held| held).count();
        for part in factor_sets(set.len()) {
            if part.iter().zip(set).any(|(inside, held)| *inside && !held) {
                continue;
            }
            let sign = if (size(set) - size(&part)).is_multiple_of(2) {
                1.0
            } else {
                -1.0
            };
            effect += self.marginal(&part) * sign;
        }
        effect
    }

    /// Means over all factors outside `part`.
    fn marginal(&self, part: &[bool]) -> DMatrix<f64> {
        let key = |place: usize| -> Vec<usize> {
            let levels = self.levels[place].iter().zip(part);
            levels
                .filter(|(_, held)| **held)
                .map(|(level, _)| *level)
                .collect()
        };
        let mut sums = std::collections::BTreeMap::new();
        for (place, mean) in self.means.iter().enumerate() {
            let (sum, count) = sums.entry(key(place)).or_insert((0.0, 0.0));
            *sum += mean;
            *count += 1.0;
        }
        let mut marginal = self.means.clone();
        for (place, value) in marginal.iter_mut().enumerate() {
            let (sum, count) = sums[&key(place)];
            *value = sum / count;
        }
        marginal
    }

    fn aligned(&self, cells: &CellMatrix, set: &[bool]) -> DMatrix<f64> {
        let shift = self.effect(set) - &self.means;
        let mut aligned = cells.scores.clone();
        for (row, &group) in cells.groups.iter().enumerate() {
            let mut ratings = aligned.row_mut(row);
            ratings += shift.row(group);
        }
        aligned
    }
}

/// The rank of each value, ties sharing their mean rank, and the sum of t³ − t over ties of size t. Values closer
/// than 1e-10 of the largest are tied: they differ by rounding.
pub(crate) fn midranks(values: &[f64]) -> (Vec<f64>, f64) {
    let largest = values
        .iter()
        .fold(0.0_f64, |most, value| most.max(value.abs()));
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&left, &right| values[left].total_cmp(&values[right]));
    let mut ranks = vec![0.0; values.len()];
    let mut ties = 0.0;
    let mut start = 0;
    while start < order.len() {
        let mut end = start + 1;
        while end < order.len() && values[order[end]] - values[order[end - 1]] <= 1e-10 * largest {
            end += 1;
        }
        let size = (end - start) as f64;
        ties += size.powi(3) - size;
        for &index in &order[start..end] {
            ranks[index] = (start + 1 + end) as f64 / 2.0;
        }
        start = end;
    }
    (ranks, ties)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_share_their_mean_rank() {
        // R: rank(c(3, 1, 3, 2, 3)) is 4 1 4 2 4; one tie of three: 27 - 3 = 24.
        let (ranks, ties) = midranks(&[3.0, 1.0, 3.0, 2.0, 3.0]);
        assert_eq!(ranks, [4.0, 1.0, 4.0, 2.0, 4.0]);
        assert_eq!(ties, 24.0);
    }
}
