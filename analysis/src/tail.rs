//! Upper tails of the F and chi-square distributions, and the quantile of *t*.
//!
//! Tails are computed as such, in logarithms, so that a p value keeps its digits however small it is; one
//! minus a lower tail never occurs where it would lose them.
//!
//! Sources: the continued fraction of the incomplete beta function, Press et al., *Numerical Recipes*,
//! section 6.4; its leading factor after Loader (2000), "Fast and accurate computation of binomial
//! probabilities", which loses no digits at large degrees of freedom. Chi-square and *t* are `statrs`.

use std::f64::consts::TAU;

use statrs::distribution::{ChiSquared, ContinuousCDF as _, StudentsT};

/// `ln P(F > f)` for *F* with `df_num` and `df_den` degrees of freedom, which need not be whole.
///
/// ```
/// // Meyer & Liu (1992), section 3.4: F(12, 120) = 51.44; ln p by mpmath.
/// assert!((analysis::ln_f_tail(51.44, 12.0, 120.0) + 93.873_855_773_895_829).abs() < 1e-11);
/// ```
pub fn ln_f_tail(f: f64, df_num: f64, df_den: f64) -> f64 {
    if f <= 0.0 {
        return 0.0;
    }
    let total = df_num.mul_add(f, df_den);
    ln_incomplete_beta(
        df_den / total,
        df_num * f / total,
        df_den / 2.0,
        df_num / 2.0,
    )
}

/// `P(F > f)`; never 0, for a tail below the smallest number is that number, 5e-324.
///
/// ```
/// let p = analysis::f_tail(51.44, 12.0, 120.0);
/// assert!((p / 1.702_560_064_950_57e-41 - 1.0).abs() < 1e-12); // R: pf(51.44, 12, 120, lower.tail = FALSE)
/// ```
pub fn f_tail(f: f64, df_num: f64, df_den: f64) -> f64 {
    at_least_smallest(ln_f_tail(f, df_num, df_den).exp())
}

/// `P(chi-square > x)` with `df` degrees of freedom; never 0.
pub(crate) fn chi_square_tail(x: f64, df: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    ChiSquared::new(df).map_or(f64::NAN, |chi_square| at_least_smallest(chi_square.sf(x)))
}

/// The value that *t* with `df` degrees of freedom exceeds with probability `upper_tail`.
///
/// ```
/// // R: qt(0.975, 10)
/// assert!((analysis::t_quantile(0.025, 10.0) / 2.228_138_851_964_938_5 - 1.0).abs() < 1e-10);
/// ```
pub fn t_quantile(upper_tail: f64, df: f64) -> f64 {
    StudentsT::new(0.0, 1.0, df).map_or(f64::NAN, |t| -t.inverse_cdf(upper_tail))
}

fn at_least_smallest(p: f64) -> f64 {
    p.max(f64::from_bits(1))
}

/// `ln I_x(a, b)`, given `x` and `y` = 1 − `x`, each with all its digits.
fn ln_incomplete_beta(x: f64, y: f64, a: f64, b: f64) -> f64 {
    if y <= 0.0 {
        return 0.0;
    }
    if x <= 0.0 {
        return f64::NEG_INFINITY;
    }
    let ln_factor = a * (x * (a + b) / a).ln()
        + b * (y * (a + b) / b).ln()
        + 0.5 * (a * b / (TAU * (a + b))).ln()
        + stirling_remainder(a + b)
        - stirling_remainder(a)
        - stirling_remainder(b);
    if x < (a + 1.0) / (a + b + 2.0) {
        ln_factor + (continued_fraction(x, a, b) / a).ln()
    } else {
        let other_tail = ln_factor.exp() * continued_fraction(y, b, a) / b;
        (-other_tail).ln_1p()
    }
}

/// The coefficients of Stirling's series of ln Gamma: Bernoulli numbers over 2k (2k - 1), from the last term to the first.
pub(crate) const STIRLING: [f64; 7] = [
    1.0 / 156.0,
    -691.0 / 360_360.0,
    1.0 / 1188.0,
    -1.0 / 1680.0,
    1.0 / 1260.0,
    -1.0 / 360.0,
    1.0 / 12.0,
];

/// `ln Gamma(x) - ((x - 1/2) ln x - x + ln(2 pi) / 2)`.
fn stirling_remainder(x: f64) -> f64 {
    let mut x = x;
    let mut remainder = 0.0;
    while x < 10.0 {
        remainder += (x + 0.5).mul_add(x.recip().ln_1p(), -1.0);
        x += 1.0;
    }
    let square = (x * x).recip();
    remainder + STIRLING.iter().fold(0.0, |sum, c| sum * square + c) / x
}

/// The continued fraction of `I_x(a, b)` by Lentz's method.
fn continued_fraction(x: f64, a: f64, b: f64) -> f64 {
    const TINY: f64 = 1e-300;
    const MOST_TERMS: u32 = 100_000;
    let away_from_zero = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut c = 1.0;
    let mut d = away_from_zero(1.0 - (a + b) * x / (a + 1.0)).recip();
    let mut fraction = d;
    for term in 1..=MOST_TERMS {
        let m = f64::from(term);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        for numerator in [even, odd] {
            d = away_from_zero(numerator.mul_add(d, 1.0)).recip();
            c = away_from_zero(1.0 + numerator / c);
            fraction *= c * d;
        }
        if (c * d - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    /// function, arguments, value, ln value: 40 digits by mpmath; see tests/reference/README.md.
    const DISTRIBUTIONS: &str = include_str!("../tests/reference/distributions.csv");

    fn reference(function: &str) -> Vec<(Vec<f64>, f64, f64)> {
        let rows = DISTRIBUTIONS
            .lines()
            .filter(|line| line.starts_with(function));
        let parse = |text: &str| text.parse().unwrap();
        rows.map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let arguments = fields[1].split(';').map(parse).collect();
            (arguments, parse(fields[2]), parse(fields[3]))
        })
        .collect()
    }

    #[test]
    fn f_tails_agree_with_forty_digit_arithmetic_to_1e_12() {
        let rows = reference("f_sf");
        assert_eq!(rows.len(), 15);
        for (x, p, ln_p) in rows {
            let computed = ln_f_tail(x[0], x[1], x[2]);
            assert!(
                (computed / ln_p - 1.0).abs() < 1e-12,
                "{x:?}: {computed} and {ln_p}"
            );
            if p > 0.0 {
                let computed = f_tail(x[0], x[1], x[2]);
                assert!(
                    (computed / p - 1.0).abs() < 1e-12,
                    "{x:?}: {computed:e} and {p:e}"
                );
            }
        }
    }

    #[test]
    fn t_tails_are_f_tails_of_the_square() {
        for (x, p, _) in reference("t_two_sided") {
            let computed = f_tail(x[0] * x[0], 1.0, x[1]);
            assert!(
                (computed / p - 1.0).abs() < 1e-12,
                "{x:?}: {computed:e} and {p:e}"
            );
        }
    }

    #[test]
    fn chi_square_tails_agree_with_forty_digit_arithmetic_to_1e_12() {
        for (x, p, _) in reference("chisq_sf") {
            let computed = chi_square_tail(x[0], x[1]);
            assert!(
                (computed / p - 1.0).abs() < 1e-12,
                "{x:?}: {computed:e} and {p:e}"
            );
        }
    }

    #[test]
    fn two_numerator_degrees_of_freedom_have_a_closed_form() {
        // P(F > f) = (1 + 2 f / d)^(-d / 2).
        for df_den in [1.0_f64, 3.5, 120.0, 1e5] {
            for f in [1e-9_f64, 0.3, 1.0, 40.0, 1e4] {
                let expected = -df_den / 2.0 * (2.0 * f / df_den).ln_1p();
                let computed = ln_f_tail(f, 2.0, df_den);
                assert!(
                    (computed / expected - 1.0).abs() < 1e-10,
                    "{f} {df_den}: {computed} {expected}"
                );
            }
        }
    }

    #[test]
    fn a_tail_below_the_smallest_number_is_that_number() {
        assert_eq!(f_tail(6873.3, 3.0, 441.0), 5e-324);
        assert_eq!(f_tail(0.0, 3.0, 10.0), 1.0);
    }
}
