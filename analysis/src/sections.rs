//! The sections of a report on rendered images, and what they share with a report on own pictures.

use protocols::{ChannelGroup, Observer, Study};

use crate::apa;
use crate::data_sections::{PLAIN_FIGURE, figure_name};
use crate::document::{Block, Document, Section, Style, Table};
use crate::findings::Findings;
use crate::page::escaped;
use crate::results_text::key_result;
use crate::study_analysis::{ConditionMean, StudyAnalysis, analysed_scale};
use crate::study_in_words::design_in_words;
use crate::study_ratings::StudyRatings;
use crate::text_table::p_text;

/// All that the sections speak of.
pub(crate) struct Sections<'a> {
    pub(crate) study: &'a Study,
    pub(crate) ratings: &'a StudyRatings,
    pub(crate) analysis: &'a StudyAnalysis,
    /// Figure 10 in the colours of the page.
    pub(crate) figure_svg: &'a str,
    /// The same in the published form, where there is one.
    pub(crate) plain_svg: Option<&'a str>,
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
        let findings = self.findings();
        let before = [
            self.banners(),
            Some(result),
            Some(self.the_study()),
            Some(figure),
            Some(findings.anova()),
            findings.published(),
            findings.asymptotes(),
        ];
        let after = [
            findings.follow_ups(),
            findings.distribution_free(),
            self.observers(),
            Some(findings.fragility()),
            Some(self.deviations()),
            Some(self.quality()),
            Some(self.to_paste()),
            Some(self.provenance()),
        ];
        let sections = before.into_iter().flatten().chain(means);
        self.with_head(sections.chain(after.into_iter().flatten()).collect())
    }

    /// What the analysis found, for the sections that any table has.
    pub(crate) fn findings(&self) -> Findings<'_> {
        let plan = &self.study.protocol.analysis;
        Findings {
            plan,
            table: &self.analysis.table,
            cells: &self.analysis.cells,
            fragility: &self.analysis.fragility,
            observers: self.analysis.observers.as_ref(),
            n_subjects: self.analysis.subjects.len(),
            n_groups: if plan.between.is_empty() { 1 } else { 2 },
            who: self.who(),
            scale: analysed_scale(self.study),
            is_simulated: self.ratings.observer == Observer::Simulated,
            are_whole: true,
        }
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
        banners.extend(self.findings().too_few());
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
        let ours = Block::Figure {
            svg: self.figure_svg.to_owned(),
            file: figure_name(self.study).to_owned(),
            caption,
        };
        let Some(svg) = self.plain_svg else {
            return Section::without_heading().block(ours);
        };
        let plain = Block::Figure {
            svg: svg.to_owned(),
            file: PLAIN_FIGURE.to_owned(),
            caption: format!(
                "<b>Figure 10 in the published form.</b> Image quality rating against the number of spatial samples for \
                 chrominance (squares) and for luminance (diamonds): the means of {} alone.",
                self.who()
            ),
        };
        Section::without_heading().block(Block::Beside(vec![plain, ours]))
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
