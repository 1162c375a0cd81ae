//! Where a curve of means flattens: the level of a factor beyond which more does not help.
//!
//! The linear plateau of the mean curve, its interval by resampling whole subjects, and beside it a test that
//! supposes no shape: which levels are equivalent to the top one. "Not significantly different" is never taken
//! for "flat".

use nalgebra::DMatrix;
use protocols::InputError;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;
use serde::Serialize;

use crate::cell_matrix::CellMatrix;
use crate::chi_scale::normal_cdf;
use crate::factor_place::FactorPlace;
use crate::interval::{mean, standard_deviation};
use crate::permutation::below;
use crate::plateau::{
    PlateauFinder, PlateauFit, exponential, linear_plateau, quadratic_plateau, straight_line,
};
use crate::polynomial::scores_of_levels;
use crate::tail::{f_tail, t_quantile};

/// How an asymptote is sought.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AsymptoteSettings {
    /// The confidence level of the intervals.
    pub confidence: f64,
    /// How often the subjects are drawn again.
    pub n_resamples: u32,
    /// The seed of these draws.
    pub seed: u64,
    /// Ratings closer than this are equivalent.
    pub delta: f64,
}

/// Where the curves of one factor flatten, for each level of another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Asymptotes {
    /// The factor along which they run.
    pub factor: String,
    /// The factor whose levels have a curve each.
    pub by: Option<String>,
    /// The unit after the numbers of the levels, such as `K`.
    pub unit: String,
    /// How they were sought.
    pub settings: AsymptoteSettings,
    /// One for each curve.
    pub curves: Vec<Asymptote>,
    /// The first curve's plateau point less the second's, where there are two.
    pub difference: Option<Estimate>,
}

/// An estimate with the ends of its interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

/// What the search ended with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// A corner between the levels.
    InRange,
    /// The curve is flat from the second level on, or earlier.
    AtOrBelowSecondLevel,
    /// The curve rises to the last level: no plateau in range.
    NoPlateauInRange,
}

impl Outcome {
    /// Why the search stopped where it did.
    pub(crate) fn in_words(self) -> &'static str {
        match self {
            Self::InRange => "a corner between the levels",
            Self::AtOrBelowSecondLevel => "flat from the second level on, or earlier",
            Self::NoPlateauInRange => "rising to the last level: no plateau in range",
        }
    }
}

/// Where one curve flattens.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Asymptote {
    /// The level of the other factor whose curve it is; empty for the only one.
    pub level: String,
    /// How many subjects.
    pub n: usize,
    /// The levels as numbers.
    pub x: Vec<f64>,
    /// The mean at each.
    pub means: Vec<f64>,
    /// The linear plateau of the means.
    pub fit: PlateauFit,
    /// What the search ended with.
    pub outcome: Outcome,
    /// The plateau point with its interval over subjects.
    pub psi: Estimate,
    /// The share of the variance of the means that each shape explains, and its error of prediction.
    pub shapes: Vec<ShapeFit>,
    /// The lowest level that is equivalent to the top one, as all between are.
    pub lowest_equivalent: f64,
    /// The equivalence test of each level, from the last but one downward.
    pub equivalence: Vec<EquivalenceTest>,
}

/// How well one shape fits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapeFit {
    /// The shape.
    pub shape: &'static str,
    /// Where it flattens (95% of the way, for the exponential); `None` for the line.
    pub psi: Option<f64>,
    /// The sum of squared residuals of the means.
    pub sse: f64,
    /// The share of the variance of the means that it explains; `None` for equal means.
    pub r_squared: Option<f64>,
    /// The root mean square error for the ratings of a subject left out.
    pub left_out_rms: Option<f64>,
}

/// The test whether one level is equivalent to the top one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EquivalenceTest {
    /// The level.
    pub x: f64,
    /// The mean of the top level less that of this one.
    pub difference: f64,
    /// The larger p of the two one-sided tests.
    pub p: f64,
    /// Whether it and all levels above it are equivalent to the top one at .05.
    pub passed: bool,
}

impl Asymptotes {
    /// Seeks the plateau of `factor` for each level of `by`.
    ///
    /// The interval is the expanded percentile interval: of the plateau points of resampled subjects, the
    /// quantiles at Phi(−sqrt(n / (n − 1)) t) and one less that.
    ///
    /// # Source
    ///
    /// Hesterberg (2015), *Am. Stat.* 69, 371–386, for the interval; Schuirmann (1987), *J. Pharmacokinet.
    /// Biopharm.* 15, 657–680, for the two one-sided tests.
    ///
    /// # Errors
    ///
    /// Factors that the cells do not have, a factor between subjects, fewer than four levels or levels that are
    /// no numbers of one unit, a curve of fewer than three subjects.
    pub fn new(
        cells: &CellMatrix,
        factor: &str,
        by: Option<&str>,
        settings: AsymptoteSettings,
    ) -> Result<Self, InputError> {
        let sought = Sought::new(cells, factor, by)?;
        let resampled = sought.resampled(settings);
        let found: Vec<Asymptote> = (sought.curves.iter().zip(&resampled))
            .map(|(curve, resampled)| curve.asymptote(&sought.x, resampled, settings))
            .collect();
        let estimates: Vec<(usize, Estimate)> =
            found.iter().map(|curve| (curve.n, curve.psi)).collect();
        Ok(Self {
            factor: factor.to_owned(),
            by: by.map(str::to_owned),
            unit: sought.unit,
            difference: difference(&estimates, &resampled, settings.confidence),
            settings,
            curves: found,
        })
    }
}

/// The plateau points alone, without other shapes and equivalence tests.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PlateauPoints {
    /// The unit after the numbers of the levels.
    pub(crate) unit: String,
    /// The level whose curve it is, and its plateau point.
    pub(crate) curves: Vec<(String, Estimate)>,
    /// The first less the second, where there are two.
    pub(crate) difference: Option<Estimate>,
}

impl PlateauPoints {
    /// As [`Asymptotes::new`] finds them.
    pub(crate) fn new(
        cells: &CellMatrix,
        factor: &str,
        by: Option<&str>,
        settings: AsymptoteSettings,
    ) -> Result<Self, InputError> {
        let sought = Sought::new(cells, factor, by)?;
        let resampled = sought.resampled(settings);
        let estimates: Vec<(usize, Estimate)> = (sought.curves.iter().zip(&resampled))
            .map(|(curve, resampled)| {
                let value = linear_plateau(&sought.x, &curve.means()).psi;
                let psi = curve.with_interval(value, resampled, settings.confidence);
                (curve.ratings.nrows(), psi)
            })
            .collect();
        let difference = difference(&estimates, &resampled, settings.confidence);
        let levels = sought.curves.into_iter().map(|curve| curve.level);
        Ok(Self {
            unit: sought.unit,
            curves: levels
                .zip(estimates.into_iter().map(|(_, psi)| psi))
                .collect(),
            difference,
        })
    }
}

/// Curves whose asymptote is sought.
struct Sought {
    /// The levels as numbers.
    x: Vec<f64>,
    unit: String,
    curves: Vec<Curve>,
    /// Whether the curves are of the same subjects.
    is_paired: bool,
}

impl Sought {
    fn new(cells: &CellMatrix, factor: &str, by: Option<&str>) -> Result<Self, InputError> {
        let place = FactorPlace::find(cells, factor)?;
        let levels = place.levels(cells);
        let scores =
            scores_of_levels(levels).filter(|scores| scores.len() >= 4 && place.is_within());
        let Some(x) = scores else {
            return Err(FactorPlace::error(
                cells,
                format!("the factor {factor} with the levels {}", levels.join(", ")),
                "a within factor with at least four levels that are numbers of one unit, to seek an asymptote",
            ));
        };
        let unit = levels[0].trim_start_matches(|c: char| c.is_ascii_digit() || ".+-".contains(c));
        let curves = curves(cells, place, by)?;
        if let Some(curve) = curves.iter().find(|curve| curve.ratings.nrows() < 3) {
            let found = format!("{} subjects for a curve", curve.ratings.nrows());
            return Err(FactorPlace::error(
                cells,
                found,
                "at least three, to seek an asymptote",
            ));
        }
        Ok(Self {
            x,
            unit: unit.to_owned(),
            curves,
            is_paired: by.is_none_or(|by| cells.within.iter().any(|factor| factor.name == by)),
        })
    }

    /// For each curve the plateau points of subjects drawn again.
    fn resampled(&self, settings: AsymptoteSettings) -> Vec<Vec<f64>> {
        (self.curves.iter().enumerate())
            .map(|(index, curve)| {
                let mut random = ChaCha8Rng::seed_from_u64(settings.seed);
                // Curves of the same subjects share their draws.
                random.set_stream(if self.is_paired { 0 } else { index as u64 });
                curve.resampled_psi(&self.x, settings.n_resamples, &mut random)
            })
            .collect()
    }
}

/// The first plateau point less the second; each estimate stands with its number of subjects.
fn difference(
    found: &[(usize, Estimate)],
    resampled: &[Vec<f64>],
    confidence: f64,
) -> Option<Estimate> {
    let ([first, second], [of_first, of_second]) = (found, resampled) else {
        return None;
    };
    let differences: Vec<f64> = of_first.iter().zip(of_second).map(|(a, b)| a - b).collect();
    let n = first.0.min(second.0);
    let [low, high] = expanded_percentile_interval(&differences, n, confidence);
    Some(Estimate {
        value: first.1.value - second.1.value,
        low,
        high,
    })
}

/// The ratings of one curve: subjects × levels.
struct Curve {
    level: String,
    ratings: DMatrix<f64>,
}

fn curves(
    cells: &CellMatrix,
    factor: FactorPlace,
    by: Option<&str>,
) -> Result<Vec<Curve>, InputError> {
    let along = |cells: &CellMatrix, factor: FactorPlace| {
        let n_levels = factor.levels(cells).len();
        let mut ratings = DMatrix::zeros(cells.subjects.len(), n_levels);
        for level in 0..n_levels {
            let mut weights = vec![0.0; n_levels];
            weights[level] = 1.0;
            let weights = factor.weights(cells, &weights).cells;
            ratings.set_column(level, &(&cells.scores * weights));
        }
        ratings
    };
    let Some(by) = by else {
        return Ok(vec![Curve {
            level: String::new(),
            ratings: along(cells, factor),
        }]);
    };
    let name = factor.name(cells);
    let by = FactorPlace::find(cells, by)?;
    (by.levels(cells).iter().enumerate())
        .map(|(place, level)| {
            let part = by.restricted(cells, place);
            let factor = FactorPlace::find(&part, name)?;
            Ok(Curve {
                level: level.clone(),
                ratings: along(&part, factor),
            })
        })
        .collect()
}

impl Curve {
    fn means(&self) -> Vec<f64> {
        self.ratings.row_mean().iter().copied().collect()
    }

    /// The plateau points of the mean curves of subjects drawn again.
    fn resampled_psi(&self, x: &[f64], n_resamples: u32, random: &mut ChaCha8Rng) -> Vec<f64> {
        let n = self.ratings.nrows();
        let by_subject = self.ratings.transpose();
        let finder = PlateauFinder::new(x);
        let mut means = vec![0.0; x.len()];
        (0..n_resamples)
            .map(|_| {
                means.fill(0.0);
                for _ in 0..n {
                    let drawn = by_subject.column(below(random, n));
                    for (mean, rating) in means.iter_mut().zip(drawn.iter()) {
                        *mean += rating;
                    }
                }
                for mean in &mut means {
                    *mean /= n as f64;
                }
                finder.psi(&means)
            })
            .collect()
    }

    /// A plateau point with its interval by the plateau points of subjects drawn again.
    fn with_interval(&self, value: f64, resampled: &[f64], confidence: f64) -> Estimate {
        let n = self.ratings.nrows();
        let [low, high] = expanded_percentile_interval(resampled, n, confidence);
        Estimate { value, low, high }
    }

    fn asymptote(&self, x: &[f64], resampled: &[f64], settings: AsymptoteSettings) -> Asymptote {
        let means = self.means();
        let fit = linear_plateau(x, &means);
        let equivalence = self.equivalence(x, settings.delta);
        let lowest = equivalence.iter().rfind(|test| test.passed);
        Asymptote {
            level: self.level.clone(),
            n: self.ratings.nrows(),
            x: x.to_vec(),
            outcome: match fit.psi {
                psi if psi <= x[1] => Outcome::AtOrBelowSecondLevel,
                psi if psi >= x[x.len() - 1] => Outcome::NoPlateauInRange,
                _ => Outcome::InRange,
            },
            psi: self.with_interval(fit.psi, resampled, settings.confidence),
            shapes: self.shapes(x, &means),
            means,
            fit,
            lowest_equivalent: lowest.map_or(x[x.len() - 1], |test| test.x),
            equivalence,
        }
    }

    /// Two one-sided paired tests of each level against the top one, from above, until the first fails.
    fn equivalence(&self, x: &[f64], delta: f64) -> Vec<EquivalenceTest> {
        let top = x.len() - 1;
        let n = self.ratings.nrows() as f64;
        let mut passed = true;
        let mut tests = Vec::new();
        for level in (0..top).rev() {
            let differences: Vec<f64> = (self.ratings.row_iter())
                .map(|row| row[top] - row[level])
                .collect();
            let difference = mean(&differences);
            let se = standard_deviation(&differences).unwrap_or(0.0) / n.sqrt();
            let p = if se > 1e-12 * (delta + difference.abs()) {
                let above = upper_t_tail((difference + delta) / se, n - 1.0);
                let below = upper_t_tail((delta - difference) / se, n - 1.0);
                above.max(below)
            } else {
                f64::from(u8::from(difference.abs() >= delta))
            };
            passed &= p < 0.05;
            tests.push(EquivalenceTest {
                x: x[level],
                difference,
                p,
                passed,
            });
        }
        tests
    }

    fn shapes(&self, x: &[f64], means: &[f64]) -> Vec<ShapeFit> {
        let centre = mean(means);
        let total: f64 = means.iter().map(|mean| (mean - centre).powi(2)).sum();
        SHAPES
            .iter()
            .map(|shape| {
                let fit = (shape.fit)(x, means);
                ShapeFit {
                    shape: shape.name,
                    psi: shape.flattens.then_some(fit.psi),
                    sse: fit.sse,
                    r_squared: (total > 1e-12 * centre.abs()).then(|| 1.0 - fit.sse / total),
                    left_out_rms: self.left_out_rms(x, shape),
                }
            })
            .collect()
    }

    /// The error of a shape fitted without one subject for the ratings of that subject, over all subjects.
    fn left_out_rms(&self, x: &[f64], shape: &Shape) -> Option<f64> {
        let n = self.ratings.nrows();
        let sums: Vec<f64> = self.ratings.row_sum().iter().copied().collect();
        let mut squares = 0.0;
        for row in self.ratings.row_iter() {
            let others: Vec<f64> = (sums.iter().zip(row.iter()))
                .map(|(sum, rating)| (sum - rating) / (n as f64 - 1.0))
                .collect();
            let fit = (shape.fit)(x, &others);
            let errors = x.iter().zip(row.iter());
            squares += errors
                .map(|(&at, rating)| (rating - (shape.height)(&fit, at, x[0])).powi(2))
                .sum::<f64>();
        }
        let rms = (squares / self.ratings.len() as f64).sqrt();
        rms.is_finite().then_some(rms)
    }
}

/// A shape that a curve may have.
struct Shape {
    name: &'static str,
    flattens: bool,
    fit: fn(&[f64], &[f64]) -> PlateauFit,
    /// The height of a fit at a place, given the first place.
    height: fn(&PlateauFit, f64, f64) -> f64,
}

const SHAPES: [Shape; 4] = [
    Shape {
        name: "line",
        flattens: false,
        fit: straight_line,
        height: |fit, x, _| fit.level - fit.slope * (fit.psi - x),
    },
    Shape {
        name: "linear plateau",
        flattens: true,
        fit: linear_plateau,
        height: |fit, x, _| fit.at(x, 1),
    },
    Shape {
        name: "quadratic plateau",
        flattens: true,
        fit: quadratic_plateau,
        height: |fit, x, _| fit.at(x, 2),
    },
    Shape {
        name: "exponential",
        flattens: true,
        fit: exponential,
        height: PlateauFit::exponential_at,
    },
];

/// P(T > t) for Student's *t*.
fn upper_t_tail(t: f64, df: f64) -> f64 {
    let half = f_tail(t * t, 1.0, df) / 2.0;
    if t >= 0.0 { half } else { 1.0 - half }
}

/// The expanded percentile interval of an estimate from `n` subjects: quantiles further out than the percentile
/// interval's, by the factor sqrt(n / (n − 1)) and *t* in place of the normal.
pub fn expanded_percentile_interval(resampled: &[f64], n: usize, confidence: f64) -> [f64; 2] {
    let n = n as f64;
    let t = t_quantile((1.0 - confidence) / 2.0, n - 1.0);
    let side = normal_cdf(-(n / (n - 1.0)).sqrt() * t);
    let mut sorted = resampled.to_vec();
    sorted.sort_by(f64::total_cmp);
    [side, 1.0 - side].map(|share| quantile(&sorted, share))
}

/// The quantile of sorted values, linear between them (type 7 of Hyndman & Fan 1996).
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() as f64 - 1.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the number of values"
    )]
    let below = place.floor() as usize;
    let above = (below + 1).min(sorted.len() - 1);
    (sorted[above] - sorted[below]).mul_add(place - place.floor(), sorted[below])
}
