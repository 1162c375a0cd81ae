//! What a report says in words: the key result, the sphericity, the degrees of freedom that were printed.
//!
//! Every sentence is chosen by the numbers; none is written in advance.

use std::fmt::Write as _;

use protocols::{ChannelGroup, Correction, PublishedEffect, Study};

use crate::apa::{self, LeadingTest};
use crate::study_analysis::{Difference, StudyAnalysis};
use crate::{AnovaTable, EffectRow};

/// The key result, a paragraph for each thought, in HTML.
pub(crate) fn key_result(study: &Study, analysis: &StudyAnalysis) -> Vec<String> {
    let words = Words { study, analysis };
    [
        words.of_channel(),
        words.of_rays_and_interaction(),
        words.of_each_ray_count(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

struct Words<'a> {
    study: &'a Study,
    analysis: &'a StudyAnalysis,
}

impl Words<'_> {
    fn correction(&self) -> Correction {
        self.study.protocol.analysis.correction
    }

    fn alpha(&self) -> f64 {
        1.0 - self.study.protocol.analysis.confidence
    }

    fn is_significant(&self, row: &EffectRow) -> bool {
        LeadingTest::new(row, self.correction()).is_some_and(|test| test.p < self.alpha())
    }

    fn test(&self, row: &EffectRow) -> String {
        apa::f_test(row, self.correction())
    }

    fn of_channel(&self) -> Option<String> {
        let row = self.analysis.anova.effect("channel")?;
        let test = self.test(row);
        let Some(difference) = &self.analysis.overall_difference else {
            return Some(if self.is_significant(row) {
                format!("Which channels were reduced changed the ratings: {test}.")
            } else {
                format!(
                    "Which channels were reduced made no significant difference to the ratings: {test}."
                )
            });
        };
        let interval = interval(difference, self.study.protocol.analysis.confidence);
        let size = apa::signed(difference.mean.abs(), 2);
        Some(if !self.is_significant(row) {
            format!(
                "It made no significant difference which channels had fewer rays: {test}. Images with fewer chromatic rays \
                 were rated {} points {} than images with as few achromatic rays{interval}.",
                size,
                if difference.mean < 0.0 {
                    "lower"
                } else {
                    "higher"
                }
            )
        } else if difference.mean > 0.0 {
            format!(
                "Fewer rays for the chromatic channels cost less image quality than as few for the achromatic channel: \
                 averaged over ray counts, images with reduced chromatic channels were rated {size} points \
                 higher{interval}, {test}."
            )
        } else {
            format!(
                "Fewer rays for the chromatic channels cost <em>more</em> image quality than as few for the achromatic \
                 channel, against the paper: averaged over ray counts, images with reduced chromatic channels were rated \
                 {size} points lower{interval}, {test}."
            )
        })
    }

    fn of_rays_and_interaction(&self) -> Option<String> {
        let rays = self.analysis.anova.effect("rays")?;
        let mut text = if self.is_significant(rays) {
            format!(
                "Ratings depended on the number of rays, {}",
                self.test(rays)
            )
        } else {
            format!(
                "No significant effect of the number of rays was found, {}",
                self.test(rays)
            )
        };
        if let Some(both) = self.analysis.anova.effect("channel:rays") {
            let found = if self.is_significant(both) {
                "how much they did depended on which channels were varied (interaction)"
            } else {
                "no significant interaction with the channels that were varied was found"
            };
            // Writing to a `String` cannot fail.
            _ = write!(text, "; {found}, {}", self.test(both));
        }
        text.push('.');
        Some(text)
    }

    fn of_each_ray_count(&self) -> Option<String> {
        let all = &self.analysis.differences;
        if all.is_empty() {
            return None;
        }
        let n_above = all.iter().filter(|one| one.mean > 0.0).count();
        let n_clear = all
            .iter()
            .filter(|one| one.excludes_zero() == Some(true))
            .count();
        let n_holm = (all.iter())
            .filter(|one| one.p_holm.is_some_and(|p| p < self.alpha()))
            .count();
        Some(format!(
            "The chromatic mean lay above the achromatic one at {n_above} of {} ray counts; the {:.0}% interval of the \
             paired difference leaves out zero at {n_clear}, and the difference is significant after Holm’s correction at {n_holm}.",
            all.len(),
            100.0 * self.study.protocol.analysis.confidence
        ))
    }
}

/// `, 95% CI [2.12, 3.45]`, or nothing where there is no interval.
fn interval(difference: &Difference, confidence: f64) -> String {
    difference.half.map_or_else(String::new, |half| {
        format!(
            ", {:.0}% CI [{}, {}]",
            100.0 * confidence,
            apa::signed(difference.mean.abs() - half, 2),
            apa::signed(difference.mean.abs() + half, 2)
        )
    })
}

/// Which correction leads and why, and what Mauchly's test says of each effect that needs one.
pub(crate) fn sphericity(anova: &AnovaTable, correction: Correction) -> String {
    let lead = match correction {
        Correction::None => {
            "As planned, the degrees of freedom are not corrected; the corrected values stand beside."
        }
        Correction::GreenhouseGeisser => {
            "The Greenhouse–Geisser correction leads, as planned: it is applied to every effect with more than \
             two levels and does not wait for a test of sphericity."
        }
        Correction::HuynhFeldt => {
            "The Huynh–Feldt correction (Lecoutre’s form) leads, as planned: it is applied to every effect with \
             more than two levels and does not wait for a test of sphericity."
        }
        Correction::ChiMuller => {
            "The Chi–Muller correction leads, as planned: it is applied to every effect with more than two levels \
             and does not wait for a test of sphericity."
        }
    };
    let mut text = lead.to_owned();
    for row in &anova.effects {
        if let (Some(w), Some(p)) = (row.mauchly_w, row.mauchly_p_exact) {
            // Writing to a `String` cannot fail.
            _ = write!(
                text,
                " Mauchly’s test for {}: <i>W</i> {}, {}.",
                effect_name(&row.effect),
                if w < 0.0005 {
                    "&lt; .001".to_owned()
                } else {
                    format!("= {}", apa::fraction(w, 3))
                },
                apa::p_in_html(p)
            );
        }
    }
    text
}

/// What is wanting in the table and why, a line for each.
pub(crate) fn remarks(anova: &AnovaTable) -> Vec<String> {
    let is_trivial = |warning: &&String| {
        warning.contains("two levels are always spherical")
            || warning.contains("sphericity is no matter")
    };
    (anova.warnings.iter())
        .filter(|warning| !is_trivial(warning))
        .map(|warning| with_signs(anova, warning))
        .collect()
}

/// A warning with its effect as a table writes it.
fn with_signs(anova: &AnovaTable, warning: &str) -> String {
    let named = anova.effects.iter().find_map(|row| {
        let rest = warning.strip_prefix(&row.effect)?.strip_prefix(": ")?;
        Some(format!("{}: {rest}.", row.effect.replace(':', " × ")))
    });
    named.unwrap_or_else(|| format!("{warning}."))
}

/// An effect with a sign between its factors that reads as one.
pub(crate) fn effect_name(effect: &str) -> String {
    crate::page::escaped(effect).replace(':', " × ")
}

/// Which designs the printed degrees of freedom allow; `who` are the subjects here, in `n_groups` groups, and
/// `df_error` their error degrees of freedom for each contrast.
pub(crate) fn printed_designs(
    published: &[PublishedEffect],
    who: &str,
    n_groups: usize,
    df_error: usize,
) -> Option<String> {
    let error_df = |effect: &PublishedEffect| effect.df_den / effect.df_num;
    let first = error_df(published.first()?);
    let all_agree = (published.iter()).all(|effect| (error_df(effect) - first).abs() < 1e-9);
    if !all_agree || first.fract() != 0.0 {
        return None;
    }
    let mut dfs: Vec<String> = (published.iter())
        .map(|effect| format!("({}, {})", effect.df_num, effect.df_den))
        .collect();
    dfs.dedup();
    let here = if n_groups == 1 {
        "each of whom rated everything,"
    } else {
        "in two groups,"
    };
    let same = if df_error as f64 == first {
        "as many, so <i>F</i> values and <i>p</i> values compare directly"
    } else {
        "so <i>F</i> values compare in size only"
    };
    Some(format!(
        "The printed degrees of freedom, {}, mean {first} error degrees of freedom for each contrast: {} subjects who each \
         rated everything, or {} subjects in two groups of which each rated one sequence. The {who} here, {here} give \
         {df_error} for each contrast, {same}.",
        dfs.join(" and "),
        first + 1.0,
        first + 2.0,
    ))
}

/// The name of a channel group at the start of a table row.
pub(crate) fn group_name(group: ChannelGroup) -> &'static str {
    match group {
        ChannelGroup::Achromatic => "achromatic",
        ChannelGroup::Chromatic => "chromatic",
    }
}
