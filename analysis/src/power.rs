//! The power of a study that is planned: simulated studies of so many subjects, each analysed as the protocol says.
//!
//! Counted are the studies in which an effect is significant under the protocol's correction, those in which a simple
//! effect is after Holm, and how wide the interval of each asymptote comes out.
//!
//! The same seed gives the same numbers on any number of threads. Study *k* of 8 subjects has the first 8 subjects of
//! study *k* of 12, so that neighbouring points differ by the subjects added and not by chance alone.
//!
//! Not here: who rates (`rate`, which the caller brings), and how the result is printed and drawn.

use std::sync::atomic::{AtomicU64, Ordering};

use protocols::{FollowUpPlan, InputError};
use rayon::prelude::*;
use serde::Serialize;

use crate::apa::LeadingTest;
use crate::asymptote::PlateauPoints;
use crate::interval::{mean, standard_deviation};
use crate::power_design::PowerDesign;
use crate::{AsymptoteSettings, Estimate, FollowUp, FollowUpSettings, anova};

/// The normal quantile of a two-sided 95% interval.
const Z95: f64 = 1.959_963_984_540_054;

/// What is simulated.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PowerSettings {
    /// Numbers of subjects, rising.
    pub subjects: Vec<u32>,
    /// Studies for each number of subjects.
    pub n_studies: u32,
    /// The level of significance.
    pub alpha: f64,
    /// The power that is wanted.
    pub target: f64,
    /// How often the subjects of a study are drawn again for the interval of an asymptote.
    pub n_resamples: u32,
    /// The seed of these draws.
    pub seed: u64,
}

/// The power of a study, by its number of subjects.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Power {
    /// What was simulated.
    pub settings: PowerSettings,
    /// One for each number of subjects.
    pub points: Vec<PowerPoint>,
}

/// The power with one number of subjects.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PowerPoint {
    /// How many subjects.
    pub subjects: u32,
    /// The effects of the analysis of variance.
    pub effects: Vec<EffectPower>,
    /// The simple effects that the protocol asks for, after Holm within their family.
    pub simple_effects: Vec<EffectPower>,
    /// The asymptotes that the protocol asks for, and their difference.
    pub asymptotes: Vec<AsymptoteWidth>,
}

/// How often an effect was significant.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EffectPower {
    /// The effect.
    pub effect: String,
    /// The share of the studies in which it was.
    pub power: f64,
    /// The lower end of the 95% interval of that share (Wilson 1927).
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

/// How well an asymptote would be known.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AsymptoteWidth {
    /// The curve, or `difference`.
    pub curve: String,
    /// The unit after the numbers.
    pub unit: String,
    /// The mean estimate.
    pub estimate: f64,
    /// The standard deviation of the estimates.
    pub sd: f64,
    /// The mean width of the interval.
    pub width: f64,
}

/// What one simulated study shows.
#[derive(Debug)]
struct Outcome {
    effects: Vec<(String, bool)>,
    simple_effects: Vec<(String, bool)>,
    asymptotes: Vec<(String, Estimate)>,
    unit: String,
}

/// Lets `rate` rate `settings.n_studies` studies of each number of subjects, and analyses each as `design` says.
///
/// `rate` is given the number of the study and of the subject, each from 0, and gives one rating for each of
/// [`PowerDesign::images`]; the same numbers must give the same ratings. `progress` is told how many studies of how
/// many are done.
///
/// # Errors
///
/// Fewer subjects than the design needs, or follow-ups of factors and levels that it does not have.
pub fn power(
    design: &PowerDesign,
    settings: &PowerSettings,
    rate: &(dyn Fn(u64, u32) -> Vec<f64> + Sync),
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<Power, InputError> {
    let total = settings.subjects.len() as u64 * u64::from(settings.n_studies);
    let done = AtomicU64::new(0);
    let points = (settings.subjects.iter())
        .map(|&subjects| {
            let outcomes: Vec<Outcome> = (0..u64::from(settings.n_studies))
                .into_par_iter()
                .map(|study| {
                    let outcome =
                        outcome(design, settings, subjects, &|subject| rate(study, subject));
                    progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
                    outcome
                })
                .collect::<Result<_, _>>()?;
            Ok(PowerPoint::new(subjects, &outcomes))
        })
        .collect::<Result<_, InputError>>()?;
    Ok(Power {
        settings: settings.clone(),
        points,
    })
}

/// One study, rated and analysed.
fn outcome(
    design: &PowerDesign,
    settings: &PowerSettings,
    subjects: u32,
    rate: &dyn Fn(u32) -> Vec<f64>,
) -> Result<Outcome, InputError> {
    let plan = &design.plan;
    let cells = design.rated(subjects, rate);
    let is_significant = |p: Option<f64>| p.is_some_and(|p| p < settings.alpha);
    let table = anova(&cells, &[], plan.sums_of_squares);
    let effects = (table.effects.iter())
        .map(|row| {
            let p = LeadingTest::new(row, plan.correction).map(|test| test.p);
            // Without error, any effect is certain.
            let is_certain = row.ss_error == 0.0 && row.ss_effect > 0.0;
            (row.effect.clone(), is_certain || is_significant(p))
        })
        .collect();
    let follow_up_settings = FollowUpSettings {
        confidence: plan.confidence,
        sums_of_squares: plan.sums_of_squares,
    };
    let mut simple_effects = Vec::new();
    for asked in &plan.follow_ups {
        if let FollowUpPlan::SimpleEffects { factor, at } = asked {
            let family = FollowUp::new(asked, &cells, follow_up_settings)?;
            simple_effects.extend(family.simple_effects.into_iter().map(|one| {
                (
                    format!("{factor} at {at} {}", one.at),
                    is_significant(one.p_holm),
                )
            }));
        }
    }
    let mut asymptotes = Vec::new();
    let mut unit = String::new();
    if let Some(asked) = &plan.asymptote {
        let asymptote_settings = AsymptoteSettings {
            confidence: plan.confidence,
            n_resamples: settings.n_resamples,
            seed: settings.seed,
            delta: asked.delta,
        };
        let points = PlateauPoints::new(
            &cells,
            &asked.factor,
            asked.by.as_deref(),
            asymptote_settings,
        )?;
        unit = points.unit;
        asymptotes = points.curves;
        asymptotes.extend(points.difference.map(|one| ("difference".to_owned(), one)));
    }
    Ok(Outcome {
        effects,
        simple_effects,
        asymptotes,
        unit,
    })
}

impl PowerPoint {
    fn new(subjects: u32, outcomes: &[Outcome]) -> Self {
        let Some(first) = outcomes.first() else {
            return Self {
                subjects,
                effects: Vec::new(),
                simple_effects: Vec::new(),
                asymptotes: Vec::new(),
            };
        };
        let asymptote = |(place, (curve, _)): (usize, &(String, Estimate))| {
            let of = |number: fn(&Estimate) -> f64| -> Vec<f64> {
                let estimates = outcomes.iter().filter_map(|one| one.asymptotes.get(place));
                estimates.map(|(_, estimate)| number(estimate)).collect()
            };
            let values = of(|estimate| estimate.value);
            AsymptoteWidth {
                curve: curve.clone(),
                unit: first.unit.clone(),
                estimate: mean(&values),
                sd: standard_deviation(&values).unwrap_or(0.0),
                width: mean(&of(|estimate| estimate.high - estimate.low)),
            }
        };
        Self {
            subjects,
            effects: shares(outcomes, |outcome| &outcome.effects),
            simple_effects: shares(outcomes, |outcome| &outcome.simple_effects),
            asymptotes: first.asymptotes.iter().enumerate().map(asymptote).collect(),
        }
    }
}

/// How often each of the same tests was significant. A simple effect that a study could not test counts as not found.
fn shares(outcomes: &[Outcome], of: fn(&Outcome) -> &Vec<(String, bool)>) -> Vec<EffectPower> {
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in outcomes.iter().flat_map(of) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let power_of = |name: &String| {
        let found = |outcome: &&Outcome| of(outcome).iter().any(|(one, is)| one == name && *is);
        EffectPower::new(name, outcomes.iter().filter(found).count(), outcomes.len())
    };
    names.into_iter().map(power_of).collect()
}

impl EffectPower {
    /// With *k* of *n* studies, the share and its interval by Wilson's score:
    ///
    /// ```text
    /// (k + z^2 / 2 ± z sqrt(k (n - k) / n + z^2 / 4)) / (n + z^2)
    /// ```
    fn new(effect: &str, k: usize, n: usize) -> Self {
        let (k, n, square) = (k as f64, n as f64, Z95 * Z95);
        let half = Z95 * (k * (n - k) / n + square / 4.0).sqrt();
        Self {
            effect: effect.to_owned(),
            power: k / n,
            low: ((k + square / 2.0 - half) / (n + square)).max(0.0),
            high: ((k + square / 2.0 + half) / (n + square)).min(1.0),
        }
    }
}

impl Power {
    /// For each effect, the fewest subjects from which on its power stays at the target; `None` if it does not get there.
    pub fn subjects_needed(&self) -> Vec<(String, Option<u32>)> {
        let of = |list: fn(&PowerPoint) -> &Vec<EffectPower>| -> Vec<(String, Option<u32>)> {
            let names = self.points.first().map(list).into_iter().flatten();
            let needed = |one: &EffectPower| {
                let power = |point: &PowerPoint| {
                    let found = list(point).iter().find(|other| other.effect == one.effect);
                    found.map_or(0.0, |found| found.power)
                };
                let reaches = |point: &&PowerPoint| power(point) >= self.settings.target;
                let last = self.points.iter().rev().take_while(reaches).last();
                (one.effect.clone(), last.map(|point| point.subjects))
            };
            names.map(needed).collect()
        };
        let mut needed = of(|point| &point.effects);
        needed.extend(of(|point| &point.simple_effects));
        needed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_share_is_wilsons() {
        // R 4.2.2: prop.test(81, 263, correct = FALSE)$conf.int, the example of Newcombe (1998), and prop.test(0, 20).
        let power = EffectPower::new("one", 81, 263);
        assert!(
            (power.low - 0.255_289).abs() < 1e-6 && (power.high - 0.366_210).abs() < 1e-6,
            "{power:?}"
        );
        let none = EffectPower::new("none", 0, 20);
        assert!(
            none.low == 0.0 && (none.high - 0.161_125).abs() < 1e-6,
            "{none:?}"
        );
    }
}
