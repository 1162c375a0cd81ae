//! Averages over the scale of a *t* statistic: s = sqrt(chi-square / df), by the trapezoidal rule in ln s.
//!
//! The integrand is analytic and falls off on both sides, so the rule converges geometrically; it is summed
//! outward from its largest term, so that small averages keep their digits.

/// Terms below this fraction of the largest are left out.
const NEGLIGIBLE: f64 = 1e-18;

/// The mean of `g(s)` for s = sqrt(chi-square / `df`), with `g` from 0 to 1 and monotone.
///
/// ```text
/// E g = integral of g(e^t) f(t) dt,   ln f(t) = ln 2 + (df/2) ln(df/2) - ln gamma(df/2) + df t - df e^2t / 2
/// ```
pub(crate) fn mean_over_scale(df: f64, g: impl Fn(f64) -> f64) -> f64 {
    let half = df / 2.0;
    let ln_constant = std::f64::consts::LN_2 + half * half.ln() - libm::lgamma(half);
    let step = (1.5 * (2.0 * df).sqrt()).recip().min(0.1);
    let term = |index: i32| {
        let t = f64::from(index) * step;
        let ln_density = ln_constant + df * t - half * (2.0 * t).exp();
        ln_density.exp() * g(t.exp())
    };
    let peak = peak_of(&term, step);
    let largest = term(peak);
    let side = |direction: i32| -> f64 {
        (1..100_000)
            .map(|distance| term(peak + direction * distance))
            .take_while(|&value| value > NEGLIGIBLE * largest)
            .sum()
    };
    step * (largest + side(-1) + side(1))
}

/// Where `term` is largest, by climbing from s = 1; terms that vanish there are sought at smaller s.
fn peak_of(term: &impl Fn(i32) -> f64, step: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "a few thousand steps")]
    let lowest = (-40.0 / step) as i32;
    let mut peak = 0;
    let mut value = term(0);
    while value == 0.0 && peak > lowest {
        peak -= 1;
        value = term(peak);
    }
    for direction in [-1, 1] {
        loop {
            let next = term(peak + direction);
            if next <= value {
                break;
            }
            (peak, value) = (peak + direction, next);
        }
    }
    peak
}

/// P(Z < z) for a standard normal Z.
pub(crate) fn normal_cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}
