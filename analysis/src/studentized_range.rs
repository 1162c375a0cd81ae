//! The upper tail of the studentized range: the largest of *k* means less the smallest, over their error.
//!
//! The tail itself is integrated, not one less the rest, so that it keeps its digits however small it is.
//!
//! Source: Tukey (1949); the double integral is that of Copenhaver & Holland (1988), *J. Stat. Comput. Simul.*
//! 30, 1–15.

use std::f64::consts::TAU;

use crate::chi_scale::{mean_over_scale, normal_cdf};

/// Distance of the points in z; the integrand is an entire function as narrow as a normal density.
const STEP: f64 = 0.2;
/// Beyond this many standard deviations nothing counts.
const REACH: f64 = 8.6;

/// P(Q > q) for the range of `n_means` means and an error with `df` degrees of freedom.
///
/// ```text
/// P(Q > q) = E R(q s),   s = sqrt(chi2_df / df)
/// R(w)     = k integral of phi(z) (Phi(z)^(k-1) - (Phi(z) - Phi(z - w))^(k-1)) dz
/// ```
pub(crate) fn studentized_range_tail(q: f64, n_means: usize, df: f64) -> f64 {
    if q <= 0.0 {
        return 1.0;
    }
    let grid = Grid::new();
    let tail = mean_over_scale(df, |scale| grid.range_tail(q * scale, n_means));
    tail.clamp(f64::from_bits(1), 1.0)
}

/// Points in z with the normal density and its integral.
struct Grid {
    points: Vec<[f64; 3]>,
}

impl Grid {
    fn new() -> Self {
        let point = |index: u32| {
            let z = f64::from(index) * STEP - REACH;
            let density = (-z * z / 2.0).exp() / TAU.sqrt();
            [z, density, normal_cdf(z)]
        };
        Self {
            points: (0..=230).map(point).collect(),
        }
    }

    /// P(range of `n_means` standard normal values > w).
    fn range_tail(&self, w: f64, n_means: usize) -> f64 {
        let others = (n_means - 1) as f64;
        let mut sum = 0.0;
        for &[z, density, below] in &self.points {
            if z > w + REACH || (z > 0.0 && density < 1e-19 * sum) {
                break;
            }
            let out_of_reach = normal_cdf(z - w) / below;
            // Phi^m - (Phi - Phi(z - w))^m without the cancellation.
            let share = -(others * (-out_of_reach).ln_1p()).exp_m1();
            sum += density * below.powf(others) * share;
        }
        n_means as f64 * STEP * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_agree_with_forty_digit_arithmetic_to_1e_9() {
        // tests/reference/README.md says how these were made. R's own ptukey is 2.8% off in one of them.
        let rows = include_str!("../tests/reference/distributions.csv").lines();
        let mut n_rows = 0;
        for line in rows.filter(|line| line.starts_with("studentized_range_sf")) {
            let fields: Vec<&str> = line.split(',').collect();
            let arguments: Vec<f64> = fields[1].split(';').map(|x| x.parse().unwrap()).collect();
            let expected: f64 = fields[2].parse().unwrap();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a small whole number"
            )]
            let n_means = arguments[1] as usize;
            let found = studentized_range_tail(arguments[0], n_means, arguments[2]);
            let error = (found / expected - 1.0).abs();
            assert!(
                error < 1e-9,
                "{arguments:?}: {found:e} and {expected:e}, {error:e}"
            );
            n_rows += 1;
        }
        assert_eq!(n_rows, 8);
    }

    #[test]
    fn two_means_are_a_t_test() {
        // P(Q_2 > q) = P(|t| > q / sqrt 2).
        for df in [1.0, 2.0, 7.0, 40.0, 3000.0] {
            for q in [0.01, 1.0, 4.0, 12.0, 30.0] {
                let expected = crate::f_tail(q * q / 2.0, 1.0, df);
                let found = studentized_range_tail(q, 2, df);
                assert!(
                    (found / expected - 1.0).abs() < 1e-9,
                    "{q} {df}: {found:e} and {expected:e}"
                );
            }
        }
    }
}
