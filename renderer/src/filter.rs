//! The filter of the reconstruction: a tent with a radius of one pixel, along x and along y.
//!
//! `f(t) = 1 - |t|` for `|t| < 1`, with `t` in pixels from the pixel's centre. Tents one pixel apart sum to
//! 1 everywhere, so that no part of the screen counts more than another; the tent is never negative, so
//! that no edge rings and no value leaves the range of the samples.

/// How far the filter reaches from the pixel's centre, in pixels.
pub(crate) const RADIUS_PX: f64 = 1.0;

/// Over how many independent pixels the filter averages: `(∫f)² / ∫f²` along each axis is 3/2.
pub(crate) const AREA_PX: f64 = 2.25;

/// The integral of the filter from −∞ to `t` pixels from the pixel's centre.
///
/// ```text
/// F(t) = 1/2 + t - t |t| / 2 for -1 < t < 1;  0 before, 1 after
/// ```
pub(crate) fn integral_up_to(t: f64) -> f64 {
    let t = t.clamp(-RADIUS_PX, RADIUS_PX);
    0.5 + t * (1.0 - 0.5 * t.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tent(t: f64) -> f64 {
        (1.0 - t.abs()).max(0.0)
    }

    /// The midpoint rule with 20 000 steps: exact on each straight piece but for the one step that may
    /// straddle a corner, where it errs by less than a step squared, 1e-8.
    #[test]
    fn the_integral_is_that_of_brute_force() {
        let steps = 20_000;
        for place in -25..=25 {
            let upper = f64::from(place) * 0.0613;
            let width = (upper + 2.0) / f64::from(steps);
            let sum: f64 = (0..steps)
                .map(|step| width * tent(width.mul_add(f64::from(step) + 0.5, -2.0)))
                .sum();
            assert!((integral_up_to(upper) - sum).abs() < 2e-8, "up to {upper}");
        }
    }
}
