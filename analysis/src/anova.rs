//! The analysis of variance of any number of within and between factors, as one multivariate linear model.
//!
//! For each set of within factors, orthonormal contrasts turn the subjects × cells matrix into contrast
//! scores; their residuals about the group means are the error of every effect of that set, and hypotheses
//! on the group means (`between_model`) give the effects. There is no case for two factors, or one.
//!
//! Sources: Rencher & Christensen (2012), *Methods of Multivariate Analysis*, section 6.10, for the model;
//! Olejnik & Algina (2003) and Bakeman (2005) for generalized eta squared.

use nalgebra::DMatrix;
use protocols::SumsOfSquares;

use crate::anova_table::{AnovaTable, EffectRow};
use crate::between_model::{BetweenModel, BetweenTerm, level_counts};
use crate::cell_matrix::{CellMatrix, Factor};
use crate::contrasts::{effect_contrasts, factor_sets};
use crate::sphericity::{Epsilons, Mauchly, Sphericity, held_to_range};
use crate::tail::{f_tail, ln_f_tail};

/// The analysis of variance of `cells`; `observed` names the factors that were measured and not
/// manipulated.
///
/// With *M* the contrasts of a set of within factors (cells × *p*), *Z* = *Y M*, *n* subjects in *g* groups:
///
/// ```text
/// E   = sum over groups of (Z - mean Z)' (Z - mean Z)        nu = n - g
/// H_t = L' L,   L = Q_t' sqrt(D) (group means of Z)          D: group sizes; Q_t: directions of the term t
/// F   = (tr H / (p df_t)) / (tr E / (p nu))
/// ```
///
/// which for sum-to-zero coded between factors is the residual sum of squares without the term, less that
/// with it, beside the terms that the type of the sums of squares adjusts for.
pub fn anova(cells: &CellMatrix, observed: &[String], kind: SumsOfSquares) -> AnovaTable {
    let model = Model::new(cells, kind);
    let mut effects = Vec::new();
    let mut warnings = cells.warnings.clone();
    let mut error_total = 0.0;
    let mut subjects_error = None;
    for held in factor_sets(cells.within.len()) {
        let stratum = model.stratum(held);
        error_total += stratum.ss_error;
        let between_error = *subjects_error.get_or_insert((stratum.ss_error, stratum.df_error));
        for term in &model.between.terms {
            if stratum.holds_factors() || term.holds.contains(&true) {
                let mut row = stratum.effect(term, &mut warnings);
                row.omega2 = stratum.omega_squared(&row, between_error);
                effects.push(row);
            }
        }
    }
    add_generalized_eta(&mut effects, error_total, observed);
    AnovaTable {
        n_subjects: cells.subjects.len(),
        sums_of_squares: kind,
        effects,
        dropped_subjects: cells.dropped_subjects.clone(),
        n_averaged_cells: cells.n_averaged_cells,
        warnings,
    }
}

/// What all effects of a design share.
struct Model<'a> {
    cells: &'a CellMatrix,
    /// Scores less one constant, so that an offset costs no digits.
    centred: DMatrix<f64>,
    group_sizes: Vec<usize>,
    between: BetweenModel,
    /// Sums of squares up to this are rounding noise.
    zero: f64,
}

impl<'a> Model<'a> {
    fn new(cells: &'a CellMatrix, kind: SumsOfSquares) -> Self {
        let centred = cells.scores.add_scalar(-cells.scores.mean());
        let noise = 64.0 * f64::EPSILON * cells.scores.amax();
        Self {
            cells,
            centred,
            group_sizes: cells.group_sizes(),
            between: BetweenModel::new(cells, kind),
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
    fn effect(&self, term: &BetweenTerm, warnings: &mut Vec<String>) -> EffectRow {
        let explained = self.model.between.explained(term, &self.means);
        let ss_effect = explained.norm_squared();
        let is_noise = ss_effect <= self.model.zero;
        let ss_effect = if is_noise { 0.0 } else { ss_effect };
        let mut row = EffectRow::new(
            effect_name(self.model.cells, &term.holds, &self.held),
            [
                term.directions.ncols() * self.n_contrasts,
                self.df_error * self.n_contrasts,
            ],
            [ss_effect, self.ss_error],
        );
        add_test(&mut row, warnings);
        self.add_sphericity(&mut row, warnings);
        row
    }

    /// Partial omega squared, never below 0; `None` without variance. `between_error` is the sum of squares
    /// and the degrees of freedom of the subjects.
    ///
    /// ```text
    /// within factors:   df (MS - MSE) / (SS + [within effect] SSE + SS_subjects + MS_subjects)
    /// none in the design: df (MS - MSE) / (SS + (n - df) MSE)
    /// ```
    ///
    /// Source: Olejnik & Algina (2003), *Psychol. Methods* 8, 434–447, as JASP and R's effectsize have it.
    fn omega_squared(&self, row: &EffectRow, between_error: (f64, usize)) -> Option<f64> {
        let (df, mse) = (row.df_num as f64, row.ss_error / row.df_den as f64);
        let (ss_subjects, df_subjects) = between_error;
        let total = if self.model.cells.within.is_empty() {
            let n = self.model.cells.subjects.len() as f64;
            row.ss_effect + (n - df) * mse
        } else {
            let own = if self.holds_factors() {
                row.ss_error
            } else {
                0.0
            };
            row.ss_effect + own + ss_subjects + ss_subjects / df_subjects as f64
        };
        (total > 0.0).then(|| ((row.ss_effect - df * mse) / total).max(0.0))
    }

    fn add_sphericity(&self, row: &mut EffectRow, warnings: &mut Vec<String>) {
        let Some(sphericity) = &self.sphericity else {
            self.say_why_no_sphericity(row, warnings);
            return;
        };
        if let Some(epsilons) = &sphericity.epsilons {
            self.add_epsilons(row, epsilons);
            if epsilons.huynh_feldt.is_none() {
                warnings.push(format!(
                    "{}: the Huynh-Feldt epsilon is 0/0 with so few subjects, and Chi-Muller's with it; the lower bound exists",
                    row.effect
                ));
            }
        }
        match sphericity.mauchly {
            Mauchly::Tested { w, p, p_exact } => {
                (row.mauchly_w, row.mauchly_p) = (Some(w), Some(p));
                row.mauchly_p_exact = Some(p_exact);
            }
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

    fn add_epsilons(&self, row: &mut EffectRow, epsilons: &Epsilons) {
        let p_held = |epsilon: f64| p_with(row, held_to_range(epsilon, self.n_contrasts));
        let p_gg = p_held(epsilons.greenhouse_geisser);
        let p_hf = epsilons.huynh_feldt.and_then(p_held);
        let p_hf_classic = epsilons.huynh_feldt_classic.and_then(p_held);
        let p_cm = epsilons.chi_muller.and_then(p_held);
        let p_lb = p_held(epsilons.lower_bound);
        (row.gg_epsilon, row.p_gg) = (Some(epsilons.greenhouse_geisser), p_gg);
        (row.hf_epsilon, row.p_hf) = (epsilons.huynh_feldt, p_hf);
        (row.hf_epsilon_classic, row.p_hf_classic) = (epsilons.huynh_feldt_classic, p_hf_classic);
        (row.cm_epsilon, row.p_cm) = (epsilons.chi_muller, p_cm);
        (row.lb_epsilon, row.p_lb) = (Some(epsilons.lower_bound), p_lb);
    }

    fn say_why_no_sphericity(&self, row: &mut EffectRow, warnings: &mut Vec<String>) {
        if !self.holds_factors() {
            warnings.push(format!(
                "{}: sphericity is no matter between subjects: no epsilon, no Mauchly's test",
                row.effect
            ));
            return;
        }
        warnings.push(format!(
            "{}: two levels are always spherical: epsilon is 1 and Mauchly's test does not exist",
            row.effect
        ));
        for epsilon in [
            &mut row.gg_epsilon,
            &mut row.hf_epsilon,
            &mut row.hf_epsilon_classic,
            &mut row.cm_epsilon,
            &mut row.lb_epsilon,
        ] {
            *epsilon = Some(1.0);
        }
        (row.p_gg, row.p_hf, row.p_hf_classic) = (row.p, row.p, row.p);
        (row.p_cm, row.p_lb) = (row.p, row.p);
    }
}

/// The factors that an effect holds, joined by `:`, between factors first.
pub(crate) fn effect_name(cells: &CellMatrix, between: &[bool], within: &[bool]) -> String {
    let held = |factors: &[Factor], held: &[bool]| -> Vec<String> {
        (factors.iter().zip(held))
            .filter(|(_, is_held)| **is_held)
            .map(|(factor, _)| factor.name.clone())
            .collect()
    };
    let mut names = held(&cells.between, between);
    names.extend(held(&cells.within, within));
    names.join(":")
}

/// F, p and partial eta squared.
fn add_test(row: &mut EffectRow, warnings: &mut Vec<String>) {
    let (df_num, df_den) = (row.df_num as f64, row.df_den as f64);
    row.f = (row.ss_error > 0.0).then(|| (row.ss_effect / df_num) / (row.ss_error / df_den));
    warn_of_f(&row.effect, row.ss_effect, row.f, warnings);
    row.p = p_with(row, 1.0);
    row.ln_p = row.f.map(|f| ln_f_tail(f, df_num, df_den));
    if let Some(ln_p) = row.ln_p.filter(|ln_p| ln_p.exp() == 0.0) {
        warnings.push(format!(
            "{}: p is below 5e-324, the smallest number that can be written; its natural logarithm is {ln_p:.4}",
            row.effect
        ));
    }
    let total = row.ss_effect + row.ss_error;
    row.pes = (total > 0.0).then(|| row.ss_effect / total);
}

/// The p value of an effect with both degrees of freedom multiplied by `epsilon`.
fn p_with(row: &EffectRow, epsilon: f64) -> Option<f64> {
    let (df_num, df_den) = (row.df_num as f64, row.df_den as f64);
    row.f.map(|f| f_tail(f, epsilon * df_num, epsilon * df_den))
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
