//! Figure 10: mean rating against ray count, squares for the chromatic channels, diamonds for the achromatic
//! one, bars within subjects.
//!
//! Written as SVG directly, so that the bytes depend on nothing but the numbers and the colours can follow
//! the page. Shape, fill and line style tell the curves apart, so grey and any colour vision will do.

use std::fmt::Write as _;

use protocols::{ChannelGroup, RayCount};

use crate::axis::Axis;
use crate::figure_frame::{Frame, RIGHT};
use crate::study_analysis::{ConditionMean, StudyAnalysis};

/// The width of the figure, in user units.
pub(crate) const WIDTH: f64 = 760.0;
pub(crate) const HEIGHT: f64 = 470.0;
pub(crate) const BOTTOM: f64 = 404.0;
/// How far the two curves stand apart, so that their bars do not cover each other.
const DODGE: f64 = 3.5;

/// The colours of a figure, as CSS values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Palette {
    pub(crate) ink: &'static str,
    pub(crate) faint: &'static str,
    pub(crate) paper: &'static str,
    pub(crate) chromatic: &'static str,
    /// The first line of a design of any factors.
    pub(crate) blue: &'static str,
}

impl Palette {
    /// Black on white, vermilion (Okabe & Ito 2008) for the chromatic curve.
    pub(crate) const PRINT: Self = Self {
        ink: "#1a1a1a",
        faint: "#d9d9d9",
        paper: "#ffffff",
        chromatic: "#c64b00",
        blue: "#0072b2",
    };
    /// The colours of the page that the figure stands in.
    pub(crate) const PAGE: Self = Self {
        ink: "var(--ink)",
        faint: "var(--rule)",
        paper: "var(--paper)",
        chromatic: "var(--chromatic)",
        blue: "var(--blue)",
    };
}

/// What the figure shows.
#[derive(Debug)]
pub(crate) struct Figure<'a> {
    pub(crate) analysis: &'a StudyAnalysis,
    pub(crate) axis: Axis,
    pub(crate) confidence: f64,
    /// Who rated, such as `12 subjects`.
    pub(crate) who: &'a str,
    pub(crate) palette: Palette,
}

impl Figure<'_> {
    /// The figure as an SVG document.
    pub(crate) fn to_svg(&self) -> String {
        let mut svg = self
            .opened("Mean rating against ray count for the achromatic and the chromatic sequence");
        self.axes(&mut svg);
        self.plateaus(&mut svg);
        self.legend(&mut svg); // Below the curves, so that it never hides a rating.
        for group in ChannelGroup::ALL {
            self.curve(&mut svg, group);
        }
        svg.push_str("</svg>\n");
        svg
    }

    fn frame(&self) -> Frame {
        Frame::new(self.axis, BOTTOM, self.palette)
    }

    /// The beginning of a document with this description, and its paper.
    pub(crate) fn opened(&self, label: &str) -> String {
        self.frame().opened(HEIGHT, label)
    }

    pub(crate) fn x(&self, rays: RayCount) -> f64 {
        self.x_of(f64::from(rays.get()))
    }

    fn x_of(&self, rays: f64) -> f64 {
        let counts = self.analysis.ray_counts();
        let number = |rays: &RayCount| f64::from(rays.get());
        let first = counts.first().map_or(0.0, number);
        let last = counts.last().map_or(1.0, number);
        let inset = 22.0;
        let share = if last > first {
            (rays - first) / (last - first)
        } else {
            0.5
        };
        let left = self.frame().left;
        (RIGHT - left - 2.0 * inset).mul_add(share, left + inset)
    }

    /// The height of a rating; beyond the axis, of its end.
    pub(crate) fn y(&self, rating: f64) -> f64 {
        self.frame().y(rating)
    }

    pub(crate) fn axes(&self, svg: &mut String) {
        let frame = self.frame();
        frame.grid(svg);
        let counts = self.analysis.ray_counts().into_iter();
        let labels: Vec<(f64, String)> = counts
            .map(|rays| (self.x(rays), rays.to_string()))
            .collect();
        let room = frame.labels(svg, &labels);
        frame.titles(svg, "Rays for the varied channels", "Mean rating", room);
    }

    fn curve(&self, svg: &mut String, group: ChannelGroup) {
        let style = CurveStyle::of(group, self.palette);
        let conditions: Vec<&ConditionMean> = (self.analysis.ray_counts().into_iter())
            .filter_map(|rays| self.analysis.condition(group, rays))
            .collect();
        let place = |condition: &ConditionMean| {
            (self.x(condition.rays) + style.dodge, self.y(condition.mean))
        };
        let points: Vec<String> = (conditions.iter())
            .map(|condition| place(condition))
            .map(|(x, y)| format!("{x:.2},{y:.2}"))
            .collect();
        let color = style.color;
        _ = writeln!(
            svg,
            "<g style=\"stroke:{color}\" stroke-width=\"1.5\" fill=\"none\">"
        );
        _ = writeln!(
            svg,
            "<polyline points=\"{}\" {}/>",
            points.join(" "),
            style.dash
        );
        for condition in &conditions {
            if let Some(half) = condition.half_within {
                let (x, _) = place(condition);
                self.error_bar(svg, x, condition.mean, half);
            }
        }
        for condition in &conditions {
            let (x, y) = place(condition);
            style.marker(svg, x, y, self.palette);
        }
        svg.push_str("</g>\n");
    }

    /// The plateau fitted to each curve, with the interval of its corner above the axis.
    fn plateaus(&self, svg: &mut String) {
        let Some(found) = &self.analysis.table.asymptotes else {
            return;
        };
        // Ray counts are written as 10K or 500.
        let unit = if found.unit == "K" { 1000.0 } else { 1.0 };
        for (row, group) in ChannelGroup::ALL.into_iter().enumerate() {
            let Some(curve) = found
                .curves
                .iter()
                .find(|curve| curve.level == group.level())
            else {
                continue;
            };
            let style = CurveStyle::of(group, self.palette);
            let (first, last) = (curve.x[0], curve.x[curve.x.len() - 1]);
            let at = |x: f64| {
                (
                    self.x_of(unit * x) + style.dodge,
                    self.y(curve.fit.at(x, 1)),
                )
            };
            let [(x1, y1), (x2, y2), (x3, y3)] = [first, curve.fit.psi, last].map(at);
            let y = BOTTOM - 7.0 - 11.0 * row as f64;
            let [low, middle, high] =
                [curve.psi.low, curve.psi.value, curve.psi.high].map(|x| self.x_of(unit * x));
            _ = writeln!(
                svg,
                "<g style=\"stroke:{}\" fill=\"none\"><path d=\"M{x1:.2},{y1:.2}L{x2:.2},{y2:.2}L{x3:.2},{y3:.2}\" \
                 stroke-width=\"4\" stroke-opacity=\"0.22\"/><path d=\"M{low:.2},{y:.2}H{high:.2}M{middle:.2},{:.2}v7\" \
                 stroke-width=\"2\"/></g>",
                style.color,
                y - 3.5
            );
        }
    }

    fn error_bar(&self, svg: &mut String, x: f64, mean: f64, half: f64) {
        // Beyond the plot a bar is cut, without a cap; ratings cannot lie there.
        let Axis { low, high, .. } = self.axis;
        let cap = 3.0;
        let mut path = format!(
            "M{x:.2},{:.2}V{:.2}",
            self.y(mean - half),
            self.y(mean + half)
        );
        for end in [mean - half, mean + half] {
            if (low..=high).contains(&end) {
                _ = write!(path, "M{:.2},{:.2}h{:.2}", x - cap, self.y(end), 2.0 * cap);
            }
        }
        _ = writeln!(svg, "<path d=\"{path}\" stroke-width=\"1.1\"/>");
    }

    fn legend(&self, svg: &mut String) {
        let ink = self.palette.ink;
        let has_plateaus = self.analysis.table.asymptotes.is_some();
        let [raised, height] = if has_plateaus {
            [46.0, 116.0]
        } else {
            [0.0, 92.0]
        };
        let (left, top) = (RIGHT - 318.0, BOTTOM - 106.0 - raised);
        _ = writeln!(
            svg,
            "<rect x=\"{}\" y=\"{}\" width=\"326\" height=\"{}\" style=\"fill:{}\"/>",
            left - 8.0,
            top - 13.0,
            height,
            self.palette.paper
        );
        let entries = [
            (
                ChannelGroup::Chromatic,
                "chromatic channels (C1, C2) varied, A held",
            ),
            (
                ChannelGroup::Achromatic,
                "achromatic channel (A) varied, C1 and C2 held",
            ),
        ];
        for (row, entry) in entries.into_iter().enumerate() {
            self.curve_legend(svg, entry, [left, 22.0_f64.mul_add(row as f64, top)]);
        }
        let y = top + 44.0;
        let percent = self.confidence * 100.0;
        _ = writeln!(
            svg,
            "<path d=\"M{0},{1}v16M{2},{1}h6M{2},{3}h6\" fill=\"none\" style=\"stroke:{ink}\" stroke-width=\"1.1\"/>\
             <text x=\"{4}\" y=\"{5}\" style=\"fill:{ink}\">{percent}% within-subject intervals, Cousineau–Morey</text>",
            left + 16.0,
            y - 8.0,
            left + 13.0,
            y + 8.0,
            left + 42.0,
            y + 4.5
        );
        _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" style=\"fill:{ink}\">{}</text>",
            left + 42.0,
            y + 26.5,
            self.who
        );
        if has_plateaus {
            self.plateau_legend(svg, left, y + 44.0);
        }
    }

    fn curve_legend(&self, svg: &mut String, entry: (ChannelGroup, &str), place: [f64; 2]) {
        let ((group, text), [left, y]) = (entry, place);
        let style = CurveStyle::of(group, self.palette);
        _ = writeln!(
            svg,
            "<g style=\"stroke:{}\" stroke-width=\"1.5\" fill=\"none\"><path d=\"M{left},{y}h32\" {}/>",
            style.color, style.dash
        );
        style.marker(svg, left + 16.0, y, self.palette);
        _ = writeln!(
            svg,
            "</g><text x=\"{}\" y=\"{}\" style=\"fill:{}\">{text}</text>",
            left + 42.0,
            y + 4.5,
            self.palette.ink
        );
    }

    fn plateau_legend(&self, svg: &mut String, left: f64, y: f64) {
        let ink = self.palette.ink;
        let percent = self.confidence * 100.0;
        _ = writeln!(
            svg,
            "<path d=\"M{left},{0}l16,-7h16\" fill=\"none\" style=\"stroke:{ink}\" stroke-width=\"4\" stroke-opacity=\"0.22\"/>\
                 <text x=\"{1}\" y=\"{2}\" style=\"fill:{ink}\">fitted plateau, {percent}% interval of its corner</text>",
            y + 3.0,
            left + 42.0,
            y + 4.5
        );
    }
}

/// How a curve looks.
pub(crate) struct CurveStyle {
    group: ChannelGroup,
    pub(crate) color: &'static str,
    dash: &'static str,
    dodge: f64,
}

impl CurveStyle {
    pub(crate) fn of(group: ChannelGroup, palette: Palette) -> Self {
        match group {
            ChannelGroup::Chromatic => Self {
                group,
                color: palette.chromatic,
                dash: "",
                dodge: DODGE,
            },
            ChannelGroup::Achromatic => Self {
                group,
                color: palette.ink,
                dash: "stroke-dasharray=\"5 3\"",
                dodge: -DODGE,
            },
        }
    }

    /// A filled square, or an open diamond.
    pub(crate) fn marker(&self, svg: &mut String, x: f64, y: f64, palette: Palette) {
        let (path, fill) = match self.group {
            ChannelGroup::Chromatic => (
                format!("M{:.2},{:.2}h9v9h-9z", x - 4.5, y - 4.5),
                self.color,
            ),
            ChannelGroup::Achromatic => (
                format!("M{:.2},{y:.2}l6,-6l6,6l-6,6z", x - 6.0),
                palette.paper,
            ),
        };
        _ = writeln!(svg, "<path d=\"{path}\" style=\"fill:{fill}\"/>");
    }
}
