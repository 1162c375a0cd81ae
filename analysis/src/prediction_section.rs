//! The section of a report that puts what models of vision predicted beside the ratings.

use crate::apa;
use crate::document::{Block, Section, Table};
use crate::predictions::Predictions;
use crate::sections::{Sections, fraction_cell};

impl Sections<'_> {
    /// How well each model agrees with the means; `svg` is the figure in the colours of the page, where there is one.
    pub(crate) fn predicted(&self, predictions: &Predictions, svg: Option<&str>) -> Section {
        let shown: Vec<&str> = (self.ratings.sessions.iter())
            .filter_map(|session| session.sidecar.manifest_sha256.as_deref())
            .collect();
        let is_other = !shown.is_empty() && !shown.contains(&predictions.manifest_sha256.as_str());
        let columns = [
            "Model",
            "images",
            "<i>r</i>",
            "RMS difference",
            "mean difference",
        ];
        let caption = "Predicted ratings beside the mean ratings of the images; differences in steps of the scale.";
        let mut table = Table::new(caption, &columns);
        for model in &predictions.models {
            let Some(found) = model.agreement(&self.analysis.opinions) else {
                continue;
            };
            table.row(&[
                model.model.to_owned(),
                found.n.to_string(),
                fraction_cell(found.correlation, 3),
                format!("{:.2}", found.rms),
                apa::signed(found.bias, 2),
            ]);
        }
        let mut section = Section::new("Predicted before anyone was asked");
        if is_other {
            section = section.paragraph(
                "<b>The predictions are for other images</b> than those that were rated, by the digest of their manifest.",
            );
        }
        if let Some(svg) = svg {
            section = section.block(Block::Figure {
                svg: svg.to_owned(),
                file: "figure-predicted".to_owned(),
                caption: "Mean ratings (marks) and the ratings that two models of vision predict (lines): ColorVideoVDP (Mantiuk et \
                          al. 2024) and S-CIELAB (Zhang &amp; Wandell 1997)."
                    .to_owned(),
            });
        }
        section.table(table).note(
            "Each model’s difference from the reference is stretched so that no difference (or the ten anchor) has the highest rating \
             and the zero anchor the lowest; what differs more than the zero anchor has the lowest too. The shape of the curves is predicted, not how people use a scale. \
             Simulated observers are ColorVideoVDP with noise, so their agreement with it is no evidence.",
        )
    }
}
