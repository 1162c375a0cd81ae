//! The analysis and its results as sentences: what a methods paragraph says of it, and the results in the style of the APA.
//!
//! Every number comes from the plan or the data.

use protocols::{Correction, FollowUpPlan, SumsOfSquares};

use crate::apa;
use crate::findings::Findings;
use crate::page::escaped;
use crate::results_text::effect_name;
use crate::{EffectRow, FollowUp};

impl Findings<'_> {
    pub(crate) fn of_analysis(&self) -> String {
        let plan = self.plan;
        let named = |factors: &[String]| {
            let names: Vec<String> = factors.iter().map(|name| escaped(name)).collect();
            names.join(" and ")
        };
        let mut factors = Vec::new();
        if !plan.within.is_empty() {
            factors.push(format!("{} within subjects", named(&plan.within)));
        }
        if !plan.between.is_empty() {
            factors.push(format!("{} between subjects", named(&plan.between)));
        }
        let kind = match plan.sums_of_squares {
            SumsOfSquares::TypeTwo => "type II",
            SumsOfSquares::TypeThree => "type III",
        };
        let correction = match plan.correction {
            Correction::None => "without a correction for sphericity",
            Correction::GreenhouseGeisser => "with the Greenhouse–Geisser correction",
            Correction::HuynhFeldt => "with the Huynh–Feldt correction (Lecoutre’s form)",
            Correction::ChiMuller => "with the Chi–Muller correction",
        };
        let excluded: Vec<String> = (plan.exclude.iter())
            .map(|one| {
                format!(
                    "; {} {} was left out ({})",
                    escaped(&one.factor),
                    escaped(&one.levels.join(", ")),
                    escaped(&one.reason)
                )
            })
            .collect();
        format!(
            "Ratings were analysed by a {kind} analysis of variance with {}, {correction}{}. Intervals are at the {} level.",
            factors.join(" and "),
            excluded.concat(),
            self.percent()
        )
    }

    pub(crate) fn of_what_follows(&self) -> Vec<String> {
        let plan = self.plan;
        let families: Vec<String> = (plan.follow_ups.iter())
            .map(|asked| {
                let factor = escaped(asked.factor());
                let at = asked.at().map_or_else(String::new, |at| {
                    format!(" at each level of {}", escaped(at))
                });
                match asked {
                    FollowUpPlan::SimpleEffects { .. } => format!("the effect of {factor}{at}"),
                    FollowUpPlan::Pairwise { .. } => format!("pairs of levels of {factor}{at}"),
                    FollowUpPlan::AgainstControl { control, .. } => {
                        format!("levels of {factor} against {}{at}", escaped(control))
                    }
                    FollowUpPlan::Trends { degrees: None, .. } => format!("trends over {factor}"),
                    FollowUpPlan::Trends {
                        degrees: Some(degrees),
                        ..
                    } => {
                        format!("trends over {factor} up to degree {degrees}")
                    }
                    FollowUpPlan::Contrast { name, .. } => {
                        format!("the contrast {} of {factor}{at}", escaped(name))
                    }
                }
            })
            .collect();
        let mut sentences = Vec::new();
        if !families.is_empty() {
            sentences.push(format!(
                "Planned follow-ups, each family corrected after Holm: {}.",
                families.join("; ")
            ));
        }
        if let Some(found) = &self.table.asymptotes {
            sentences.push(format!(
                "Where the curves over {} flatten was estimated by a linear plateau of the means, with expanded-percentile \
                 intervals over {} resamples of the subjects (seed {}), beside equivalence tests within {}.",
                escaped(&found.factor),
                found.settings.n_resamples,
                found.settings.seed,
                found.settings.delta
            ));
        }
        sentences
    }

    /// A sentence for each effect, family of simple effects and asymptote.
    pub(crate) fn sentences(&self) -> Vec<String> {
        let effects = self.table.anova.effects.iter();
        let mut sentences: Vec<String> = effects.map(|row| self.of_effect(row)).collect();
        let families = self.table.follow_ups.iter();
        sentences.extend(families.filter_map(|family| self.of_simple_effects(family)));
        if let Some(found) = &self.table.asymptotes {
            let unit = escaped(&found.unit);
            sentences.extend(found.curves.iter().map(|curve| {
                format!(
                    "The {} curve flattened at {:.0}{unit}, {} CI [{:.0}{unit}, {:.0}{unit}].",
                    escaped(&curve.level),
                    curve.psi.value,
                    self.percent(),
                    curve.psi.low,
                    curve.psi.high
                )
            }));
        }
        sentences
    }

    fn of_effect(&self, row: &EffectRow) -> String {
        let plan = self.plan;
        let leading = apa::LeadingTest::new(row, plan.correction);
        let is_significant = leading.is_some_and(|test| test.p < 1.0 - plan.confidence);
        let found = match (is_significant, row.effect.contains(':')) {
            (true, true) => "There was an interaction",
            (true, false) => "There was a main effect",
            (false, true) => "There was no significant interaction",
            (false, false) => "There was no significant main effect",
        };
        let test = apa::f_test(row, plan.correction);
        format!("{found} of {}, {test}.", effect_name(&row.effect))
    }

    fn of_simple_effects(&self, family: &FollowUp) -> Option<String> {
        let plan = self.plan;
        let (factor, at) = (escaped(family.plan.factor()), escaped(family.plan.at()?));
        let all = &family.simple_effects;
        let significant: Vec<String> = (all.iter())
            .filter(|one| one.p_holm.is_some_and(|p| p < 1.0 - plan.confidence))
            .map(|one| {
                format!(
                    "{}, {}",
                    escaped(&one.at),
                    apa::f_test(&one.effect, plan.correction)
                )
            })
            .collect();
        match significant.as_slice() {
            _ if all.is_empty() => None,
            [] => Some(format!(
                "The effect of {factor} was significant at no level of {at} after Holm."
            )),
            some => Some(format!(
                "The effect of {factor} was significant after Holm at {} of {} levels of {at}: {}.",
                some.len(),
                all.len(),
                some.join("; ")
            )),
        }
    }
}
