//! The sections of a report, in HTML.

use std::fmt::Write as _;

use protocols::{ChannelGroup, Correction, Observer, PublishedEffect, Study};

use crate::apa;
use crate::page::{Table, escaped};
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
    /// The body of the page.
    pub(crate) fn to_html(&self) -> String {
        [
            self.head(),
            self.banners(),
            self.result(),
            self.figure(),
            self.anova(),
            self.published(),
            self.asymptotes(),
            self.means(),
            self.differences(),
            self.follow_ups(),
            self.distribution_free(),
            self.observers(),
            self.quality(),
            self.provenance(),
        ]
        .concat()
    }

    pub(crate) fn percent(&self) -> String {
        format!("{:.0}%", 100.0 * self.study.protocol.analysis.confidence)
    }

    pub(crate) fn who(&self) -> String {
        self.ratings.who(self.analysis.subjects.len())
    }

    pub(crate) fn head(&self) -> String {
        let protocol = &self.study.protocol;
        format!(
            "<header>\n<p class=\"byline\">Report of the study <b>{}</b></p>\n<h1>{}</h1>\n\
             <p class=\"byline\">{}</p>\n<p class=\"byline\">{} · {}</p>\n</header>\n",
            escaped(&protocol.study),
            escaped(&protocol.title),
            escaped(&protocol.source),
            self.who(),
            self.dates()
        )
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

    pub(crate) fn banners(&self) -> String {
        let mut html = String::new();
        if self.ratings.observer == Observer::Simulated {
            html.push_str(
                "<div class=\"banner\"><strong>SIMULATED.</strong> No person took part. The ratings come from a published \
                 model of colour vision (ColorVideoVDP), seen through each simulated observer’s own bias, gain and noise as \
                 the protocol states them. They show that the study runs; they are no evidence about people.</div>\n",
            );
        }
        if self.ratings.sessions.iter().any(|session| session.is_pilot) {
            html.push_str(
                "<div class=\"banner\"><strong>PILOT.</strong> Trial runs with shortened times are among these ratings, \
                 because they were asked for.</div>\n",
            );
        }
        if self.analysis.subjects.len() < 6 {
            // Writing to a `String` cannot fail.
            _ = writeln!(
                html,
                "<div class=\"banner\"><strong>FEW SUBJECTS.</strong> With {}, every test and interval below has little \
                 power and rests on its assumptions.</div>",
                self.who()
            );
        }
        html
    }

    fn result(&self) -> String {
        let paragraphs: Vec<String> = key_result(self.study, self.analysis)
            .into_iter()
            .map(|paragraph| format!("<p class=\"result\">{paragraph}</p>\n"))
            .collect();
        self.result_and_design(&paragraphs.concat())
    }

    pub(crate) fn result_and_design(&self, paragraphs: &str) -> String {
        format!(
            "<section>\n<h2>Result</h2>\n{paragraphs}</section>\n<section>\n<h2>The study</h2>\n<p>{}</p>\n</section>\n",
            design_in_words(&self.study.protocol)
        )
    }

    fn figure(&self) -> String {
        let n = self.analysis.subjects.len();
        let last = self.analysis.conditions.last();
        let shares_an_image = last.is_some_and(|condition| condition.curves.len() > 1);
        format!(
            "<figure>\n{}<figcaption><b>Figure 10.</b> Mean rating of {} against the number of rays for the chromatic \
             channels (squares) and for the achromatic channel (diamonds); the other channels were held. Bars are {} \
             within-subject intervals (Cousineau–Morey, <i>n</i> = {n}): they are for comparing images, not for \
             generalising a mean.{}</figcaption>\n</figure>\n",
            self.figure_svg,
            self.who(),
            self.percent(),
            if shares_an_image {
                " Both curves end in the same image."
            } else {
                ""
            }
        )
    }

    pub(crate) fn anova(&self) -> String {
        let remarks: Vec<String> = (remarks(&self.analysis.anova).iter())
            .map(|remark| format!("<li>{}</li>\n", escaped(remark)))
            .collect();
        let list = if remarks.is_empty() {
            String::new()
        } else {
            format!("<ul class=\"note\">\n{}</ul>\n", remarks.concat())
        };
        format!(
            "<section>\n<h2>Analysis of variance</h2>\n<p>{}{}</p>\n{}\
             <p class=\"note\">η²<sub>p</sub>, η²<sub>G</sub>, ω²<sub>p</sub>: partial and generalized eta squared, partial \
             omega squared. The Huynh–Feldt ε is Lecoutre’s; it and Chi–Muller’s stand as they come out, above 1 they count as 1. \
             The p of Mauchly’s W is by its exact law. A dash marks what does not exist.</p>\n{list}</section>\n",
            sphericity(
                &self.analysis.anova,
                self.study.protocol.analysis.correction
            ),
            self.exclusions(),
            self.anova_table()
        )
    }

    fn anova_table(&self) -> String {
        let columns = [
            "Effect",
            "<i>df</i>",
            "<i>F</i>",
            "<i>p</i>",
            "ε",
            "<i>p</i>",
            "ε",
            "<i>p</i>",
            "ε",
            "<i>p</i>",
            "η²<sub>p</sub>",
            "η²<sub>G</sub>",
            "ω²<sub>p</sub>",
            "<i>W</i>",
            "<i>p</i>",
        ];
        let heading = |text: &str, correction: Correction| {
            let leads = self.study.protocol.analysis.correction == correction;
            format!("{text}{}", if leads { " (leads)" } else { "" })
        };
        let caption = format!(
            "Analysis of variance, type {}, of the ratings of {}.",
            self.analysis.anova.sums_of_squares.numeral(),
            self.who()
        );
        let mut table = Table::new(&caption, &columns).grouped(&[
            ("", 1),
            (&heading("uncorrected", Correction::None), 3),
            (
                &heading("Greenhouse–Geisser", Correction::GreenhouseGeisser),
                2,
            ),
            (&heading("Huynh–Feldt", Correction::HuynhFeldt), 2),
            (&heading("Chi–Muller", Correction::ChiMuller), 2),
            ("effect size", 3),
            ("Mauchly", 2),
        ]);
        for row in &self.analysis.anova.effects {
            table.row(&anova_cells(row));
        }
        table.to_html()
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

    pub(crate) fn published(&self) -> String {
        let published = &self.study.protocol.analysis.published;
        if published.is_empty() {
            return String::new();
        }
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
        let n_groups = if self.study.protocol.analysis.between.is_empty() {
            1
        } else {
            2
        };
        let df_error = self.analysis.subjects.len().saturating_sub(n_groups);
        let designs =
            printed_designs(published, &self.who(), n_groups, df_error).unwrap_or_default();
        let allowed = allowed_designs(published);
        format!(
            "<section>\n<h2>Beside the paper</h2>\n<p>The paper prints <i>F</i> values and bounds on <i>p</i>; the <i>p</i> and \
             η²<sub>p</sub> in the table follow from <i>F</i> and its degrees of freedom. {designs}</p>\n{}{allowed}</section>\n",
            table.to_html()
        )
    }

    fn means(&self) -> String {
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
        format!("<section>\n<h2>Means</h2>\n{}</section>\n", table.to_html())
    }

    fn differences(&self) -> String {
        let all = &self.analysis.differences;
        if all.is_empty() {
            return String::new();
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
        format!(
            "<section>\n<h2>The two sequences at each ray count</h2>\n{}<p class=\"note\">Each line is a paired <i>t</i> test of its \
             own; Holm’s correction is over the ray counts. Where all subjects differ by the same amount there is no test.</p>\n\
             </section>\n",
            table.to_html()
        )
    }
}

fn anova_cells(row: &EffectRow) -> Vec<String> {
    let number = |value: Option<f64>, decimals: usize| {
        value.map_or_else(|| "–".to_owned(), |value| format!("{value:.decimals$}"))
    };
    vec![
        effect_name(&row.effect),
        format!("{}, {}", row.df_num, row.df_den),
        number(row.f, 2),
        p_cell(row.p),
        number(row.gg_epsilon, 3),
        p_cell(row.p_gg),
        number(row.hf_epsilon, 3),
        p_cell(row.p_hf),
        number(row.cm_epsilon, 3),
        p_cell(row.p_cm),
        fraction_cell(row.pes, 3),
        fraction_cell(row.ges, 3),
        fraction_cell(row.omega2, 3),
        fraction_cell(row.mauchly_w, 3),
        p_cell(row.mauchly_p_exact),
    ]
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
fn allowed_designs(published: &[PublishedEffect]) -> String {
    let whole = |df: f64| -> Option<u32> { format!("{df}").parse().ok() };
    let lines: Vec<String> = (published.iter())
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
                "<li>{}, {printed}: {designs}.</li>\n",
                effect_name(&effect.effect)
            ))
        })
        .collect();
    if lines.is_empty() {
        return String::new();
    }
    format!(
        "<p class=\"note\">What the printed degrees of freedom allow, in one group or two:</p>\n<ul class=\"note\">\n{}</ul>\n",
        lines.concat()
    )
}

fn f_with_df(f: f64, df_num: f64, df_den: f64) -> String {
    format!("{f:.2} ({df_num}, {df_den})")
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
