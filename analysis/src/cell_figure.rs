//! The means of a design of any factors: one factor along x, a line for each combination of the others.
//!
//! Written as SVG directly, so that the bytes depend on nothing but the numbers. `LineStyle` tells the lines apart.

use std::fmt::Write as _;

use crate::axis::Axis;
use crate::cell_means::{CellMeans, Mean};
use crate::figure::Palette;
use crate::figure_frame::{Frame, RIGHT};
use crate::line_style::LineStyle;

const BOTTOM: f64 = 330.0;
/// From one line of the legend to the next.
const LEGEND_STEP: f64 = 20.0;
/// How far lines stand apart at most, so that their bars do not cover each other.
const DODGE: f64 = 5.0;

/// What the figure shows.
#[derive(Debug)]
pub(crate) struct CellFigure<'a> {
    pub(crate) means: &'a CellMeans,
    pub(crate) axis: Axis,
    /// What the y axis shows.
    pub(crate) measure: &'a str,
    pub(crate) palette: Palette,
}

impl CellFigure<'_> {
    /// The figure as an SVG document.
    pub(crate) fn to_svg(&self) -> String {
        let frame = Frame::new(self.axis, BOTTOM, self.palette);
        let lines = self.lines();
        let legend = if lines.len() > 1 { lines.len() } else { 0 };
        let mut body = String::new();
        frame.grid(&mut body);
        let along_x = self.along_x();
        let labels: Vec<(f64, String)> = (self.means.levels[along_x].iter())
            .map(|level| (self.x(&frame, level), level.clone()))
            .collect();
        let room = frame.labels(&mut body, &labels);
        frame.titles(&mut body, &self.means.factors[along_x], self.measure, room);
        let step = (RIGHT - frame.left) / labels.len().max(1) as f64;
        let apart = DODGE.min(0.8 * step / lines.len().max(1) as f64);
        for (place, (name, cells)) in lines.iter().enumerate() {
            let dodge = apart * (place as f64 - (lines.len() - 1) as f64 / 2.0);
            self.line(&mut body, &frame, (place, dodge), cells);
            if legend > 0 {
                let y = LEGEND_STEP.mul_add(place as f64, BOTTOM + room + 45.0);
                LineStyle::new(place, self.palette).key(&mut body, [frame.left, y], name);
            }
        }
        let height = LEGEND_STEP.mul_add(legend as f64, BOTTOM + room + 40.0);
        let label = format!("{} of each cell of the design", self.measure);
        format!("{}{body}</svg>\n", frame.opened(height.round(), &label))
    }

    /// The factor along x: the one with the most levels, of several the last.
    fn along_x(&self) -> usize {
        let levels = self.means.levels.iter().enumerate();
        levels
            .max_by_key(|(_, levels)| levels.len())
            .map_or(0, |(place, _)| place)
    }

    /// The cells of each line in the order of x, and the line's name.
    fn lines(&self) -> Vec<(String, Vec<&Mean<Vec<String>>>)> {
        let along_x = self.along_x();
        let mut lines: Vec<(String, Vec<&Mean<Vec<String>>>)> = Vec::new();
        for cell in &self.means.cells {
            let others = cell.of.iter().zip(&self.means.factors).enumerate();
            let others = others.filter(|(place, _)| *place != along_x);
            let name: Vec<String> = others
                .map(|(_, (level, factor))| format!("{factor} {level}"))
                .collect();
            let name = name.join(", ");
            match lines.iter_mut().find(|(known, _)| *known == name) {
                Some((_, cells)) => cells.push(cell),
                None => lines.push((name, vec![cell])),
            }
        }
        lines
    }

    fn x(&self, frame: &Frame, level: &str) -> f64 {
        let levels = &self.means.levels[self.along_x()];
        let place = levels.iter().position(|known| known == level).unwrap_or(0);
        let step = (RIGHT - frame.left) / levels.len().max(1) as f64;
        step.mul_add(place as f64 + 0.5, frame.left)
    }

    fn line(
        &self,
        svg: &mut String,
        frame: &Frame,
        (place, dodge): (usize, f64),
        cells: &[&Mean<Vec<String>>],
    ) {
        let along_x = self.along_x();
        let style = LineStyle::new(place, self.palette);
        let at = |cell: &Mean<Vec<String>>| {
            let x = self.x(frame, &cell.of[along_x]) + dodge;
            [x, frame.y(cell.summary.mean)]
        };
        let points: Vec<[f64; 2]> = cells.iter().map(|cell| at(cell)).collect();
        style.open(svg);
        style.path(svg, &points);
        for cell in cells {
            if let Some(half) = cell.half() {
                let [low, high] = [cell.summary.mean - half, cell.summary.mean + half];
                // Writing to a `String` cannot fail.
                _ = writeln!(
                    svg,
                    "<path d=\"M{:.2},{:.2}V{:.2}\" stroke-width=\"1.1\"/>",
                    at(cell)[0],
                    frame.y(low),
                    frame.y(high)
                );
            }
            style.marker(svg, at(cell));
        }
        svg.push_str("</g>\n");
    }
}
