//! The sections of a report on own pictures that a report on rendered images words otherwise.

use protocols::Study;

use crate::anova_table::{quoted, shortest};
use crate::apa::{self, LeadingTest};
use crate::document::{Document, Section, Style, Table};
use crate::page::escaped;
use crate::picture_analysis::PictureAnalysis;
use crate::results_text::effect_name;
use crate::sections::Sections;

impl Sections<'_> {
    /// The whole report.
    pub(crate) fn document_of_pictures(&self, pictures: &PictureAnalysis) -> Document {
        self.document_of(
            self.result_of_effects(),
            self.figure_of_cells(pictures),
            vec![self.means_of_cells(pictures)],
        )
    }

    /// A sentence for each effect.
    fn result_of_effects(&self) -> Section {
        let plan = &self.study.protocol.analysis;
        let sentences = self.analysis.anova.effects.iter().map(|row| {
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

    fn figure_of_cells(&self, pictures: &PictureAnalysis) -> Section {
        let n = self.analysis.subjects.len();
        let factors: Vec<String> = pictures.factors.iter().map(|name| escaped(name)).collect();
        self.with_figure(format!(
            "Mean rating of {} for each level of {}. Bars are {} within-subject intervals \
             (Cousineau–Morey, <i>n</i> = {n}): they are for comparing cells, not for generalising a mean.",
            self.who(),
            factors.join(" and "),
            self.percent(),
        ))
    }

    fn means_of_cells(&self, pictures: &PictureAnalysis) -> Section {
        let percent = self.percent();
        let names: Vec<String> = pictures.factors.iter().map(|name| escaped(name)).collect();
        let mut columns: Vec<&str> = names.iter().map(String::as_str).collect();
        columns.extend(["mean", "SD", "between", "within"]);
        let caption = format!(
            "Mean ratings and half widths of their {percent} intervals: between subjects (<i>t</i>) for the mean itself, within \
             subjects (Cousineau–Morey) for comparing cells. Each picture has a line in <code>means.csv</code>."
        );
        let mut table = Table::new(&caption, &columns);
        for cell in &pictures.cells {
            let number = |value: Option<f64>, sign: &str| {
                value.map_or_else(|| "–".to_owned(), |value| format!("{sign}{value:.2}"))
            };
            let mut line: Vec<String> = cell.of.iter().map(|level| escaped(level)).collect();
            line.extend([
                format!("{:.2}", cell.summary.mean),
                number(cell.summary.sd, ""),
                number(cell.summary.half_between, "± "),
                number(cell.summary.half_within, "± "),
            ]);
            table.row(&line);
        }
        Section::new("Means").table(table)
    }
}

/// One line for each picture: its mean, and the ends of both intervals.
pub(crate) fn means_csv(study: &Study, pictures: &PictureAnalysis) -> String {
    let factors = study.protocol.stimuli.factors().join(",");
    let confidence = shortest(study.protocol.analysis.confidence);
    let mut csv = format!(
        "stimulus_id,{factors},n,mean,sd,confidence,between_low,between_high,within_low,within_high\n"
    );
    for image in &pictures.images {
        let summary = &image.summary;
        let ends = |half: Option<f64>| match half {
            Some(half) => [shortest(summary.mean - half), shortest(summary.mean + half)],
            None => [String::new(), String::new()],
        };
        let mut fields = vec![image.of.id.to_string()];
        fields.extend(image.of.levels.iter().map(|level| quoted(level)));
        fields.extend([
            summary.n.to_string(),
            shortest(summary.mean),
            summary.sd.map(shortest).unwrap_or_default(),
            confidence.clone(),
        ]);
        fields.extend(ends(summary.half_between));
        fields.extend(ends(summary.half_within));
        csv.push_str(&fields.join(","));
        csv.push('\n');
    }
    csv
}
