//! The section of a report that says what would make its conclusion fragile.
//!
//! Every sentence is chosen by the numbers: what is harmless is said too, so that silence means nothing.

use protocols::Correction;

use crate::EffectRow;
use crate::apa::{self, LeadingTest};
use crate::document::{Section, Style};
use crate::findings::Findings;
use crate::page::escaped;
use crate::results_text::effect_name;

/// With fewer observers BT.500 calls a study informal.
pub(crate) const FEWEST_OBSERVERS: usize = 15;
/// A share of ratings at one end of the scale that hides differences.
const CROWDED: f64 = 0.15;

impl Findings<'_> {
    pub(crate) fn fragility(&self) -> Section {
        let mut items = Vec::new();
        if self.is_simulated {
            items.push(
                "<b>Simulated data.</b> Nothing here is evidence about people; the observers share one model of vision, which \
                 makes effects clearer than people’s."
                    .to_owned(),
            );
        }
        items.push(self.of_numbers());
        items.push(self.of_sphericity());
        items.extend(self.of_single_subjects());
        items.extend(self.of_screens());
        items.extend(self.of_distribution());
        items.extend(self.of_the_scale());
        items.extend(self.of_asymptotes());
        Section::new("What would make this fragile").list(Style::Plain, items)
    }

    fn alpha(&self) -> f64 {
        1.0 - self.plan.confidence
    }

    fn of_numbers(&self) -> String {
        let n = self.n_subjects;
        let rows = self.table.anova.effects.iter();
        let most_contrasts = rows.clone().map(|row| row.df_num).max().unwrap_or(0);
        let error_df = rows
            .map(|row| row.df_den / row.df_num.max(1))
            .min()
            .unwrap_or(0);
        let informal = if n < FEWEST_OBSERVERS {
            format!(
                "{} are fewer than the {FEWEST_OBSERVERS} that BT.500 asks for",
                self.who
            )
        } else {
            format!(
                "{} are as many as BT.500 asks for ({FEWEST_OBSERVERS}), or more",
                self.who
            )
        };
        let singular = if most_contrasts > error_df {
            format!(
                ". The largest effect has {most_contrasts} contrasts and each only {error_df} error degrees of freedom, so their covariance \
                 cannot be known and all rests on the correction"
            )
        } else {
            String::new()
        };
        format!("<b>Number of subjects.</b> {informal}{singular}.")
    }

    fn of_sphericity(&self) -> String {
        let alpha = self.alpha();
        let verdicts = |row: &EffectRow| {
            let p = [row.p, row.p_gg, row.p_hf, row.p_cm, row.p_lb];
            let found: Vec<bool> = p.into_iter().flatten().map(|p| p < alpha).collect();
            found.contains(&true) && found.contains(&false)
        };
        let torn: Vec<String> = (self.table.anova.effects.iter())
            .filter(|row| verdicts(row))
            .map(|row| {
                let uncorrected = row.p.map(apa::p_in_html).unwrap_or_default();
                let leading = LeadingTest::new(row, self.plan.correction);
                let leading = leading.map(|test| apa::p_in_html(test.p)).unwrap_or_default();
                let bound = row.p_lb.map(apa::p_in_html).unwrap_or_default();
                let name = effect_name(&row.effect);
                format!("{name} ({uncorrected} uncorrected, {leading} as reported, {bound} at the lower bound)")
            })
            .collect();
        if !torn.is_empty() {
            return format!(
                "<b>Sphericity.</b> It depends on the correction whether these are significant: {}.",
                torn.join("; ")
            );
        }
        let lead = if self.plan.correction == Correction::None {
            ", none included"
        } else {
            ""
        };
        format!(
            "<b>Sphericity.</b> It does not matter here: every correction{lead} says the same of every effect, down to the lower bound."
        )
    }

    fn of_single_subjects(&self) -> Option<String> {
        let all = &self.fragility.left_out;
        if all.is_empty() {
            return None;
        }
        let ranges: Vec<String> = (all.iter())
            .map(|one| {
                format!(
                    "{} {:.1} to {:.1}",
                    effect_name(&one.effect),
                    one.f[0],
                    one.f[1]
                )
            })
            .collect();
        let decided: Vec<String> = (all.iter())
            .filter(|one| !one.decided_by.is_empty())
            .map(|one| {
                format!(
                    "{} hangs on {}",
                    effect_name(&one.effect),
                    escaped(&one.decided_by.join(", "))
                )
            })
            .collect();
        let verdict = if decided.is_empty() {
            "no conclusion about significance hangs on one subject".to_owned()
        } else {
            decided.join("; ")
        };
        Some(format!(
            "<b>Outliers.</b> With each subject left out in turn {verdict}; <i>F</i> then ranges over: {}.",
            ranges.join(", ")
        ))
    }

    fn of_screens(&self) -> Option<String> {
        let screening = self.observers?;
        let rejected: Vec<String> = (screening.observers.iter())
            .filter(|one| one.is_rejected_by_bt500 || one.is_rejected_by_bt1788)
            .map(|one| escaped(&one.subject))
            .collect();
        Some(if rejected.is_empty() {
            "<b>Observers.</b> Neither screen of the ITU would reject anybody.".to_owned()
        } else {
            format!(
                "<b>Observers.</b> A screen of the ITU would reject {}; all are in the results nevertheless.",
                rejected.join(", ")
            )
        })
    }

    fn of_distribution(&self) -> Option<String> {
        let free = self.table.distribution_free.as_ref()?;
        let (alpha, plan) = (self.alpha(), self.plan);
        let disagree: Vec<String> = (free.permutation.iter())
            .filter(|test| {
                let row = self.table.anova.effect(&test.effect);
                let leading = row.and_then(|row| LeadingTest::new(row, plan.correction));
                leading
                    .zip(test.p)
                    .is_some_and(|(leading, p)| (leading.p < alpha) != (p < alpha))
            })
            .map(|test| effect_name(&test.effect))
            .collect();
        Some(if disagree.is_empty() {
            "<b>Distribution.</b> Permutation tests, which suppose no distribution, agree with the <i>F</i> tests on every effect."
                .to_owned()
        } else {
            format!(
                "<b>Distribution.</b> Permutation test and <i>F</i> test disagree on {}.",
                disagree.join(", ")
            )
        })
    }

    fn of_the_scale(&self) -> Option<String> {
        let scale = self.scale?;
        let [low, high] = self.fragility.at_ends;
        let percent = |share: f64| format!("{:.0}%", 100.0 * share);
        let verdict = if low.max(high) > CROWDED {
            "so many at one end hide differences there and shrink the variance"
        } else {
            "too few to hide differences"
        };
        Some(format!(
            "<b>Ends of the scale.</b> {} of the analysed ratings are {} and {} are {}: {verdict}.",
            percent(low),
            scale.lowest,
            percent(high),
            scale.highest
        ))
    }

    fn of_asymptotes(&self) -> Option<String> {
        let found = self.table.asymptotes.as_ref()?;
        let unit = escaped(&found.unit);
        let widths: Vec<String> = (found.curves.iter())
            .map(|curve| {
                let range = curve.x.last().copied().unwrap_or(0.0) - curve.x[0];
                let share = (curve.psi.high - curve.psi.low) / range;
                format!(
                    "{} {:.0}{unit} wide, {:.0}% of the range ({})",
                    escaped(&curve.level),
                    curve.psi.high - curve.psi.low,
                    100.0 * share,
                    curve.outcome.in_words()
                )
            })
            .collect();
        Some(format!(
            "<b>Asymptotes.</b> Their intervals: {}; an interval that covers most of the range says little.",
            widths.join("; ")
        ))
    }
}
