//! The sections of a report on rendered images, and what they share with a report on own pictures.

use protocols::{ChannelGroup, Correction, Observer, PublishedEffect, Study};

use crate::apa::{self, LeadingTest};
use crate::data_sections::figure_name;
use crate::document::{Block, Document, Section, Style, Table};
use crate::page::escaped;
use crate::results_text::{effect_name, key_result, printed_designs, remarks, sphericity};
use crate::study_analysis::{ConditionMean, StudyAnalysis};
use crate::study_in_words::design_in_words;
use crate::study_ratings::StudyRatings;
use crate::tail::f_tail;
use crate::text_table::p_text;
use crate::{EffectRow, PrintedF};

/// All that the sections speak of.
pub(crate) struct Sections<'a> {
    pub(crate) study: &'a Study,
    pub(crate) ratings: &'a StudyRatings,
    pub(crate) analysis: &'a StudyAnalysis,
    /// Figure 10 in the colours of the page.
    pub(crate) figure_svg: &'a str,
}

impl Sections<'_> {
    /// The whole report.
    pub(crate) fn document(&self) -> Document {
        let means = [Some(self.means()), self.differences()];
        self.document_of(
            self.result(),
            self.figure(),
            means.into_iter().flatten().collect(),
        )
    }

    /// A report with these sections in their places among those that every study has.
    pub(crate) fn document_of(
        &self,
        result: Section,
        figure: Section,
        means: Vec<Section>,
    ) -> Document {
        let before = [
            self.banners(),
            Some(result),
            Some(self.the_study()),
            Some(figure),
            Some(self.anova()),
            self.published(),
            self.asymptotes(),
        ];
        let after = [
            self.follow_ups(),
            self.distribution_free(),
            self.observers(),
            Some(self.fragility()),
            Some(self.deviations()),
            Some(self.quality()),
            Some(self.to_paste()),
            Some(self.provenance()),
        ];
        let sections = before.into_iter().flatten().chain(means);
        self.with_head(sections.chain(after.into_iter().flatten()).collect())
    }

    pub(crate) fn percent(&self) -> String {
        format!("{:.0}%", 100.0 * self.study.protocol.analysis.confidence)
    }

    pub(crate) fn who(&self) -> String {
        self.ratings.who(self.analysis.subjects.len())
    }

    fn with_head(&self, sections: Vec<Section>) -> Document {
        let protocol = &self.study.protocol;
        Document {
            study: escaped(&protocol.study),
            title: escaped(&protocol.title),
            bylines: vec![
                escaped(&protocol.source),
                format!("{} · {}", self.who(), self.dates()),
            ],
            sections,
        }
    }

    /// When the ratings were taken, by the data.
    fn dates(&self) -> String {
        if self.ratings.observer == Observer::Simulated {
            return "simulated ratings, on a virtual clock".to_owned();
        }
        let mut days: Vec<&str> = (self.ratings.sessions.iter())
            .map(|session| session.started_at.get(..10).unwrap_or(&session.started_at))
            .collect();
        days.sort_unstable();
        match (days.first(), days.last()) {
            (Some(first), Some(last)) if first == last => format!("ratings of {}", escaped(first)),
            (Some(first), Some(last)) => {
                format!("ratings of {} to {}", escaped(first), escaped(last))
            }
            _ => "no ratings".to_owned(),
        }
    }

    pub(crate) fn banners(&self) -> Option<Section> {
        let mut banners = Vec::new();
        if self.ratings.observer == Observer::Simulated {
            banners.push(
                "<strong>SIMULATED.</strong> No person took part. The ratings come from a published \
                 model of colour vision (ColorVideoVDP), seen through each simulated observer’s own bias, gain and noise as \
                 the protocol states them. They show that the study runs; they are no evidence about people."
                    .to_owned(),
            );
        }
        if self.ratings.sessions.iter().any(|session| session.is_pilot) {
            banners.push(
                "<strong>PILOT.</strong> Trial runs with shortened times are among these ratings, \
                 because they were asked for."
                    .to_owned(),
            );
        }
        if self.analysis.subjects.len() < 6 {
            banners.push(format!(
                "<strong>FEW SUBJECTS.</strong> With {}, every test and interval below has little \
                 power and rests on its assumptions.",
                self.who()
            ));
        }
        let section = Section::without_heading().paragraphs(Style::Banner, banners);
        (!section.blocks.is_empty()).then_some(section)
    }

    fn result(&self) -> Section {
        let paragraphs = key_result(self.study, self.analysis);
        Section::new("Result").paragraphs(Style::Result, paragraphs)
    }

    pub(crate) fn the_study(&self) -> Section {
        Section::new("The study").paragraph(design_in_words(&self.study.protocol))
    }

    fn figure(&self) -> Section {
        let n = self.analysis.subjects.len();
        let last = self.analysis.conditions.last();
        let shares_an_image = last.is_some_and(|condition| condition.curves.len() > 1);
        let caption = format!(
            "<b>Figure 10.</b> Mean rating of {} against the number of rays for the chromatic \
             channels (squares) and for the achromatic channel (diamonds); the other channels were held. Bars are {} \
             within-subject intervals (Cousineau–Morey, <i>n</i> = {n}): they are for comparing images, not for \
             generalising a mean.{}",
            self.who(),
            self.percent(),
            if shares_an_image {
                " Both curves end in the same image."
            } else {
                ""
            }
        );
        self.with_figure(caption)
    }

    pub(crate) fn with_figure(&self, caption: String) -> Section {
        Section::without_heading().block(Block::Figure {
            svg: self.figure_svg.to_owned(),
            file: figure_name(self.study).to_owned(),
            caption,
        })
    }

    pub(crate) fn anova(&self) -> Section {
        let remarks = remarks(&self.analysis.anova);
        let correction = self.study.protocol.analysis.correction;
        Section::new("Analysis of variance")
            .paragraph(format!(
                "{}{}",
                sphericity(&self.analysis.anova, correction),
                self.exclusions()
            ))
            .table(self.tests(correction))
            .table(self.corrections())
            .note(
                "η²<sub>p</sub>, η²<sub>G</sub>, ω²<sub>p</sub>: partial and generalized eta squared, partial \
                 omega squared. The Huynh–Feldt ε is Lecoutre’s; it and Chi–Muller’s stand as they come out, above 1 they count as 1. \
                 The p of Mauchly’s W is by its exact law. A dash marks what does not exist.",
            )
            .list(
                Style::Note,
                remarks.iter().map(|remark| escaped(remark)).collect(),
            )
    }

    /// F, the uncorrected and the leading p, and the effect sizes.
    fn tests(&self, correction: Correction) -> Table {
        let caption = format!(
            "Analysis of variance, type {}, of the ratings of {}.",
            self.analysis.anova.sums_of_squares.numeral(),
            self.who()
        );
        let columns = [
            "Effect",
            "<i>df</i>",
            "<i>F</i>",
            "<i>p</i>",
            "ε",
            "<i>p</i>",
            "η²<sub>p</sub>",
            "η²<sub>G</sub>",
            "ω²<sub>p</sub>",
        ];
        let leading = match correction {
            Correction::None => "no correction",
            Correction::GreenhouseGeisser => "Greenhouse–Geisser",
            Correction::HuynhFeldt => "Huynh–Feldt",
            Correction::ChiMuller => "Chi–Muller",
        };
        let mut table = Table::new(&caption, &columns).grouped(&[
            ("", 1),
            ("uncorrected", 3),
            (&format!("{leading} (leads)"), 2),
            ("effect size", 3),
        ]);
        for row in &self.analysis.anova.effects {
            let leading = LeadingTest::new(row, correction);
            table.row(&[
                effect_name(&row.effect),
                format!("{}, {}", row.df_num, row.df_den),
                number_cell(row.f, 2),
                p_cell(row.p),
                number_cell(leading.map(|test| test.epsilon), 3),
                p_cell(leading.map(|test| test.p)),
                fraction_cell(row.pes, 3),
                fraction_cell(row.ges, 3),
                fraction_cell(row.omega2, 3),
            ]);
        }
        table
    }

    /// Every correction, and Mauchly's test.
    fn corrections(&self) -> Table {
        let columns = [
            "Effect", "ε", "<i>p</i>", "ε", "<i>p</i>", "ε", "<i>p</i>", "ε", "<i>p</i>",
            "<i>W</i>", "<i>p</i>",
        ];
        let caption = "The same tests under each correction for sphericity.";
        let mut table = Table::new(caption, &columns).grouped(&[
            ("", 1),
            ("Greenhouse–Geisser", 2),
            ("Huynh–Feldt", 2),
            ("Chi–Muller", 2),
            ("lower bound", 2),
            ("Mauchly", 2),
        ]);
        for row in &self.analysis.anova.effects {
            table.row(&[
                effect_name(&row.effect),
                number_cell(row.gg_epsilon, 3),
                p_cell(row.p_gg),
                number_cell(row.hf_epsilon, 3),
                p_cell(row.p_hf),
                number_cell(row.cm_epsilon, 3),
                p_cell(row.p_cm),
                number_cell(row.lb_epsilon, 3),
                p_cell(row.p_lb),
                fraction_cell(row.mauchly_w, 3),
                p_cell(row.mauchly_p_exact),
            ]);
        }
        table
    }

    fn exclusions(&self) -> String {
        let sentences: Vec<String> = (self.study.protocol.analysis.exclude.iter())
            .map(|exclusion| {
                format!(
                    " Of the factor {}, {} is left out: {}.",
                    escaped(&exclusion.factor),
                    escaped(&exclusion.levels.join(", ")),
                    escaped(&exclusion.reason)
                )
            })
            .collect();
        sentences.concat()
    }

    pub(crate) fn published(&self) -> Option<Section> {
        let published = &self.study.protocol.analysis.published;
        if published.is_empty() {
            return None;
        }
        let table = self.published_table(published);
        let n_groups = if self.study.protocol.analysis.between.is_empty() {
            1
        } else {
            2
        };
        let df_error = self.analysis.subjects.len().saturating_sub(n_groups);
        let designs =
            printed_designs(published, &self.who(), n_groups, df_error).unwrap_or_default();
        let section = Section::new("Beside the paper")
            .paragraph(format!(
                "The paper prints <i>F</i> values and bounds on <i>p</i>; the <i>p</i> and η²<sub>p</sub> in the table follow from \
                 <i>F</i> and its degrees of freedom. {designs}"
            ))
            .table(table);
        let allowed = allowed_designs(published);
        Some(if allowed.is_empty() {
            section
        } else {
            section
                .note("What the printed degrees of freedom allow, in one group or two:")
                .list(Style::Note, allowed)
        })
    }

    /// The printed tests beside those of this data set.
    fn published_table(&self, published: &[PublishedEffect]) -> Table {
        let columns = [
            "Effect",
            "<i>F</i>",
            "<i>p</i>",
            "η²<sub>p</sub>",
            "<i>F</i>",
            "<i>p</i>",
            "η²<sub>p</sub>",
        ];
        let mut table = Table::new(
            "Printed test statistics beside those of this data set, all without correction.",
            &columns,
        )
        .grouped(&[("", 1), ("as printed", 3), ("here", 3)]);
        for effect in published {
            let explained = effect.df_num * effect.f;
            let pes = explained / (explained + effect.df_den);
            let mut cells = vec![
                effect_name(&effect.effect),
                f_with_df(effect.f, effect.df_num, effect.df_den),
                p_cell(Some(f_tail(effect.f, effect.df_num, effect.df_den))),
                apa::fraction(pes, 3),
            ];
            match self.analysis.anova.effect(&effect.effect) {
                Some(EffectRow {
                    df_num,
                    df_den,
                    f: Some(f),
                    p,
                    pes,
                    ..
                }) => cells.extend([
                    f_with_df(*f, *df_num as f64, *df_den as f64),
                    p_cell(*p),
                    fraction_cell(*pes, 3),
                ]),
                _ => cells.extend(["–", "–", "–"].map(str::to_owned)),
            }
            table.row(&cells);
        }
        table
    }

    fn means(&self) -> Section {
        let percent = self.percent();
        let columns = [
            "Rays", "mean", "SD", "between", "within", "mean", "SD", "between", "within",
        ];
        let caption = format!(
            "Mean ratings and half widths of their {percent} intervals: between subjects (<i>t</i>) for the mean itself, within \
             subjects (Cousineau–Morey) for comparing images."
        );
        let mut table = Table::new(&caption, &columns).grouped(&[
            ("", 1),
            ("achromatic varied", 4),
            ("chromatic varied", 4),
        ]);
        for rays in self.analysis.ray_counts() {
            let mut cells = vec![rays.to_string()];
            for group in ChannelGroup::ALL {
                cells.extend(mean_cells(self.analysis.condition(group, rays)));
            }
            table.row(&cells);
        }
        Section::new("Means").table(table)
    }

    fn differences(&self) -> Option<Section> {
        let all = &self.analysis.differences;
        if all.is_empty() {
            return None;
        }
        let percent = self.percent();
        let interval = format!("{percent} CI");
        let caption = "Chromatic less achromatic at the same ray count, paired over subjects; above zero, fewer chromatic rays \
                       cost less.";
        let columns = [
            "Rays",
            "difference",
            interval.as_str(),
            "<i>p</i>",
            "<i>p</i> (Holm)",
        ];
        let mut table = Table::new(caption, &columns);
        for one in all.iter().chain(&self.analysis.overall_difference) {
            let interval = one.half.map_or_else(
                || "–".to_owned(),
                |half| {
                    format!(
                        "[{}, {}]",
                        apa::signed(one.mean - half, 2),
                        apa::signed(one.mean + half, 2)
                    )
                },
            );
            table.row(&[
                one.rays
                    .map_or_else(|| "all".to_owned(), |rays| rays.to_string()),
                apa::signed(one.mean, 2),
                interval,
                p_cell(one.p),
                p_cell(one.p_holm),
            ]);
        }
        let section = Section::new("The two sequences at each ray count").table(table);
        Some(section.note(
            "Each line is a paired <i>t</i> test of its own; Holm’s correction is over the ray counts. Where all subjects differ by the \
             same amount there is no test.",
        ))
    }
}

fn mean_cells(condition: Option<&ConditionMean>) -> [String; 4] {
    let Some(condition) = condition else {
        return ["–"; 4].map(str::to_owned);
    };
    let half =
        |half: Option<f64>| half.map_or_else(|| "–".to_owned(), |half| format!("± {half:.2}"));
    [
        format!("{:.2}", condition.mean),
        condition
            .sd
            .map_or_else(|| "–".to_owned(), |sd| format!("{sd:.2}")),
        half(condition.half_between),
        half(condition.half_within),
    ]
}

/// For each printed F, the subjects, levels and groups that its degrees of freedom allow, up to two groups.
fn allowed_designs(published: &[PublishedEffect]) -> Vec<String> {
    let whole = |df: f64| -> Option<u32> { format!("{df}").parse().ok() };
    (published.iter())
        .filter_map(|effect| {
            let printed = PrintedF {
                df_num: whole(effect.df_num)?,
                df_den: whole(effect.df_den)?,
                f: Some(effect.f),
            };
            let few = printed
                .designs()
                .into_iter()
                .filter(|design| design.n_groups <= 2);
            let designs: Vec<String> = few.map(|design| design.to_string()).collect();
            let designs = escaped(&designs.join("; ")).replace(" x ", " × ");
            Some(format!(
                "{}, {printed}: {designs}.",
                effect_name(&effect.effect)
            ))
        })
        .collect()
}

fn f_with_df(f: f64, df_num: f64, df_den: f64) -> String {
    format!("{f:.2} ({df_num}, {df_den})")
}

pub(crate) fn number_cell(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.decimals$}"))
}

pub(crate) fn fraction_cell(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |value| apa::fraction(value, decimals))
}

/// A p value for a table: small ones as a power of ten, `1.7 × 10⁻⁴¹`.
pub(crate) fn p_cell(p: Option<f64>) -> String {
    let Some(p) = p else {
        return "–".to_owned();
    };
    let text = p_text(p);
    match text.split_once("e-") {
        Some((digits, exponent)) => format!("{digits} × 10<sup>−{exponent}</sup>"),
        None => apa::fraction(p, 4),
    }
}
