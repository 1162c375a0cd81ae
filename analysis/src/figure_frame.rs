//! What the figures of means have in common: paper, grid, axes and their titles.

use std::fmt::Write as _;

use crate::axis::Axis;
use crate::figure::{Palette, WIDTH};
use crate::page::escaped;

pub(crate) const RIGHT: f64 = 742.0;
pub(crate) const TOP: f64 = 18.0;
/// The least room for the numbers of the y axis.
const LEAST_LEFT: f64 = 62.0;
/// The width of a sign, about.
const SIGN: f64 = 7.2;
/// A label along x with more signs is cut.
const MOST_SIGNS: usize = 14;

/// The frame of a figure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    width: f64,
    pub(crate) left: f64,
    pub(crate) bottom: f64,
    pub(crate) axis: Axis,
    pub(crate) palette: Palette,
}

impl Frame {
    /// A frame down to `bottom`, with room for the numbers of `axis`.
    pub(crate) fn new(axis: Axis, bottom: f64, palette: Palette) -> Self {
        let numbers = axis.numbers();
        let most = numbers.iter().map(|(_, text)| text.chars().count()).max();
        Self {
            width: WIDTH,
            left: SIGN.mul_add(most.unwrap_or(0) as f64, 33.0).max(LEAST_LEFT),
            bottom,
            axis,
            palette,
        }
    }

    /// The same frame, so wide.
    pub(crate) const fn narrowed(self, width: f64) -> Self {
        Self { width, ..self }
    }

    /// The right end of the x axis.
    pub(crate) fn right(&self) -> f64 {
        self.width - (WIDTH - RIGHT)
    }

    /// The beginning of a document of this height and description, and its paper.
    pub(crate) fn opened(&self, height: f64, label: &str) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {height}\" role=\"img\" aria-label=\"{1}\" \
             font-family=\"Ubuntu, 'Helvetica Neue', Helvetica, Arial, sans-serif\" font-size=\"13\">\n\
             <rect width=\"{0}\" height=\"{height}\" style=\"fill:{2}\"/>\n",
            self.width,
            escaped(label),
            self.palette.paper
        )
    }

    /// The height of a value; beyond the axis, of its end.
    pub(crate) fn y(&self, value: f64) -> f64 {
        (self.bottom - TOP).mul_add(-self.axis.share(value), self.bottom)
    }

    /// The numbers of the y axis, with a line across for each.
    pub(crate) fn grid(&self, svg: &mut String) {
        let Palette { ink, faint, .. } = self.palette;
        let right = self.right();
        for (value, text) in self.axis.numbers() {
            let y = self.y(value);
            // Writing to a `String` cannot fail, here and below.
            _ = writeln!(
                svg,
                "<line x1=\"{0}\" y1=\"{y:.2}\" x2=\"{right}\" y2=\"{y:.2}\" style=\"stroke:{faint}\" stroke-width=\"0.8\"/>\
                 <text x=\"{1:.2}\" y=\"{2:.2}\" text-anchor=\"end\" style=\"fill:{ink}\">{text}</text>",
                self.left,
                self.left - 9.0,
                y + 4.5
            );
        }
    }

    /// Labels along x at their places; aslant, and cut, where they would touch. Gives the room that they take below the axis.
    pub(crate) fn labels(&self, svg: &mut String, labels: &[(f64, String)]) -> f64 {
        let step = (labels.windows(2))
            .map(|pair| pair[1].0 - pair[0].0)
            .fold(self.right() - self.left, f64::min);
        let signs = |text: &str| text.chars().count();
        let most = labels
            .iter()
            .map(|(_, text)| signs(text))
            .max()
            .unwrap_or(0);
        let is_aslant = SIGN.mul_add(most as f64, 4.0) > step;
        let ink = self.palette.ink;
        for (x, text) in labels {
            let tick = format!(
                "<line x1=\"{x:.2}\" y1=\"{0}\" x2=\"{x:.2}\" y2=\"{1:.2}\" style=\"stroke:{ink}\" stroke-width=\"1\"/>",
                self.bottom,
                self.bottom + 5.0
            );
            let text = escaped(&if is_aslant { cut(text) } else { text.clone() });
            _ = if is_aslant {
                writeln!(
                    svg,
                    "{tick}<text transform=\"translate({0:.2} {1:.2}) rotate(-40)\" text-anchor=\"end\" style=\"fill:{ink}\">{text}</text>",
                    x + 4.0,
                    self.bottom + 16.0
                )
            } else {
                writeln!(
                    svg,
                    "{tick}<text x=\"{x:.2}\" y=\"{:.2}\" text-anchor=\"middle\" style=\"fill:{ink}\">{text}</text>",
                    self.bottom + 21.0
                )
            };
        }
        if is_aslant {
            // sin 40° of the longest label.
            (0.643 * SIGN).mul_add(most.min(MOST_SIGNS) as f64, 24.0)
        } else {
            26.0
        }
    }

    /// Both axes and their titles; `room` is what the labels along x take.
    pub(crate) fn titles(&self, svg: &mut String, along_x: &str, along_y: &str, room: f64) {
        let ink = self.palette.ink;
        let (middle, centre) = (
            f64::midpoint(TOP, self.bottom),
            f64::midpoint(self.left, self.right()),
        );
        let right = self.right();
        _ = writeln!(
            svg,
            "<path d=\"M{0},{TOP}V{1}H{right}\" fill=\"none\" style=\"stroke:{ink}\" stroke-width=\"1\"/>\
             <text x=\"{centre}\" y=\"{2:.2}\" text-anchor=\"middle\" font-size=\"14\" style=\"fill:{ink}\">{3}</text>\
             <text transform=\"translate(20 {middle}) rotate(-90)\" text-anchor=\"middle\" font-size=\"14\" style=\"fill:{ink}\">{4}</text>",
            self.left,
            self.bottom,
            self.bottom + room + 21.0,
            escaped(along_x),
            escaped(along_y)
        );
    }
}

/// A label, cut where it is too long.
fn cut(text: &str) -> String {
    if text.chars().count() > MOST_SIGNS {
        let start: String = text.chars().take(MOST_SIGNS - 1).collect();
        return start + "…";
    }
    text.to_owned()
}
