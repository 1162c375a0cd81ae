//! The sections of a report on own pictures that a report on rendered images words otherwise.

use protocols::Study;

use crate::anova_table::{quoted, shortest};
use crate::apa::{self, LeadingTest};
use crate::page::{Table, escaped};
use crate::picture_analysis::PictureAnalysis;
use crate::results_text::effect_name;
use crate::sections::Sections;

impl Sections<'_> {
    /// The body of the page.
    pub(crate) fn to_html_of_pictures(&self, pictures: &PictureAnalysis) -> String {
        [
            self.head(),
            self.banners(),
            self.result_of_effects(),
            self.figure_of_cells(pictures),
            self.anova(),
            self.published(),
            self.asymptotes(),
            self.means_of_cells(pictures),
            self.follow_ups(),
            self.distribution_free(),
            self.quality(),
            self.provenance(),
        ]
        .concat()
    }

    /// A sentence for each effect.
    fn result_of_effects(&self) -> String {
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
            format!(
                "<p class=\"result\">{found} {}, {test}.</p>\n",
                effect_name(&row.effect)
            )
        });
        self.result_and_design(&sentences.collect::<String>())
    }

    fn figure_of_cells(&self, pictures: &PictureAnalysis) -> String {
        let n = self.analysis.subjects.len();
        let factors: Vec<String> = pictures.factors.iter().map(|name| escaped(name)).collect();
        format!(
            "<figure>\n{}<figcaption>Mean rating of {} for each level of {}. Bars are {} within-subject intervals \
             (Cousineau–Morey, <i>n</i> = {n}): they are for comparing cells, not for generalising a mean.</figcaption>\n\
             </figure>\n",
            self.figure_svg,
            self.who(),
            factors.join(" and "),
            self.percent(),
        )
    }

    fn means_of_cells(&self, pictures: &PictureAnalysis) -> String {
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
        format!("<section>\n<h2>Means</h2>\n{}</section>\n", table.to_html())
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
