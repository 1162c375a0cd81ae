//! Curves that flatten, fitted to means by exact least squares: the linear plateau, and the shapes beside it.

use crate::interval::mean;

/// A fitted curve: where it flattens, its level there, how steeply it rises before, and how far off it is.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct PlateauFit {
    /// Where the curve flattens.
    pub psi: f64,
    /// Its level from there on.
    pub level: f64,
    /// How much it loses for each unit (for each squared unit) below `psi`.
    pub slope: f64,
    /// The sum of squared residuals.
    pub sse: f64,
}

/// The linear plateau y = level − slope max(0, psi − x), with psi from the second to the last of the rising `x`.
///
/// With the first *j* points on the slope, the best line through them and the mean of the rest are independent
/// fits; psi is where they cross if that lies between `x_j` and `x_(j+1)`, else an end of that stretch. The least
/// sum of squares wins, the smallest psi among equals.
///
/// # Source
///
/// Hudson (1966), *J. Am. Stat. Assoc.* 61, 1097–1129.
pub fn linear_plateau(x: &[f64], y: &[f64]) -> PlateauFit {
    let mut candidates: Vec<f64> = x[1..].to_vec();
    for j in 2..x.len() {
        let (centre, height) = (mean(&x[..j]), mean(&y[..j]));
        let points = || x[..j].iter().zip(&y[..j]);
        let sxy: f64 = points().map(|(x, y)| (x - centre) * (y - height)).sum();
        let sxx: f64 = points().map(|(x, _)| (x - centre).powi(2)).sum();
        let crossing = centre + (mean(&y[j..]) - height) / (sxy / sxx);
        if crossing >= x[j - 1] && crossing <= x[j] {
            candidates.push(crossing);
        }
    }
    best(&candidates, |psi| fit_at(x, y, psi, 1))
}

/// The plateau points of many curves over the same levels, as [`linear_plateau`] finds them, from running sums:
/// each place is tried in constant time.
#[derive(Clone, Debug)]
pub(crate) struct PlateauFinder {
    centre: f64,
    /// Levels less their mean.
    x: Vec<f64>,
    /// Of the first *j* of them, the sum and the sum of squares.
    sums: Vec<[f64; 2]>,
}

impl PlateauFinder {
    pub(crate) fn new(levels: &[f64]) -> Self {
        let centre = mean(levels);
        let x: Vec<f64> = levels.iter().map(|level| level - centre).collect();
        let mut sums = vec![[0.0, 0.0]];
        for (j, x) in x.iter().enumerate() {
            let [sum, squares] = sums[j];
            sums.push([sum + x, x.mul_add(*x, squares)]);
        }
        Self { centre, x, sums }
    }

    /// The plateau point of the means `y`.
    pub(crate) fn psi(&self, y: &[f64]) -> f64 {
        let (height, n) = (mean(y), self.x.len());
        let (mut sy, mut sxy) = (y[0] - height, self.x[0] * (y[0] - height));
        let total: f64 = y.iter().map(|y| (y - height).powi(2)).sum();
        let mut best = (self.x[1], self.explained(self.x[1], 1, [sy, sxy]));
        let mut try_at = |psi: f64, j: usize, of_y: [f64; 2]| {
            let explained = self.explained(psi, j, of_y);
            if explained > best.1 + 1e-12 * (total - best.1) {
                best = (psi, explained);
            }
        };
        for j in 2..n {
            let below = y[j - 1] - height;
            (sy, sxy) = (sy + below, self.x[j - 1].mul_add(below, sxy));
            let [sx, sxx] = self.sums[j];
            let count = j as f64;
            let slope = (sxy - sx * sy / count) / (sxx - sx * sx / count);
            let rest = -sy / (n - j) as f64;
            let crossing = sx / count + (rest - sy / count) / slope;
            if crossing >= self.x[j - 1] && crossing <= self.x[j] {
                try_at(crossing, j, [sy, sxy]);
            }
            try_at(self.x[j], j, [sy, sxy]);
        }
        best.0 + self.centre
    }

    /// The sum of squares that the best plateau with this corner explains; *j* levels lie below it.
    fn explained(&self, psi: f64, j: usize, [sy, sxy]: [f64; 2]) -> f64 {
        let ([sx, sxx], count) = (self.sums[j], j as f64);
        let sum = count.mul_add(psi, -sx);
        let squares = psi * count.mul_add(psi, -2.0 * sx) + sxx;
        let product = psi.mul_add(sy, -sxy);
        product * product / (squares - sum * sum / self.x.len() as f64)
    }
}

/// The quadratic plateau y = level − slope max(0, psi − x)²: no corner at psi.
pub(crate) fn quadratic_plateau(x: &[f64], y: &[f64]) -> PlateauFit {
    let mut candidates: Vec<f64> = x[1..].to_vec();
    for ends in x[1..].windows(2) {
        candidates.push(least(ends[0], ends[1], |psi| fit_at(x, y, psi, 2).sse));
    }
    best(&candidates, |psi| fit_at(x, y, psi, 2))
}

/// The exponential approach y = level − drop exp(−(x − first) / tau): `psi` is where it has made up 95% of the drop,
/// first + tau ln 20, and `slope` the drop.
pub(crate) fn exponential(x: &[f64], y: &[f64]) -> PlateauFit {
    let first = x[0];
    let range = x[x.len() - 1] - first;
    let fit = |ln_tau: f64| {
        let tau = ln_tau.exp();
        let z: Vec<f64> = x.iter().map(|x| libm::exp((first - x) / tau)).collect();
        let (level, slope, sse) = regression(&z, y);
        PlateauFit {
            psi: first + tau * 20.0_f64.ln(),
            level,
            slope,
            sse,
        }
    };
    let steps = 60;
    let (low, high) = ((range / 200.0).ln(), (range * 20.0).ln());
    let at = |step: i32| low + (high - low) * f64::from(step) / f64::from(steps);
    let candidates: Vec<f64> = (1..steps)
        .map(|step| least(at(step - 1), at(step + 1), |ln_tau| fit(ln_tau).sse))
        .collect();
    best(&candidates, fit)
}

/// The straight line: `psi` is the last point, `level` its height there.
pub(crate) fn straight_line(x: &[f64], y: &[f64]) -> PlateauFit {
    fit_at(x, y, x[x.len() - 1], 1)
}

impl PlateauFit {
    /// The height of a plateau curve of this degree at `x`.
    pub(crate) fn at(&self, x: f64, degree: i32) -> f64 {
        self.level - self.slope * (self.psi - x).max(0.0).powi(degree)
    }

    /// The height of the exponential curve at `x`, which began at `first`.
    pub(crate) fn exponential_at(&self, x: f64, first: f64) -> f64 {
        let tau = (self.psi - first) / 20.0_f64.ln();
        self.level - self.slope * libm::exp((first - x) / tau)
    }
}

fn best(candidates: &[f64], fit: impl Fn(f64) -> PlateauFit) -> PlateauFit {
    let mut sorted = candidates.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut fits = sorted.into_iter().map(fit);
    let first = fits.next().unwrap_or(PlateauFit {
        psi: f64::NAN,
        level: f64::NAN,
        slope: f64::NAN,
        sse: f64::INFINITY,
    });
    fits.fold(first, |best, next| {
        if next.sse < best.sse * (1.0 - 1e-12) {
            next
        } else {
            best
        }
    })
}

fn fit_at(x: &[f64], y: &[f64], psi: f64, degree: i32) -> PlateauFit {
    let z: Vec<f64> = (x.iter())
        .map(|x| (psi - x).max(0.0).powi(degree))
        .collect();
    let (level, slope, sse) = regression(&z, y);
    PlateauFit {
        psi,
        level,
        slope,
        sse,
    }
}

/// y = level − slope z by least squares, and the sum of squared residuals.
fn regression(z: &[f64], y: &[f64]) -> (f64, f64, f64) {
    let (centre, height) = (mean(z), mean(y));
    let points = || z.iter().zip(y);
    let szy: f64 = points().map(|(z, y)| (z - centre) * (y - height)).sum();
    let szz: f64 = points().map(|(z, _)| (z - centre).powi(2)).sum();
    let slope = if szz > 0.0 { -szy / szz } else { 0.0 };
    let level = height + slope * centre;
    let sse = points().map(|(z, y)| (y - level + slope * z).powi(2)).sum();
    (level, slope, sse)
}

/// Where `f` is least between `low` and `high`, by golden section.
fn least(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    for _ in 0..60 {
        let step = golden * (high - low);
        if f(high - step) <= f(low + step) {
            high = low + step;
        } else {
            low = high - step;
        }
    }
    f64::midpoint(low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: [f64; 6] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0];

    #[test]
    fn a_curve_without_noise_is_found_again() {
        let truth = PlateauFit {
            psi: 34.0,
            level: 8.0,
            slope: 0.1,
            sse: 0.0,
        };
        let fit = linear_plateau(&X, &X.map(|x| truth.at(x, 1)));
        assert!((fit.psi - 34.0).abs() < 1e-10 && (fit.level - 8.0).abs() < 1e-12);
        let fit = quadratic_plateau(&X, &X.map(|x| truth.at(x, 2)));
        assert!((fit.psi - 34.0).abs() < 1e-5 && fit.sse < 1e-10, "{fit:?}");
        let fit = exponential(&X, &X.map(|x| 9.0 - 5.0 * (-(x - 10.0) / 13.0).exp()));
        assert!(
            (fit.psi - (10.0 + 13.0 * 20.0_f64.ln())).abs() < 1e-4,
            "{fit:?}"
        );
    }

    #[test]
    fn a_line_has_no_plateau_in_range() {
        let fit = linear_plateau(&X, &X);
        assert_eq!(fit.psi, 60.0);
        assert!(straight_line(&X, &X).sse < 1e-20);
    }

    #[test]
    fn the_exact_fit_is_no_worse_than_a_scan() {
        // The plain slow way: a psi every hundredth.
        let y = [3.0, 4.1, 4.0, 6.2, 5.9, 6.3];
        let scan = (2000..=6000)
            .map(|psi| fit_at(&X, &y, f64::from(psi) / 100.0, 1).sse)
            .fold(f64::INFINITY, f64::min);
        let fit = linear_plateau(&X, &y);
        assert!(fit.sse <= scan && scan - fit.sse < 1e-4, "{fit:?} {scan}");
    }

    #[test]
    fn running_sums_find_the_same_plateau() {
        use rand_chacha::rand_core::{Rng as _, SeedableRng as _};
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1966);
        let finder = PlateauFinder::new(&X);
        for case in 0..2000 {
            // Half of them of whole numbers, where ties are frequent.
            let y: Vec<f64> = (0..X.len())
                .map(|_| match case % 2 {
                    0 => f64::from(random.next_u32() % 5),
                    _ => f64::from(random.next_u32()) / 1e9,
                })
                .collect();
            let (slow, fast) = (linear_plateau(&X, &y), finder.psi(&y));
            let is_as_good = fit_at(&X, &y, fast, 1).sse <= slow.sse * (1.0 + 1e-9) + 1e-9;
            assert!(is_as_good, "{y:?}: {fast} and {slow:?}");
            assert!((slow.psi - fast).abs() < 1e-6, "{y:?}: {fast} and {slow:?}");
        }
    }
}
