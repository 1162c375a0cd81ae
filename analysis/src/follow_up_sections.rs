//! The sections of a report that follow the analysis of variance: comparisons, tests without a distribution, the
//! asymptote.

use crate::apa;
use crate::asymptote::{Asymptote, Asymptotes, Estimate};
use crate::comparison::Comparison;
use crate::document::{Section, Style, Table};
use crate::findings::Findings;
use crate::follow_up::{FollowUp, SimpleEffect};
use crate::page::escaped;
use crate::results_text::effect_name;
use crate::sections::{fraction_cell, p_cell};

impl Findings<'_> {
    /// Where each curve flattens, and how sure that is.
    pub(crate) fn asymptotes(&self) -> Option<Section> {
        let found = self.table.asymptotes.as_ref()?;
        let mut paragraphs: Vec<String> = (found.curves.iter())
            .map(|curve| self.asymptote_in_words(found, curve))
            .collect();
        paragraphs.extend(found.difference.map(|difference| {
            let [first, second] = [0, 1].map(|place| escaped(&found.curves[place].level));
            format!(
                "The plateau of the {first} curve less that of the {second} one: {}.",
                self.with_interval(found, difference)
            )
        }));
        let mut shapes = Table::new(
            "Shapes fitted to the means: the share of their variance that each explains, where it flattens, and its root mean \
             square error for the ratings of a subject left out.",
            &["Curve", "shape", "<i>R</i>²", "flattens at", "error"],
        );
        for curve in &found.curves {
            for shape in &curve.shapes {
                shapes.row(&[
                    escaped(&curve.level),
                    shape.shape.to_owned(),
                    fraction_cell(shape.r_squared, 3),
                    shape.psi.map_or_else(
                        || "–".to_owned(),
                        |psi| format!("{psi:.1}{}", escaped(&found.unit)),
                    ),
                    shape
                        .left_out_rms
                        .map_or_else(|| "–".to_owned(), |rms| format!("{rms:.3}")),
                ]);
            }
        }
        let section = Section::new("Where the curves flatten").paragraphs(Style::Plain, paragraphs);
        Some(section.table(shapes).note(format!(
            "Linear plateau of the means (Hudson \
             1966); intervals by drawing whole subjects again {} times (expanded percentiles, Hesterberg 2015). The exponential \
             flattens where it has made up 95% of the way. Equivalence: paired two one-sided tests against the highest \
             {}, from above, until the first fails; a difference that is not significant is never taken for none.",
            found.settings.n_resamples,
            escaped(&found.factor)
        )))
    }

    fn with_interval(&self, found: &Asymptotes, estimate: Estimate) -> String {
        let unit = escaped(&found.unit);
        format!(
            "{}{unit}, {} CI [{}, {}]",
            apa::signed(estimate.value, 1),
            self.percent(),
            apa::signed(estimate.low, 1),
            apa::signed(estimate.high, 1)
        )
    }

    fn asymptote_in_words(&self, found: &Asymptotes, curve: &Asymptote) -> String {
        let unit = escaped(&found.unit);
        let top = curve.x.last().copied().unwrap_or_default();
        let equivalent = if curve.lowest_equivalent < top {
            format!(
                "From {}{unit} on, every level is equivalent to {top}{unit} within {} of a rating",
                curve.lowest_equivalent, found.settings.delta
            )
        } else {
            format!(
                "No level below {top}{unit} was shown to be equivalent to it within {} of a rating",
                found.settings.delta
            )
        };
        format!(
            "The {} curve flattens at {} ({}), at a mean rating of {:.2}. {equivalent}.",
            escaped(&curve.level),
            self.with_interval(found, curve.psi),
            curve.outcome.in_words(),
            curve.fit.level
        )
    }

    /// The families of tests that the protocol asks for.
    pub(crate) fn follow_ups(&self) -> Option<Section> {
        let families = &self.table.follow_ups;
        if families.is_empty() {
            return None;
        }
        let section = (families.iter()).fold(Section::new("Follow-up tests"), |section, family| {
            self.family(section, family)
        });
        Some(section.note(
            "Each comparison has an error term of its own, the \
             subjects’ scores of that contrast, so none needs sphericity. <i>d</i><sub>z</sub> is the difference over the \
             standard deviation of these scores, <i>d</i><sub>av</sub> over the mean standard deviation of the two \
             means. Intervals are not adjusted; adjusted <i>p</i> values are over all lines of a table (Bonferroni’s stand in \
             <code>follow-ups.csv</code>). Simple effects: Greenhouse–Geisser <i>p</i>.",
        ))
    }

    fn family(&self, mut section: Section, family: &FollowUp) -> Section {
        let caption = escaped(&family.title);
        if !family.simple_effects.is_empty() {
            let columns = [
                "At",
                "<i>df</i>",
                "<i>F</i>",
                "ε",
                "<i>p</i>",
                "<i>p</i> (Holm)",
                "η²<sub>p</sub>",
            ];
            let mut table = Table::new(&caption, &columns);
            for SimpleEffect { at, effect, p_holm } in &family.simple_effects {
                table.row(&[
                    escaped(at),
                    format!("{}, {}", effect.df_num, effect.df_den),
                    effect
                        .f
                        .map_or_else(|| "–".to_owned(), |f| format!("{f:.2}")),
                    fraction_cell(effect.gg_epsilon, 3),
                    p_cell(effect.p_gg.or(effect.p)),
                    p_cell(*p_holm),
                    fraction_cell(effect.pes, 3),
                ]);
            }
            section = section.table(table);
        }
        if !family.comparisons.is_empty() {
            let interval = format!("{} CI", self.percent());
            let has_tukey = family.comparisons.iter().any(|one| one.p_tukey.is_some());
            let mut columns = vec![
                "Comparison",
                "estimate",
                &interval,
                "<i>t</i>",
                "<i>p</i>",
                "Holm",
            ];
            columns.extend(has_tukey.then_some("Tukey"));
            columns.extend(["<i>d</i><sub>z</sub>", &interval, "<i>d</i><sub>av</sub>"]);
            let mut table = Table::new(&caption, &columns);
            let errors = family.comparisons.iter().map(|one| one.se);
            let decimals = apa::decimals_for(errors, 2);
            for one in &family.comparisons {
                let mut cells = comparison_cells(one, decimals);
                if has_tukey {
                    cells.insert(6, p_cell(one.p_tukey));
                }
                table.row(&cells);
            }
            section = section.table(table);
        }
        let warnings = family.warnings.iter();
        let warnings = warnings.map(|warning| format!("{}.", escaped(warning)));
        section.paragraphs(Style::Note, warnings.collect())
    }

    /// Permutation tests, aligned ranks and Friedman's test beside the F tests.
    pub(crate) fn distribution_free(&self) -> Option<Section> {
        let free = self.table.distribution_free.as_ref()?;
        let columns = [
            "Effect",
            "<i>p</i> of <i>F</i> (GG)",
            "permutation <i>p</i>",
            "arrangements",
            "aligned ranks: <i>F</i>",
            "<i>p</i> (GG)",
        ];
        let mut table = Table::new(
            "The same effects without the normal distribution.",
            &columns,
        );
        for test in &free.permutation {
            let ranks = free
                .aligned_ranks
                .iter()
                .find(|row| row.effect == test.effect);
            let row = self.table.anova.effect(&test.effect);
            table.row(&[
                effect_name(&test.effect),
                p_cell(row.and_then(|row| row.p_gg.or(row.p))),
                p_cell(test.p),
                format!(
                    "{}{}",
                    test.n_arrangements,
                    if test.is_exact { ", all" } else { ", drawn" }
                ),
                ranks
                    .and_then(|row| row.f)
                    .map_or_else(|| "–".to_owned(), |f| format!("{f:.2}")),
                p_cell(ranks.and_then(|row| row.p_gg.or(row.p))),
            ]);
        }
        let friedman: Vec<String> = (free.friedman.iter())
            .map(|one| {
                format!(
                    "Friedman, {}: χ²({}) = {:.2}, {}; Kendall’s <i>W</i> = {}.",
                    escaped(&one.factor),
                    one.df,
                    one.chi_square,
                    apa::p_in_html(one.p),
                    apa::fraction(one.kendall_w, 2)
                )
            })
            .collect();
        let why = if self.are_whole {
            "Ratings are whole numbers, and their steps may not be equal. "
        } else {
            ""
        };
        let section = Section::new("Does the scale matter?").paragraph(format!(
            "{why}These tests suppose neither a normal distribution nor sphericity; where they agree with the <i>F</i> tests, that \
             does not matter here."
        ));
        Some(section.table(table).list(Style::Note, friedman).note(
            "A permutation <i>p</i> cannot be smaller than \
             one over the number of arrangements, twice that where all signs can be turned together.",
        ))
    }
}

/// The cells of one comparison, without Tukey's p.
fn comparison_cells(one: &Comparison, decimals: usize) -> Vec<String> {
    let number =
        |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| apa::signed(value, 2));
    let between = |low: f64, high: f64, decimals: usize| {
        let [low, high] = [low, high].map(|end| apa::signed(end, decimals));
        format!("[{low}, {high}]")
    };
    let mut cells = vec![
        escaped(&one.label()).replace(" - ", " − "),
        apa::signed(one.estimate, decimals),
        between(one.low, one.high, decimals),
        number(one.t),
        p_cell(one.p),
        p_cell(one.p_holm),
    ];
    cells.push(number(one.dz));
    cells.push(
        one.dz_low
            .zip(one.dz_high)
            .map_or_else(|| "–".to_owned(), |(low, high)| between(low, high, 2)),
    );
    cells.push(number(one.dav));
    cells
}
