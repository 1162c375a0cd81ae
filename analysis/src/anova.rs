//! The analysis of variance of any number of within and between factors, as one multivariate linear model.
//!
//! For each set of within factors, orthonormal contrasts turn the subjects × cells matrix into contrast
//! scores; their residuals about the group means are the error of every effect of that set, and type III
//! hypotheses on the unweighted group means give the effects. There is no case for two factors, or one.
//!
//! Sources: Rencher & Christensen (2012), *Methods of Multivariate Analysis*, section 6.10, for the model;
//! Olejnik & Algina (2003) and Bakeman (2005) for generalized eta squared.

use nalgebra::DMatrix;

use crate::anova_table::{AnovaTable, EffectRow};
use crate::cell_matrix::{CellMatrix, Factor};
use crate::contrasts::{effect_contrasts, factor_sets};
use crate::sphericity::{Mauchly, Sphericity, held_to_range};
use crate::tail::{f_tail, ln_f_tail};

/// The type III analysis of variance of `cells`; `observed` names the factors that were measured and not
/// manipulated.
///
/// With *M* the contrasts of a set of within factors (cells × *p*), *Z* = *Y M*, *n* subjects in *g* groups:
///
/// ```text
/// E   = sum over groups of (Z - mean Z)' (Z - mean Z)        nu = n - g
/// H_t = L' (C' D C)^-1 L,   L = C' (group means of Z)        C: contrasts of the between term t
/// F   = (tr H / (p df_t)) / (tr E / (p nu))                  D: diagonal of 1 / group size
/// ```
///
/// which for sum-to-zero coded between factors is the residual sum of squares without the term, less that
/// with it.
pub fn anova(cells: &CellMatrix, observed: &[String]) -> AnovaTable {
    let model = Model::new(cells);
    let mut effects = Vec::new();
    let mut warnings = cells.warnings.clone();
    let mut error_total = 0.0;
    for held in factor_sets(cells.within.len()) {
        let stratum = model.stratum(held);
        error_total += stratum.ss_error;
        for term in factor_sets(cells.between.len()) {
            if stratum.holds_factors() || term.contains(&true) {
                effects.push(stratum.effect(&term, &mut warnings));
            }
        }
    }
    add_generalized_eta(&mut effects, error_total, observed);
    AnovaTable {
        n_subjects: cells.subjects.len(),
        effects,
        dropped_subjects: cells.dropped_subjects.clone(),
        warnings,
    }
}

/// What all effects of a design share.
struct Model<'a> {
    cells: &'a CellMatrix,
    /// Scores less one constant, so that an offset costs no digits.
    centred: DMatrix<f64>,
    group_sizes: Vec<usize>,
    /// Sums of squares up to this are rounding noise.
    zero: f64,
}

impl<'a> Model<'a> {
    fn new(cells: &'a CellMatrix) -> Self {
        let centred = cells.scores.add_scalar(-cells.scores.mean());
        let noise = 64.0 * f64::EPSILON * cells.scores.amax();
        Self {
            cells,
            centred,
            group_sizes: cells.group_sizes(),
            zero: cells.scores.len() as f64 * noise * noise,
        }
    }

    /// The stratum of one set of within factors.
    fn stratum(&'a self, held: Vec<bool>) -> Stratum<'a> {
        let contrasts = effect_contrasts(&level_counts(&self.cells.within), &held);
        let scores = &self.centred * contrasts;
        let mut means = DMatrix::zeros(self.group_sizes.len(), scores.ncols());
        for (row, &group) in self.cells.groups.iter().enumerate() {
            let mut mean = means.row_mut(group);
            mean += scores.row(row) / self.group_sizes[group] as f64;
        }
        let mut residuals = scores;
        for (row, &group) in self.cells.groups.iter().enumerate() {
            let mut residual = residuals.row_mut(row);
            residual -= means.row(group);
        }
        let mut ss_error = residuals.norm_squared();
        if ss_error <= self.zero {
            ss_error = 0.0;
            residuals.fill(0.0);
        }
        let df_error = self.cells.subjects.len() - self.group_sizes.len();
        let needs_sphericity = held.contains(&true) && residuals.ncols() > 1;
        Stratum {
            model: self,
            sphericity: needs_sphericity
                .then(|| Sphericity::new(&residuals, df_error, self.centred.ncols())),
            n_contrasts: residuals.ncols(),
            held,
            means,
            ss_error,
            df_error,
        }
    }
}

/// One set of within factors: its contrasts and the error term that its effects share.
struct Stratum<'a> {
    model: &'a Model<'a>,
    /// Which within factors it holds.
    held: Vec<bool>,
    n_contrasts: usize,
    /// Groups × contrasts.
    means: DMatrix<f64>,
    ss_error: f64,
    /// Error degrees of freedom of each contrast.
    df_error: usize,
    sphericity: Option<Sphericity>,
}

impl Stratum<'_> {
    fn holds_factors(&self) -> bool {
        self.held.contains(&true)
    }

    /// The effect of the between factors `term` on this stratum's contrasts.
    fn effect(&self, term: &[bool], warnings: &mut Vec<String>) -> EffectRow {
        let (ss_effect, df_term) = self.hypothesis(term);
        let name = self.name(term);
        let df_num = df_term * self.n_contrasts;
        let df_den = self.df_error * self.n_contrasts;
        let f = (self.ss_error > 0.0)
            .then(|| (ss_effect / df_num as f64) / (self.ss_error / df_den as f64));
        warn_of_f(&name, ss_effect, f, warnings);
        let p_with =
            |epsilon: f64| f.map(|f| f_tail(f, epsilon * df_num as f64, epsilon * df_den as f64));
        let ln_p = f.map(|f| ln_f_tail(f, df_num as f64, df_den as f64));
        if let Some(ln_p) = ln_p.filter(|ln_p| ln_p.exp() == 0.0) {
            warnings.push(format!(
                "{name}: p is below 5e-324, the smallest number that can be written; its natural logarithm is {ln_p:.4}"
            ));
        }
        let total = ss_effect + self.ss_error;
        let mut row = EffectRow {
            effect: name,
            df_num,
            df_den,
            ss_effect,
            ss_error: self.ss_error,
            f,
            p: p_with(1.0),
            ln_p,
            gg_epsilon: None,
            p_gg: None,
            hf_epsilon: None,
            p_hf: None,
            pes: (total > 0.0).then(|| ss_effect / total),
            ges: None,
            mauchly_w: None,
            mauchly_p: None,
        };
        self.add_sphericity(&mut row, p_with, warnings);
        row
    }

    /// The type III sum of squares of a between term and its degrees of freedom on each contrast.
    fn hypothesis(&self, term: &[bool]) -> (f64, usize) {
        let contrasts = effect_contrasts(&level_counts(&self.model.cells.between), term);
        let tested = contrasts.tr_mul(&self.means);
        let mut weighted = contrasts.clone();
        for (mut row, &size) in weighted.row_iter_mut().zip(&self.model.group_sizes) {
            row /= size as f64;
        }
        let covariance = contrasts.tr_mul(&weighted);
        let sum_of_squares = covariance
            .cholesky()
            .map_or(f64::NAN, |factor| factor.solve(&tested).dot(&tested));
        let is_noise = sum_of_squares <= self.model.zero;
        (
            if is_noise { 0.0 } else { sum_of_squares },
            contrasts.ncols(),
        )
    }

    fn name(&self, term: &[bool]) -> String {
        let cells = self.model.cells;
        let held = |factors: &[Factor], held: &[bool]| -> Vec<String> {
            (factors.iter().zip(held))
                .filter(|(_, is_held)| **is_held)
                .map(|(factor, _)| factor.name.clone())
                .collect()
        };
        let mut names = held(&cells.between, term);
        names.extend(held(&cells.within, &self.held));
        names.join(":")
    }

    fn add_sphericity(
        &self,
        row: &mut EffectRow,
        p_with: impl Fn(f64) -> Option<f64>,
        warnings: &mut Vec<String>,
    ) {
        let Some(sphericity) = &self.sphericity else {
            if self.holds_factors() {
                warnings.push(format!(
                    "{}: two levels are always spherical: epsilon is 1 and Mauchly's test does not exist",
                    row.effect
                ));
                (row.gg_epsilon, row.hf_epsilon) = (Some(1.0), Some(1.0));
                (row.p_gg, row.p_hf) = (row.p, row.p);
            } else {
                warnings.push(format!(
                    "{}: sphericity is no matter between subjects: no epsilon, no Mauchly's test",
                    row.effect
                ));
            }
            return;
        };
        row.gg_epsilon = sphericity.gg_epsilon;
        row.p_gg = sphericity.gg_epsilon.and_then(&p_with);
        row.hf_epsilon = sphericity.hf_epsilon;
        row.p_hf = (sphericity.hf_epsilon)
            .and_then(|epsilon| p_with(held_to_range(epsilon, self.n_contrasts)));
        if sphericity.gg_epsilon.is_some() && sphericity.hf_epsilon.is_none() {
            warnings.push(format!(
                "{}: the Huynh-Feldt epsilon is 0/0 with so few subjects",
                row.effect
            ));
        }
        match sphericity.mauchly {
            Mauchly::Tested { w, p } => (row.mauchly_w, row.mauchly_p) = (Some(w), Some(p)),
            Mauchly::Singular { rank } => warnings.push(format!(
                "{}: Mauchly's test does not exist, because the error matrix of {} contrasts has rank {rank} \
                 ({} error degrees of freedom); the epsilons need no inverse and do exist",
                row.effect, self.n_contrasts, self.df_error
            )),
            Mauchly::NoVariance => warnings.push(format!(
                "{}: without error variance there is no epsilon and no Mauchly's test",
                row.effect
            )),
        }
    }
}

fn warn_of_f(name: &str, ss_effect: f64, f: Option<f64>, warnings: &mut Vec<String>) {
    if f.is_some() {
        return;
    }
    warnings.push(if ss_effect > 0.0 {
        format!(
            "{name}: the error sum of squares is zero, so F is infinite; no F and no p are given"
        )
    } else {
        format!("{name}: effect and error sums of squares are zero, so F is 0/0 and not defined")
    });
}

fn level_counts(factors: &[Factor]) -> Vec<usize> {
    factors.iter().map(|factor| factor.levels.len()).collect()
}

/// Generalized eta squared: every error stratum once, and the effects that hold an observed factor.
fn add_generalized_eta(effects: &mut [EffectRow], error_total: f64, observed: &[String]) {
    let is_measured = |row: &EffectRow| {
        let mut factors = row.effect.split(':');
        factors.any(|factor| observed.iter().any(|name| name == factor))
    };
    let measured_total: f64 = (effects.iter().filter(|row| is_measured(row)))
        .map(|row| row.ss_effect)
        .sum();
    for row in effects {
        let own = if is_measured(row) { 0.0 } else { row.ss_effect };
        let total = own + measured_total + error_total;
        row.ges = (total > 0.0).then(|| row.ss_effect / total);
    }
}
