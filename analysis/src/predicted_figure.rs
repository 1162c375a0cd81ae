//! Figure 10 with the curves that models of vision predict in place of intervals and plateaus.

use std::fmt::Write as _;

use protocols::ChannelGroup;

use crate::figure::{CurveStyle, Figure};
use crate::predictions::Predictions;

/// The dashes of each model's lines, in the order of the models.
const DASHES: [&str; 2] = ["7 3", "1.5 3"];

impl Figure<'_> {
    /// The measured means as marks, the predictions as lines.
    pub(crate) fn with_predictions(&self, predictions: &Predictions) -> String {
        let mut svg =
            self.opened("Mean rating against ray count, and what two models of vision predict");
        self.axes(&mut svg);
        for group in ChannelGroup::ALL {
            let style = CurveStyle::of(group, self.palette);
            for (model, dashes) in predictions.models.iter().zip(DASHES) {
                let points: Vec<String> = (self.analysis.ray_counts().into_iter())
                    .filter_map(|rays| {
                        let condition = self.analysis.condition(group, rays)?;
                        let rating = model.ratings.get(&condition.stimulus.id)?;
                        Some(format!("{:.2},{:.2}", self.x(rays), self.y(*rating)))
                    })
                    .collect();
                // Writing to a `String` cannot fail, here and below.
                _ = writeln!(
                    svg,
                    "<polyline points=\"{}\" style=\"stroke:{}\" stroke-width=\"1.6\" fill=\"none\" stroke-dasharray=\"{dashes}\"/>",
                    points.join(" "),
                    style.color
                );
            }
            _ = writeln!(
                svg,
                "<g style=\"stroke:{}\" stroke-width=\"1.5\" fill=\"none\">",
                style.color
            );
            for rays in self.analysis.ray_counts() {
                if let Some(condition) = self.analysis.condition(group, rays) {
                    style.marker(&mut svg, self.x(rays), self.y(condition.mean), self.palette);
                }
            }
            svg.push_str("</g>\n");
        }
        self.predicted_legend(&mut svg, predictions);
        svg.push_str("</svg>\n");
        svg
    }

    fn predicted_legend(&self, svg: &mut String, predictions: &Predictions) {
        let [left, top] = [455.0, 296.0];
        let (ink, paper) = (self.palette.ink, self.palette.paper);
        _ = writeln!(
            svg,
            "<rect x=\"{}\" y=\"{}\" width=\"300\" height=\"94\" style=\"fill:{paper}\"/>",
            left - 8.0,
            top - 13.0
        );
        let text = |svg: &mut String, y: f64, text: &str| {
            _ = writeln!(
                svg,
                "<text x=\"{}\" y=\"{}\" style=\"fill:{ink}\">{text}</text>",
                left + 42.0,
                y + 4.5
            );
        };
        for (row, (group, name)) in [
            (
                ChannelGroup::Chromatic,
                "chromatic channels varied: mean rating",
            ),
            (
                ChannelGroup::Achromatic,
                "achromatic channel varied: mean rating",
            ),
        ]
        .into_iter()
        .enumerate()
        {
            let (y, style) = (
                21.0_f64.mul_add(row as f64, top),
                CurveStyle::of(group, self.palette),
            );
            _ = writeln!(
                svg,
                "<g style=\"stroke:{}\" stroke-width=\"1.5\" fill=\"none\">",
                style.color
            );
            style.marker(svg, left + 16.0, y, self.palette);
            svg.push_str("</g>\n");
            text(svg, y, name);
        }
        for (row, (model, dashes)) in predictions.models.iter().zip(DASHES).enumerate() {
            let y = 21.0_f64.mul_add(row as f64 + 2.0, top);
            _ = writeln!(
                svg,
                "<path d=\"M{left},{y}h32\" style=\"stroke:{ink}\" stroke-width=\"1.6\" fill=\"none\" stroke-dasharray=\"{dashes}\"/>"
            );
            text(svg, y, &format!("predicted by {}", model.model));
        }
    }
}
