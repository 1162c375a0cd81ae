//! Means of the cells with their confidence intervals, between and within subjects.

use crate::anova_table::shortest;
use crate::cell_matrix::CellMatrix;
use crate::tail::t_quantile;

/// One cell of one group of subjects.
#[derive(Clone, Debug, PartialEq)]
pub struct CellSummary {
    /// The group, as [`CellMatrix::group_levels`] takes it.
    pub group: usize,
    /// The cell, as [`CellMatrix::cell_levels`] takes it.
    pub cell: usize,
    /// How many subjects.
    pub n: usize,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation; `None` for one subject.
    pub sd: Option<f64>,
    /// Half the width of the *t* interval of the mean over subjects; `None` for one subject.
    pub half_between: Option<f64>,
    /// Half the width of the Cousineau–Morey interval; `None` for one subject or one cell.
    pub half_within: Option<f64>,
}

impl CellSummary {
    /// The columns of [`Self::fields`].
    pub(crate) const COLUMNS: &'static str =
        "mean,sd,confidence,between_low,between_high,within_low,within_high";

    /// The mean, its spread and the ends of both intervals as fields of CSV; what does not exist is empty.
    pub(crate) fn fields(&self, confidence: f64) -> [String; 7] {
        let end = |half: Option<f64>, sign: f64| {
            half.map(|half| shortest(sign.mul_add(half, self.mean)))
                .unwrap_or_default()
        };
        [
            shortest(self.mean),
            self.sd.map(shortest).unwrap_or_default(),
            shortest(confidence),
            end(self.half_between, -1.0),
            end(self.half_between, 1.0),
            end(self.half_within, -1.0),
            end(self.half_within, 1.0),
        ]
    }
}

/// Mean and intervals of each cell of each group, groups first.
///
/// With *y* the rating of subject *i* in cell *j* of *W* cells, *n* subjects in the group:
///
/// ```text
/// half_between = t sd_j / sqrt(n)                                   t: (1 + confidence) / 2, n - 1 df
/// y'_ij        = y_ij - mean_i + grand mean
/// half_within  = t sd'_j / sqrt(n) sqrt(W / (W - 1))
/// ```
///
/// The interval within subjects is for comparing cells of the same subjects; it says nothing of the gap
/// between groups, nor of where the mean of all people lies.
///
/// # Source
///
/// Cousineau (2005), *Tutor. Quant. Methods Psychol.* 1, 42–45; Morey (2008), same, 4, 61–64.
pub fn cell_summaries(cells: &CellMatrix, confidence: f64) -> Vec<CellSummary> {
    let n_cells = cells.scores.ncols();
    let mut summaries = Vec::new();
    for group in 0..cells.n_groups() {
        let members: Vec<usize> = (0..cells.subjects.len())
            .filter(|&subject| cells.groups[subject] == group)
            .collect();
        let n = members.len();
        let grand_mean = cells.scores.mean();
        let factor = (n > 1).then(|| {
            let t = t_quantile((1.0 - confidence) / 2.0, n as f64 - 1.0);
            t / (n as f64).sqrt()
        });
        for cell in 0..n_cells {
            let ratings: Vec<f64> = members.iter().map(|&i| cells.scores[(i, cell)]).collect();
            let normalised: Vec<f64> = (members.iter())
                .map(|&i| cells.scores[(i, cell)] - cells.scores.row(i).mean() + grand_mean)
                .collect();
            let morey = (n_cells > 1).then(|| (n_cells as f64 / (n_cells as f64 - 1.0)).sqrt());
            let sd = standard_deviation(&ratings);
            summaries.push(CellSummary {
                group,
                cell,
                n,
                mean: mean(&ratings),
                sd,
                half_between: factor.zip(sd).map(|(factor, sd)| factor * sd),
                half_within: (factor.zip(morey).zip(standard_deviation(&normalised)))
                    .map(|((factor, morey), sd)| factor * morey * sd),
            });
        }
    }
    summaries
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The standard deviation with *n* − 1; `None` for fewer than two values.
pub(crate) fn standard_deviation(values: &[f64]) -> Option<f64> {
    let centre = mean(values);
    let sum: f64 = values.iter().map(|value| (value - centre).powi(2)).sum();
    (values.len() > 1).then(|| (sum / (values.len() as f64 - 1.0)).sqrt())
}
