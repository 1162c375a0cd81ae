//! Figure 10 in the form in which it was published: two lines of means, squares and diamonds, black on white.
//!
//! No intervals and no plateaus: those are in our own figure beside it.

use std::fmt::Write as _;

use protocols::{ChannelGroup, RayCount};

use crate::figure::{BOTTOM, CurveStyle, Figure, HEIGHT, Palette};
use crate::figure_frame::Frame;

/// The width of the figure, in user units; it is as high as the other.
const WIDTH: f64 = 470.0;
/// From the ends of the axis to the first and the last ray count.
const INSET: f64 = 20.0;

impl Figure<'_> {
    /// The figure in the published form as an SVG document.
    pub(crate) fn plain(&self) -> String {
        // One ink for both: shape and fill tell the curves apart.
        let palette = Palette {
            chromatic: self.palette.ink,
            ..self.palette
        };
        let frame = Frame::new(self.axis, BOTTOM, palette).narrowed(WIDTH);
        let mut svg = frame.opened(
            HEIGHT,
            "Image quality rating against spatial samples for luminance and chrominance",
        );
        frame.grid(&mut svg);
        let counts = self.analysis.ray_counts();
        let labels: Vec<(f64, String)> = (counts.iter())
            .map(|&rays| (x_of(frame, &counts, rays), thousands(rays).to_string()))
            .collect();
        let room = frame.labels(&mut svg, &labels);
        frame.titles(
            &mut svg,
            "Spatial samples (thousands of rays)",
            "Image quality rating",
            room,
        );
        self.plain_legend(&mut svg, frame);
        for group in ChannelGroup::ALL {
            let places: Vec<[f64; 2]> = (counts.iter())
                .filter_map(|&rays| {
                    let condition = self.analysis.condition(group, rays)?;
                    Some([x_of(frame, &counts, rays), frame.y(condition.mean)])
                })
                .collect();
            curve(&mut svg, group, palette, &places);
        }
        svg.push_str("</svg>\n");
        svg
    }

    fn plain_legend(&self, svg: &mut String, frame: Frame) {
        let Palette { ink, paper, .. } = frame.palette;
        let (left, top) = (frame.right() - 158.0, BOTTOM - 66.0);
        // Writing to a `String` cannot fail, here and below.
        _ = writeln!(
            svg,
            "<rect x=\"{}\" y=\"{}\" width=\"164\" height=\"70\" style=\"fill:{paper}\"/>",
            left - 8.0,
            top - 12.0
        );
        let entries = [
            (ChannelGroup::Chromatic, "chrominance"),
            (ChannelGroup::Achromatic, "luminance"),
        ];
        for (row, (group, name)) in entries.into_iter().enumerate() {
            let y = 21.0_f64.mul_add(row as f64, top);
            let places = [0.0, 16.0, 32.0].map(|step| [left + step, y]);
            line(svg, frame.palette, &places);
            marks(svg, group, frame.palette, &places[1..2]);
            _ = writeln!(
                svg,
                "<text x=\"{}\" y=\"{}\" style=\"fill:{ink}\">{name}</text>",
                left + 42.0,
                y + 4.5
            );
        }
        _ = writeln!(
            svg,
            "<text x=\"{left}\" y=\"{}\" style=\"fill:{ink}\">{}</text>",
            top + 46.5,
            self.who
        );
    }
}

fn thousands(rays: RayCount) -> f64 {
    f64::from(rays.get()) / 1000.0
}

/// Where a ray count stands among `counts`, which are in order.
fn x_of(frame: Frame, counts: &[RayCount], rays: RayCount) -> f64 {
    let first = counts.first().map_or(0.0, |&rays| thousands(rays));
    let last = counts.last().map_or(1.0, |&rays| thousands(rays));
    let share = if last > first {
        (thousands(rays) - first) / (last - first)
    } else {
        0.5
    };
    let room = frame.right() - frame.left - 2.0 * INSET;
    room.mul_add(share, frame.left + INSET)
}

fn curve(svg: &mut String, group: ChannelGroup, palette: Palette, places: &[[f64; 2]]) {
    line(svg, palette, places);
    marks(svg, group, palette, places);
}

fn line(svg: &mut String, palette: Palette, places: &[[f64; 2]]) {
    let points: Vec<String> = (places.iter())
        .map(|[x, y]| format!("{x:.2},{y:.2}"))
        .collect();
    _ = writeln!(
        svg,
        "<polyline points=\"{}\" style=\"stroke:{}\" stroke-width=\"1.3\" fill=\"none\"/>",
        points.join(" "),
        palette.ink
    );
}

fn marks(svg: &mut String, group: ChannelGroup, palette: Palette, places: &[[f64; 2]]) {
    let style = CurveStyle::of(group, palette);
    _ = writeln!(
        svg,
        "<g style=\"stroke:{}\" stroke-width=\"1.3\" fill=\"none\">",
        style.color
    );
    for &[x, y] in places {
        style.marker(svg, x, y, palette);
    }
    svg.push_str("</g>\n");
}
