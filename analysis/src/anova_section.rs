//! The sections of a report on the analysis of variance: its table, the corrections, the values that were printed elsewhere.

use protocols::{Correction, PublishedEffect};

use crate::apa::{self, LeadingTest};
use crate::cell_means::CellMeans;
use crate::document::{Section, Style, Table};
use crate::findings::Findings;
use crate::page::escaped;
use crate::results_text::{effect_name, printed_designs, remarks, sphericity};
use crate::sections::{fraction_cell, number_cell, p_cell};
use crate::tail::f_tail;
use crate::{EffectRow, PrintedF};

impl Findings<'_> {
    /// A sentence for each effect.
    pub(crate) fn result_of_effects(&self) -> Section {
        let plan = self.plan;
        let sentences = self.table.anova.effects.iter().map(|row| {
            let is_significant = LeadingTest::new(row, plan.correction)
                .is_some_and(|test| test.p < 1.0 - plan.confidence);
            let found = match (is_significant, row.effect.contains(':')) {
                (true, false) => "The ratings depended on",
                (true, true) => "There was an interaction of",
                (false, false) => "No significant effect was found of",
                (false, true) => "No significant interaction was found of",
            };
            let test = apa::f_test(row, plan.correction);
            format!("{found} {}, {test}.", effect_name(&row.effect))
        });
        Section::new("Result").paragraphs(Style::Result, sentences.collect())
    }

    pub(crate) fn anova(&self) -> Section {
        let remarks = remarks(&self.table.anova);
        let correction = self.plan.correction;
        Section::new("Analysis of variance")
            .paragraph(format!(
                "{}{}",
                sphericity(&self.table.anova, correction),
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
            self.table.anova.sums_of_squares.numeral(),
            self.who
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
        for row in &self.table.anova.effects {
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
        for row in &self.table.anova.effects {
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
                p_cell(row.mauchly_w),
                p_cell(row.mauchly_p_exact),
            ]);
        }
        table
    }

    fn exclusions(&self) -> String {
        let sentences: Vec<String> = (self.plan.exclude.iter())
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

    /// The means of the cells; `remark` ends the caption.
    pub(crate) fn means_of_cells(&self, means: &CellMeans, remark: &str) -> Section {
        let percent = self.percent();
        let names: Vec<String> = means.factors.iter().map(|name| escaped(name)).collect();
        let mut columns: Vec<&str> = names.iter().map(String::as_str).collect();
        columns.extend(["mean", "SD", "between", "within"]);
        let caption = format!(
            "Mean ratings and half widths of their {percent} intervals: between subjects (<i>t</i>) for the mean itself, within \
             subjects (Cousineau–Morey) for comparing cells.{remark}"
        );
        let sds = means.cells.iter().filter_map(|cell| cell.summary.sd);
        let decimals = apa::decimals_for(sds, 2);
        let mut table = Table::new(&caption, &columns);
        for cell in &means.cells {
            let number = |value: Option<f64>, sign: &str| {
                value.map_or_else(
                    || "–".to_owned(),
                    |value| format!("{sign}{value:.decimals$}"),
                )
            };
            let mut line: Vec<String> = cell.of.iter().map(|level| escaped(level)).collect();
            line.extend([
                apa::signed(cell.summary.mean, decimals),
                number(cell.summary.sd, ""),
                number(cell.summary.half_between, "± "),
                number(cell.summary.half_within, "± "),
            ]);
            table.row(&line);
        }
        Section::new("Means").table(table)
    }

    pub(crate) fn published(&self) -> Option<Section> {
        let published = &self.plan.published;
        if published.is_empty() {
            return None;
        }
        let table = self.published_table(published);
        let df_error = self.n_subjects.saturating_sub(self.n_groups);
        let designs =
            printed_designs(published, &self.who, self.n_groups, df_error).unwrap_or_default();
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
            match self.table.anova.effect(&effect.effect) {
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
