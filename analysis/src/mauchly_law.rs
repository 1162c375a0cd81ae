//! The law of Mauchly's W under sphericity, without approximation.
//!
//! W of *p* contrasts with nu error degrees of freedom is distributed as a product of independent beta
//! variables, so the transform of −ln W is a product of gamma functions; it is inverted along a parabola.
//! Absolute error below 1e-10; a p value below that is given as 1e-10.
//!
//! Sources: Anderson (2003), *An Introduction to Multivariate Statistical Analysis*, section 10.7.3, for the
//! moments; Weideman & Trefethen (2007), *Math. Comp.* 76, 1341–1356, for the parabola.

use std::f64::consts::{LN_2, PI};

use nalgebra::Complex;

use crate::tail::STIRLING;

/// Points on the upper half of the parabola; the error falls as 2.85^−2N.
const N_POINTS: u32 = 14;
const I: Complex<f64> = Complex::new(0.0, 1.0);
/// What the inversion cannot resolve.
const SMALLEST: f64 = 1e-10;

/// P(ln W < `ln_w`) for *p* contrasts and `nu` ≥ *p* error degrees of freedom.
///
/// ```text
/// E W^s = product over i = 2 .. p of  G(a_i + s) G(a_i + b_i) / (G(a_i) G(a_i + b_i + s)),
/// a_i = (nu + 1 - i) / 2,   b_i = (i - 1) (1/2 + 1/p),   G the gamma function
/// ```
pub(crate) fn mauchly_p_exact(ln_w: f64, n_contrasts: usize, nu: usize) -> f64 {
    let x = -ln_w;
    if x <= 0.0 {
        return 1.0;
    }
    let (p, nu) = (n_contrasts as f64, nu as f64);
    let betas: Vec<(f64, f64)> = (2..=n_contrasts)
        .map(|i| {
            let i = i as f64;
            ((nu + 1.0 - i) / 2.0, (i - 1.0) * (0.5 + 1.0 / p))
        })
        .collect();
    let ln_at_zero: f64 = betas.iter().map(|&(a, b)| ln_ratio(real(a), b).re).sum();
    let transform = |s: Complex<f64>| -> Complex<f64> {
        let ln: Complex<f64> = betas.iter().map(|&(a, b)| ln_ratio(s + a, b)).sum();
        (ln - ln_at_zero).exp()
    };
    // The cumulative law of x is the inverse transform of E W^s / s.
    let n = f64::from(N_POINTS);
    let step = 3.0 / n;
    let size = PI * n / (12.0 * x);
    let below: f64 = (0..N_POINTS)
        .map(|point| {
            let u = (f64::from(point) + 0.5) * step;
            let root = Complex::new(1.0, u);
            let s = root * root * size;
            let slope = I * root * (2.0 * size);
            let term: Complex<f64> = (s * x).exp() * transform(s) / s * slope;
            step / PI * term.im
        })
        .sum();
    (1.0 - below).clamp(SMALLEST, 1.0)
}

fn real(value: f64) -> Complex<f64> {
    Complex::new(value, 0.0)
}

/// ln of gamma(z) / gamma(z + b), on any branch.
fn ln_ratio(z: Complex<f64>, b: f64) -> Complex<f64> {
    ln_gamma(z) - ln_gamma(z + b)
}

/// ln of the gamma function for Im z ≥ 0, on any branch: Stirling's series, after reflection or a few steps
/// of the recurrence.
fn ln_gamma(z: Complex<f64>) -> Complex<f64> {
    if z.re < 0.5 {
        // Reflection: sin(pi z) = exp(-i pi z) (exp(2 i pi z) - 1) / 2i, which cannot overflow for Im z >= 0.
        let turn = I * PI * z;
        let ln_sine = -turn + ((turn * 2.0).exp() - 1.0).ln() - LN_2 - I.ln();
        let mirrored = ln_gamma((real(1.0) - z).conj()).conj();
        return real(PI.ln()) - ln_sine - mirrored;
    }
    let mut z = z;
    let mut shift = Complex::new(0.0, 0.0);
    while z.norm_sqr() < 144.0 {
        shift += z.ln();
        z += 1.0;
    }
    let square = (z * z).inv();
    let series = (STIRLING.iter()).fold(real(0.0), |sum, c| sum * square + c) / z;
    (z - 0.5) * z.ln() - z + 0.5 * (2.0 * PI).ln() + series - shift
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_contrasts_have_a_closed_form() {
        // P(W < w) = w^((nu - 1) / 2) for p = 2: Anderson (2003), section 10.7.3.
        for nu in [2, 3, 10, 60] {
            for w in [0.001_f64, 0.2, 0.5, 0.9, 0.999] {
                let expected = w.powf((nu as f64 - 1.0) / 2.0);
                let found = mauchly_p_exact(w.ln(), 2, nu);
                assert!(
                    (found - expected.max(SMALLEST)).abs() < 1e-10,
                    "nu {nu}, W {w}: {found:e} and {expected:e}"
                );
            }
        }
    }

    #[test]
    fn the_law_is_that_of_simulated_wishart_matrices() {
        // The determinant and trace of a Wishart matrix by Bartlett's decomposition.
        use rand_chacha::ChaCha8Rng;
        use rand_chacha::rand_core::{Rng as _, SeedableRng as _};
        let mut random = ChaCha8Rng::seed_from_u64(1940);
        let mut uniform = move || (f64::from(random.next_u32()) + 0.5) / 4_294_967_296.0;
        let mut normal = move || (-2.0 * uniform().ln()).sqrt() * (2.0 * PI * uniform()).cos();
        for (p, nu) in [(3_usize, 3_usize), (12, 13), (6, 10)] {
            let n_draws = 4000_u32;
            let mut ln_ws: Vec<f64> = (0..n_draws)
                .map(|_| {
                    let mut square_sum =
                        |n: usize| -> f64 { (0..n).map(|_| normal().powi(2)).sum() };
                    let diagonal: Vec<f64> = (0..p).map(|i| square_sum(nu - i)).collect();
                    let trace = diagonal.iter().sum::<f64>() + square_sum(p * (p - 1) / 2);
                    let ln_det: f64 = diagonal.iter().map(|d| d.ln()).sum();
                    ln_det - p as f64 * (trace / p as f64).ln()
                })
                .collect();
            ln_ws.sort_by(f64::total_cmp);
            for place in [200_u32, 1000, 2000, 3600] {
                let share = f64::from(place) / f64::from(n_draws);
                let ln_w = ln_ws[place as usize];
                let found = mauchly_p_exact(ln_w, p, nu);
                // Four standard errors of the simulated share.
                let tolerance = 4.0 * (share * (1.0 - share) / f64::from(n_draws)).sqrt();
                assert!(
                    (found - share).abs() < tolerance,
                    "p {p}, nu {nu}: {found} and {share}"
                );
            }
        }
    }
}
