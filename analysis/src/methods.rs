//! What can be pasted into a paper: a methods paragraph and the results in the style of the APA.
//!
//! Every number comes from the protocol or the data; what neither says is not claimed.

use std::fmt::Write as _;

use protocols::{
    Correction, FollowUpPlan, Observer, OrderScheme, RatingTime, ResponseStyle, Stimuli,
    SumsOfSquares,
};

use crate::apa;
use crate::document::{Section, Style};
use crate::page::escaped;
use crate::results_text::effect_name;
use crate::rich_text::plain;
use crate::sections::Sections;
use crate::study_in_words::design_in_words;
use crate::{EffectRow, FollowUp};

impl Sections<'_> {
    pub(crate) fn to_paste(&self) -> Section {
        Section::new("To paste into a paper")
            .paragraph(self.methods())
            .list(Style::Plain, self.sentences())
    }

    /// The methods paragraph.
    pub(crate) fn methods(&self) -> String {
        let mut sentences = vec![self.of_people(), design_in_words(&self.study.protocol)];
        sentences.push(self.of_viewing());
        sentences.push(self.of_procedure());
        sentences.push(self.of_analysis());
        sentences.extend(self.of_what_follows());
        sentences.push(self.of_software());
        sentences.join(" ")
    }

    fn of_people(&self) -> String {
        let sessions = self.ratings.sessions.len();
        let left_out = match self.analysis.incomplete.len() {
            0 => "nobody was left out".to_owned(),
            n => format!("{n} more did not rate every image and were left out"),
        };
        let plural = if sessions == 1 { "" } else { "s" };
        let took_part = match self.ratings.observer {
            Observer::Person => "took part",
            Observer::Simulated => {
                "(ColorVideoVDP with a bias, gain and noise of each) rated the images"
            }
        };
        format!(
            "{} {took_part}, in {sessions} session{plural}; {left_out}.",
            self.who()
        )
    }

    fn of_viewing(&self) -> String {
        let protocol = &self.study.protocol;
        let viewing = protocol.viewing;
        let pixel = format!(
            "{} cm from the screen, where a pixel ({:.3} mm) subtended {}°",
            viewing.distance_cm,
            viewing.pixel_pitch_mm(),
            viewing.degrees_per_pixel
        );
        let seen = match self.ratings.observer {
            Observer::Person => "Subjects sat",
            Observer::Simulated => "The modelled observers sat",
        };
        match &protocol.stimuli {
            Stimuli::Rendered(plan) => {
                let [width, height] = plan.size_px;
                let angle = |pixels: u32| f64::from(pixels) * viewing.degrees_per_pixel;
                format!(
                    "{seen} {pixel} and an image ({width} × {height} pixels) {:.2}° × {:.2}°.",
                    angle(width),
                    angle(height)
                )
            }
            Stimuli::Pictures(_) => format!("{seen} {pixel}."),
        }
    }

    fn of_procedure(&self) -> String {
        let session = &self.study.protocol.session;
        let order = match session.order.scheme {
            OrderScheme::Shuffled => format!(
                "in a random order of each subject’s own (seed {})",
                session.order_seed
            ),
            OrderScheme::LatinSquare => {
                "in the order of a row of a balanced Latin square".to_owned()
            }
        };
        let times = match session.blocks {
            1 => "once".to_owned(),
            n => format!("{n} times"),
        };
        let practice = match session.practice.len() {
            0 => String::new(),
            1 => " after 1 practice trial".to_owned(),
            n => format!(" after {n} practice trials"),
        };
        let response = match session.response {
            ResponseStyle::Buttons => "on buttons with whole numbers",
            ResponseStyle::Labelled => "on a scale with a word for each rating",
            ResponseStyle::Continuous => "on an upright bar",
        };
        let when = match session.rating {
            RatingTime::AfterExposure => "after the exposure",
            RatingTime::DuringExposure => "while the images stood",
        };
        let mut text = format!(
            "Each image was rated {times}, {order}{practice}; ratings were given {response}, {when}, and {} s of grey (sRGB {}) \
             followed.",
            session.pause_s, session.background_srgb
        );
        if self.ratings.observer == Observer::Person {
            let sessions = &self.ratings.sessions;
            let late: u32 = sessions.iter().map(|session| session.missed_frames).sum();
            let trials: usize = sessions.iter().map(|session| session.n_rated).sum();
            // Writing to a `String` cannot fail.
            _ = write!(text, " In {trials} trials {late} frames came late.");
        }
        text
    }

    fn of_analysis(&self) -> String {
        let plan = &self.study.protocol.analysis;
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

    fn of_what_follows(&self) -> Vec<String> {
        let plan = &self.study.protocol.analysis;
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
                    FollowUpPlan::Trends { degrees, .. } => {
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
        if let Some(found) = &self.analysis.table.asymptotes {
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

    fn of_software(&self) -> String {
        let start = |sha256: &dyn std::fmt::Display| {
            sha256.to_string().chars().take(12).collect::<String>()
        };
        format!(
            "Analysed with Acuity {} (SHA-256 of the protocol {}…, of the ratings {}…).",
            env!("CARGO_PKG_VERSION"),
            start(&self.study.sha256),
            start(&self.ratings.sha256())
        )
    }

    /// The paragraph and the sentences as plain text.
    pub(crate) fn to_paste_as_text(&self) -> String {
        let mut text = plain(&self.methods());
        text.push('\n');
        for sentence in self.sentences() {
            text.push('\n');
            text.push_str(&plain(&sentence));
        }
        text.push('\n');
        text
    }

    /// A sentence for each effect, family of simple effects and asymptote.
    fn sentences(&self) -> Vec<String> {
        let effects = self.analysis.anova.effects.iter();
        let mut sentences: Vec<String> = effects.map(|row| self.of_effect(row)).collect();
        let families = self.analysis.table.follow_ups.iter();
        sentences.extend(families.filter_map(|family| self.of_simple_effects(family)));
        if let Some(found) = &self.analysis.table.asymptotes {
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
        let plan = &self.study.protocol.analysis;
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
        let plan = &self.study.protocol.analysis;
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
