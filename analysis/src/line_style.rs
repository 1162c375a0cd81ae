//! How the lines of a figure are told apart: colour, dash and marker, each alone enough as far as there are six.

use std::fmt::Write as _;

use crate::figure::Palette;
use crate::page::escaped;

/// After the palette's blue, Okabe & Ito (2008) without black and yellow: legible on white and for any colour vision.
const COLORS: [&str; 5] = ["#c64b00", "#009e73", "#a6568a", "#56b4e9", "#8a6d00"];
const DASHES: [&str; 3] = ["", "5 3", "2 3"];

/// The look of the line of one place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineStyle {
    place: usize,
    palette: Palette,
}

impl LineStyle {
    pub(crate) const fn new(place: usize, palette: Palette) -> Self {
        Self { place, palette }
    }

    const fn color(self) -> &'static str {
        match self.place % (COLORS.len() + 1) {
            0 => self.palette.blue, // Lighter on a dark page.
            place => COLORS[place - 1],
        }
    }

    /// Opens a group in which strokes have this look.
    pub(crate) fn open(self, svg: &mut String) {
        // Writing to a `String` cannot fail, here and below.
        _ = writeln!(
            svg,
            "<g style=\"stroke:{}\" stroke-width=\"1.5\" fill=\"none\">",
            self.color()
        );
    }

    /// A line through points.
    pub(crate) fn path(self, svg: &mut String, points: &[[f64; 2]]) {
        let points: Vec<String> = (points.iter())
            .map(|[x, y]| format!("{x:.2},{y:.2}"))
            .collect();
        _ = writeln!(
            svg,
            "<polyline points=\"{}\" stroke-dasharray=\"{}\"/>",
            points.join(" "),
            DASHES[self.place % DASHES.len()]
        );
    }

    /// A square, a diamond or a circle, filled or open.
    pub(crate) fn marker(self, svg: &mut String, [x, y]: [f64; 2]) {
        let fill = if self.place.is_multiple_of(2) {
            self.color()
        } else {
            self.palette.paper
        };
        let path = match self.place % 3 {
            0 => format!("M{:.2},{:.2}h8v8h-8z", x - 4.0, y - 4.0),
            1 => format!("M{:.2},{y:.2}l5.5,-5.5l5.5,5.5l-5.5,5.5z", x - 5.5),
            _ => format!(
                "M{:.2},{y:.2}a4.5,4.5 0 1 0 9,0a4.5,4.5 0 1 0 -9,0z",
                x - 4.5
            ),
        };
        _ = writeln!(svg, "<path d=\"{path}\" style=\"fill:{fill}\"/>");
    }

    /// A line of a legend.
    pub(crate) fn key(self, svg: &mut String, [x, y]: [f64; 2], name: &str) {
        self.open(svg);
        self.path(svg, &[[x, y], [x + 36.0, y]]);
        self.marker(svg, [x + 18.0, y]);
        _ = writeln!(
            svg,
            "</g><text x=\"{}\" y=\"{}\" style=\"fill:{}\">{}</text>",
            x + 46.0,
            y + 4.5,
            self.palette.ink,
            escaped(name)
        );
    }
}
