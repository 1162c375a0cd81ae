//! The means of a design of any within factors: one factor along x, a line for each combination of the others.
//!
//! Written as SVG directly, so that the bytes depend on nothing but the numbers. `LineStyle` tells the lines apart.

use std::fmt::Write as _;

use protocols::Scale;

use crate::figure::{Palette, WIDTH};
use crate::line_style::LineStyle;
use crate::page::escaped;
use crate::picture_analysis::{Mean, PictureAnalysis};

const LEFT: f64 = 62.0;
const RIGHT: f64 = 742.0;
const TOP: f64 = 18.0;
const BOTTOM: f64 = 330.0;
/// From one line of the legend to the next.
const LEGEND_STEP: f64 = 20.0;
/// How far lines stand apart, so that their bars do not cover each other.
const DODGE: f64 = 5.0;
/// What the figure shows.
#[derive(Debug)]
pub(crate) struct CellFigure<'a> {
    pub(crate) pictures: &'a PictureAnalysis,
    pub(crate) scale: Scale,
    pub(crate) palette: Palette,
}

impl CellFigure<'_> {
    /// The figure as an SVG document.
    pub(crate) fn to_svg(&self) -> String {
        let lines = self.lines();
        let legend = if lines.len() > 1 { lines.len() } else { 0 };
        let height = BOTTOM + 66.0 + LEGEND_STEP * legend as f64;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" role=\"img\" \
             aria-label=\"Mean rating of each cell of the design\" \
             font-family=\"Ubuntu, 'Helvetica Neue', Helvetica, Arial, sans-serif\" font-size=\"13\">\n"
        );
        // Writing to a `String` cannot fail, here and below.
        _ = writeln!(
            svg,
            "<rect width=\"{WIDTH}\" height=\"{height}\" style=\"fill:{}\"/>",
            self.palette.paper
        );
        self.axes(&mut svg);
        for (place, (name, cells)) in lines.iter().enumerate() {
            let dodge = DODGE * (place as f64 - (lines.len() - 1) as f64 / 2.0);
            self.line(&mut svg, place, dodge, cells);
            if legend > 0 {
                let y = LEGEND_STEP.mul_add(place as f64, BOTTOM + 70.0);
                LineStyle::new(place, self.palette).key(&mut svg, [LEFT, y], name);
            }
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// The factor along x: the one with the most levels, of several the last.
    fn along_x(&self) -> usize {
        let levels = self.pictures.levels.iter().enumerate();
        levels
            .max_by_key(|(_, levels)| levels.len())
            .map_or(0, |(place, _)| place)
    }

    /// The cells of each line in the order of x, and the line's name.
    fn lines(&self) -> Vec<(String, Vec<&Mean<Vec<String>>>)> {
        let along_x = self.along_x();
        let mut lines: Vec<(String, Vec<&Mean<Vec<String>>>)> = Vec::new();
        for cell in &self.pictures.cells {
            let others = cell.of.iter().zip(&self.pictures.factors).enumerate();
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

    fn x(&self, level: &str) -> f64 {
        let levels = &self.pictures.levels[self.along_x()];
        let place = levels.iter().position(|known| known == level).unwrap_or(0);
        let step = (RIGHT - LEFT) / levels.len().max(1) as f64;
        step.mul_add(place as f64 + 0.5, LEFT)
    }

    fn y(&self, rating: f64) -> f64 {
        let (lowest, highest) = (f64::from(self.scale.lowest), f64::from(self.scale.highest));
        let share = (rating.clamp(lowest, highest) - lowest) / (highest - lowest);
        (BOTTOM - TOP).mul_add(-share, BOTTOM)
    }

    fn axes(&self, svg: &mut String) {
        let Palette { ink, faint, .. } = self.palette;
        let span = self.scale.highest - self.scale.lowest;
        let step = usize::try_from(1 + span / 10).unwrap_or(1);
        for rating in self.scale.ratings().step_by(step) {
            let y = self.y(f64::from(rating));
            _ = writeln!(
                svg,
                "<line x1=\"{LEFT}\" y1=\"{y:.2}\" x2=\"{RIGHT}\" y2=\"{y:.2}\" style=\"stroke:{faint}\" stroke-width=\"0.8\"/>\
                 <text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"end\" style=\"fill:{ink}\">{rating}</text>",
                LEFT - 9.0,
                y + 4.5
            );
        }
        let along_x = self.along_x();
        for level in &self.pictures.levels[along_x] {
            let x = self.x(level);
            _ = writeln!(
                svg,
                "<line x1=\"{x:.2}\" y1=\"{BOTTOM}\" x2=\"{x:.2}\" y2=\"{:.2}\" style=\"stroke:{ink}\" stroke-width=\"1\"/>\
                 <text x=\"{x:.2}\" y=\"{:.2}\" text-anchor=\"middle\" style=\"fill:{ink}\">{}</text>",
                BOTTOM + 5.0,
                BOTTOM + 21.0,
                escaped(level)
            );
        }
        let (middle, centre) = (f64::midpoint(TOP, BOTTOM), f64::midpoint(LEFT, RIGHT));
        _ = writeln!(
            svg,
            "<path d=\"M{LEFT},{TOP}V{BOTTOM}H{RIGHT}\" fill=\"none\" style=\"stroke:{ink}\" stroke-width=\"1\"/>\
             <text x=\"{centre}\" y=\"{:.2}\" text-anchor=\"middle\" font-size=\"14\" style=\"fill:{ink}\">{}</text>\
             <text transform=\"translate(20 {middle}) rotate(-90)\" text-anchor=\"middle\" font-size=\"14\" style=\"fill:{ink}\">Mean rating</text>",
            BOTTOM + 46.0,
            escaped(&self.pictures.factors[along_x])
        );
    }

    fn line(&self, svg: &mut String, place: usize, dodge: f64, cells: &[&Mean<Vec<String>>]) {
        let along_x = self.along_x();
        let style = LineStyle::new(place, self.palette);
        let at = |cell: &Mean<Vec<String>>| {
            [self.x(&cell.of[along_x]) + dodge, self.y(cell.summary.mean)]
        };
        let points: Vec<[f64; 2]> = cells.iter().map(|cell| at(cell)).collect();
        style.open(svg);
        style.path(svg, &points);
        for cell in cells {
            if let Some(half) = cell.summary.half_within {
                let [low, high] = [cell.summary.mean - half, cell.summary.mean + half];
                _ = writeln!(
                    svg,
                    "<path d=\"M{:.2},{:.2}V{:.2}\" stroke-width=\"1.1\"/>",
                    at(cell)[0],
                    self.y(low),
                    self.y(high)
                );
            }
            style.marker(svg, at(cell));
        }
        svg.push_str("</g>\n");
    }
}
