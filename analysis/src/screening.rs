//! Observers: mean opinions, who rates unlike the others, and models of bias and inconsistency.
//!
//! Both screens of the ITU are computed and reported; neither is applied here.
//!
//! Sources: ITU-R BT.500-14 and BT.1788, ITU-T P.913 section 12.4 and P.910 Annex E; Li, Bampis, Janowski &
//! Katsavounidis (2020), "A simple model for subject behavior in subjective experiments"; Shrout & Fleiss (1979),
//! *Psychol. Bull.* 86, 420–428.

use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF as _};

use crate::interval::{mean, standard_deviation};
use crate::tail::t_quantile;

/// The mean opinion of one image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Opinion {
    /// How many rated it.
    pub n: usize,
    /// The mean opinion score.
    pub mean: f64,
    /// The sample standard deviation.
    pub sd: f64,
    /// Half the width of the 95% interval as BT.500 has it: 1.96 sd / sqrt(n).
    pub half_bt500: f64,
    /// The same with *t* for 1.96: right with few observers.
    pub half_t: f64,
}

/// One observer beside the others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Observer {
    /// The subject.
    pub subject: String,
    /// How often its rating lay far above the mean (P of BT.500).
    pub n_above: u32,
    /// How often far below (Q).
    pub n_below: u32,
    /// Whether BT.500 would reject it.
    pub is_rejected_by_bt500: bool,
    /// The smaller of Pearson's and Spearman's correlation with the mean opinions; `None` for constant ratings.
    pub correlation: Option<f64>,
    /// Whether BT.1788 would reject it; constant ratings are rejected.
    pub is_rejected_by_bt1788: bool,
    /// The mean by which it rates above the mean opinion (P.913).
    pub bias: f64,
}

/// The model of P.910 Annex E: rating = quality of the image + bias of the observer + its inconsistency × noise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObserverModel {
    /// The quality of each image.
    pub quality: Vec<f64>,
    /// Half the width of its 95% interval.
    pub quality_half: Vec<f64>,
    /// The bias of each observer.
    pub bias: Vec<f64>,
    /// Half the width of its 95% interval.
    pub bias_half: Vec<f64>,
    /// The inconsistency of each observer.
    pub inconsistency: Vec<f64>,
    /// The ends of its 95% interval.
    pub inconsistency_ends: Vec<[f64; 2]>,
}

/// How far ratings of the same image agree.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct IntraclassCorrelation {
    /// ICC(2,1): of one observer, in absolute value.
    pub single: f64,
    /// ICC(2,k): of the mean of all observers.
    pub of_mean: f64,
    /// ICC(3,1): of one observer, up to a bias of its own.
    pub single_consistency: f64,
}

/// All observers of a study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObserverScreening {
    /// The mean opinion of each image.
    pub opinions: Vec<Opinion>,
    /// Each observer.
    pub observers: Vec<Observer>,
    /// The correlation below which BT.1788 rejects.
    pub correlation_threshold: Option<f64>,
    /// The model of bias and inconsistency.
    pub model: ObserverModel,
    /// The agreement; `None` with missing ratings or without variance.
    pub intraclass: Option<IntraclassCorrelation>,
}

/// Images × observers.
type Ratings = [Vec<Option<f64>>];

impl ObserverScreening {
    /// Screens observers by their ratings, image by image; `criterion` is the maximum correlation threshold of
    /// BT.1788: 0.85 for DSCQS and SAMVIQ, 0.7 for single stimuli and DSIS.
    ///
    /// ```text
    /// BT.500   k = 2 if 2 <= m4 / m2^2 <= 4, else sqrt 20; above if u >= mean + k S, below if u <= mean - k S;
    ///          rejected if (P + Q) / images > .05 and |P - Q| / (P + Q) < .3
    /// BT.1788  r = min(Pearson, Spearman); rejected if r <= the criterion, or mean r - SD r where that is lower
    /// ```
    ///
    /// An image that all rated alike says nothing of anyone and is passed over.
    pub fn new(subjects: Vec<String>, ratings: &Ratings, criterion: f64) -> Self {
        let opinions: Vec<Opinion> = ratings.iter().map(|row| opinion(row)).collect();
        let counts = bt500_counts(ratings, &opinions, subjects.len());
        let correlations: Vec<Option<f64>> = (0..subjects.len())
            .map(|observer| correlation_with_opinions(ratings, &opinions, observer))
            .collect();
        let present: Vec<f64> = correlations.iter().copied().flatten().collect();
        let correlation_threshold =
            standard_deviation(&present).map(|sd| (mean(&present) - sd).min(criterion));
        let observers = (subjects.into_iter().enumerate())
            .map(|(index, subject)| {
                let [n_above, n_below] = counts[index];
                let own: Vec<f64> = (ratings.iter().zip(&opinions))
                    .filter_map(|(row, opinion)| row[index].map(|rating| rating - opinion.mean))
                    .collect();
                Observer {
                    subject,
                    n_above,
                    n_below,
                    is_rejected_by_bt500: is_rejected_by_bt500(n_above, n_below, own.len()),
                    correlation: correlations[index],
                    is_rejected_by_bt1788: correlations[index].is_none_or(|r| {
                        correlation_threshold.is_some_and(|threshold| r <= threshold)
                    }),
                    bias: mean(&own),
                }
            })
            .collect();
        Self {
            model: ObserverModel::new(ratings, &opinions),
            intraclass: intraclass(ratings),
            opinions,
            observers,
            correlation_threshold,
        }
    }
}

fn opinion(row: &[Option<f64>]) -> Opinion {
    let present: Vec<f64> = row.iter().copied().flatten().collect();
    let n = present.len() as f64;
    let sd = standard_deviation(&present).unwrap_or(0.0);
    Opinion {
        n: present.len(),
        mean: mean(&present),
        sd,
        half_bt500: 1.96 * sd / n.sqrt(),
        half_t: if n > 1.0 {
            t_quantile(0.025, n - 1.0) * sd / n.sqrt()
        } else {
            0.0
        },
    }
}

fn bt500_counts(ratings: &Ratings, opinions: &[Opinion], n_observers: usize) -> Vec<[u32; 2]> {
    let mut counts = vec![[0, 0]; n_observers];
    for (row, opinion) in ratings.iter().zip(opinions) {
        let moment = |power: i32| {
            let powers = row.iter().flatten().map(|u| (u - opinion.mean).powi(power));
            powers.sum::<f64>() / opinion.n as f64
        };
        if opinion.sd <= 0.0 {
            continue;
        }
        let kurtosis = moment(4) / moment(2).powi(2);
        let k = if (2.0..=4.0).contains(&kurtosis) {
            2.0
        } else {
            20.0_f64.sqrt()
        };
        for (count, rating) in counts.iter_mut().zip(row) {
            if let Some(u) = rating {
                count[0] += u32::from(*u >= opinion.mean + k * opinion.sd);
                count[1] += u32::from(*u <= opinion.mean - k * opinion.sd);
            }
        }
    }
    counts
}

fn is_rejected_by_bt500(n_above: u32, n_below: u32, n_images: usize) -> bool {
    let both = f64::from(n_above + n_below);
    both / n_images as f64 > 0.05 && f64::from(n_above.abs_diff(n_below)) / both < 0.3
}

fn correlation_with_opinions(
    ratings: &Ratings,
    opinions: &[Opinion],
    observer: usize,
) -> Option<f64> {
    let (own, others): (Vec<f64>, Vec<f64>) = (ratings.iter().zip(opinions))
        .filter_map(|(row, opinion)| Some((row[observer]?, opinion.mean)))
        .unzip();
    let ranks = |values: &[f64]| crate::ranks::midranks(values).0;
    let pearson = correlation(&own, &others)?;
    Some(pearson.min(correlation(&ranks(&own), &ranks(&others))?))
}

/// Pearson's correlation; `None` where one side is constant.
pub(crate) fn correlation(left: &[f64], right: &[f64]) -> Option<f64> {
    let (centre, other) = (mean(left), mean(right));
    let sum = |f: fn(f64, f64) -> f64| -> f64 {
        left.iter()
            .zip(right)
            .map(|(l, r)| f(l - centre, r - other))
            .sum()
    };
    let scale = (sum(|l, _| l * l) * sum(|_, r| r * r)).sqrt();
    (scale > 1e-12 * centre.abs().max(1.0)).then(|| sum(|l, r| l * r) / scale)
}

impl ObserverModel {
    /// Alternating projection, as P.910 Annex E has it, from mean opinions and biases.
    ///
    /// ```text
    /// e = u - quality - bias,   inconsistency_i = SD_i e (population)
    /// quality_j = sum w_i (u - bias_i) / sum w_i,   w_i = 1 / (inconsistency_i^2 + 1e-8)
    /// bias_i = mean_j (u - quality_j);  until quality moves by less than 1e-8, at most 1000 rounds
    /// ```
    fn new(ratings: &Ratings, opinions: &[Opinion]) -> Self {
        let n_observers = ratings.first().map_or(0, Vec::len);
        let mut quality: Vec<f64> = opinions.iter().map(|opinion| opinion.mean).collect();
        let mut bias = biases(ratings, &quality, n_observers);
        let mut inconsistency = vec![0.0; n_observers];
        for _ in 0..1000 {
            inconsistency = inconsistencies(ratings, &quality, &bias);
            let weights: Vec<f64> = (inconsistency.iter())
                .map(|sd| (sd * sd + 1e-8).recip())
                .collect();
            let next: Vec<f64> = (ratings.iter())
                .map(|row| weighted_mean(row, &bias, &weights))
                .collect();
            let moved: f64 = next
                .iter()
                .zip(&quality)
                .map(|(a, b)| (a - b).powi(2))
                .sum();
            quality = next;
            bias = biases(ratings, &quality, n_observers);
            if moved.sqrt() < 1e-8 {
                break;
            }
        }
        let shift = mean(&bias);
        for value in &mut bias {
            *value -= shift;
        }
        for value in &mut quality {
            *value += shift;
        }
        Self::with_intervals(ratings, quality, bias, inconsistency)
    }

    fn with_intervals(
        ratings: &Ratings,
        quality: Vec<f64>,
        bias: Vec<f64>,
        inconsistency: Vec<f64>,
    ) -> Self {
        let quality_half = (ratings.iter())
            .map(|row| {
                let present = row.iter().zip(&inconsistency).filter(|(u, _)| u.is_some());
                let information: f64 = present.map(|(_, sd)| (sd * sd).recip()).sum();
                1.96 / information.sqrt()
            })
            .collect();
        let n_rated =
            |observer: usize| ratings.iter().filter(|row| row[observer].is_some()).count() as f64;
        let halves = inconsistency.iter().enumerate();
        let bias_half = halves
            .map(|(i, sd)| 1.96 * sd / n_rated(i).sqrt())
            .collect();
        let ends = |observer: usize, sd: f64| {
            let n = n_rated(observer);
            ChiSquared::new(n).map_or([f64::NAN; 2], |law| {
                [0.975, 0.025].map(|share| (n / law.inverse_cdf(share)).sqrt() * sd)
            })
        };
        let inconsistency_ends = (inconsistency.iter().enumerate())
            .map(|(observer, &sd)| ends(observer, sd))
            .collect();
        Self {
            quality,
            quality_half,
            bias,
            bias_half,
            inconsistency,
            inconsistency_ends,
        }
    }
}

fn biases(ratings: &Ratings, quality: &[f64], n_observers: usize) -> Vec<f64> {
    (0..n_observers)
        .map(|observer| {
            let own: Vec<f64> = (ratings.iter().zip(quality))
                .filter_map(|(row, quality)| row[observer].map(|u| u - quality))
                .collect();
            mean(&own)
        })
        .collect()
}

fn inconsistencies(ratings: &Ratings, quality: &[f64], bias: &[f64]) -> Vec<f64> {
    (bias.iter().enumerate())
        .map(|(observer, bias)| {
            let errors: Vec<f64> = (ratings.iter().zip(quality))
                .filter_map(|(row, quality)| row[observer].map(|u| u - quality - bias))
                .collect();
            let centre = mean(&errors);
            let squares: Vec<f64> = errors.iter().map(|e| (e - centre).powi(2)).collect();
            mean(&squares).sqrt()
        })
        .collect()
}

fn weighted_mean(row: &[Option<f64>], bias: &[f64], weights: &[f64]) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for ((rating, bias), weight) in row.iter().zip(bias).zip(weights) {
        if let Some(u) = rating {
            sum += weight * (u - bias);
            total += weight;
        }
    }
    sum / total
}

/// Two-way random effects, by the mean squares of images, observers and the rest.
fn intraclass(ratings: &Ratings) -> Option<IntraclassCorrelation> {
    let rows: Vec<Vec<f64>> = (ratings.iter())
        .map(|row| row.iter().copied().collect::<Option<Vec<f64>>>())
        .collect::<Option<_>>()?;
    let (n, k) = (rows.len() as f64, rows.first()?.len() as f64);
    let all: Vec<f64> = rows.concat();
    let centre = mean(&all);
    let total: f64 = all.iter().map(|u| (u - centre).powi(2)).sum();
    let of_images: f64 = rows
        .iter()
        .map(|row| k * (mean(row) - centre).powi(2))
        .sum();
    let of_observers: f64 = (0..rows[0].len())
        .map(|observer| {
            let column: Vec<f64> = rows.iter().map(|row| row[observer]).collect();
            n * (mean(&column) - centre).powi(2)
        })
        .sum();
    let images = of_images / (n - 1.0);
    let observers = of_observers / (k - 1.0);
    let rest = (total - of_images - of_observers).max(0.0) / ((n - 1.0) * (k - 1.0));
    let scale = images + (k - 1.0) * rest + k * (observers - rest) / n;
    (n > 1.0 && k > 1.0 && scale > 0.0).then(|| IntraclassCorrelation {
        single: (images - rest) / scale,
        of_mean: (images - rest) / (images + (observers - rest) / n),
        single_consistency: (images - rest) / (images + (k - 1.0) * rest),
    })
}
