//! The power of a study against its number of subjects: a curve for each effect, the widths of the asymptotes'
//! intervals, and a table of the simple effects.
//!
//! Written as SVG directly, so that the bytes depend on nothing but the numbers.

use std::fmt::Write as _;

use crate::apa::fraction;
use crate::figure::{Palette, WIDTH};
use crate::line_style::LineStyle;
use crate::page::escaped;
use crate::power::{Power, PowerPoint};

const LEFT: f64 = 62.0;
const RIGHT: f64 = 742.0;
const TOP: f64 = 24.0;
/// The height of a panel with curves.
const PANEL: f64 = 230.0;
/// From one line of text to the next.
const STEP: f64 = 20.0;
/// With more numbers of subjects only every second, third and so on has its number and its column.
const MOST_LABELS: usize = 25;
const PALETTE: Palette = Palette::PRINT;

/// One line of a panel: a name, and for each number of subjects its value with its interval.
struct Line {
    name: String,
    values: Vec<[f64; 3]>,
}

/// A panel of curves.
struct Panel<'a> {
    title: &'a str,
    top: f64,
    highest: f64,
    /// From one number on the y axis to the next, and its decimals.
    step: f64,
    decimals: usize,
}

impl Power {
    /// The figure as an SVG document.
    pub fn to_svg(&self) -> String {
        let effects = self.lines(|point| &point.effects);
        let asymptotes = self.asymptote_lines();
        let mut body = String::new();
        let mut y = self.effect_panel(&mut body, &effects);
        if !asymptotes.is_empty() {
            y = self.width_panel(&mut body, y, &asymptotes);
        }
        let simple = self.lines(|point| &point.simple_effects);
        if !simple.is_empty() {
            y = self.grid(&mut body, y, &simple);
        }
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {y:.0}\" role=\"img\" \
             aria-label=\"Power against the number of subjects\" \
             font-family=\"Ubuntu, 'Helvetica Neue', Helvetica, Arial, sans-serif\" font-size=\"13\">\n\
             <rect width=\"{WIDTH}\" height=\"{y:.0}\" style=\"fill:{}\"/>\n{body}</svg>\n",
            PALETTE.paper
        )
    }

    fn lines(&self, of: fn(&PowerPoint) -> &Vec<crate::EffectPower>) -> Vec<Line> {
        let names = self.points.first().map(of).into_iter().flatten();
        let line = |(place, one): (usize, &crate::EffectPower)| Line {
            name: one.effect.clone(),
            values: (self.points.iter())
                .filter_map(|point| of(point).get(place))
                .map(|one| [one.power, one.low, one.high])
                .collect(),
        };
        names.enumerate().map(line).collect()
    }

    fn asymptote_lines(&self) -> Vec<Line> {
        let first = self.points.first().map(|point| &point.asymptotes);
        let line = |(place, one): (usize, &crate::AsymptoteWidth)| Line {
            name: if one.curve.is_empty() {
                "the curve".to_owned()
            } else {
                one.curve.clone()
            },
            values: (self.points.iter())
                .filter_map(|point| point.asymptotes.get(place))
                .map(|one| [one.width; 3])
                .collect(),
        };
        first.into_iter().flatten().enumerate().map(line).collect()
    }

    /// Draws the powers of the effects and returns where the next panel begins.
    fn effect_panel(&self, svg: &mut String, lines: &[Line]) -> f64 {
        let panel = Panel {
            title: "Power",
            top: TOP,
            highest: 1.0,
            step: 0.2,
            decimals: 1,
        };
        self.axes(svg, &panel);
        let target = panel.y(self.settings.target);
        // Writing to a `String` cannot fail, here and below.
        _ = writeln!(
            svg,
            "<path d=\"M{LEFT},{target:.2}H{RIGHT}\" style=\"stroke:{}\" stroke-width=\"1\" stroke-dasharray=\"1 3\"/>",
            PALETTE.ink
        );
        self.curves(svg, &panel, lines)
    }

    fn width_panel(&self, svg: &mut String, top: f64, lines: &[Line]) -> f64 {
        let values = lines.iter().flat_map(|line| &line.values);
        let largest = values.fold(0.0_f64, |largest, value| largest.max(value[0]));
        let step = round_step(largest / 5.0);
        let unit = self
            .points
            .first()
            .and_then(|point| point.asymptotes.first());
        let unit = unit.map_or("", |one| one.unit.as_str());
        let title = if unit.is_empty() {
            "Width of the interval".to_owned()
        } else {
            format!("Width of the interval ({unit})")
        };
        let panel = Panel {
            title: &title,
            top,
            highest: step * (largest / step).ceil().max(1.0),
            step,
            decimals: usize::from(step < 1.0),
        };
        self.axes(svg, &panel);
        self.curves(svg, &panel, lines)
    }

    fn x(&self, place: usize) -> f64 {
        let steps = self.points.len().max(2) - 1;
        let inset = 16.0;
        (RIGHT - LEFT - 2.0 * inset).mul_add(place as f64 / steps as f64, LEFT + inset)
    }

    fn axes(&self, svg: &mut String, panel: &Panel<'_>) {
        let Palette { ink, faint, .. } = PALETTE;
        let mut value = 0.0;
        while value <= panel.highest * (1.0 + 1e-9) {
            let (y, decimals) = (panel.y(value), panel.decimals);
            _ = writeln!(
                svg,
                "<path d=\"M{LEFT},{y:.2}H{RIGHT}\" style=\"stroke:{faint}\" stroke-width=\"0.8\"/>\
                 <text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"end\" style=\"fill:{ink}\">{value:.decimals$}</text>",
                LEFT - 9.0,
                y + 4.5
            );
            value += panel.step;
        }
        let bottom = panel.top + PANEL;
        let every = self.points.len().div_ceil(MOST_LABELS);
        for (place, point) in self.points.iter().enumerate().step_by(every) {
            let x = self.x(place);
            _ = writeln!(
                svg,
                "<path d=\"M{x:.2},{bottom:.2}v5\" style=\"stroke:{ink}\" stroke-width=\"1\"/>\
                 <text x=\"{x:.2}\" y=\"{:.2}\" text-anchor=\"middle\" style=\"fill:{ink}\">{}</text>",
                bottom + 21.0,
                point.subjects
            );
        }
        let (middle, centre) = (panel.top + PANEL / 2.0, f64::midpoint(LEFT, RIGHT));
        _ = writeln!(
            svg,
            "<path d=\"M{LEFT},{}V{bottom:.2}H{RIGHT}\" fill=\"none\" style=\"stroke:{ink}\" stroke-width=\"1\"/>\
             <text x=\"{centre}\" y=\"{:.2}\" text-anchor=\"middle\" font-size=\"14\" style=\"fill:{ink}\">Subjects</text>\
             <text transform=\"translate(20 {middle:.2}) rotate(-90)\" text-anchor=\"middle\" font-size=\"14\" style=\"fill:{ink}\">{}</text>",
            panel.top,
            bottom + 42.0,
            escaped(panel.title)
        );
    }

    fn curves(&self, svg: &mut String, panel: &Panel<'_>, lines: &[Line]) -> f64 {
        let legend = panel.top + PANEL + 66.0;
        for (place, line) in lines.iter().enumerate() {
            let style = LineStyle::new(place, PALETTE);
            let points: Vec<[f64; 2]> = (line.values.iter().enumerate())
                .map(|(point, value)| [self.x(point), panel.y(value[0])])
                .collect();
            style.open(svg);
            style.path(svg, &points);
            for (point, [_, low, high]) in line.values.iter().enumerate() {
                if high > low {
                    let x = self.x(point);
                    _ = writeln!(
                        svg,
                        "<path d=\"M{x:.2},{:.2}V{:.2}\" stroke-width=\"1\"/>",
                        panel.y(*low),
                        panel.y(*high)
                    );
                }
            }
            for [x, y] in points {
                style.marker(svg, [x, y]);
            }
            svg.push_str("</g>\n");
            let y = STEP.mul_add(place as f64, legend);
            style.key(svg, [LEFT, y], &line.name);
        }
        STEP.mul_add(lines.len() as f64, legend) + 12.0
    }

    /// The powers of the simple effects, two digits in a cell, darker as they rise.
    fn grid(&self, svg: &mut String, top: f64, lines: &[Line]) -> f64 {
        let ink = PALETTE.ink;
        let left = 190.0_f64;
        let every = self.points.len().div_ceil(MOST_LABELS);
        let n_columns = self.points.len().div_ceil(every);
        let width = ((RIGHT - left) / n_columns as f64).min(44.0);
        let row_height = 19.0_f64;
        _ = writeln!(
            svg,
            "<text x=\"{LEFT}\" y=\"{:.2}\" font-size=\"14\" style=\"fill:{ink}\">Power of the simple effects, in hundredths, after Holm; \
             columns are subjects</text>",
            top + 8.0
        );
        let first = top + 42.0;
        for (column, point) in self.points.iter().step_by(every).enumerate() {
            let x = width.mul_add(column as f64 + 0.5, left);
            _ = writeln!(
                svg,
                "<text x=\"{x:.2}\" y=\"{:.2}\" text-anchor=\"middle\" font-size=\"12\" style=\"fill:{ink}\">{}</text>",
                first - 6.0,
                point.subjects
            );
        }
        for (row, line) in lines.iter().enumerate() {
            let y = row_height.mul_add(row as f64, first);
            _ = writeln!(
                svg,
                "<text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"end\" font-size=\"12\" style=\"fill:{ink}\">{}</text>",
                left - 8.0,
                y + 14.0,
                escaped(&line.name)
            );
            for (column, value) in line.values.iter().step_by(every).enumerate() {
                let x = width.mul_add(column as f64, left);
                let text = fraction(value[0], 2);
                let paper = if value[0] > 0.55 { PALETTE.paper } else { ink };
                _ = writeln!(
                    svg,
                    "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{:.2}\" height=\"{:.2}\" style=\"fill:#23405c\" fill-opacity=\"{:.3}\"/>\
                     <text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"middle\" font-size=\"11\" style=\"fill:{paper}\">{}</text>",
                    width - 1.0,
                    row_height - 1.0,
                    0.06 + 0.94 * value[0],
                    x + width / 2.0,
                    y + 13.0,
                    text.trim_start_matches('.').replace("1.00", "100")
                );
            }
        }
        row_height.mul_add(lines.len() as f64, first) + 16.0
    }
}

impl Panel<'_> {
    fn y(&self, value: f64) -> f64 {
        PANEL.mul_add(1.0 - value / self.highest, self.top)
    }
}

/// The smallest of 1, 2 and 5 times a power of ten that is no less than `step`.
fn round_step(step: f64) -> f64 {
    let power = libm::pow(10.0, libm::floor(libm::log10(step.max(1e-6))));
    let round = [1.0, 2.0, 5.0].map(|digit| digit * power);
    round
        .into_iter()
        .find(|round| *round >= step * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}
