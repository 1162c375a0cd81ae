//! The sections of a report on own pictures that a report on rendered images words otherwise.

use protocols::Study;

use crate::CellSummary;
use crate::anova_table::quoted;
use crate::document::{Document, Section};
use crate::page::escaped;
use crate::picture_analysis::PictureAnalysis;
use crate::sections::Sections;

impl Sections<'_> {
    /// The whole report.
    pub(crate) fn document_of_pictures(&self, pictures: &PictureAnalysis) -> Document {
        self.document_of(
            self.findings().result_of_effects(),
            self.figure_of_cells(pictures),
            vec![self.findings().means_of_cells(
                &pictures.means,
                " Each picture has a line in <code>means.csv</code>.",
            )],
        )
    }

    fn figure_of_cells(&self, pictures: &PictureAnalysis) -> Section {
        let n = self.analysis.subjects.len();
        let factors: Vec<String> = pictures
            .means
            .factors
            .iter()
            .map(|name| escaped(name))
            .collect();
        self.with_figure(format!(
            "Mean rating of {} for each level of {}. Bars are {} within-subject intervals \
             (Cousineau–Morey, <i>n</i> = {n}): they are for comparing cells, not for generalising a mean.",
            self.who(),
            factors.join(" and "),
            self.percent(),
        ))
    }
}

/// One line for each picture: its mean, and the ends of both intervals.
pub(crate) fn means_csv(study: &Study, pictures: &PictureAnalysis) -> String {
    let factors = study.protocol.stimuli.factors().join(",");
    let confidence = study.protocol.analysis.confidence;
    let mut csv = format!("stimulus_id,{factors},n,{}\n", CellSummary::COLUMNS);
    for image in &pictures.images {
        let mut fields = vec![image.of.id.to_string()];
        fields.extend(image.of.levels.iter().map(|level| quoted(level)));
        fields.push(image.summary.n.to_string());
        fields.extend(image.summary.fields(confidence));
        csv.push_str(&fields.join(","));
        csv.push('\n');
    }
    csv
}
