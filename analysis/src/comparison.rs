//! One comparison of cell means: a contrast of the cells, weighted over the groups, against its own error.
//!
//! Each subject has one score, the contrast of its cells; the error is the spread of these scores within the
//! groups. No error is pooled over cells, so sphericity plays no part.
//!
//! Source: Maxwell & Delaney (2004), *Designing Experiments and Analyzing Data*, chapter 13, for the separate
//! error term; Lakens (2013), *Front. Psychol.* 4, 863, for the standardized differences.

use nalgebra::DVector;
use serde::Serialize;

use crate::cell_matrix::CellMatrix;
use crate::noncentral_t::noncentrality_interval;
use crate::tail::{f_tail, t_quantile};
use crate::text_table::{decimals, optional_p};

/// A contrast of cell means. What does not exist is `None`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The level of another factor at which it is made.
    pub at: Option<String>,
    /// What is compared, such as `10K - 20K` or `linear`.
    pub name: String,
    /// The contrast of the means.
    pub estimate: f64,
    /// Its standard error.
    pub se: f64,
    /// The ends of its *t* interval, not adjusted for other comparisons.
    pub low: f64,
    /// The upper end.
    pub high: f64,
    /// Estimate over standard error; `None` without variance.
    pub t: Option<f64>,
    /// The degrees of freedom of `t`.
    pub df: usize,
    /// The two-sided p value.
    pub p: Option<f64>,
    /// `p` after Holm, over all comparisons of the family.
    pub p_holm: Option<f64>,
    /// `p` after Bonferroni, over all comparisons of the family.
    pub p_bonferroni: Option<f64>,
    /// `p` by Tukey's studentized range, over all pairs of levels; for pairwise comparisons only.
    pub p_tukey: Option<f64>,
    /// The estimate over the standard deviation of the subjects' scores: *dz*, between groups *ds*.
    pub dz: Option<f64>,
    /// The lower end of its interval, by the noncentral *t*.
    pub dz_low: Option<f64>,
    /// The upper end.
    pub dz_high: Option<f64>,
    /// The estimate over the mean of the two cells' standard deviations: *dav*; for two cells of the same
    /// subjects.
    pub dav: Option<f64>,
    /// The lower end of its interval: that of *dz* in this unit.
    pub dav_low: Option<f64>,
    /// The upper end.
    pub dav_high: Option<f64>,
}

/// Weights of cells and of groups that make one comparison.
#[derive(Clone, Debug)]
pub(crate) struct Weights {
    /// One for each cell.
    pub(crate) cells: DVector<f64>,
    /// One for each group; a comparison within subjects has the mean of the groups, 1 / g each.
    pub(crate) groups: Vec<f64>,
}

impl Comparison {
    /// Compares the means of `cells`.
    ///
    /// With `c_i` the contrast of subject *i*'s cells, `v_g` the weight of group *g* and `n_g` its size:
    ///
    /// ```text
    /// estimate = sum over g of v_g mean_g c       s^2 = sum (c_i - mean_g c)^2 / (n - g)
    /// se       = s sqrt(sum over g of v_g^2 / n_g)      t = estimate / se on n - g degrees of freedom
    /// dz       = estimate / s;   its interval: that of the noncentrality of t, times se / s
    /// ```
    pub(crate) fn new(
        name: String,
        cells: &CellMatrix,
        weights: &Weights,
        confidence: f64,
    ) -> Self {
        let scores = &cells.scores.add_scalar(-cells.scores.mean()) * &weights.cells;
        let sizes = cells.group_sizes();
        let mut means = vec![0.0; sizes.len()];
        for (score, &group) in scores.iter().zip(&cells.groups) {
            means[group] += score / sizes[group] as f64;
        }
        let df = cells.subjects.len() - sizes.len();
        let ss: f64 = (scores.iter().zip(&cells.groups))
            .map(|(score, &group)| (score - means[group]).powi(2))
            .sum();
        let estimate: f64 = means.iter().zip(&weights.groups).map(|(m, v)| m * v).sum();
        let noise = 64.0 * f64::EPSILON * cells.scores.amax() * weights.cells.norm();
        let has_variance = ss > cells.subjects.len() as f64 * noise * noise;
        let sd = if has_variance {
            (ss / df as f64).sqrt()
        } else {
            0.0
        };
        let share: f64 = (weights.groups.iter().zip(&sizes))
            .map(|(weight, &size)| weight * weight / size as f64)
            .sum();
        let se = sd * share.sqrt();
        let half = t_quantile((1.0 - confidence) / 2.0, df as f64) * se;
        let t = has_variance.then(|| estimate / se);
        let ends = t.map(|t| {
            noncentrality_interval(t, df as f64, confidence).map(|end| end * share.sqrt())
        });
        Self {
            at: None,
            name,
            estimate,
            se,
            low: estimate - half,
            high: estimate + half,
            t,
            df,
            p: t.map(|t| f_tail(t * t, 1.0, df as f64)),
            p_holm: None,
            p_bonferroni: None,
            p_tukey: None,
            dz: has_variance.then(|| estimate / sd),
            dz_low: ends.map(|ends| ends[0]),
            dz_high: ends.map(|ends| ends[1]),
            dav: None,
            dav_low: None,
            dav_high: None,
        }
    }

    /// Adds *dav*, given the standard deviations of the two means compared.
    ///
    /// Source: Cumming (2012), *Understanding the New Statistics*, chapter 11.
    pub(crate) fn with_average_sd(mut self, sds: [f64; 2]) -> Self {
        let average = f64::midpoint(sds[0], sds[1]);
        if let (Some(dz), true) = (self.dz, average > 0.0) {
            let unit = self.estimate / average / dz;
            if unit.is_finite() {
                self.dav = Some(self.estimate / average);
                self.dav_low = self.dz_low.map(|end| end * unit);
                self.dav_high = self.dz_high.map(|end| end * unit);
            }
        }
        self
    }

    /// What is compared, with the level at which it is.
    pub(crate) fn label(&self) -> String {
        match &self.at {
            Some(at) => format!("{at}: {}", self.name),
            None => self.name.clone(),
        }
    }

    /// The fields of a line of text; estimate and interval have `n_decimals`.
    pub(crate) fn text_fields(&self, n_decimals: usize) -> Vec<String> {
        vec![
            self.label(),
            format!("{:.n_decimals$}", self.estimate),
            format!("{:.n_decimals$}", self.low),
            format!("{:.n_decimals$}", self.high),
            decimals(self.t, 2),
            self.df.to_string(),
            optional_p(self.p),
            optional_p(self.p_holm),
            optional_p(self.p_bonferroni),
            optional_p(self.p_tukey),
            decimals(self.dz, 2),
            decimals(self.dz_low, 2),
            decimals(self.dz_high, 2),
            decimals(self.dav, 2),
        ]
    }
}
