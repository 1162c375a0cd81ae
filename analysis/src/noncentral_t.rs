//! The noncentral *t* distribution, for intervals of standardized differences.

use crate::chi_scale::{mean_over_scale, normal_cdf};

/// P(T < t) for *t* with `df` degrees of freedom and noncentrality `delta`: the mean of Phi(t s − delta) over the
/// scale s.
pub(crate) fn noncentral_t_cdf(t: f64, df: f64, delta: f64) -> f64 {
    mean_over_scale(df, |scale| normal_cdf(t * scale - delta))
}

/// The noncentralities under which `t` stands at the upper and the lower end of the middle `confidence` of its
/// distribution: the interval of the noncentrality.
///
/// # Source
///
/// Steiger & Fouladi (1997), "Noncentrality interval estimation and the evaluation of statistical models".
pub(crate) fn noncentrality_interval(t: f64, df: f64, confidence: f64) -> [f64; 2] {
    let side = (1.0 - confidence) / 2.0;
    [1.0 - side, side].map(|probability| {
        // The probability falls as delta rises; the standard error of t itself bounds the search.
        let reach = 10.0 * (1.0 + t * t / (2.0 * df)).sqrt() + 10.0;
        let (mut low, mut high) = (t - reach, t + reach);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            if noncentral_t_cdf(t, df, middle) > probability {
                low = middle;
            } else {
                high = middle;
            }
        }
        f64::midpoint(low, high)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn central_t_is_student() {
        for (t, df) in [
            (2.228_138_851_964_939_f64, 10.0_f64),
            (0.3, 3.0),
            (5.0, 40.0),
        ] {
            let expected = 1.0 - crate::f_tail(t * t, 1.0, df) / 2.0;
            assert!((noncentral_t_cdf(t, df, 0.0) - expected).abs() < 1e-12);
            assert!((noncentral_t_cdf(-t, df, 0.0) - (1.0 - expected)).abs() < 1e-12);
        }
    }

    #[test]
    fn probabilities_agree_with_r() {
        // R 4.2.2: pt(t, df, ncp), whose own accuracy is 1e-12.
        let rows = [
            (3.0, 10.0, 1.5, 0.883_351_624_234_274),
            (1.0, 25.0, 2.0, 0.158_631_775_588_182),
            (-0.5, 7.0, 0.7, 0.120_492_709_018_197),
            (4.062_1, 9.0, 2.0, 0.924_168_797_249_352),
        ];
        for (t, df, delta, expected) in rows {
            let found = noncentral_t_cdf(t, df, delta);
            assert!((found - expected).abs() < 1e-11, "{found} and {expected}");
        }
    }

    #[test]
    fn the_interval_puts_t_at_its_ends() {
        let (t, df) = (4.062_1, 9.0);
        let [low, high] = noncentrality_interval(t, df, 0.95);
        assert!((noncentral_t_cdf(t, df, low) - 0.975).abs() < 1e-10);
        assert!((noncentral_t_cdf(t, df, high) - 0.025).abs() < 1e-10);
    }
}
