//! How far the covariance of an effect's contrasts is from spherical, and what that does to its F test.
//!
//! Epsilons come from traces and need no inverse, so they exist where there are more contrasts than error
//! degrees of freedom; Mauchly's test does not.

use nalgebra::DMatrix;

use crate::mauchly_law::mauchly_p_exact;
use crate::tail::chi_square_tail;

/// Eigenvalues below this fraction of the largest count as zero.
const RANK_TOLERANCE: f64 = 1e-10;

/// The sphericity of one within-subject effect with at least two contrasts.
#[derive(Clone, Debug, PartialEq)]
pub struct Sphericity {
    /// The estimates of epsilon; `None` without error variance.
    pub epsilons: Option<Epsilons>,
    /// Mauchly's test.
    pub mauchly: Mauchly,
}

/// Estimates of epsilon, as they come out; those that may leave [1/p, 1] are held to it for a p value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Epsilons {
    /// Greenhouse–Geisser, in [1/p, 1].
    pub greenhouse_geisser: f64,
    /// Huynh–Feldt in Lecoutre's form; `None` where it is 0/0.
    pub huynh_feldt: Option<f64>,
    /// Huynh–Feldt as published in 1976, the same for one group; `None` where it is 0/0.
    pub huynh_feldt_classic: Option<f64>,
    /// Chi–Muller; `None` where Huynh–Feldt is 0/0.
    pub chi_muller: Option<f64>,
    /// The lower bound 1/p.
    pub lower_bound: f64,
}

/// Mauchly's test of sphericity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mauchly {
    /// It exists.
    Tested {
        /// The ratio of determinant and trace, in [0, 1].
        w: f64,
        /// Its p value by the chi-square approximation with the second-order term.
        p: f64,
        /// Its p value by the law of W itself.
        p_exact: f64,
    },
    /// The error matrix has no inverse: its rank is below the number of contrasts.
    Singular {
        /// The rank.
        rank: usize,
    },
    /// There is no error variance at all.
    NoVariance,
}

impl Sphericity {
    /// From the residuals of an effect's contrast scores, with `df_error` error degrees of freedom in a
    /// design of `n_cells` within cells.
    ///
    /// `residuals` is *n* × *p*: *n* subjects, *p* contrasts. With *E* = residualsᵀ residuals and nu =
    /// `df_error`,
    ///
    /// ```text
    /// e_gg = tr(E)^2 / (p tr(E E))                                  Greenhouse-Geisser
    /// e_hf = ((nu + 1) p e_gg - 2) / (p (nu - p e_gg))              Lecoutre (1991)
    /// e_h  = (n p e_gg - 2) / (p (nu - p e_gg))                     Huynh & Feldt (1976)
    /// a    = (nu - 1) + nu (nu - 1) / 2
    /// e_cm = e_hf (a - 2) (a - 4) / a^2                             Chi & Muller
    /// W    = det(E) / (tr(E) / p)^p                                 Mauchly
    /// rho  = 1 - (2 p^2 + p + 2) / (6 p nu),   X = -nu rho ln W,   f = p (p + 1) / 2 - 1
    /// w2   = (p + 2)(p - 1)(p - 2)(2 p^3 + 6 p^2 + 3 q + 2) / (288 p^2 nu^2 rho^2)
    /// p    = P(chi2_f > X) + w2 (P(chi2_{f+4} > X) - P(chi2_f > X))
    /// ```
    ///
    /// with *q* the number of within cells, as in R's `mauchly.test` and `car` (Anderson 2003, section
    /// 10.7, has *q* = *p*; the difference is below 4e-3). The approximation fails where nu is near *p*: for
    /// *p* = 12 and nu = 13 its true size at .05 is .20. The exact p has no such fault.
    ///
    /// # Source
    ///
    /// Geisser & Greenhouse (1958); Huynh & Feldt (1976); Lecoutre (1991), *J. Educ. Stat.* 16, 371–372;
    /// Chi, Gribbin, Lamers, Gregory & Muller (2012), *Stat. Med.* 31, 810–824; Mauchly (1940); Anderson
    /// (2003), section 10.7.
    pub fn new(residuals: &DMatrix<f64>, df_error: usize, n_cells: usize) -> Self {
        let error = residuals.tr_mul(residuals);
        let trace = error.trace();
        if trace <= 0.0 {
            return Self {
                epsilons: None,
                mauchly: Mauchly::NoVariance,
            };
        }
        let p = residuals.ncols() as f64;
        let scaled = &error / trace;
        let gg = (p * scaled.norm_squared()).recip().clamp(p.recip(), 1.0);
        Self {
            epsilons: Some(Epsilons::new(
                gg,
                p,
                residuals.nrows() as f64,
                df_error as f64,
            )),
            mauchly: mauchly(residuals, df_error, n_cells),
        }
    }
}

impl Epsilons {
    /// From the Greenhouse–Geisser estimate `gg` of `p` contrasts, `n` subjects and `nu` error degrees of
    /// freedom.
    fn new(gg: f64, p: f64, n: f64, nu: f64) -> Self {
        let denominator = p * (nu - p * gg);
        let unless_undefined =
            |numerator: f64| (denominator > 1e-9 * p * nu).then_some(numerator / denominator);
        let huynh_feldt = unless_undefined((nu + 1.0) * p * gg - 2.0);
        let a = (nu - 1.0) + nu * (nu - 1.0) / 2.0;
        let shrinkage = (a - 2.0) * (a - 4.0) / (a * a);
        Self {
            greenhouse_geisser: gg,
            huynh_feldt,
            huynh_feldt_classic: unless_undefined(n * p * gg - 2.0),
            chi_muller: huynh_feldt.map(|epsilon| epsilon * shrinkage),
            lower_bound: p.recip(),
        }
    }
}

/// The epsilon that multiplies degrees of freedom: an estimate held to its range [1/p, 1].
pub(crate) fn held_to_range(epsilon: f64, n_contrasts: usize) -> f64 {
    epsilon.clamp((n_contrasts as f64).recip(), 1.0)
}

fn mauchly(residuals: &DMatrix<f64>, df_error: usize, n_cells: usize) -> Mauchly {
    let p = residuals.ncols();
    // Singular values keep the digits that squaring the matrix would lose.
    let values = residuals.singular_values();
    let eigenvalues: Vec<f64> = values.iter().map(|value| value * value).collect();
    let largest = eigenvalues.iter().copied().fold(0.0, f64::max);
    let is_counted = |&&value: &&f64| value > RANK_TOLERANCE * largest;
    let rank = eigenvalues.iter().filter(is_counted).count().min(df_error);
    if rank < p {
        return Mauchly::Singular { rank };
    }
    let mean = eigenvalues.iter().sum::<f64>() / p as f64;
    let ln_w: f64 = eigenvalues.iter().map(|value| (value / mean).ln()).sum();
    let ln_w = ln_w.min(0.0);
    Mauchly::Tested {
        w: ln_w.exp(),
        p: mauchly_p(ln_w, p as f64, df_error as f64, n_cells as f64),
        p_exact: mauchly_p_exact(ln_w, p, df_error),
    }
}

fn mauchly_p(ln_w: f64, p: f64, nu: f64, q: f64) -> f64 {
    let rho = 1.0 - (2.0 * p * p + p + 2.0) / (6.0 * p * nu);
    let df = p * (p + 1.0) / 2.0 - 1.0;
    let chi_square = -nu * rho * ln_w;
    let w2 = (p + 2.0) * (p - 1.0) * (p - 2.0) * (2.0 * p.powi(3) + 6.0 * p * p + 3.0 * q + 2.0)
        / (288.0 * (p * nu * rho).powi(2));
    let first_order = chi_square_tail(chi_square, df);
    let second_order = w2 * (chi_square_tail(chi_square, df + 4.0) - first_order);
    (first_order + second_order).clamp(f64::from_bits(1), 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_variances_without_correlation_are_spherical() {
        // Columns of a Hadamard matrix: E = 4 I.
        let residuals = DMatrix::from_row_slice(
            4,
            3,
            &[
                1.0, 1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, -1.0, -1.0, -1.0, 1.0,
            ],
        );
        let sphericity = Sphericity::new(&residuals, 3, 4);
        let epsilon = sphericity.epsilons.unwrap().greenhouse_geisser;
        assert!((epsilon - 1.0).abs() < 1e-15);
        let Mauchly::Tested { w, p, p_exact } = sphericity.mauchly else {
            panic!("Mauchly's test exists here");
        };
        assert!((w - 1.0).abs() < 1e-14 && (p - 1.0).abs() < 1e-6 && (p_exact - 1.0).abs() < 1e-9);
    }

    #[test]
    fn more_contrasts_than_subjects_leave_epsilons_but_no_mauchly() {
        let residuals = DMatrix::from_row_slice(2, 2, &[1.0, 2.0, -1.0, -2.0]);
        let sphericity = Sphericity::new(&residuals, 1, 3);
        let epsilons = sphericity.epsilons.unwrap();
        assert_eq!(epsilons.greenhouse_geisser, 0.5);
        assert_eq!(epsilons.lower_bound, 0.5);
        assert_eq!(epsilons.huynh_feldt, None); // 0/0: nu = p e_gg = 1.
        assert_eq!(sphericity.mauchly, Mauchly::Singular { rank: 1 });
    }
}
